"""What may be assumed where something required is missing: never physics, always reported."""

from __future__ import annotations

from lxml import etree

from colladaphy.conform.bodies import assumed_shape
from colladaphy.conform.context import NS, Context, local
from colladaphy.conform.grammar import ComplexType, Declaration, Group, SimpleType

__all__ = ["assumed_attribute", "assumed_element"]

_EPOCH = "1970-01-01T00:00:00Z"
_LIST_ELEMENTS = {
    "float_array", "int_array", "bool_array", "Name_array", "IDREF_array", "token_array",
    "SIDREF_array",
}  # fmt: skip
_PRIMITIVES = {"triangles", "polygons", "lines", "linestrips", "trifans", "tristrips", "polylist"}


def assumed_element(
    context: Context, parent: etree._Element, declaration: Declaration
) -> tuple[etree._Element, str] | None:
    """A new child for `parent` as `declaration` says, and why it is so; None where none may be."""
    name = declaration.name
    if name in ("created", "modified") and local(parent) == "asset":
        other = parent.find(NS + ("modified" if name == "created" else "created"))
        if other is not None and other.text:
            return context.make(name, other.text), f"{other.text} is taken from <{local(other)}>"
        return context.make(name, _EPOCH), f"nothing says when; {_EPOCH} is assumed"
    if name == "asset":
        asset = context.make("asset")
        asset.extend([context.make("created", _EPOCH), context.make("modified", _EPOCH)])
        return asset, f"nothing says who or when; {_EPOCH} is assumed"
    if name == "color":
        kind = declaration.type.value if isinstance(declaration.type, ComplexType) else None
        count = 3 if kind is None or kind.length is None else kind.length[0]
        return context.make("color", " ".join("0001"[:count])), "black"
    if name == "shape":
        why = (
            "nothing says what shape the body has; an empty hull, marked as assumed, stands for it"
        )
        return assumed_shape(context), why
    if name in ("translate", "rotate", "channel", "sampler", "link"):
        return None
    return _empty(context, declaration)


def _empty(context: Context, declaration: Declaration) -> tuple[etree._Element, str] | None:
    """An element that may be without attributes and content, with what it needs inside."""
    kind = declaration.type
    if isinstance(kind, SimpleType) or kind.value is not None:
        return None if declaration.default is None else (context.make(declaration.name), "")
    if kind.anything or any(attribute.required for attribute in kind.attributes.values()):
        return None
    element = context.make(declaration.name)
    return (element, "") if kind.content is None or _fill(context, element, kind.content) else None


def _fill(context: Context, element: etree._Element, content: Group) -> bool:
    if not content.low:
        return True
    if content.kind == "choice":
        return any(not part.low for part in content.parts)
    for part in content.parts:
        if not part.low:
            continue
        if isinstance(part, Group):
            if not _fill(context, element, part):
                return False
            continue
        for _ in range(part.low):
            inner = _empty(context, part)
            if inner is None:
                return False
            element.append(inner[0])
    return True


def assumed_attribute(
    context: Context, element: etree._Element, name: str
) -> tuple[str, str] | None:
    """A value for a required attribute that is missing, and why; None where none may be made."""
    kind = local(element)
    if name == "version" and kind == "COLLADA":
        return "1.5.0", "the namespace says so"
    if name == "id":
        return context.new_id(f"{local(element)}-unnamed"), "any free id does"
    if name == "sid":
        return _free_sid(element), "any free sid does"
    if name == "count":
        return _count(element)
    if name == "source" and kind == "accessor":
        return _array_of(context, element)
    if name == "profile" and kind == "technique":
        return "unknown", "the technique names no profile"
    if name == "texcoord":
        return "UVSET0", "the texture names no coordinates; the first set is meant"
    if name == "symbol" and kind == "instance_material":
        target = element.get("target", "")
        return (target.lstrip("#") or "material"), "the material it binds"
    if name == "type" and kind == "param":
        return "float", "a parameter is a number unless it says otherwise"
    if name in ("levels", "length") and kind in ("mips", "array"):
        return "1", "one is the least there can be"
    if name == "share":
        return "false", "nothing asks for sharing"
    if name == "platform":
        return "PC", "the default of COLLADA 1.4"
    if name == "offset" and kind == "input":
        return str(sum(1 for _ in element.itersiblings(element.tag, preceding=True))), "its order"
    if name == "stage":
        return None
    return None


def _array_of(context: Context, accessor: etree._Element) -> tuple[str, str] | None:
    """The array beside an accessor, which gets an id where it has none."""
    common = accessor.getparent()
    source = None if common is None else common.getparent()
    if source is None:
        return None
    for array in source:
        if local(array) in _LIST_ELEMENTS:
            if not array.get("id"):
                array.set("id", context.new_id(f"{source.get('id', 'source')}-array"))
            return f"#{array.get('id')}", "the array beside it"
    return None


def _free_sid(element: etree._Element) -> str:
    parent = element.getparent()
    near = [] if parent is None else [child.get("sid") for child in parent]
    name, number = local(element), 2
    while name in near:
        name, number = f"{local(element)}-{number}", number + 1
    return name


def _count(element: etree._Element) -> tuple[str, str] | None:
    kind = local(element)
    if kind in _LIST_ELEMENTS:
        return str(len((element.text or "").split())), "the number of its values"
    if kind in ("polylist", "vertex_weights", "wires", "faces", "shells", "solids"):
        counts = element.find(NS + "vcount")
        return str(0 if counts is None else len((counts.text or "").split())), "its vcount"
    if kind in _PRIMITIVES:
        indices = [len((p.text or "").split()) for p in element.iter(NS + "p")]
        if kind not in ("triangles", "lines"):
            return str(len(indices)), "the number of its <p>"
        offsets = [int(item.get("offset", "0")) for item in element.iter(NS + "input")]
        each = (max(offsets, default=0) + 1) * (3 if kind == "triangles" else 2)
        return str(sum(indices) // each), "the number of indices in its <p>"
    if kind == "accessor":
        source = element.getparent()
        source = None if source is None else source.getparent()
        if source is not None:
            for array in source:
                if local(array) in _LIST_ELEMENTS:
                    values = len((array.text or "").split())
                    stride = max(1, int(element.get("stride", "1") or 1))
                    return str(values // stride), "the values in its array by its stride"
    return None
