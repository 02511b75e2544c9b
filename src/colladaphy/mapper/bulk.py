"""Many numbers as text and back at once: by far the largest part of storing and loading.

orjson takes an eighth of the time that repr() and float() take, and writes and reads the same.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import orjson
from numpy.typing import NDArray

__all__ = ["numbers_of", "texts_of"]

Array = NDArray[Any]

# Between these, repr() and orjson both write numbers without an exponent.
_SMALLEST, _LARGEST = 1e-4, 1e16


def texts_of(rows: Array) -> list[str]:
    """One text for each row of (n, m) finite numbers, as repr() but without fractions of zero."""
    count = len(rows)
    if not count:
        return []
    rows = np.ascontiguousarray(rows, dtype=np.float64)
    bits = rows.view(np.int64)
    if np.array_equal(bits[0], bits[-1]) and np.all(bits == bits[0]):
        return _by_repr(rows[:1]) * count
    size = np.abs(rows)
    plain = np.all(((size >= _SMALLEST) & (size < _LARGEST)) | (rows == 0.0), axis=1)
    if plain.all():
        return _by_orjson(rows)
    texts = np.empty(count, dtype=object)
    texts[plain] = _by_orjson(rows[plain])
    texts[~plain] = _by_repr(rows[~plain])
    return texts.tolist()


def _by_repr(rows: Array) -> list[str]:
    if not len(rows):
        return []
    # A list's repr writes every number as repr() does, all in one call.
    return _lines(repr(rows.tolist())[2:-2].replace("], [", "\n").replace(", ", " "))


def _by_orjson(rows: Array) -> list[str]:
    if not len(rows):
        return []
    written = orjson.dumps(rows, option=orjson.OPT_SERIALIZE_NUMPY)
    return _lines(written.decode("ascii")[2:-2].replace("],[", "\n").replace(",", " "))


def _lines(text: str) -> list[str]:
    text += "\n"
    return text.replace(".0 ", " ").replace(".0\n", "\n")[:-1].split("\n")


def numbers_of(texts: Sequence[str], width: int) -> Array:
    """The numbers (n, width) in texts; ValueError where they are none, or not so many.

    XML's spelling: INF, -INF and NaN.
    """
    joined = " ".join(texts)
    values = None
    if "," not in joined:
        # To JSON, -0 is an integer, which has no sign.
        listed = f"[{joined}]".replace(" ", ",").replace("-0,", "-0.0,").replace("-0]", "-0.0]")
        try:
            values = np.array(orjson.loads(listed), dtype=np.float64)
        except ValueError:
            values = None  # blanks, or a spelling that JSON does not have
    if values is None:
        values = np.fromstring(joined, dtype=np.float64, sep=" ")
    if values.shape != (len(texts) * width,):
        raise ValueError(f"there are {values.size} numbers in {len(texts)} texts of {width}")
    return values.reshape(len(texts), width)
