"""Poses and velocities between the columns of a World and MuJoCo's coordinates."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from colladaphy.engines.mujoco_engine.axes import coordinates
from colladaphy.engines.mujoco_engine.frames import ORIGIN, Pose
from colladaphy.world import rotations

if TYPE_CHECKING:
    from colladaphy.engines.mujoco_engine.model import Model
    from colladaphy.world import World

__all__ = ["Motion"]

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


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
        self.ids: Ints = np.array([model.bodies[sid] for sid in order], dtype=np.int64)
        """MuJoCo's ids of the same bodies."""
        self.trees: Ints = np.asarray(compiled.body_treeid)[self.ids]
        self._free_rows = np.array([rows[sid] for sid in free], dtype=np.int64)
        self._hanging_rows = np.array([rows[sid] for sid in self._hanging], dtype=np.int64)
        self._hanging_ids = np.array([model.bodies[sid] for sid in self._hanging], dtype=np.int64)
        free_ids = np.array([model.bodies[sid] for sid in free], dtype=np.int64)
        joints = np.asarray(compiled.body_jntadr)[free_ids]
        positions = np.asarray(compiled.jnt_qposadr)[joints]
        velocities = np.asarray(compiled.jnt_dofadr)[joints]
        self._position = positions[:, None] + np.arange(3)
        self._turn = positions[:, None] + np.arange(3, 7)
        self._linear = velocities[:, None] + np.arange(3)
        self._angular = velocities[:, None] + np.arange(3, 6)

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
        """Speeds of the joints that come closest to the velocities of the bodies."""
        compiled, forest = self._model.compiled, self._model.forest
        moves: dict[int, tuple[Floats, Floats]] = {}
        still = (np.zeros(3), np.zeros(3))
        rows = {sid: row for row, sid in enumerate(world.sids.tolist())}
        for sid in forest.order:
            row, id = rows[sid], self._model.bodies[sid]
            linear, angular = world.linear_velocities[row], world.angular_velocities[row]
            link = forest.links.get(sid)
            if link is None:
                moves[sid] = np.array(linear), np.array(angular)
                continue
            base_linear, base_angular = moves.get(link.parent, still)
            parent = int(compiled.body_parentid[id])
            arm = data.xpos[id] - data.xpos[parent]
            base_linear = base_linear + np.cross(base_angular, arm)
            count = int(compiled.body_dofnum[id])
            if count:
                first = int(compiled.body_dofadr[id])
                axes = np.array(data.cdof[first : first + count])
                center = data.subtree_com[compiled.body_rootid[id]]
                axes[:, 3:] += np.cross(axes[:, :3], data.xpos[id] - center)
                wanted = np.concatenate([angular - base_angular, linear - base_linear])
                speeds = np.linalg.lstsq(axes.T, wanted, rcond=None)[0]
                data.qvel[first : first + count] = speeds
                got = speeds @ axes
                base_angular, base_linear = base_angular + got[:3], base_linear + got[3:]
            moves[sid] = base_linear, base_angular

    def take(self, world: World, data: Any) -> None:
        """Write positions and velocities of `data` into the World."""
        rows = self._free_rows
        turns = np.array(data.qpos[self._turn])
        world.positions[rows] = data.qpos[self._position]
        world.orientations[rows] = turns
        world.linear_velocities[rows] = data.qvel[self._linear]
        world.angular_velocities[rows] = rotations.rotate(turns, data.qvel[self._angular])
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
