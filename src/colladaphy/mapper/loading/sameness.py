"""Which of two values is the newer one (thesis 6.2.1, left open there).

Software that does not know the pe profile keeps it and edits the common one. So the value of the
profile is compared with what the file's common profile says, to the precision that the file was
written with: equal, and the profile's value is taken, exact; different, and the common value is
the newer one. The precision is told from the numbers that stand in the same record: at least the
six significant digits that C++ streams write by default. It is measured only for records that do
not agree by the strictest measure, that of fifteen digits: what agrees by it agrees by any.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.links.poses import reach, unit_quaternions
from colladaphy.links.resource import Resource

__all__ = ["Sameness", "significant_digits", "tolerance_of"]

Array = NDArray[Any]

_FEWEST_DIGITS = 6
_ALL_DIGITS = 15
_STRICTEST = 0.5e-14
_TINIEST = 1e-307
# Radians beyond this have no degrees; the common profile says the largest number instead.
_LARGEST = 2.9e306


def significant_digits(word: bytes) -> int:
    """How many significant digits a number is written with."""
    # Java and Python write `.0` behind whole numbers, which are no more exact by it.
    mantissa = word.lower().partition(b"e")[0].lstrip(b"+-").removesuffix(b".0")
    digits = mantissa.replace(b".", b"").lstrip(b"0")
    if b"." not in mantissa:
        digits = digits.rstrip(b"0")
    return len(digits)


def tolerance_of(resource: Resource, *elements: int) -> float:
    """The relative difference up to which numbers in records are the same."""
    most = _FEWEST_DIGITS
    for element in elements:
        for text in resource.columns.record_texts(element):
            for word in text.split():
                if word[-1:].isdigit():
                    most = max(most, significant_digits(word))
    digits = min(most, _ALL_DIGITS)
    if resource.converted_digits is not None:
        digits = min(digits, max(_FEWEST_DIGITS, resource.converted_digits))
    # Half a unit of the last digit of a number that begins with 1, and some for arithmetic.
    return 0.5 * 10.0 ** (1 - digits) * 1.000001


class Sameness:
    """Compares what two profiles say of the same records, row by row."""

    def __init__(self, count: int, measure: Callable[[int], float]) -> None:
        self._measure = measure
        self._known = np.full(count, np.nan)

    def tolerances(self, rows: Array) -> Array:
        """How exactly the numbers of some records are written (n,)."""
        for row in rows[np.isnan(self._known[rows])].tolist():
            self._known[row] = self._measure(row)
        return self._known[rows]

    def _decided(self, rows: Array, same: Callable[[Array, Array], Any]) -> Array:
        """What holds by the strictest measure, or else by that of the record."""
        found: Array = same(np.full(len(rows), _STRICTEST), np.arange(len(rows)))
        unsure = np.flatnonzero(~found)
        if len(unsure):
            found[unsure] = same(self.tolerances(rows[unsure]), unsure)
        return found

    def each(self, rows: Array, one: Array, other: Array) -> Array:
        """Which vectors (n, m) agree in every number, each to its own size."""
        one, other = _by_row(one, len(rows)), _by_row(other, len(rows))
        return self._decided(rows, lambda tolerance, mine: _same(
            one[mine], other[mine], tolerance, np.zeros(len(mine))).all(axis=1))  # fmt: skip

    def scaled(self, rows: Array, one: Array, other: Array, scale: Array) -> Array:
        """Which numbers (n,) agree to their own size or to a scale (n,)."""
        return self._decided(rows, lambda tolerance, mine: _same(
            one[mine, None], other[mine, None], tolerance, scale[mine])[:, 0])  # fmt: skip

    def whole(self, rows: Array, one: Array, other: Array, extent: Array | float = 0.0) -> Array:
        """Which vectors (n, m) agree, where arithmetic has mixed their components.

        `extent` (n,) is the size of other numbers that took part in it.
        """
        one, other = _by_row(one, len(rows)), _by_row(other, len(rows))
        both = np.concatenate([one, other], axis=1)
        size = reach(np.where(np.isfinite(both), both, 0.0))
        scale = 4.0 * np.maximum(size, extent)
        return self._decided(rows, lambda tolerance, mine: _same(
            one[mine], other[mine], tolerance, scale[mine]).all(axis=1))  # fmt: skip

    def turn(self, rows: Array, one: Array, other: Array, steps: Array | int = 0) -> Array:
        """Which quaternions (n, 4) turn the same way.

        `steps` (n,) tells of how many turns they were composed, each of which was rounded.
        """
        first, second = unit_quaternions(one), unit_quaternions(other)
        several = np.broadcast_to(steps, (len(rows),))
        with np.errstate(all="ignore"):
            apart = np.minimum(
                np.sqrt(np.sum((first - second) ** 2, axis=1)),
                np.sqrt(np.sum((first + second) ** 2, axis=1)),
            )
        return self._decided(
            rows, lambda tolerance, mine: apart[mine] <= (8.0 + several[mine]) * tolerance
        )


def _same(one: Array, other: Array, tolerance: Array, scale: Array) -> Array:
    """Where numbers (n, m) are the same."""
    with np.errstate(all="ignore"):
        first, second = np.abs(one), np.abs(other)
        same: Array = np.asarray((one == other) | ((one != one) & (other != other)))
        if same.all():
            return same
        same |= (np.minimum(first, second) > _LARGEST) & ((one > 0) == (other > 0))
        size = np.maximum(np.maximum(first, second), scale[:, None])
        # The tiniest doubles have few bits, and what is tiny in radians has fewer in degrees.
        close = (np.abs(one - other) <= tolerance[:, None] * size) | (size < _TINIEST)
        return np.asarray(same | (close & np.isfinite(one) & np.isfinite(other)))


def _by_row(values: Array, count: int) -> Array:
    return values.reshape(count, -1) if count else np.zeros((0, 1))
