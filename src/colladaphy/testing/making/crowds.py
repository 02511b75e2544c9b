"""Hundreds of bodies from one number, as choosing each by itself takes too many choices."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from colladaphy.world import BodyColumns, Kind, World, rotations

__all__ = ["CROWD_SHAPES", "crowd"]

CROWD_SHAPES = ("sphere", "box", "capsule", "cylinder", "ellipsoid")


def crowd(world: World, count: int, seed: int = 0, *, shapes: Sequence[str] = CROWD_SHAPES) -> None:
    """Adds `count` bodies of everyday size at random places, with random motions.

    The same arguments give the same bodies. `shapes` are of CROWD_SHAPES.
    """
    random = np.random.default_rng(seed)
    numbers = [int(Kind[name.upper()]) for name in shapes]
    kinds = random.choice(np.array(numbers, dtype=np.int8), count)
    sizes = random.uniform(0.1, 2.0, (count, 4))
    for kind, used in (
        (Kind.SPHERE, (1, 0, 0, 0)),
        (Kind.BOX, (1, 1, 1, 0)),
        (Kind.CYLINDER, (0, 1, 1, 1)),
        (Kind.ELLIPSOID, (1, 1, 1, 0)),
    ):
        sizes[kinds == kind] *= used
    world.extend(
        BodyColumns(
            kinds=kinds,
            dimensions=sizes,
            uids=random.integers(-9, 9, count),
            positions=random.uniform(-50, 50, (count, 3)),
            orientations=rotations.normalize(random.normal(size=(count, 4))),
            linear_velocities=random.normal(size=(count, 3)),
            angular_velocities=random.normal(size=(count, 3)),
            fixed=random.random(count) < 0.2,
            sleeping=random.random(count) < 0.1,
        )
    )
