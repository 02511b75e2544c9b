"""Bodies that are moved by hand while a space runs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from colladaphy.engines.planar import LARGEST, TOLERANCE, Planarity
from colladaphy.world import rotations

if TYPE_CHECKING:
    from colladaphy.engines.pymunk_engine.space import Model
    from colladaphy.world import World

__all__ = ["Moved"]

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Moved:
    """Which bodies were moved, and where to."""

    rows: NDArray[np.int64]
    """Of those that move, in their order."""
    fits: bool
    """Whether they may stand there without a load: in the plane, and joined to nothing."""
    places: Floats
    """In the plane (n, 2)."""
    heights: Floats
    angles: Floats
    """From the orientation that they were loaded with; NaN where it is left as it was."""

    @classmethod
    def of(
        cls, world: World, plan: Planarity, before: tuple[Floats, Floats],
        loaded: tuple[Floats, Floats], joined: frozenset[int],
    ) -> Moved:  # fmt: skip
        """`before`: positions and orientations of all bodies; `loaded`: heights and orientations,

        of those that move, as they were loaded; `joined`: system ids of bodies with joints.
        """
        shifted = np.any(world.positions != before[0], axis=1)
        turned = np.any(world.orientations != before[1], axis=1)
        changed = np.flatnonzero(shifted | turned)
        rows = (np.cumsum(~world.fixed) - 1)[changed]
        positions, frame = world.positions[changed], plan.frame
        heights = frame.height(positions)
        angles, across = _turns(world.orientations[changed], loaded[1][rows], frame.normal)
        fits = (
            not world.fixed[changed].any()
            and joined.isdisjoint(world.sids[changed].tolist())
            and bool(np.all(np.abs(positions) < LARGEST))
            and bool(np.all(np.abs(heights - loaded[0][rows]) <= TOLERANCE * plan.size))
            and bool(np.all(across[turned[changed]] <= TOLERANCE))
        )
        angles[~turned[changed]] = np.nan
        return cls(rows, fits, frame.flat(positions), heights, angles)

    def put(self, model: Model) -> None:
        """Move them in the space."""
        for row, (x, y), angle in zip(
            self.rows.tolist(), self.places.tolist(), self.angles.tolist(), strict=True
        ):
            body = model.bodies[row]
            body.position = x, y
            if angle == angle:
                body.angle = angle
            model.space.reindex_shapes_for_body(body)


def _turns(new: Floats, old: Floats, normal: Floats) -> tuple[Floats, Floats]:
    """Angles (n,) about the normal between orientations (n, 4), and how far they turn across."""
    with np.errstate(all="ignore"):
        between = rotations.multiply(rotations.normalize(new), rotations.conjugate(old))
        about = between[:, 1:] @ normal
        across = np.abs(between[:, 1:] - about[:, None] * normal).max(axis=1, initial=0.0)
        return 2.0 * np.arctan2(about, between[:, 0]), across
