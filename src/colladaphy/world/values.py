"""Checks of single values on their way into a World."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from colladaphy.world.rules import DIMENSION, INERTIA, MASS, NUMBER, USER_ID, refuse

__all__ = ["inertia", "mass", "normal", "positive", "quaternion", "user_id", "vector"]

Floats = NDArray[np.float64]

# Far above what rounding does to a unit vector, far below what anybody means by another length.
_UNIT_TOLERANCE = 1e-9


def _numbers(what: str, value: ArrayLike, count: int) -> Floats:
    try:
        array = np.array(value, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise refuse(NUMBER, f"The {what} is {value!r}: {count} numbers are needed.") from error
    if array.shape != (count,) or not all(map(math.isfinite, array.tolist())):
        raise refuse(NUMBER, f"The {what} is {value!r}: {count} finite numbers are needed.")
    return array


def vector(what: str, value: ArrayLike) -> Floats:
    """Three finite numbers, copied."""
    return _numbers(what, value, 3)


def quaternion(value: ArrayLike) -> Floats:
    """Four finite numbers, as they are if of length one to rounding, otherwise normalised."""
    array = _numbers("orientation", value, 4)
    return _unit(array, lambda: refuse(NUMBER, "The orientation is a quaternion of length zero."))


def normal(value: ArrayLike) -> Floats:
    """Three finite numbers, as they are if of length one to rounding, otherwise normalised."""
    array = _numbers("normal", value, 3)
    return _unit(array, lambda: refuse(DIMENSION, "The normal of the plane has length zero."))


def _unit(array: Floats, zero: Callable[[], Exception]) -> Floats:
    square = math.fsum(number * number for number in array.tolist())
    if abs(square - 1.0) <= _UNIT_TOLERANCE:
        return array
    largest = max(map(abs, array.tolist()))
    if largest == 0.0:
        raise zero()
    array = np.ldexp(array, -math.frexp(largest)[1])
    return np.asarray(array / math.sqrt(float(array @ array)))


def positive(what: str, value: float) -> float:
    """A finite number greater than zero."""
    try:
        number = float(value)
    except (TypeError, ValueError) as error:
        raise refuse(DIMENSION, f"The {what} is {value!r}, not a number.") from error
    if not (0.0 < number < math.inf):
        raise refuse(DIMENSION, f"The {what} is {number!r}; it has to be positive.")
    return number


def mass(value: float) -> float:
    """A finite number, zero or greater."""
    number = float(value)
    if not (0.0 <= number < math.inf):
        raise refuse(MASS, f"The mass is {number!r}.")
    return number


def inertia(value: ArrayLike) -> Floats:
    """A 3×3 matrix of finite numbers; three numbers are its diagonal."""
    array = np.array(value, dtype=np.float64)
    if array.shape == (3,):
        array = np.diag(array)
    if array.shape != (3, 3) or not np.all(np.isfinite(array)):
        raise refuse(INERTIA, f"The inertia is {value!r}.")
    return array


def user_id(value: int) -> int:
    """An integer that fits into 64 bits."""
    try:
        number = value.__index__()
    except AttributeError as error:
        raise refuse(USER_ID, f"The user id is {value!r}.") from error
    if not (-(2**63) <= number < 2**63):
        raise refuse(USER_ID, f"The user id is {value!r}.")
    return number
