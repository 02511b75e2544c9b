"""Checks of values on their way into a World: what passes is of the right type and range."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Sequence
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from colladaphy.findings import Rule
from colladaphy.world.rules import (
    ARGUMENT,
    COLUMNS,
    DIMENSION,
    INERTIA,
    MASS,
    NUMBER,
    SYSTEM_ID,
    USER_ID,
    refuse,
)

__all__ = [
    "are_distinct",
    "array",
    "column",
    "finite",
    "fitting",
    "flag",
    "inertia",
    "instance",
    "integer",
    "mass",
    "names",
    "new_system_id",
    "new_system_ids",
    "normal",
    "number",
    "optional",
    "positive",
    "positives",
    "quaternion",
    "text",
    "user_id",
    "vector",
    "whole",
]

Floats = NDArray[np.float64]
Scalar = TypeVar("Scalar", bound=np.generic)
Value = TypeVar("Value")

# Far above what rounding does to a unit vector, far below what anybody means by another length.
_UNIT_TOLERANCE = 1e-9
# Which kinds of arrays may become which, without a loss that nobody asked for.
_TAKES = {"f": "fiu", "i": "iu", "b": "b"}


def array(value: Any) -> NDArray[Any] | None:
    """An array of numbers, new; None if it is none. Texts are not numbers."""
    try:
        result = np.array(value)
        if result.dtype.kind == "O" and not any(isinstance(item, str) for item in result.flat):
            result = result.astype(np.float64)  # numbers beyond 64 bits, fractions
    except (TypeError, ValueError, OverflowError):
        return None
    return result if result.dtype.kind in "fiub" else None


def vector(what: str, value: ArrayLike, count: int = 3, rule: Rule = NUMBER) -> Floats:
    """Three (or `count`) finite numbers, copied."""
    numbers = array(value)
    if (
        numbers is None
        or numbers.shape != (count,)
        or not all(map(math.isfinite, numbers.tolist()))
    ):
        raise refuse(rule, f"The {what} is {value!r}: {count} finite numbers are needed.")
    return numbers if numbers.dtype == np.float64 else numbers.astype(np.float64)


def quaternion(value: ArrayLike) -> Floats:
    """Four finite numbers, as they are if of length one to rounding, otherwise normalised."""
    numbers = vector("orientation", value, 4)
    return _unit(numbers, lambda: refuse(NUMBER, "The orientation is a quaternion of length zero."))


def normal(value: ArrayLike) -> Floats:
    """Three finite numbers, as they are if of length one to rounding, otherwise normalised."""
    numbers = vector("normal", value)
    return _unit(numbers, lambda: refuse(DIMENSION, "The normal of the plane has length zero."))


def _unit(numbers: Floats, zero: Callable[[], Exception]) -> Floats:
    items = numbers.tolist()
    largest = max(map(abs, items))
    # The squares of larger ones may have no sum.
    if largest < 2.0 and abs(math.fsum([item * item for item in items]) - 1.0) <= _UNIT_TOLERANCE:
        return numbers
    if largest == 0.0:
        raise zero()
    numbers = np.ldexp(numbers, -math.frexp(largest)[1])
    return np.asarray(numbers / math.sqrt(float(numbers @ numbers)))


def number(what: str, value: float, rule: Rule = ARGUMENT) -> float:
    """A float, finite or not."""
    if type(value) is float:
        return value
    try:
        if isinstance(value, (str, bytes, bytearray)):
            raise TypeError
        return float(value)
    except (TypeError, ValueError, OverflowError) as error:
        raise refuse(rule, f"The {what} is {value!r}, not a number.") from error


def positive(what: str, value: float, rule: Rule = DIMENSION) -> float:
    """A finite number greater than zero."""
    result = number(what, value, rule)
    if not (0.0 < result < math.inf):
        raise refuse(rule, f"The {what} is {result!r}; it has to be positive.")
    return result


def positives(what: str, given: ArrayLike, count: int) -> list[float]:
    """Positive numbers, one an axis; a single one stands for all."""
    if isinstance(given, (int, float)):
        return [positive(what, given)] * count
    items = given if isinstance(given, (tuple, list)) else np.asarray(given, dtype=object).tolist()
    if not isinstance(items, (tuple, list)):
        return [positive(what, items)] * count
    if len(items) != count:
        raise refuse(DIMENSION, f"A {what} is needed for each of {count} axes, not {given!r}.")
    return [positive(what, item) for item in items]


def mass(value: float) -> float:
    """A finite number, zero or greater."""
    result = number("mass", value, MASS)
    if not (0.0 <= result < math.inf):
        raise refuse(MASS, f"The mass is {result!r}.")
    return result


def inertia(value: ArrayLike) -> Floats:
    """A 3×3 matrix of finite numbers; three numbers are its diagonal."""
    numbers = array(value)
    if numbers is not None and numbers.shape == (3,):
        numbers = np.diag(numbers)
    if numbers is None or numbers.shape != (3, 3) or not np.all(np.isfinite(numbers)):
        raise refuse(INERTIA, f"The inertia is {value!r}.")
    return numbers.astype(np.float64, copy=False)


def whole(what: str, value: int) -> int:
    """A whole number, zero or greater, of 64 bits."""
    result = integer(what, value)
    if not 0 <= result < 2**63:
        raise refuse(ARGUMENT, f"The {what} is negative, or out of the range of numbers.")
    return result


def integer(what: str, value: int, rule: Rule = ARGUMENT) -> int:
    """A whole number of any size."""
    try:
        return operator.index(value)
    except TypeError as error:
        raise refuse(rule, f"The {what} is {value!r}, not a whole number.") from error


def user_id(value: int) -> int:
    """An integer that fits into 64 bits."""
    result = integer("user id", value, USER_ID)
    if not (-(2**63) <= result < 2**63):
        raise refuse(USER_ID, f"The user id is {value!r}.")
    return result


def flag(what: str, value: bool) -> bool:
    """True or False."""
    if isinstance(value, (bool, np.bool_)):
        return bool(value)
    raise refuse(ARGUMENT, f"The {what} is {value!r}: True or False is needed.")


def text(what: str, value: str) -> str:
    """A text."""
    if isinstance(value, str):
        return str(value)
    raise refuse(ARGUMENT, f"The {what} is {value!r}, not a text.")


def optional(check: Callable[[str, Any], Value]) -> Callable[[str, Any], Value | None]:
    """The same check, which lets None pass."""
    return lambda what, value: None if value is None else check(what, value)


def instance(kind: type[Value]) -> Callable[[str, Any], Value]:
    """A check for the objects of a class."""

    def check(what: str, value: Any) -> Value:
        if isinstance(value, kind):
            return value
        raise refuse(ARGUMENT, f"The {what} is {value!r}, not an object of {kind.__name__}.")

    return check


def fitting(name: str, given: ArrayLike, dtype: type[Scalar]) -> NDArray[Scalar]:
    """An array of a type; not copied where it has it already."""
    try:
        numbers = np.asarray(given)
    except (TypeError, ValueError, OverflowError) as error:
        raise refuse(COLUMNS, f"The column {name} is not an array of numbers.") from error
    if numbers.dtype.kind not in _TAKES[np.dtype(dtype).kind] and numbers.size:
        # Whole numbers may come as floats, and flags as 0 and 1.
        with np.errstate(all="ignore"):
            exact = numbers.dtype.kind in "fiub" and np.array_equal(numbers.astype(dtype), numbers)
        if not exact:
            raise refuse(COLUMNS, f"The column {name} does not hold what it is for.")
    return numbers.astype(dtype, copy=False)


def finite(what: str, value: float) -> float:
    """A finite number."""
    result = number(what, value, NUMBER)
    if not math.isfinite(result):
        raise refuse(NUMBER, f"The {what} is {result!r}.")
    return result


def column(
    name: str, given: ArrayLike, dtype: type[Scalar], shape: tuple[int, ...]
) -> NDArray[Scalar]:
    """An array of a type and shape; not copied where it has them already."""
    numbers = fitting(name, given, dtype)
    if numbers.shape != shape:
        raise refuse(COLUMNS, f"The column {name} has the shape {numbers.shape}, not {shape}.")
    return numbers


def names(sids: NDArray[np.int64], given: Sequence[str | None] | None) -> dict[int, str]:
    """Names by system id, of the rows that have one."""
    if given is None:
        return {}
    if isinstance(given, str) or not isinstance(given, Sequence | np.ndarray):
        raise refuse(COLUMNS, f"The names are {given!r}, not a list.")
    if len(given) != len(sids):
        raise refuse(COLUMNS, f"There are {len(given)} names for {len(sids)} rows.")
    pairs = zip(sids.tolist(), given, strict=True)
    return {sid: text("name", name) for sid, name in pairs if name is not None}


def are_distinct(ids: NDArray[np.int64]) -> bool:
    """Whether no id is there twice."""
    if bool(np.all(ids[1:] > ids[:-1])):
        return True
    ordered = np.sort(ids)
    return bool(np.all(ordered[1:] > ordered[:-1]))


def new_system_ids(
    given: ArrayLike | None, count: int, following: int, is_used: Callable[[int], bool]
) -> NDArray[np.int64]:
    """System ids (n,) for new rows: the next ones, or those given, if they are free."""
    if given is None:
        return np.arange(following, following + count, dtype=np.int64)
    sids = column("sids", given, np.int64, (count,))
    if count == 0:
        return sids
    if sids.min() < 1 or sids.max() == 2**63 - 1 or not are_distinct(sids):
        raise refuse(SYSTEM_ID, "System ids are positive and differ from each other.")
    if sids.min() < following:
        for sid in sids[sids < following].tolist():
            if is_used(sid):
                raise refuse(SYSTEM_ID, f"The system id {sid} is in use.")
    return sids


def new_system_id(given: int | None, following: int, is_used: Callable[[int], bool]) -> int:
    """The system id for one new row: the next one, or the one given, if it is free."""
    if given is None:
        return following
    sid = integer("system id", given, SYSTEM_ID)
    if not 0 < sid < 2**63 - 1 or (sid < following and is_used(sid)):
        raise refuse(SYSTEM_ID, f"The system id {sid} is in use, or out of range.")
    return sid
