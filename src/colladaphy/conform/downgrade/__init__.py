"""The way back: a valid COLLADA 1.5 document as a valid 1.4.1 document.

What 1.4.1 says in other words is said so. What it cannot say goes, in the namespace of 1.5, to
``<technique profile="colladaphy-1.5">`` at the nearest place where 1.4.1 allows foreign content.
Each change of meaning is a finding.
"""

from __future__ import annotations

import copy

from lxml import etree

from colladaphy.conform.downgrade.draft import KEPT_PROFILE, Draft
from colladaphy.conform.downgrade.effects import change_effects
from colladaphy.conform.downgrade.images import change_images
from colladaphy.conform.downgrade.names import change_names
from colladaphy.conform.downgrade.namespace import NS14, in_namespace_1_4
from colladaphy.conform.downgrade.physics import change_physics
from colladaphy.conform.downgrade.sources import change_arrays
from colladaphy.conform.downgrade.structure import keep_libraries, keep_structure
from colladaphy.findings import Finding

__all__ = ["KEPT_PROFILE", "NS14", "to_collada_1_4"]

_STEPS = (
    keep_libraries,
    keep_structure,
    change_arrays,
    change_images,
    change_effects,
    change_physics,
    change_names,
)


def to_collada_1_4(tree: etree._ElementTree) -> tuple[etree._ElementTree, list[Finding]]:
    """The 1.4.1 document that says as much of a schema-valid 1.5 `tree` as 1.4.1 can.

    Returns a new tree and what was changed or set aside; `tree` itself is not touched.
    """
    draft = Draft(copy.deepcopy(tree).getroot())
    for step in _STEPS:
        step(draft)
    return etree.ElementTree(in_namespace_1_4(draft)), draft.findings
