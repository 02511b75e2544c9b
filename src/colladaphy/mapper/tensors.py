"""Inertia tensors as nine numbers, row by row."""

from __future__ import annotations

from collections.abc import Sequence

from colladaphy.document.poses import Pose, Quaternion, matrix_of

__all__ = ["Tensor", "diagonal", "symmetric_part", "turned"]

Tensor = tuple[float, ...]


def diagonal(moments: Sequence[float]) -> Tensor:
    """The tensor of principal moments along the axes."""
    x, y, z = moments
    return (x, 0.0, 0.0, 0.0, y, 0.0, 0.0, 0.0, z)


def turned(tensor: Tensor, orientation: Quaternion | None) -> Tensor:
    """R·T·Rᵀ: the tensor of a turned frame, in the axes it is turned in."""
    if orientation is None:
        return tensor
    rows = [row[:3] for row in matrix_of(Pose(None, orientation))[:3]]
    columns = range(3)
    half = [
        [sum(rows[i][k] * tensor[3 * k + j] for k in columns) for j in columns] for i in columns
    ]
    made = [[sum(half[i][k] * rows[j][k] for k in columns) for j in columns] for i in columns]
    # Symmetric to the last bit, as an inertia is.
    return tuple(made[i][j] if i <= j else made[j][i] for i in columns for j in columns)


def symmetric_part(tensor: Tensor) -> Tensor:
    """(T + Tᵀ)/2."""
    return tuple(
        0.5 * tensor[3 * i + j] + 0.5 * tensor[3 * j + i] for i in range(3) for j in range(3)
    )
