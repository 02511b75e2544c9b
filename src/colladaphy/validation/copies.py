"""Mended copies of a document, to look at what is behind its faults, with its own elements."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection
from dataclasses import dataclass, field
from functools import cached_property

from lxml import etree

from colladaphy.conform import conform
from colladaphy.conform.thesis_profile import in_our_spelling
from colladaphy.conform.trace import Trace

__all__ = ["Copy"]


@dataclass(frozen=True)
class Copy:
    """A tree, and what each of its elements was in the document as it came."""

    tree: etree._ElementTree
    numbers: list[int]
    """The number in the document of each element, in order; -1 for one that is new."""
    repairs: tuple[tuple[str, int], ...] = field(default=())
    """The codes of what was changed, each with the number of the element."""

    @classmethod
    def of(cls, tree: etree._ElementTree) -> Copy:
        """The document itself."""
        return cls(tree, list(range(sum(1 for _ in tree.iter(etree.Element)))))

    def mended(
        self,
        only: Collection[str] | None = None,
        *,
        convention: str = "none",
        inherited: bool = False,
    ) -> Copy:
        """A copy in which some rules of conform are kept.

        `inherited` takes for new elements those that they were made in.
        """
        trace = Trace()
        twin, _ = conform(self.tree, convention=convention, only=only, trace=trace)
        if twin is self.tree:
            return self
        return self._followed(twin, trace, inherited=inherited)

    def in_our_spelling(self) -> Copy:
        """A copy in which the pe profile is spelled as the schema has it."""
        trace = Trace()
        twin = in_our_spelling(self.tree, trace)
        return self if twin is None else self._followed(twin, trace, inherited=True)

    def upon(self, other: Copy) -> Copy:
        """The same copy, of which `other` has the elements, with the numbers of that one."""
        numbers = [-1 if number < 0 else other.numbers[number] for number in self.numbers]
        repairs = [(code, other.numbers[number]) for code, number in self.repairs]
        return Copy(self.tree, numbers, (*other.repairs, *repairs))

    def _followed(self, twin: etree._ElementTree, trace: Trace, *, inherited: bool) -> Copy:
        numbers = trace.numbers(twin.getroot(), inherited=inherited)
        return Copy(twin, numbers, tuple(trace.repairs)).upon(self)

    @cached_property
    def by_element(self) -> dict[etree._Element, int]:
        """The number in the document of each element of the copy."""
        return dict(zip(self.tree.iter(etree.Element), self.numbers, strict=True))

    @cached_property
    def parents(self) -> dict[int, int]:
        """The number of what each element stands in, by its own number."""
        found: dict[int, int] = {}
        for element, number in self.by_element.items():
            above = element.getparent()
            if above is not None:
                found.setdefault(number, self.by_element[above])
        return found

    @cached_property
    def repaired(self) -> dict[int, list[str]]:
        """The codes of what was changed, by the number of the element."""
        found: defaultdict[int, list[str]] = defaultdict(list)
        for code, number in self.repairs:
            found[number].append(code)
        return dict(found)
