"""Contacts that follow restitution and friction of each pair of materials.

MuJoCo makes contacts by solving for accelerations that come close to a reference, as one-sided
constraints. The reference is set here, in every step: an approaching speed v becomes -e·v by the
end of the step, a sliding speed becomes zero as far as friction allows, and what overlaps is moved
apart at a share of the overlap a step. So rebounds depend neither on the speed nor on the step.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import mujoco
import numpy as np
from numpy.typing import NDArray

from colladaphy.engines.protocol import Contact
from colladaphy.world.pairing import PairTable

if TYPE_CHECKING:
    from colladaphy.world import World

__all__ = ["Surfaces", "Touches"]

_MEND: Final = 0.03  # of an overlap that goes in one step
_LEAST_FRICTION: Final = 1e-5  # mjMINMU


@dataclass(slots=True)
class Surfaces:
    """Coefficients of the pairs of materials of a scene."""

    table: PairTable
    own: NDArray[np.float64]
    """Friction (k,) of each material with itself, which MuJoCo has: it takes the larger of two."""
    special: bool
    """For some pair the larger of the two is wrong: frictions are set in every step."""
    twice: bool
    """Contacts are solved for twice in a step where something slides."""

    @classmethod
    def of(cls, world: World, ids: Any, rule: str, *, twice: bool) -> Surfaces:
        """The surfaces of the materials of `ids`."""
        table = PairTable.of(world.materials, ids, rule)
        own = np.array(np.diagonal(table.dynamic))
        special = bool(np.any(table.dynamic != np.maximum(own[:, None], own)))
        return cls(table, own, special, twice)

    def aim(
        self, model: Any, data: Any, rows: NDArray[np.int64], drive: Callable[[Any], None]
    ) -> None:
        """Set what contacts do; between mj_step1 and mj_step2. `rows`: table rows of the geoms.

        `drive` sets what motors do, before anything is solved for.
        """
        contact = data.contact
        pairs = rows[np.array(contact.geom)]
        first, second = pairs[:, 0], pairs[:, 1]
        if self.special:
            friction = self.table.dynamic[first, second]
            contact.friction[:, :2] = np.maximum(friction, _LEAST_FRICTION)[:, None]
            contact.dim[:] = np.where(friction > 0, 3, 1)
            mujoco.mj_makeConstraint(model, data)
            mujoco.mj_island(model, data)
            mujoco.mj_referenceConstraint(model, data)
        drive(data)
        mujoco.mj_fwdActuation(model, data)
        mujoco.mj_fwdAcceleration(model, data)
        free = np.zeros(data.nefc)
        mujoco.mj_mulJacVec(model, data, free, data.qacc_smooth)
        dt = float(model.opt.timestep)
        speeds, free = np.array(data.efc_vel), data.efc_vel + dt * free
        starts = np.array(contact.efc_address)
        used = starts >= 0
        starts, dims = starts[used], np.array(contact.dim)[used]
        bounce = self.table.restitution[first[used], second[used]]
        mend = -_MEND / dt * np.array(contact.dist)[used]
        wanted = np.maximum(-bounce * speeds[starts], mend)
        rough = dims > 1
        rows, friction = starts[rough], np.array(contact.friction)[used, 0][rough]
        for row in (rows + 1, rows + 2):
            data.efc_aref[row] = -speeds[row] / dt
        # MuJoCo's cone lets bodies part at the friction times the speed at which they slide on:
        # that much less is asked for. First the sliding is guessed, then, if need be, solved for.
        sliding = np.hypot(free[rows + 1], free[rows + 2])
        sliding -= friction * np.maximum(wanted[rough] - free[rows], 0.0)
        for last in (not self.twice, True):
            lift = np.zeros(len(wanted))
            lift[rough] = friction * np.maximum(sliding, 0.0)
            data.efc_aref[starts] = (wanted - lift - speeds[starts]) / dt
            if last or not lift.any():
                return
            mujoco.mj_fwdConstraint(model, data)
            data.qacc_warmstart[:] = data.qacc
            mujoco.mj_mulJacVec(model, data, free, data.qacc)
            sliding = np.hypot(*(speeds[row] + dt * free[row] for row in (rows + 1, rows + 2)))


@dataclass(slots=True)
class Touches:
    """The contacts of a step, copied out of MuJoCo's data."""

    geoms: NDArray[np.int64]
    positions: NDArray[np.float64]
    normals: NDArray[np.float64]
    distances: NDArray[np.float64]
    forces: NDArray[np.float64]
    """Normal forces (n,)."""

    @classmethod
    def of(cls, data: Any) -> Touches:
        """The contacts of `data`, which has just been stepped."""
        contact = data.contact
        starts = np.array(contact.efc_address, dtype=np.int64)
        forces = np.zeros(len(starts))
        forces[starts >= 0] = data.efc_force[starts[starts >= 0]]
        return cls(
            np.array(contact.geom, dtype=np.int64).reshape(-1, 2),
            np.array(contact.pos).reshape(-1, 3),
            np.array(contact.frame).reshape(-1, 9)[:, :3],
            np.array(contact.dist),
            forces,
        )

    def listed(self, sids: NDArray[np.int64], time_step: float) -> list[Contact]:
        """As contacts of bodies, ordered by system ids; `sids` are those of the geoms' bodies."""
        found = []
        bodies = sids[self.geoms].tolist()
        for (first, second), position, normal, distance, force in zip(
            bodies, self.positions, self.normals, self.distances.tolist(), self.forces.tolist(),
            strict=True,
        ):  # fmt: skip
            if first > second:
                first, second, normal = second, first, -normal
            impulse = force * time_step
            x, y, z = position.tolist()
            nx, ny, nz = normal.tolist()
            found.append(Contact(first, second, (x, y, z), (nx, ny, nz), distance, impulse))
        return sorted(found, key=lambda contact: (contact.first, contact.second))
