"""MuJoCo's own state as bytes: what the next step needs and the World does not hold."""

from __future__ import annotations

import json
import zlib
from typing import Any, Final

import mujoco
import numpy as np
from numpy.typing import NDArray

__all__ = ["recall", "remember"]

_STATE: Final = int(mujoco.mjtState.mjSTATE_INTEGRATION)
# Which trees sleep, and what MuJoCo derives of that: part of its data, but of no state of it.
_ARRAYS: Final = (
    "tree_asleep",
    "tree_awake",
    "body_awake",
    "body_awake_ind",
    "parent_awake_ind",
    "dof_awake_ind",
)
_COUNTS: Final = ("ntree_awake", "nbody_awake", "nparent_awake", "nv_awake")
_PATIENCE: Final = 100  # steps that MuJoCo waits before a tree sleeps, at most
_DIGITS: Final = 12  # of an integer in a list, with its comma, at most
_FRAME: Final = 1000  # all else of the list


def _names(model: Any) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """The arrays and counts that matter beside MuJoCo's state: none where nothing sleeps."""
    sleeps = model.opt.enableflags & int(mujoco.mjtEnableBit.mjENBL_SLEEP)
    return (_ARRAYS, _COUNTS) if sleeps else ((), ())


def remember(model: Any, data: Any) -> bytes:
    """The state of `data`: a line of JSON and all floats bit by bit, compressed."""
    state = np.empty(mujoco.mj_stateSize(model, _STATE))
    mujoco.mj_getState(model, data, state, _STATE)
    arrays, counts = _names(model)
    record = {name: getattr(data, name).tolist() for name in arrays}
    record |= {name: int(getattr(data, name)) for name in counts}
    head = json.dumps(record, separators=(",", ":")).encode("ascii")
    return zlib.compress(head + b"\n" + state.astype("<f8").tobytes(), 1)


def recall(model: Any, data: Any, content: bytes) -> bool:
    """Set fresh `data` to a state; False, with nothing set, if it cannot be one of `model`."""
    size = mujoco.mj_stateSize(model, _STATE)
    names, count_names = _names(model)
    most = 8 * size + _FRAME + _DIGITS * sum(getattr(data, name).size for name in names)
    try:
        plain = zlib.decompressobj().decompress(content, most)
        head, _, floats = plain.partition(b"\n")
        record = json.loads(head)
        state = np.frombuffer(floats, dtype="<f8").astype(np.float64)
        arrays = {name: np.array(record[name], dtype=np.int32) for name in names}
        counts = {name: int(record[name]) for name in count_names}
    except (zlib.error, ValueError, KeyError, TypeError, OverflowError):
        return False
    if len(state) != size or not _fits(model, data, arrays, counts):
        return False
    mujoco.mj_setState(model, data, state, _STATE)
    # The poses that follow from the state, once for all, as those of sleeping bodies are not
    # computed again; then the state anew, exactly.
    mujoco.mj_forward(model, data)
    mujoco.mj_setState(model, data, state, _STATE)
    for name, array in arrays.items():
        getattr(data, name)[:] = array
    for name, count in counts.items():
        setattr(data, name, count)
    return True


def _fits(
    model: Any, data: Any, arrays: dict[str, NDArray[np.int32]], counts: dict[str, int]
) -> bool:
    """True if MuJoCo can follow the indices: a file can hold anything, and C checks nothing."""
    if not arrays:
        return True
    if any(array.shape != getattr(data, name).shape for name, array in arrays.items()):
        return False
    bodies, dofs, trees = int(model.nbody), int(model.nv), int(model.ntree)
    asleep = arrays["tree_asleep"]
    ranges = {
        "tree_asleep": (-_PATIENCE, trees),
        "tree_awake": (0, 2),
        "body_awake": (-1, 2),
        "body_awake_ind": (0, bodies),
        "parent_awake_ind": (0, bodies),
        "dof_awake_ind": (0, dofs),
    }
    within = all(
        np.all((arrays[name] >= low) & (arrays[name] < high))
        for name, (low, high) in ranges.items()
    )
    # Sleeping trees form rings: each names the next one.
    rings = np.array_equal(np.sort(asleep[asleep >= 0]), np.flatnonzero(asleep >= 0))
    most = (trees, bodies, bodies, dofs)
    counted = all(0 <= counts[name] <= top for name, top in zip(_COUNTS, most, strict=True))
    return bool(within and rings and counted)
