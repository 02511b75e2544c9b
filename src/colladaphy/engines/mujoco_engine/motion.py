"""Poses and velocities between the columns of a World and MuJoCo's coordinates."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import mujoco
import numpy as np
from numpy.typing import NDArray

from colladaphy.engines.edits import run_of
from colladaphy.engines.frames import ORIGIN, Pose
from colladaphy.engines.mujoco_engine.axes import coordinates
from colladaphy.world import rotations

if TYPE_CHECKING:
    from colladaphy.engines.mujoco_engine.model import Model
    from colladaphy.world import World

__all__ = ["Motion"]

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_NOTHING: Final = 1e-12
_MOTION: Final = ("positions", "orientations", "linear_velocities", "angular_velocities")


class Motion:
    """Moves the motion of all bodies of a World into and out of MuJoCo's data, at once."""

    def __init__(self, world: World, model: Model) -> None:
        self._model = model
        compiled = model.compiled
        rows = {sid: row for row, sid in enumerate(world.sids.tolist())}
        order = model.forest.order
        free = [sid for sid in order if sid not in model.forest.links]
        self._hanging = [sid for sid in order if sid in model.forest.links]
        self.rows: Ints = np.array([rows[sid] for sid in order], dtype=np.int64)
        """Rows of the World's columns of the bodies that move."""
        ascending = bool(np.all(np.diff(self.rows) > 0))
        self._run: Any = run_of(self.rows) if ascending else self.rows
        self.ids: Ints = np.array([model.bodies[sid] for sid in order], dtype=np.int64)
        """MuJoCo's ids of the same bodies."""
        self.trees: Ints = np.asarray(compiled.body_treeid)[self.ids]
        self._free_rows = np.array([rows[sid] for sid in free], dtype=np.int64)
        self._hanging_rows = np.array([rows[sid] for sid in self._hanging], dtype=np.int64)
        self._hanging_ids = np.array([model.bodies[sid] for sid in self._hanging], dtype=np.int64)
        roots = np.unique(np.asarray(compiled.body_rootid)[self._hanging_ids])
        in_tree = np.isin(np.asarray(compiled.body_rootid), roots)
        self._jointed_dofs = np.flatnonzero(in_tree[np.asarray(compiled.dof_bodyid)])
        free_ids = np.array([model.bodies[sid] for sid in free], dtype=np.int64)
        joints = np.asarray(compiled.body_jntadr)[free_ids]
        positions = np.asarray(compiled.jnt_qposadr)[joints]
        velocities = np.asarray(compiled.jnt_dofadr)[joints]
        self._position = positions[:, None] + np.arange(3)
        self._turn = positions[:, None] + np.arange(3, 7)
        self._linear = velocities[:, None] + np.arange(3)
        self._angular = velocities[:, None] + np.arange(3, 6)

    def columns(self, world: World) -> list[NDArray[Any]]:
        """Copies of poses and velocities of the bodies that move."""
        column, rows = world.top.column, self._run
        return [column(name)[rows].copy() for name in _MOTION]

    def put(self, world: World, data: Any) -> None:
        """Set positions and velocities of `data` from the World."""
        rows = self._free_rows
        turns = rotations.normalize(world.orientations[rows])
        data.qpos[self._position] = world.positions[rows]
        data.qpos[self._turn] = turns
        data.qvel[self._linear] = world.linear_velocities[rows]
        data.qvel[self._angular] = rotations.unrotate(turns, world.angular_velocities[rows])
        if self._hanging:
            self._put_hanging(world, data)

    def _put_hanging(self, world: World, data: Any) -> None:
        compiled, forest = self._model.compiled, self._model.forest
        joints = {joint.sid: joint for joint in world.joints}
        for sid in self._hanging:
            link, hanging = forest.links[sid], self._model.hangings[sid]
            joint = joints[link.joint]
            one, two = (
                Pose.of(body.position, body.orientation) if body else ORIGIN
                for body in (joint.body1, joint.body2)
            )
            if hanging.freedoms:
                first = compiled.jnt_qposadr[compiled.body_jntadr[self._model.bodies[sid]]]
                values = coordinates(joint, link, hanging, one, two)
                data.qpos[first : first + len(values)] = values
        mujoco.mj_kinematics(compiled, data)
        mujoco.mj_comPos(compiled, data)
        self._put_speeds(world, data)

    def _put_speeds(self, world: World, data: Any) -> None:
        """The speeds that joints allow with the momentum that the bodies have.

        They minimise the kinetic energy of the difference: what impulses in the joints do. The
        momentum along each freedom, of all that it moves, is kept; MuJoCo's mass matrix makes
        speeds of it.
        """
        compiled = self._model.compiled
        rows, ids = self.rows, self.ids
        spin = world.angular_velocities[rows]
        inertias = rotations.rotate_tensor(world.orientations[rows], world.inertias[rows])
        turn = np.einsum("nij,nj->ni", inertias, spin)
        push = world.masses[rows, None] * world.linear_velocities[rows]
        arms = data.xpos[ids] - data.subtree_com[np.asarray(compiled.body_rootid)[ids]]
        moments = np.zeros((compiled.nbody, 6))
        moments[ids, :3] = turn + np.cross(arms, push)
        moments[ids, 3:] = push
        parents = compiled.body_parentid
        for sid in reversed(self._hanging):
            id = self._model.bodies[sid]
            moments[parents[id]] += moments[id]
        carried = moments[np.asarray(compiled.dof_bodyid)]
        along = np.einsum("di,di->d", np.asarray(data.cdof), carried)[None]
        mujoco.mj_crb(compiled, data)
        mujoco.mj_factorM(compiled, data)
        speeds = np.zeros_like(along)
        mujoco.mj_solveM(compiled, data, speeds, along)
        hung = self._jointed_dofs
        data.qvel[hung] = speeds[0, hung]
        if compiled.neq and compiled.nv:
            self._close_loops(data)

    def _close_loops(self, data: Any) -> None:
        """Take out of the speeds what the constraints that close loops do not allow."""
        compiled = self._model.compiled
        mujoco.mj_fwdPosition(compiled, data)
        count = data.ne
        rows = np.zeros((count, compiled.nv))
        if mujoco.mj_isSparse(compiled):
            for row in range(count):
                start, length = data.efc_J_rowadr[row], data.efc_J_rownnz[row]
                columns = data.efc_J_colind[start : start + length]
                rows[row, columns] = data.efc_J[start : start + length]
        else:
            rows[:] = np.asarray(data.efc_J).reshape(-1, compiled.nv)[:count]
        # What the tree holds already leaves rows of rounding errors, which must not be obeyed.
        rows[np.abs(rows) < _NOTHING * (1.0 + np.abs(data.xpos).max())] = 0.0
        answers = np.zeros_like(rows)
        mujoco.mj_solveM(compiled, data, answers, rows)
        wrong = rows @ data.qvel
        impulses = np.linalg.lstsq(rows @ answers.T, wrong, rcond=1e-12)[0]
        data.qvel[:] -= answers.T @ impulses

    def free_speeds(self, data: Any) -> Floats:
        """Linear velocities (n, 3) of the bodies that hang on nothing."""
        return np.asarray(data.qvel[self._linear])

    def take(self, world: World, data: Any) -> None:
        """Write positions and velocities of `data` into the World."""
        rows = self._free_rows
        turns = np.array(data.qpos[self._turn])
        world.positions[rows] = data.qpos[self._position]
        world.orientations[rows] = turns
        world.linear_velocities[rows] = data.qvel[self._linear]
        world.angular_velocities[rows] = _rotated(turns, data.qvel[self._angular])
        if not self._hanging:
            return
        compiled, ids, rows = self._model.compiled, self._hanging_ids, self._hanging_rows
        # These fill in what follows from positions and velocities; the next step does it again.
        mujoco.mj_kinematics(compiled, data)
        mujoco.mj_comPos(compiled, data)
        mujoco.mj_comVel(compiled, data)
        places = np.array(data.xpos[ids])
        spins = np.array(data.cvel[ids])
        arms = places - data.subtree_com[np.asarray(compiled.body_rootid)[ids]]
        world.positions[rows] = places
        world.orientations[rows] = data.xquat[ids]
        world.angular_velocities[rows] = spins[:, :3]
        world.linear_velocities[rows] = spins[:, 3:] + np.cross(spins[:, :3], arms)


def _rotated(turns: Floats, vectors: Floats) -> Floats:
    """Vectors (n, 3) rotated by quaternions (n, 4) of length one: v + 2 u × (u × v + w v)."""
    w, x, y, z = turns.T
    a, b, c = vectors.T
    inner = (y * c - z * b + w * a, z * a - x * c + w * b, x * b - y * a + w * c)
    p, q, r = inner
    rotated = np.empty_like(vectors)
    rotated[:, 0] = a + 2.0 * (y * r - z * q)
    rotated[:, 1] = b + 2.0 * (z * p - x * r)
    rotated[:, 2] = c + 2.0 * (x * q - y * p)
    return rotated
