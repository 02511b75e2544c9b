"""Elements by their scoped ids (COLLADA 1.5 §Address syntax)."""

from __future__ import annotations

from collections import defaultdict
from functools import cached_property

from colladaphy.columns.reading import Document

__all__ = ["Sids"]


class Sids:
    """The scoped ids of one document."""

    def __init__(self, columns: Document) -> None:
        self.columns = columns

    @cached_property
    def _known(self) -> dict[str, list[int]]:
        """The elements of each sid, in the order of the document."""
        known: defaultdict[str, list[int]] = defaultdict(list)
        elements, texts = self.columns.with_attribute("sid")
        for element, text in zip(elements.tolist(), texts, strict=True):
            known[text].append(element)
        return known

    def within(self, scope: int, sid: str) -> int | None:
        """The element of a sid below `scope`: the nearest first, breadth before depth.

        What stands in a technique of some profile is that profile's own affair.
        """
        elements = self._known.get(sid)
        if elements is None:  # the end of a scope is dear to find
            return None
        end = self.columns.end_of(scope)
        best: tuple[int, int] | None = None
        for element in elements:
            if scope < element < end:
                depth = self._depth_below(scope, element)
                if depth is not None and (best is None or (depth, element) < best):
                    best = (depth, element)
        return None if best is None else best[1]

    def _depth_below(self, scope: int, element: int) -> int | None:
        depth = 0
        while element != scope:
            element = self.columns.parent_of(element)
            if element != scope and self.columns.is_profile(element):
                return None
            depth += 1
        return depth
