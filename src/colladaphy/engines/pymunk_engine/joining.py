"""The velocities that joints allow with the momentum that the bodies have."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from colladaphy.engines.pymunk_engine.links import Flat, Link

__all__ = ["allowed"]

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_ENOUGH: Final = 1e-14
_NOTHING: Final = 1e-300
_ROUNDS: Final = 20  # iterations for each row, at most


def allowed(
    links: list[Link], rows: dict[int, int], places: Floats, motion: Floats, inverse: Floats
) -> Floats:
    """The velocities (n, 3) nearest to `motion` by kinetic energy that no joint forbids.

    `rows` are rows of the arrays by system id (0 is the world); `places` (n, 2) are centres,
    `motion` is (u, v, angular) and `inverse` (n, 3) one over mass, mass and moment, 0 for what is
    fixed. The change is that of impulses in the joints, λ in (J·M⁻¹·Jᵀ)λ = J·v: whatever its
    accuracy, momentum and angular momentum are kept.
    """
    matrix = _Rows(links, rows, places)
    if not matrix.count:
        return motion
    wrong = matrix.times(motion)
    scale = 1.0 / np.sqrt(np.maximum(matrix.diagonal(inverse), _NOTHING))
    impulses = np.zeros(matrix.count)
    # Conjugate gradients on the rows, each scaled to one: joints that say the same twice do no
    # harm, and a scene of thousands of them needs no matrix.
    rest = scale * wrong
    ahead, size = rest.copy(), float(np.sum(rest * rest))
    least = _ENOUGH * _ENOUGH * size
    for _ in range(_ROUNDS * matrix.count):
        if size <= least:
            break
        answer = scale * matrix.times(inverse * matrix.back(scale * ahead))
        share = float(np.sum(ahead * answer))
        if share <= 0.0:
            break
        impulses += size / share * ahead
        rest = rest - size / share * answer
        size, before = float(np.sum(rest * rest)), size
        ahead = rest + size / before * ahead
    return np.asarray(motion - inverse * matrix.back(scale * impulses))


class _Rows:
    """What joints forbid: each row a number for each component of one or two bodies' motion."""

    def __init__(self, links: list[Link], rows: dict[int, int], places: Floats) -> None:
        bodies: list[tuple[int, int]] = []
        numbers: list[list[tuple[float, float, float]]] = []
        for link in links:
            pair = rows[link.first], rows[link.second]
            for point, direction in _lines(link, places[pair[1]]):
                bodies.append(pair)
                first, second = (_line(places[row], point, direction) for row in pair)
                numbers.append([(-first[0], -first[1], -first[2]), second])
            if link.phase is not None:
                bodies.append(pair)
                numbers.append([(0.0, 0.0, -1.0), (0.0, 0.0, 1.0)])
        self.count = len(bodies)
        self._bodies: Ints = np.array(bodies, dtype=np.int64).reshape(-1, 2)
        self._numbers: Floats = np.array(numbers, dtype=np.float64).reshape(-1, 2, 3)
        self._length = len(places)

    def times(self, motion: Floats) -> Floats:
        """J·v (rows,)."""
        return np.asarray((self._numbers * motion[self._bodies]).sum(axis=(1, 2)))

    def back(self, impulses: Floats) -> Floats:
        """Jᵀ·λ (n, 3)."""
        total = np.zeros((self._length, 3))
        np.add.at(total, self._bodies, self._numbers * impulses[:, None, None])
        return total

    def diagonal(self, inverse: Floats) -> Floats:
        """That of J·M⁻¹·Jᵀ (rows,)."""
        return np.asarray((self._numbers**2 * inverse[self._bodies]).sum(axis=(1, 2)))


def _lines(link: Link, center: Floats) -> list[tuple[Floats, Flat]]:
    """Points, and the directions in which the bodies must not move apart there."""
    if link.pivot is not None:
        point = center + np.array(link.pivot[1])
        return [(point, (1.0, 0.0)), (point, (0.0, 1.0))]
    if link.rail is not None:
        u, v = link.rail.along
        return [(center + np.array(link.rail.arm), (-v, u))]
    return []


def _line(center: Floats, point: Floats, direction: Flat) -> tuple[float, float, float]:
    u, v = direction
    arm = point - center
    return u, v, float(arm[0] * v - arm[1] * u)
