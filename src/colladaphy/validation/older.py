"""Documents of COLLADA 1.4: against their own schema, and what 1.5 has no place for."""

from __future__ import annotations

import math
from collections.abc import Iterator

from lxml import etree

from colladaphy.findings import Rule, Severity
from colladaphy.gate.faults import violations
from colladaphy.gate.messages import Violation
from colladaphy.gate.schema import schema_1_4
from colladaphy.links.rules import MISSING, WRONG_TYPE
from colladaphy.meaning import physics_rules
from colladaphy.source import COLLADA_1_4

__all__ = ["Told", "meant_1_4", "violations_1_4"]

NS = f"{{{COLLADA_1_4}}}"
_TAPERED = ("tapered_cylinder", "tapered_capsule")

Told = tuple[etree._Element, Rule, str, Severity | None]
"""An element, the rule, what is wrong, and another severity."""


def violations_1_4(tree: etree._ElementTree) -> list[tuple[etree._Element, Violation]] | None:
    """The deviations of a tree from the schema of 1.4.1; None where that is not there."""
    schema = schema_1_4()
    return None if schema is None else violations(tree, schema=schema)


def meant_1_4(tree: etree._ElementTree) -> Iterator[Told]:
    """What is wrong with the meaning of elements that the copy of 1.5 has not any more."""
    yield from _surfaces(tree)
    yield from _tapered(tree)


def _surfaces(tree: etree._ElementTree) -> Iterator[Told]:
    """Samplers without a surface, and surfaces without an image (1.4.1 §sampler2D, §surface)."""
    texts = {
        name: [found for kind in tree.iter(NS + name) for found in kind.iterchildren(NS + child)]
        for name, child in (("surface", "init_from"), *((f"sampler{kind}", "source")
                            for kind in ("1D", "2D", "3D", "CUBE", "RECT", "DEPTH")))
    }  # fmt: skip
    images = texts.pop("surface")
    if images:
        ids = {element.get("id"): element for element in tree.iter(etree.Element)
               if element.get("id")}  # fmt: skip
    for element in images:
        name = (element.text or "").strip()
        target = ids.get(name)
        if target is None:
            yield element, MISSING, f"There is no image of the id {name!r}.", Severity.WARNING
        elif target.tag != NS + "image":
            found = etree.QName(target).localname
            message = f"{name!r} is a <{found}>, not an <image>."
            yield element, WRONG_TYPE, message, Severity.WARNING
    known: dict[etree._Element, set[str | None]] = {}
    for sources in texts.values():
        for element in sources:
            name = (element.text or "").strip()
            effect = next(element.iterancestors(NS + "effect"), None)
            if effect is None:
                continue
            if effect not in known:
                known[effect] = _surfaces_of(effect)
            if name in known[effect]:
                continue
            message = f"There is no surface of the sid {name!r} in the effect."
            yield element, MISSING, message, Severity.WARNING


def _surfaces_of(effect: etree._Element) -> set[str | None]:
    return {param.get("sid") for param in effect.iter(NS + "newparam", NS + "setparam")
            if param.find(NS + "surface") is not None}  # fmt: skip


def _tapered(tree: etree._ElementTree) -> Iterator[Told]:
    """Tapered shapes whose sizes are none (1.4.1 §tapered_cylinder, §tapered_capsule)."""
    for shape in tree.iter(*(NS + name for name in _TAPERED)):
        what = etree.QName(shape).localname.replace("_", " ")
        for child in shape.iterchildren(NS + "height", NS + "radius1", NS + "radius2"):
            name, words = etree.QName(child).localname, (child.text or "").split()
            try:
                numbers = [float(word.replace("INF", "inf")) for word in words]
            except ValueError:
                continue  # the schema tells it
            least = min(numbers, default=1.0)
            none = name == "height" and least == 0.0 and what == "tapered cylinder"
            if all(map(math.isfinite, numbers)) and least >= 0.0 and not none:
                continue
            message = f"The {name} of the {what} is {' '.join(words)}."
            yield child, physics_rules.SHAPE_SIZE, message, Severity.WARNING if none else None
