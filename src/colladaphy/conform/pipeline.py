"""The order in which a document is upgraded, repaired and translated."""

from __future__ import annotations

from collections.abc import Collection

from lxml import etree

from colladaphy.conform import rules
from colladaphy.conform.context import Context
from colladaphy.conform.identifiers import mend_ids, mend_sids
from colladaphy.conform.normalise import normalise
from colladaphy.conform.versions import copy_as_1_5, detect_version, note_version
from colladaphy.findings import Finding

__all__ = ["conform"]


def conform(
    tree: etree._ElementTree,
    *,
    file: str | None = None,
    convention: str = "auto",
    only: Collection[str] | None = None,
) -> tuple[etree._ElementTree, list[Finding]]:
    """Schema-valid COLLADA 1.5 that means what `tree` meant, and a finding for every change.

    `tree` itself is not touched. `convention` names whose reading of the standard the document
    follows (see `colladaphy.conform.conventions`); "auto" finds out, "none" takes the standard's.
    `only` limits the changes to rules of these codes. A second run changes nothing.
    """
    version = detect_version(tree)
    if version is None:
        finding = rules.NOT_COLLADA.at(tree.getroot(), file=file)
        return tree, [finding]
    twin, far_lines = copy_as_1_5(tree)
    origin = "colladaphy-1.4" if version.startswith("1.4") else "colladaphy-repair"
    context = Context(twin.getroot(), file=file, only=only, origin=origin)
    context.far_lines = far_lines
    note_version(context, tree.getroot(), version)
    mend_ids(context)
    mend_sids(context)
    normalise(context)
    return twin, context.findings
