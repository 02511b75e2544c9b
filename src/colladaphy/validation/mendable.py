"""Which findings about the meaning of a document repair can mend, and by what."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import replace
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from colladaphy.findings import Finding
    from colladaphy.meaning.hits import Hit
    from colladaphy.validation.copies import Copy

__all__ = ["MENDED_BY", "is_mendable", "with_repairs"]

_STEPS = 3
"""How far around an element what is wrong with it may be mended."""

MENDED_BY: Final[dict[str, tuple[str, ...]]] = {
    "link-missing": (
        "repair-url-hash", "repair-escaped-reference", "repair-suffixed-reference",
        "repair-body-reference", "repair-attachment-reference", "repair-input-array",
        "repair-input-path", "repair-parent", "repair-dangling-target", "repair-dangling-scene",
        "repair-dangling-instance",
    ),
    "link-wrong-type": (
        "repair-input-array", "repair-attachment-reference", "repair-parent",
        "repair-dangling-target", "repair-dangling-scene", "repair-dangling-instance",
    ),
    "link-no-hash": ("repair-url-hash",),
    "link-cycle": ("repair-cycle",),
    "link-duplicate-sid": ("repair-duplicate-sid",),
    "link-body-twice": ("repair-ambiguous-constraint",),
    "link-not-rigid": ("repair-scaled-node",),
    "geometry-array-count": ("repair-count",),
    "geometry-accessor-range": ("repair-count",),
    "geometry-accessor-stride": ("repair-count",),
    "geometry-mixed-winding": ("repair-winding",),
    "geometry-inward": ("repair-winding",),
    "physics-hollow": ("convention-hollow",),
    "physics-gravity-unit": ("convention-gravity-unit",),
    "physics-joint-self": ("convention-world-joint",),
    "physics-joint-spring": ("convention-inert-spring",),
    "physics-joint-limits": ("convention-free-limits",),
    "physics-joint-radians": ("convention-angle-unit",),
}  # fmt: skip
"""Codes of repairs, by the code of what they mend, the likeliest first."""


def is_mendable(hit: Hit | Finding) -> bool:
    """Whether there is a repair for such a finding."""
    return getattr(hit, "rule", hit).code in MENDED_BY  # type: ignore[union-attr]


def with_repairs(hits: list[Hit], document: Copy) -> list[Hit]:
    """What was found, with the codes of the repairs that mend it."""
    if not any(map(is_mendable, hits)):
        return hits
    mended = document.mended(convention="auto")
    tree = Family(document)
    return [
        replace(hit, repair=tree.repair_near(hit, mended.repaired)) if is_mendable(hit) else hit
        for hit in hits
    ]


class Family:
    """What stands in what, by the numbers of elements."""

    def __init__(self, document: Copy) -> None:
        self.parents = document.parents
        self.children: defaultdict[int, list[int]] = defaultdict(list)
        for child, parent in self.parents.items():
            self.children[parent].append(child)

    def repair_near(self, hit: Hit, repaired: dict[int, list[str]]) -> str | None:
        """The likeliest repair of those that were made at an element, around it or in it."""
        fitting = MENDED_BY[hit.rule.code]
        around = [hit.element, *hit.related]
        for number in (hit.element, *hit.related):
            for _ in range(_STEPS):
                number = self.parents.get(number, -1)
                around.append(number)
        around += self.children.get(hit.element, ())
        around += self.children.get(self.parents.get(hit.element, -1), ())
        for number in around:
            made = repaired.get(number, ())
            for code in fitting:
                if code in made:
                    return code
        return None
