"""How the members of a union add up (thesis 2.1, 4.3; pe's rules)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.world import rotations

__all__ = ["Part", "Sum", "add_up", "shared_motion", "steiner"]

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


def steiner(mass: float, offset: Array) -> Array:
    """What a mass at `offset` (3,) adds to the inertia (3, 3): m(r²·1 − r·rᵀ)."""
    return np.asarray(mass * (float(offset @ offset) * np.eye(3) - np.outer(offset, offset)))


def add_up(parts: list[Part]) -> Sum:
    """The sum of `parts`, by the parallel-axis theorem; inertia in the axes of their frame.

    An infinite part makes the sum infinite: no mass, no inertia, at the mean position of the
    infinite parts. Parts that have no mass at all meet at their mean position.
    """
    infinite = [part for part in parts if part.infinite]
    if infinite:
        return Sum(0.0, _mean(infinite), np.zeros((3, 3)))
    mass = sum(part.mass for part in parts)
    if len(parts) == 1:
        center = np.array(parts[0].position)
    elif mass > 0:
        center = sum((part.mass * part.position for part in parts), np.zeros(3)) / mass
    else:
        center = _mean(parts)
    inertia = np.zeros((3, 3))
    for part in parts:
        inertia += rotations.rotate_tensor(part.orientation, part.inertia)
        inertia += steiner(part.mass, part.position - center)
    return Sum(mass, center, 0.5 * (inertia + inertia.T))  # rounding alone makes it uneven


def _mean(parts: list[Part]) -> Array:
    return np.asarray(sum((part.position for part in parts), np.zeros(3)) / len(parts))


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
