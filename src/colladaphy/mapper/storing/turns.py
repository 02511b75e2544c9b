"""Rotations and inertias as COLLADA says them: axis and degrees, principal moments."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.mapper.numbers import differs
from colladaphy.world import rotations
from colladaphy_schema.rows import Bools, Floats

__all__ = ["MassFrames", "mass_frames", "turns_of"]

Array = NDArray[Any]

_AXES = np.arange(3)


def turns_of(orientations: Array) -> tuple[Floats, Bools]:
    """Axes and degrees (n, 4) of quaternions (n, 4), and which of them turn at all."""
    turned = differs(orientations, rotations.IDENTITY)
    turns = np.zeros((len(orientations), 4))
    rows = slice(None) if turned.all() else np.flatnonzero(turned)
    axes, angles = rotations.to_axis_angle(orientations[rows])
    turns[rows, :3], turns[rows, 3] = axes, np.degrees(angles)
    return turns, turned


@dataclass(slots=True)
class MassFrames:
    """Inertias (n, 3, 3) about the origins of bodies as the common profile has them.

    COLLADA's inertia is diagonal, so the mass frame turns to the principal axes.
    """

    there: Bools
    """(n,) which inertias can be said."""
    framed: Bools
    """(n,) which of them need a mass frame."""
    turns: Floats
    """(n, 4) axes and degrees of the mass frames."""
    turned: Bools
    """(n,) which mass frames turn."""
    moments: Floats
    """(n, 3) along the axes of the frame."""


def mass_frames(inertias: Array, wanted: Array) -> MassFrames:
    """The mass frames of those inertias (n, 3, 3) that are wanted (n,)."""
    count = len(wanted)
    there, framed, turned = (np.zeros(count, np.bool_) for _ in range(3))
    frames = MassFrames(there, framed, np.zeros((count, 4)), turned, np.zeros((count, 3)))
    rows = np.flatnonzero(wanted)
    if not len(rows):
        return frames
    tensors = inertias[rows]
    flat = tensors.reshape(-1, 9)
    said = np.isfinite(flat).all(axis=1) & flat.any(axis=1)
    rows, tensors = rows[said], tensors[said]
    there[rows] = True
    symmetric = 0.5 * tensors
    symmetric[:, _AXES, _AXES] += symmetric[:, _AXES, _AXES]
    for i, j in ((0, 1), (0, 2), (1, 2)):
        symmetric[:, i, j] += symmetric[:, j, i]
        symmetric[:, j, i] = symmetric[:, i, j]
    frames.moments[rows] = symmetric[:, _AXES, _AXES]
    oblique = (symmetric[:, (0, 0, 1), (1, 2, 2)] != 0.0).any(axis=1)
    if oblique.any():
        _turn(frames, rows[oblique], symmetric[oblique])
    return frames


def _turn(frames: MassFrames, rows: Array, symmetric: Array) -> None:
    """Turn frames to the principal axes."""
    scale = np.abs(symmetric).max(axis=(1, 2))
    moments, axes = np.linalg.eigh(symmetric / scale[:, None, None])
    x, y, z = (axes[:, :, column].T for column in range(3))
    triple = (
        x[0] * (y[1] * z[2] - y[2] * z[1])
        + x[1] * (y[2] * z[0] - y[0] * z[2])
        + x[2] * (y[0] * z[1] - y[1] * z[0])
    )
    mirrored = triple < 0
    axes[mirrored, :, 2] = -axes[mirrored, :, 2]
    frames.framed[rows] = True
    frames.turns[rows], frames.turned[rows] = turns_of(rotations.from_matrix(axes))
    with np.errstate(over="ignore"):
        frames.moments[rows] = moments * scale[:, None]
