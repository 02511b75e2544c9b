"""Inertia tensors as principal moments, within what MuJoCo accepts."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from colladaphy.world import rotations

__all__ = ["SLACK", "principal"]

Floats = NDArray[np.float64]

SLACK: Final = 1e-6
"""How much (relative) a tensor may violate A + B ≥ C or its symmetry by rounding."""


def principal(inertia: Floats) -> tuple[Floats, Floats]:
    """Principal moments (3,) and the rotation (4,) from their axes to the body's.

    Moments are corrected to A + B ≥ C, by no more than rounding where `SLACK` was checked.
    """
    tensor = np.asarray(inertia)
    if np.count_nonzero(tensor - np.diag(np.diagonal(tensor))) == 0:
        moments, turn = np.array(np.diagonal(tensor)), np.array(rotations.IDENTITY)
    else:
        moments, axes = np.linalg.eigh(0.5 * (tensor + tensor.T))
        if np.linalg.det(axes) < 0:
            axes[:, 0] = -axes[:, 0]
        turn = rotations.from_matrix(axes)
    largest = int(np.argmax(moments))
    others = float(np.sum(np.delete(moments, largest)))
    moments[largest] = min(float(moments[largest]), others)
    return moments, turn
