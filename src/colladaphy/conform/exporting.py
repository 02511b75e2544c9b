"""Documents for readers of COLLADA 1.4.1: converted, checked and as bytes."""

from __future__ import annotations

from typing import Any, Literal, get_args

from lxml import etree

from colladaphy.conform.bullet import for_bullet
from colladaphy.conform.downgrade import NS14, to_collada_1_4
from colladaphy.conform.downgrade.rules import INVALID
from colladaphy.errors import SchemaError
from colladaphy.findings import Finding
from colladaphy.gate.schema import schema_1_4
from colladaphy.source.splitting import with_short_texts

__all__ = ["TARGETS", "Target", "export"]

Target = Literal["bullet", "collada-1.4"]
TARGETS: tuple[Target, ...] = get_args(Target)


def export(tree: etree._ElementTree, target: Target) -> tuple[bytes, list[Finding]]:
    """A schema-valid 1.5 `tree` as the bytes of a 1.4.1 document, and what was changed.

    `target` is ``"bullet"`` for what Bullet's converter reads (thesis 5.6) or ``"collada-1.4"``
    for the standard's own meaning. The result is checked against the 1.4.1 schema where pycollada,
    which ships it, is installed. Raises SchemaError where the result is not valid, which can only
    be when `tree` was not; ValueError for another target.
    """
    if target not in TARGETS:
        raise ValueError(f"cannot export for {target!r}; choose one of {', '.join(TARGETS)}")
    convert = for_bullet if target == "bullet" else to_collada_1_4
    new, findings = convert(tree)
    data = etree.tostring(new, xml_declaration=True, encoding="UTF-8") + b"\n"
    errors = _errors(data)
    if errors:
        raise SchemaError(errors)
    return with_short_texts(data), findings


def _errors(data: bytes) -> list[Finding]:
    """What is wrong with the bytes that are about to be given out."""
    root = etree.fromstring(data, etree.XMLParser(resolve_entities=False, huge_tree=True))
    if root.tag != f"{{{NS14}}}COLLADA" or root.get("version") != "1.4.1":
        return [INVALID.at(root, f"The root of the result is {root.tag}.")]
    schema = schema_1_4()
    if schema is None or schema.validate(etree.ElementTree(root)):
        return []
    log: Any = schema.error_log  # its stubs do not know that it can be iterated
    return [
        INVALID.at(message=error.message, line=error.line, column=error.column) for error in log
    ]
