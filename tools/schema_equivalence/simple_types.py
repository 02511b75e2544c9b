"""Simple types as comparable signatures: variety, root and effective facets."""

from typing import Any

from xmlschema.validators import XsdList, XsdUnion

XSD = "{http://www.w3.org/2001/XMLSchema}"

Signature = tuple[Any, ...]


def is_builtin(component: Any) -> bool:
    return bool(component.name) and component.name.startswith(XSD)


def signature(simple: Any, names: bool) -> Signature:
    """A simple type's signature; restrictions without facets collapse into their base.

    With ``names`` the members of a union keep theirs, because ``xsi:type`` can name them.
    """
    facets: dict[str, Any] = {}
    patterns: list[tuple[str, ...]] = []  # of one step: either; of several steps: all
    while True:
        if is_builtin(simple):
            root: Signature = ("builtin", simple.name.removeprefix(XSD))
            inherited = _own_facets(simple)
            break
        if isinstance(simple, XsdList):
            root = ("list of", signature(simple.item_type, names))
            inherited = {"whiteSpace": "collapse"}
            break
        if isinstance(simple, XsdUnion):
            root = ("union of", tuple(_members(simple, names)))
            inherited = {"whiteSpace": "collapse"}
            break
        own = _own_facets(simple)
        if "pattern" in own:
            patterns.append(own.pop("pattern"))
        for name, value in own.items():
            facets.setdefault(name, value)  # the nearest derivation step wins
        simple = simple.base_type
        if simple.is_complex():
            simple = simple.content
    facets = {name: value for name, value in facets.items() if inherited.get(name) != value}
    if "minLength" in facets and facets["minLength"] == facets.get("maxLength"):
        facets["length"] = facets.pop("minLength")
        del facets["maxLength"]
    if patterns:
        facets["patterns"] = tuple(sorted(patterns))
    return ("restriction", root, tuple(sorted(facets.items()))) if facets else root


def _members(union: Any, names: bool) -> list[Signature]:
    """The members in order: the first that accepts a text is the type it gets."""
    return [
        (member.name if names else None, signature(member, names)) for member in union.member_types
    ]


def _own_facets(simple: Any) -> dict[str, Any]:
    facets: dict[str, Any] = {}
    for name, facet in (simple.facets or {}).items():
        if not name:  # a validator of the library, not a facet of the schema
            continue
        local = name.removeprefix(XSD)
        if local == "enumeration":
            facets[local] = frozenset(map(str, facet.enumeration))
        elif local == "pattern":
            facets[local] = tuple(sorted(facet.regexps))
        else:
            facets[local] = facet.value
    return facets


def value(declared: Any, text: str | None) -> Any:
    """A default or fixed text in the value space of its type; ``1`` and ``1.0`` are one float."""
    if text is None:
        return None
    simple = declared if declared.is_simple() else declared.content
    if not hasattr(simple, "decode") or not simple.is_simple():
        return text  # mixed content
    decoded = simple.decode(text)
    return tuple(decoded) if isinstance(decoded, list) else decoded
