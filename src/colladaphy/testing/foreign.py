"""Content that no schema declares, as a technique and a formula may hold it."""

from __future__ import annotations

from typing import Any

from hypothesis import strategies as st
from lxml import etree

from colladaphy.conform.grammar import NAMESPACE
from colladaphy.testing.building import MATHML

__all__ = ["fill_foreign"]

FOREIGN = "urn:example:foreign"
TAGS = ["plain", "a-b", f"{{{FOREIGN}}}thing", f"{{{FOREIGN}}}other", f"{{{NAMESPACE}}}system_id"]
MATHML_TAGS = [f"{{{MATHML}}}{name}" for name in ("apply", "plus", "ci", "cn", "eq")]
PREFIXES: list[Any] = [{None: FOREIGN}, {"f": FOREIGN}, {"ns0": FOREIGN}, {}]
ATTRIBUTES = ["a", "b", f"{{{FOREIGN}}}c", "{http://www.w3.org/XML/1998/namespace}space"]
TEXT = st.text("ab 0.1\n<&λ", max_size=6)
SPACE = st.sampled_from(["", "", "\n  "])


def fill_foreign(draw: st.DrawFn, parent: etree._Element, room: int) -> None:
    """Undeclared elements, comments and processing instructions; text only inside the elements."""
    mathematical = parent.tag == f"{{{MATHML}}}math"
    count = draw(st.integers(0, min(3, max(0, room) + 1)))
    for _ in range(count):
        _node(draw, parent, MATHML_TAGS if mathematical else TAGS, depth=2)
    if count:
        parent.text = draw(SPACE)


def _node(draw: st.DrawFn, parent: etree._Element, tags: list[str], depth: int) -> None:
    shape = draw(st.sampled_from(["element", "element", "element", "comment", "instruction"]))
    if shape == "comment":
        parent.append(etree.Comment(draw(st.sampled_from(["", " note ", "<x/>"]))))
    elif shape == "instruction":
        parent.append(etree.ProcessingInstruction("check", draw(st.sampled_from(["", "a='1'"]))))
    else:
        tag, nsmap = draw(st.sampled_from(tags)), draw(st.sampled_from(PREFIXES))
        element = etree.SubElement(parent, tag, nsmap=nsmap)
        for name in draw(st.lists(st.sampled_from(ATTRIBUTES), max_size=2, unique=True)):
            element.set(name, "preserve" if name.endswith("space") else draw(TEXT))
        element.text = draw(TEXT)
        if depth:
            for _ in range(draw(st.integers(0, 2))):
                _node(draw, element, tags, depth - 1)
    parent[-1].tail = draw(SPACE)
