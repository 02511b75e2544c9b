"""Where the elements of a mended copy come from, and what was mended at them."""

from __future__ import annotations

from lxml import etree

__all__ = ["Trace"]


class Trace:
    """Follows the elements of a document through one run of conform.

    Elements are named by their numbers: their places among all elements of the document as it
    came, from 0.
    """

    def __init__(self) -> None:
        self._numbers: dict[etree._Element, int] = {}
        self.repairs: list[tuple[str, int]] = []
        """The codes of the changes, each with the element that it was made at."""

    def begin(self, root: etree._Element) -> None:
        """Start from a copy in which nothing has been changed yet."""
        self._numbers = {element: n for n, element in enumerate(root.iter(etree.Element))}

    def note(self, code: str, element: etree._Element | None) -> None:
        """A change at an element, or near it where it is new."""
        while element is not None and element not in self._numbers:
            element = element.getparent()
        self.repairs.append((code, 0 if element is None else self._numbers[element]))

    def numbers(self, root: etree._Element, *, inherited: bool = False) -> list[int]:
        """What each element of the copy was in the document; -1 for one that is new.

        `inherited` takes for new ones the element that they were made in.
        """
        found = []
        for element in root.iter(etree.Element):
            node: etree._Element | None = element
            number = self._numbers.get(element, -1)
            while inherited and number < 0 and node is not None:
                number = self._numbers.get(node, -1)
                node = node.getparent()
            found.append(number)
        return found
