"""MuJoCo's warnings, which it writes to a file where the program runs, kept from there."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import mujoco
import numpy as np

__all__ = ["quiet"]


@contextmanager
def quiet() -> Iterator[None]:
    """What diverges is looked up in MuJoCo's data; it need not be told in other ways as well."""
    before = mujoco.get_mju_user_warning()
    mujoco.set_mju_user_warning(lambda _: None)
    try:
        with np.errstate(all="ignore"):
            yield
    finally:
        mujoco.set_mju_user_warning(before)
