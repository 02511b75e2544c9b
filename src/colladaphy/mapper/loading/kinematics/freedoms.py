"""The axes of a joint as limits along and about the axes of one frame (COLLADA 1.5 §joint).

A World's joint has one frame whose axes are at right angles; its turns are about x, then y, then
z. What fits that is mapped, in the order of the axes; a single axis is z.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from colladaphy.mapper.loading.kinematics.models import Axis
from colladaphy.world import rotations

__all__ = ["Freedom", "freedom_of"]

Floats = NDArray[np.float64]

_RIGHT = 1e-6


@dataclass(frozen=True, slots=True)
class Freedom:
    """What a joint lets its bodies do."""

    turn: Floats
    """(4,) the frame's orientation in that of the joint."""
    linear: Floats
    """(2, 3) limits."""
    angular: Floats
    """(2, 3) limits in radians."""


def freedom_of(axes: Sequence[Axis]) -> Freedom | str:
    """The freedom that axes amount to, or why a World has no joint for them.

    Axes that do not move are left out by the caller.
    """
    directions: list[Floats] = []
    places: list[tuple[int, bool]] = []
    for axis in axes:
        direction = np.array(axis.direction)
        for number, known in enumerate(directions):
            along = float(direction @ known)
            if abs(along) > 1.0 - _RIGHT:
                places.append((number, along < 0.0))
                break
            if abs(along) > _RIGHT:
                return "its axes are not at right angles"
        else:
            places.append((len(directions), False))
            directions.append(direction)
    taken = [(place, axis.slides) for (place, _), axis in zip(places, axes, strict=True)]
    if len(set(taken)) < len(taken):
        return "two of its axes are the same"
    turned: set[int] = set()
    for (place, _), axis in zip(places, axes, strict=True):
        if not axis.slides:
            turned.add(place)
        elif turned - {place}:
            return "it slides along an axis that it has turned"
    if not directions:
        return Freedom(np.array(rotations.IDENTITY), np.zeros((2, 3)), np.zeros((2, 3)))
    matrix, signs, columns = _frame(directions)
    linear, angular = np.zeros((2, 3)), np.zeros((2, 3))
    for (place, against), axis in zip(places, axes, strict=True):
        low, high = axis.low, axis.high
        if low > high:  # no limits at all, as some writers put it
            low, high = -math.inf, math.inf
        if against != (signs[place] < 0.0):
            low, high = -high, -low
        (linear if axis.slides else angular)[:, columns[place]] = low, high
    return Freedom(rotations.from_matrix(matrix), linear, angular)


def _frame(directions: list[Floats]) -> tuple[Floats, list[float], list[int]]:
    """A right-handed frame of the directions, their signs in it and the columns they are."""
    first = directions[0]
    if len(directions) == 1:
        matrix = rotations.to_matrix(rotations.between((0.0, 0.0, 1.0), first))
        return matrix, [1.0], [2]
    second = directions[1] - float(directions[1] @ first) * first
    second = second / np.linalg.norm(second)
    third = np.cross(first, second)
    signs = [1.0, 1.0]
    if len(directions) > 2:
        signs.append(math.copysign(1.0, float(third @ directions[2])))
    return np.column_stack([first, second, third]), signs, [0, 1, 2]
