"""Documents of COLLADA 1.4 against their own schema."""

from __future__ import annotations

from lxml import etree

from colladaphy.gate.faults import violations
from colladaphy.gate.messages import Violation
from colladaphy.gate.schema import schema_1_4

__all__ = ["violations_1_4"]


def violations_1_4(tree: etree._ElementTree) -> list[tuple[etree._Element, Violation]] | None:
    """The deviations of a tree from the schema of 1.4.1; None where that is not there."""
    schema = schema_1_4()
    return None if schema is None else violations(tree, schema=schema)
