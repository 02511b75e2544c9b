"""Frames: the transforms of nodes, shapes and attachments as 4x4 matrices.

COLLADA applies transforms in document order, each within the one before (§node); a matrix here
acts on column vectors from the left.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence

import numpy as np
from lxml import etree
from numpy.typing import NDArray

__all__ = [
    "TRANSFORMS",
    "Matrix",
    "axis_angle",
    "floats_of",
    "inverse",
    "is_transform",
    "nearest_rotation",
    "of_element",
    "rotation",
    "transform_of",
    "translation",
]

Matrix = NDArray[np.float64]


def floats_of(element: etree._Element | None) -> list[float]:
    """The numbers of an element's text, around comments; XML's INF and NaN are Python's too."""
    if element is None:
        return []
    text = (element.text or "") + "".join(child.tail or "" for child in element)
    return [float(word) for word in text.split()]


def translation(values: Sequence[float]) -> Matrix:
    """The matrix of `<translate>x y z</translate>`."""
    result = np.eye(4)
    result[:3, 3] = values
    return result


def rotation(values: Sequence[float]) -> Matrix:
    """The matrix of `<rotate>x y z degrees</rotate>`.

    An axis without length turns nothing, nor does an angle that is no number.
    """
    axis = np.asarray(values[:3], dtype=np.float64)
    result = np.eye(4)
    largest = np.max(np.abs(axis))
    if not 0.0 < largest < math.inf or not math.isfinite(values[3]):
        return result
    axis = axis / largest
    x, y, z = axis / math.sqrt(float(axis @ axis))
    angle = math.radians(math.fmod(values[3], 360.0))
    # The half angle keeps 180 degrees free of rounding that a cosine of -1 would bring in.
    w, s = math.cos(angle / 2), math.sin(angle / 2)
    x, y, z = x * s, y * s, z * s
    result[:3, :3] = (
        (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
        (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
    )
    return result


def _scale(values: Sequence[float]) -> Matrix:
    return np.diag([*values, 1.0])


def _matrix(values: Sequence[float]) -> Matrix:
    return np.asarray(values, dtype=np.float64).reshape(4, 4)


def _unit(vector: Matrix) -> Matrix:
    length = math.sqrt(float(vector @ vector))
    return vector / length if length > 0.0 else vector


def _lookat(values: Sequence[float]) -> Matrix:
    """Eye, interest and up: the node stands at the eye and looks along its -z (§lookat)."""
    eye, interest, up = np.asarray(values, dtype=np.float64).reshape(3, 3)
    back = _unit(eye - interest)
    right = _unit(np.cross(up, back))
    result = np.eye(4)
    result[:3, :4] = np.column_stack([right, np.cross(back, right), back, eye])
    return result


def _skew(values: Sequence[float]) -> Matrix:
    """Angle, axis of rotation and axis of translation, as in RenderMan (§skew)."""
    turned = _unit(np.asarray(values[1:4], dtype=np.float64))
    along = _unit(np.asarray(values[4:7], dtype=np.float64))
    result = np.eye(4)
    cosine = float(turned @ along)
    across = _unit(turned - cosine * along)
    height = float(turned @ across)
    if height > 0.0 and math.isfinite(values[0]):
        angle = math.atan2(cosine, height) + math.radians(values[0])
        result[:3, :3] += (math.tan(angle) - cosine / height) * np.outer(along, across)
    return result


_MATRIX_OF: dict[str, Callable[[Sequence[float]], Matrix]] = {
    "translate": translation,
    "rotate": rotation,
    "scale": _scale,
    "matrix": _matrix,
    "lookat": _lookat,
    "skew": _skew,
}
_COUNTS = {"translate": 3, "rotate": 4, "scale": 3, "matrix": 16, "lookat": 9, "skew": 7}
TRANSFORMS = frozenset(_MATRIX_OF)


def _local(element: etree._Element) -> str:
    return element.tag.rpartition("}")[2] if isinstance(element.tag, str) else ""


def is_transform(element: etree._Element) -> bool:
    """Whether an element is one of the six transforms."""
    return _local(element) in TRANSFORMS


def of_element(element: etree._Element) -> Matrix:
    """The matrix of one transform element; ValueError where it has not the numbers for one."""
    name, values = _local(element), floats_of(element)
    if len(values) != _COUNTS[name]:
        raise ValueError(f"<{name}> has {len(values)} numbers, not {_COUNTS[name]}")
    return _MATRIX_OF[name](values)


def transform_of(children: Iterable[etree._Element]) -> Matrix:
    """The matrix of the transforms among `children`, in their order; others are passed over."""
    result = np.eye(4)
    for child in children:
        if is_transform(child):
            result = result @ of_element(child)
    return result


def inverse(matrix: Matrix) -> Matrix:
    """The transform that undoes `matrix`; of a singular one, what undoes its rigid part."""
    if not np.all(np.isfinite(matrix[:3, :3])) or np.linalg.cond(matrix[:3, :3]) > 1e12:
        matrix = nearest_rotation(matrix)[0]
    return np.asarray(np.linalg.inv(matrix), dtype=np.float64)


def nearest_rotation(matrix: Matrix) -> tuple[Matrix, bool]:
    """The rotation and translation nearest to `matrix`, and whether it was just that.

    What is left out is scale, skew or a mirror image.
    """
    result = np.eye(4)
    result[:3, 3] = matrix[:3, 3]
    linear = matrix[:3, :3]
    if np.allclose(linear @ linear.T, np.eye(3), rtol=0.0, atol=1e-9) and np.linalg.det(linear) > 0:
        result[:3, :3] = linear
        return result, True
    if not np.all(np.isfinite(linear)):
        return result, False
    left, _, right = np.linalg.svd(linear)
    if np.linalg.det(left @ right) < 0:
        left[:, -1] *= -1.0
    result[:3, :3] = left @ right
    return result, False


def axis_angle(matrix: Matrix) -> tuple[float, float, float, float]:
    """Axis (unit length) and angle in degrees (0 to 180) of the rotation in `matrix`."""
    r = matrix[:3, :3]
    # Four ways to the quaternion; the one with the largest pivot is the accurate one.
    pivots = (r[0, 0] + r[1, 1] + r[2, 2], r[0, 0], r[1, 1], r[2, 2])
    largest = int(np.argmax(pivots))
    if largest == 0:
        q = (1 + pivots[0], r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1])
    else:
        i, j, k = ((0, 1, 2), (1, 2, 0), (2, 0, 1))[largest - 1]
        vector = [0.0, 0.0, 0.0]
        vector[i] = 1 + r[i, i] - r[j, j] - r[k, k]
        vector[j] = r[i, j] + r[j, i]
        vector[k] = r[i, k] + r[k, i]
        q = (r[k, j] - r[j, k], *vector)
    w, x, y, z = (float(part) for part in q)
    size = max(abs(x), abs(y), abs(z))
    if size == 0.0:
        return 1.0, 0.0, 0.0, 0.0
    x, y, z = x / size, y / size, z / size  # the squares of tiny parts would lose their digits
    length = math.hypot(x, y, z)
    sign = -1.0 if w < 0 else 1.0
    angle = math.degrees(2 * math.atan2(length * size, abs(w)))
    return sign * x / length, sign * y / length, sign * z / length, angle
