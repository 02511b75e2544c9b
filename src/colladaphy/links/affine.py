"""The transforms that are no poses: skew and lookat (COLLADA 1.5 §skew, §lookat)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.links.poses import DEGREE
from colladaphy.links.sums import exact_sum

__all__ = ["lookat_matrix", "skew_matrix", "stretch_of"]

Matrix = tuple[tuple[float, float, float, float], ...]


def _unit(vector: Sequence[float]) -> tuple[float, float, float]:
    length = math.sqrt(exact_sum(part * part for part in vector)) or 1.0
    return (vector[0] / length, vector[1] / length, vector[2] / length)


def _cross(a: Sequence[float], b: Sequence[float]) -> tuple[float, float, float]:
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


def lookat_matrix(values: Sequence[float]) -> Matrix:
    """Eye, interest and up (9 numbers) as the transform of the node, which looks along -z."""
    eye, interest, up = values[:3], values[3:6], values[6:9]
    back = _unit([e - i for e, i in zip(eye, interest, strict=True)])
    right = _unit(_cross(up, back))
    above = _cross(back, right)
    rows = [(right[i], above[i], back[i], eye[i]) for i in range(3)]
    return (*rows, (0.0, 0.0, 0.0, 1.0))


def skew_matrix(values: Sequence[float]) -> Matrix:
    """Angle in degrees, axis of rotation and axis of translation (7 numbers), as in RenderMan.

    Points are sheared along the second axis, by as much as turns the first axis by the angle
    towards it.
    """
    turned = _unit(values[1:4])
    along = _unit(values[4:7])
    cosine = sum(a * b for a, b in zip(turned, along, strict=True))
    across = _unit([a - cosine * b for a, b in zip(turned, along, strict=True)])
    height = sum(a * b for a, b in zip(turned, across, strict=True))
    if abs(height) < 1e-300:
        shear = 0.0
    else:
        angle = math.atan2(cosine, height) + values[0] * DEGREE
        shear = math.tan(angle) - cosine / height
    rows = []
    for i in range(3):
        a, b, d = (shear * along[i] * across[j] + (1.0 if i == j else 0.0) for j in range(3))
        rows.append((a, b, d, 0.0))
    return (*rows, (0.0, 0.0, 0.0, 1.0))


def stretch_of(matrix: NDArray[Any]) -> str:
    """What a transform (4, 4) does beside moving and turning, in words: "scales by 0.001".

    Of factors that differ, those along the node's own axes are told.
    """
    inner = np.asarray(matrix, np.float64)[:3, :3]
    with np.errstate(all="ignore"):
        factors = np.sqrt(np.sum(inner * inner, axis=0))
        angles = inner.T @ inner / np.outer(factors, factors) - np.eye(3)
        mirrored = bool(np.linalg.det(inner) < 0.0)
    told = []
    if np.abs(factors - factors.mean()).max() <= 1e-4 * factors.max():
        if abs(factors.mean() - 1.0) > 1e-6:
            told.append(f"scales by {factors.mean():.6g}")
    else:
        shown = ", ".join(f"{factor:.6g}" for factor in factors.tolist())
        told.append(f"scales its axes by {shown}")
    if not np.abs(np.nan_to_num(angles)).max() <= 1e-4:
        told.append("skews")
    if mirrored:
        told.append("mirrors")
    return " and ".join(told) or "is not rigid"
