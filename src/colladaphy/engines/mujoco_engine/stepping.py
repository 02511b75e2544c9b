"""One step of MuJoCo's, taken apart so that contacts follow their materials and nothing drifts.

Steps of first order (MuJoCo's semi-implicit Euler integrators) hold contacts and limits. With
"rk4", whatever has no motor, touches nothing and meets no limit in a step moves by the classical
Runge-Kutta method of fourth order instead, tree by tree.
"""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from colladaphy.engines.mujoco_engine.contacts import Surfaces, Touches

__all__ = ["Stepper"]

_SMOOTH = int(mujoco.mjtDisableBit.mjDSBL_CONTACT) | int(mujoco.mjtDisableBit.mjDSBL_LIMIT)
_STATE = int(mujoco.mjtState.mjSTATE_PHYSICS) | int(mujoco.mjtState.mjSTATE_WARMSTART)


class Stepper:
    """Steps the data of one compiled model."""

    def __init__(
        self, compiled: Any, surfaces: Surfaces, geom_rows: NDArray[np.int64],
        motors: NDArray[np.float64], *, fourth: bool,
    ) -> None:  # fmt: skip
        self._compiled = compiled
        self._surfaces = surfaces
        self._geom_rows = geom_rows
        self._fourth = fourth
        self._group = _groups(compiled)
        self._geom_trees = np.asarray(compiled.body_treeid)[np.asarray(compiled.geom_bodyid)]
        joints = np.asarray(compiled.jnt_bodyid)
        self._joint_trees = np.asarray(compiled.body_treeid)[joints]
        self._dof_trees = np.asarray(compiled.dof_treeid)
        self._motors = motors
        self._driven = np.unique(self._dof_trees[~np.isnan(motors)])
        ends = np.append(np.asarray(compiled.jnt_qposadr), compiled.nq)
        self._position_trees = np.repeat(self._joint_trees, np.diff(ends))
        self.touches: Touches | None = None
        """The contacts of the last step, if MuJoCo's data do not hold them any more."""

    def step(self, data: Any) -> None:
        """Advance `data` by one time step."""
        self.touches = None
        if not self._fourth:
            self._first_order(data)
            return
        before = _save(self._compiled, data)
        mujoco.mj_step1(self._compiled, data)
        bound = self._bound(data)
        if not bound.any():
            mujoco.mj_fwdActuation(self._compiled, data)
            mujoco.mj_fwdAcceleration(self._compiled, data)
            mujoco.mj_fwdConstraint(self._compiled, data)
            self._smooth(data)
            return
        self._aim(data)
        mujoco.mj_step2(self._compiled, data)
        if bound.all():
            return
        self.touches = Touches.of(data)
        after = _save(self._compiled, data)
        held = bound[self._position_trees], bound[self._dof_trees]
        positions, speeds = data.qpos[held[0]], data.qvel[held[1]]
        mujoco.mj_setState(self._compiled, data, before, _STATE)
        self._smooth(data, anew=True)
        free_positions, free_speeds = data.qpos[~held[0]], data.qvel[~held[1]]
        mujoco.mj_setState(self._compiled, data, after, _STATE)
        data.qpos[held[0]], data.qvel[held[1]] = positions, speeds
        data.qpos[~held[0]], data.qvel[~held[1]] = free_positions, free_speeds

    def _first_order(self, data: Any) -> None:
        mujoco.mj_step1(self._compiled, data)
        self._aim(data)
        mujoco.mj_step2(self._compiled, data)

    def _aim(self, data: Any) -> None:
        """Set what motors and contacts come to in this step; between mj_step1 and mj_step2."""
        if data.ncon:
            self._surfaces.aim(self._compiled, data, self._geom_rows, self._drive)
        else:
            self._drive(data)

    def _drive(self, data: Any) -> None:
        if not len(self._driven):
            return
        rows = slice(data.ne, data.ne + data.nf)
        speeds = self._motors[data.efc_id[rows]]
        wanted = (speeds - data.efc_vel[rows]) / float(self._compiled.opt.timestep)
        data.efc_aref[rows] = np.where(np.isnan(speeds), data.efc_aref[rows], wanted)

    def _smooth(self, data: Any, *, anew: bool = False) -> None:
        """A step in which nothing touches; `anew` if `data` are not at its beginning."""
        option = self._compiled.opt
        flags = option.disableflags
        option.disableflags = flags | _SMOOTH
        try:
            if anew:
                mujoco.mj_forward(self._compiled, data)
            mujoco.mj_RungeKutta(self._compiled, data, 4)
        finally:
            option.disableflags = flags

    def _bound(self, data: Any) -> NDArray[np.bool_]:
        """Which trees a motor, contact or limit holds, and those that loops bind to them."""
        bound = np.zeros(self._compiled.ntree + 1, dtype=np.bool_)  # the last: not of any tree
        bound[self._driven] = True
        if data.ncon:
            bound[self._geom_trees[np.array(data.contact.geom)]] = True
        if data.nl:
            first = data.ne + data.nf
            limits = data.efc_id[first : first + data.nl]
            bound[self._joint_trees[limits]] = True
        bound = bound[:-1]
        if len(self._group) and bound.any():
            groups = np.zeros(len(bound), dtype=np.bool_)
            groups[self._group[bound]] = True
            bound = groups[self._group]
        return bound


def _save(compiled: Any, data: Any) -> NDArray[np.float64]:
    state = np.empty(mujoco.mj_stateSize(compiled, _STATE))
    mujoco.mj_getState(compiled, data, state, _STATE)
    return state


def _groups(compiled: Any) -> NDArray[np.int64]:
    """A number (trees,) for each tree, the same for those that loops of joints bind together."""
    group = np.arange(compiled.ntree)
    sites = np.asarray(compiled.site_bodyid)
    for one, two in zip(compiled.eq_obj1id.tolist(), compiled.eq_obj2id.tolist(), strict=True):
        first, second = np.asarray(compiled.body_treeid)[sites[[one, two]]].tolist()
        if first >= 0 and second >= 0:
            low, high = sorted((int(group[first]), int(group[second])))
            group[group == high] = low
    return group
