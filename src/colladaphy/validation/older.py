"""Documents of COLLADA 1.4 against their own schema."""

from __future__ import annotations

from functools import cache
from importlib import import_module

from lxml import etree

from colladaphy.gate.faults import violations
from colladaphy.gate.messages import Violation

__all__ = ["schema_1_4", "violations_1_4"]


@cache
def schema_1_4() -> etree.XMLSchema | None:
    """The schema of 1.4.1 that pycollada ships; None where that is not installed."""
    try:
        pycollada = import_module("collada.schema")
    except ImportError:
        return None
    schema: etree.XMLSchema = pycollada.ColladaValidator().COLLADA_SCHEMA_1_4_1_INSTANCE
    return schema


def violations_1_4(tree: etree._ElementTree) -> list[tuple[etree._Element, Violation]] | None:
    """The deviations of a tree from the schema of 1.4.1; None where that is not there."""
    schema = schema_1_4()
    return None if schema is None else violations(tree, schema=schema)
