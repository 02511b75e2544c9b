"""MuJoCo's own state as bytes: what the next step needs and the World does not hold."""

from __future__ import annotations

import json
from typing import Any, Final

import mujoco
import numpy as np

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


def remember(model: Any, data: Any) -> bytes:
    """The state of `data`: floats as hexadecimal digits, so that nothing is rounded."""
    state = np.empty(mujoco.mj_stateSize(model, _STATE))
    mujoco.mj_getState(model, data, state, _STATE)
    record = {
        "state": state.astype("<f8").tobytes().hex(),
        "arrays": {name: getattr(data, name).tolist() for name in _ARRAYS},
        "counts": {name: int(getattr(data, name)) for name in _COUNTS},
    }
    return json.dumps(record, separators=(",", ":")).encode("ascii")


def recall(model: Any, data: Any, content: bytes) -> bool:
    """Set fresh `data` to a state; False, with nothing set, if it cannot be one of `model`."""
    try:
        record = json.loads(content)
        state = np.frombuffer(bytes.fromhex(record["state"]), dtype="<f8").astype(np.float64)
        arrays = {name: np.array(record["arrays"][name], dtype=np.int32) for name in _ARRAYS}
        counts = {name: int(record["counts"][name]) for name in _COUNTS}
    except (ValueError, KeyError, TypeError, OverflowError):
        return False
    fits = all(arrays[name].shape == getattr(data, name).shape for name in _ARRAYS)
    if len(state) != mujoco.mj_stateSize(model, _STATE) or not fits:
        return False
    if any(count < 0 for count in counts.values()):
        return False
    mujoco.mj_setState(model, data, state, _STATE)
    # The poses that follow from the state, once for all, as those of sleeping bodies are not
    # computed again; then the state anew, exactly.
    mujoco.mj_forward(model, data)
    mujoco.mj_setState(model, data, state, _STATE)
    for name in _ARRAYS:
        getattr(data, name)[:] = arrays[name]
    for name in _COUNTS:
        setattr(data, name, counts[name])
    return True
