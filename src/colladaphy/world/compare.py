"""Two Worlds compared, bit by bit or within a tolerance."""

from __future__ import annotations

import math

from colladaphy.world import values
from colladaphy.world.differences import Difference, Tolerance, differences, texts
from colladaphy.world.rules import ARGUMENT, refuse
from colladaphy.world.world import World

__all__ = ["compare", "differing"]

_MOST = 10  # differences named per column; the rest are counted


def compare(
    first: World, second: World, rtol: float = 0.0, atol: float = 0.0, *,
    unused_materials: bool = False,
) -> list[str]:  # fmt: skip
    """Every difference between two Worlds, one line each; an empty list if there is none.

    Without tolerances floats are equal if their bits are: zeros of different sign differ, a NaN
    equals itself. With them, numbers may be apart by `atol` + `rtol` times the larger size of the
    two (that of a vector's largest number); quaternions may differ in sign, and the state of an
    engine, which is no number, is left out. Lines say how far numbers are apart.

    Meshes are compared by content, whatever their ids. Materials that no body has are left out,
    with their pairs, unless asked for: a file does not keep them (thesis 5.4).
    """
    found = differing(first, second, rtol, atol, unused_materials=unused_materials)
    return texts(found, _MOST)


def differing(
    first: World, second: World, rtol: float = 0.0, atol: float = 0.0, *,
    unused_materials: bool = False,
) -> list[Difference]:  # fmt: skip
    """The same, all of them as objects with numbers."""
    for name, world in (("first", first), ("second", second)):
        if not isinstance(world, World):
            raise refuse(ARGUMENT, f"The {name} is {world!r}, not a World.")
    numbers = [values.number(name, value) for name, value in (("rtol", rtol), ("atol", atol))]
    if not all(0.0 <= number < math.inf for number in numbers):
        raise refuse(ARGUMENT, f"The tolerances are {rtol!r} and {atol!r}.")
    tolerance = Tolerance(*numbers)
    return differences(first, second, tolerance, unused_materials=unused_materials)
