"""How the members of a union add up (thesis 2.1, 4.3; pe's rules)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from colladaphy.world import rotations

__all__ = ["Part", "Sum", "add_up", "shared_motion", "steiner", "sums"]

Array = NDArray[Any]


@dataclass(slots=True)
class Part:
    """One member as the union sees it, in the frame in which the union is made up."""

    position: Array
    orientation: Array
    mass: float
    inertia: Array
    infinite: bool
    linear_velocity: Array
    angular_velocity: Array


@dataclass(slots=True)
class Sum:
    """Mass, centre of mass and inertia of all parts together."""

    mass: float
    center: Array
    inertia: Array


def steiner(mass: ArrayLike, offset: Array) -> Array:
    """What masses (...) at `offset` (..., 3) add to inertias (..., 3, 3): m(r²·1 − r·rᵀ)."""
    row, column = offset[..., None, :], offset[..., :, None]
    square = row @ column
    return np.asarray(np.asarray(mass)[..., None, None] * (square * np.eye(3) - column * row))


def sums(
    owner: Array,
    count: int,
    positions: Array,
    orientations: Array,
    masses: Array,
    inertias: Array,
    infinite: Array,
) -> tuple[Array, Array, Array]:
    """Masses (n,), centres (n, 3) and inertias (n, 3, 3) of `count` unions of many parts.

    Parts have the row of their union as `owner`, and are added in the order in which they stand,
    by the parallel-axis theorem; the inertia is about the centre, in the axes of their frame. An
    infinite part makes the sum infinite: no mass, no inertia, at the mean position of the infinite
    parts. Parts that have no mass at all meet at their mean position. A single part is as it is.
    """
    endless = np.zeros(count, dtype=np.bool_)
    endless[owner[infinite]] = True
    total = np.bincount(owner, masses, count)
    mean = endless | ~(total > 0)
    # Means are weighted too: with one for each part that counts.
    weights = np.where(mean[owner], (infinite | ~endless[owner]).astype(np.float64), masses)
    divisors = np.where(mean, np.bincount(owner, weights, count), total)
    centers = _grouped(owner, count, weights[:, None] * positions) / divisors[:, None]
    alone = (np.bincount(owner, minlength=count) == 1)[owner]
    centers[owner[alone]] = positions[alone]
    terms = np.empty((len(owner), 2, 3, 3))
    terms[:, 0] = rotations.rotate_tensor(orientations, inertias)
    terms[:, 1] = steiner(masses, positions - centers[owner])
    around = _grouped(np.repeat(owner, 2), count, terms.reshape(-1, 9)).reshape(-1, 3, 3)
    around = 0.5 * (around + np.swapaxes(around, -1, -2))  # rounding alone makes it uneven
    total[endless], around[endless] = 0.0, 0.0
    return total, centers, around


def _grouped(owner: Array, count: int, values: Array) -> Array:
    """Sums (n, k) of the rows of `values` (m, k) by owner, one after the other in each."""
    width = values.shape[1]
    places = owner[:, None] * width + np.arange(width)
    return np.bincount(places.ravel(), values.ravel(), count * width).reshape(count, width)


def add_up(parts: list[Part]) -> Sum:
    """The sum of `parts`, see `sums`."""
    masses, centers, inertias = sums(
        np.zeros(len(parts), dtype=np.int64),
        1,
        np.array([part.position for part in parts]),
        np.array([part.orientation for part in parts]),
        np.array([part.mass for part in parts]),
        np.array([part.inertia for part in parts]),
        np.array([part.infinite for part in parts], dtype=np.bool_),
    )
    return Sum(float(masses[0]), centers[0], inertias[0])


def shared_motion(parts: list[Part], total: Sum) -> tuple[Array, Array]:
    """Linear and angular velocity of the whole that keep both momenta of its parts.

    An infinite whole has no momentum and stays at rest.
    """
    moving = any(np.any(part.linear_velocity) or np.any(part.angular_velocity) for part in parts)
    if not moving or total.mass == 0:
        return np.zeros(3), np.zeros(3)
    linear = sum((part.mass * part.linear_velocity for part in parts), np.zeros(3)) / total.mass
    momentum, inertia = np.zeros(3), np.zeros((3, 3))
    for part in parts:
        arm = part.position - total.center
        own = rotations.rotate_tensor(part.orientation, part.inertia)
        momentum += own @ part.angular_velocity
        momentum += part.mass * np.cross(arm, part.linear_velocity - linear)
        inertia += own + steiner(part.mass, arm)
    if not (np.all(np.isfinite(inertia)) and np.all(np.isfinite(momentum))):
        return linear, np.full(3, np.nan)
    # Points on a line have no inertia about it: no spin there either.
    return linear, np.asarray(np.linalg.pinv(inertia, hermitian=True) @ momentum)
