"""What ``xsi:type`` can see of a type: its named ancestors and how it derives from each."""

from typing import Any

from xmlschema.validators import XsdList, XsdUnion

ANY = "anyType"


def ancestors(declared: Any) -> tuple[tuple[str, frozenset[str]], ...]:
    """The named ancestors of a type, nearest first, each with the methods on the way to it."""
    chain: list[tuple[str, frozenset[str]]] = []
    methods: set[str] = set()
    step = declared
    while step is not None:
        base = step.base_type
        methods.add(_method(step))
        if base is None:
            chain.append((ANY, frozenset(methods)))
            break
        if base.name:
            chain.append((base.name, frozenset(methods)))
        if base is step:
            break
        step = base
    return tuple(chain)


def _method(declared: Any) -> str:
    if getattr(declared, "derivation", None):
        return str(declared.derivation)
    if isinstance(declared, XsdList):
        return "list"
    if isinstance(declared, XsdUnion):
        return "union"
    return "restriction"  # a complex type without a base restricts anyType


def control(value: Any) -> frozenset[str]:
    """A ``block`` or ``final`` as the set of methods it names."""
    return frozenset(str(value).split()) if value else frozenset()
