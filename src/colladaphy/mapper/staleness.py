"""Which of two values is the newer one (thesis 6.2.1, left open there).

Software that does not know the pe profile keeps it and edits the common one. So the value of the
profile is compared with what the file's common profile says, to the precision that the file was
written with: equal, and the profile's value is taken, exact; different, and the common value is
the newer one. The precision is told from the numbers that stand in the same record: at least the
six significant digits that C++ streams write by default.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence

from lxml import etree

from colladaphy.document.names import local_name
from colladaphy.document.poses import Quaternion, unit_quaternion

__all__ = ["Precision", "same_rotation"]

_OTHERS = ("technique", "extra")
_FEWEST_DIGITS = 6
_ALL_DIGITS = 15
_TINIEST = 2.3e-308
# Radians beyond this have no degrees; the common profile says the largest number instead.
_LARGEST = 2.9e306


def significant_digits(word: str) -> int:
    """How many significant digits a number is written with."""
    mantissa = word.lower().partition("e")[0].lstrip("+-")
    digits = mantissa.replace(".", "").lstrip("0")
    if "." not in mantissa:
        digits = digits.rstrip("0")
    return len(digits)


def _texts(element: etree._Element) -> Iterator[str]:
    """The texts of an element and those in it, without what stands in other profiles."""
    if not isinstance(element.tag, str) or local_name(element.tag) in _OTHERS:
        return
    if element.text:
        yield element.text
    for child in element:
        yield from _texts(child)


class Precision:
    """How exactly the numbers of one record are written."""

    __slots__ = ("_records", "_tolerance")

    def __init__(self, records: Iterable[etree._Element]) -> None:
        self._records = tuple(records)
        self._tolerance: float | None = None

    @property
    def tolerance(self) -> float:
        """Relative difference up to which numbers are the same."""
        if self._tolerance is None:
            self._tolerance = self._measure()
        return self._tolerance

    def _measure(self) -> float:
        most = _FEWEST_DIGITS
        for record in self._records:
            for text in _texts(record):
                for word in text.split():
                    if word[-1:].isdigit():
                        most = max(most, significant_digits(word))
        digits = min(most, _ALL_DIGITS)
        # Half a unit of the last digit of a number that begins with 1, and some for arithmetic.
        return 0.5 * 10.0 ** (1 - digits) * 1.000001

    def same(self, one: float, other: float, scale: float = 0.0) -> bool:
        """Whether two numbers are the same; `scale` is that of the vector they are parts of."""
        if one == other or (one != one and other != other):
            return True
        if min(abs(one), abs(other)) > _LARGEST and (one > 0) == (other > 0):
            return True
        if math.isinf(one) or math.isinf(other):
            return False
        size = max(abs(one), abs(other), scale)
        # The tiniest doubles have few bits, so that half of one can be as large as the whole.
        return abs(one - other) <= self.tolerance * size or size < _TINIEST

    def same_each(self, one: Sequence[float], other: Sequence[float]) -> bool:
        """Whether all numbers are the same, each to its own size."""
        return len(one) == len(other) and all(map(self.same, one, other))

    def same_as_whole(
        self, one: Sequence[float], other: Sequence[float], extent: float = 0.0
    ) -> bool:
        """Whether vectors are the same, where arithmetic has mixed their components.

        `extent` is the size of other numbers that took part in it.
        """
        if len(one) != len(other):
            return False
        scale = max((abs(value) for value in (*one, *other) if math.isfinite(value)), default=0.0)
        scale = max(scale, extent)
        return all(self.same(a, b, 4.0 * scale) for a, b in zip(one, other, strict=True))

    def same_turn(self, one: Quaternion, other: Quaternion) -> bool:
        """Whether two quaternions turn the same way."""
        return same_rotation(one, other, 8.0 * self.tolerance)


def same_rotation(one: Quaternion, other: Quaternion, tolerance: float) -> bool:
    """Whether two quaternions of any length are the same rotation but for `tolerance` (radians)."""
    first, second = unit_quaternion(one), unit_quaternion(other)
    aligned = min(math.dist(first, second), math.dist(first, tuple(-value for value in second)))
    return aligned <= tolerance
