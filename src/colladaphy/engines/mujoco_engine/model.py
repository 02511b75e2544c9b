"""From a World to a compiled MuJoCo model, in memory.

The model depends on nothing that changes while the World runs, so that it is the same one, bit by
bit, at every checkpoint: free bodies stand at the origin, hanging bodies at zero.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from colladaphy.engines.frames import ORIGIN, Pose
from colladaphy.engines.mujoco_engine.axes import Freedom, Hanging, hang
from colladaphy.engines.mujoco_engine.contacts import Surfaces
from colladaphy.engines.mujoco_engine.forest import Forest, plan
from colladaphy.engines.mujoco_engine.freeing import add_free_joint, freed, is_quick
from colladaphy.engines.mujoco_engine.inertia import inertias_of, principal
from colladaphy.engines.mujoco_engine.loops import close
from colladaphy.engines.mujoco_engine.settings import Chosen
from colladaphy.engines.mujoco_engine.shapes import Shapes, shapes_of
from colladaphy.engines.rules import LIBRARY, refuse
from colladaphy.engines.surfaces import used_materials

if TYPE_CHECKING:
    from colladaphy.world import Joint, World

__all__ = ["Model", "build"]

Floats = NDArray[np.float64]

_SLEEP = 0.05  # of the velocity that gravity gives in one step
_DRIVEN = 0.999  # of the way to its speed that a motor goes in a step
_HARD = 2.0  # steps: the least that MuJoCo is stable with
# MuJoCo's own guess grows with the square of the number of bodies.
_MEMORY = 32 << 20
_MEMORY_PER_SHAPE = 128 << 10
_FEW = 100  # free bodies that MuJoCo compiles in no time
_PART = 200  # bodies of a specification that is added to as a whole
_FAR = 1e10  # what MuJoCo takes for infinity


@dataclass(slots=True)
class Model:
    """A compiled model and where the bodies of the World are in it."""

    compiled: Any
    forest: Forest
    hangings: dict[int, Hanging]
    """By system id of the body that hangs."""
    bodies: dict[int, int]
    """MuJoCo's body ids by system id, of top-level bodies that move."""
    geom_sids: NDArray[np.int64]
    """System id of the top-level body of each geom."""
    surfaces: Surfaces
    geom_rows: NDArray[np.int64]
    """Row in the table of `surfaces` of each geom."""
    motors: NDArray[np.float64]
    """The speed (nv,) at which each degree of freedom is driven, NaN for those without a motor."""


def build(world: World, chosen: Chosen) -> Model:
    """Compile `world`, which `refusals.check` finds no error in; EngineError if that fails."""
    spec = _specification()
    _set_options(spec, world, chosen)
    forest = plan(world)
    quick = len(forest.order) > _FEW and is_quick(forest)
    joints = {joint.sid: joint for joint in world.joints}
    used = used_materials(world)[0].tolist()
    surfaces = Surfaces.of(world, used, chosen.friction, twice=chosen.solver == "newton")
    builder = _Builder(world, spec, forest, joints, surfaces, chosen.impedance)
    builder.add_fixed()
    if quick:
        builder.add_in_parts(forest.order)
    else:
        for sid in forest.order:
            builder.add_moving(sid, spec)
    for number in forest.loops:
        close(spec, joints[number], builder.bodies, _solref(world, _HARD))
    builder.add_exclusions()
    spec.memory = _MEMORY + _MEMORY_PER_SHAPE * len(builder.geoms)
    try:
        with _same_names():
            compiled = _compiled(spec, builder.free, quick=quick)
    except (ValueError, mujoco.FatalError) as error:
        raise refuse(LIBRARY, f"MuJoCo refuses the scene: {error}") from error
    numbers = {sid: int(builder.bodies[sid].id) for sid in forest.order}
    owners = np.zeros(compiled.ngeom, dtype=np.int64)
    materials = np.zeros(compiled.ngeom, dtype=np.int64)
    for geom, sid, material in builder.geoms:
        owners[geom.id], materials[geom.id] = sid, material
    rows = surfaces.table.places(materials)
    motors = np.full(compiled.nv, np.nan)
    for driven, speed in builder.motors:
        motors[compiled.jnt_dofadr[driven.id]] = speed
    return Model(compiled, forest, builder.hangings, numbers, owners, surfaces, rows, motors)


def _compiled(spec: Any, free: list[Any], *, quick: bool) -> Any:
    """The model; `quick` if nothing but `free` moves."""
    if quick:
        try:
            return freed(spec.compile(), np.array([body.id for body in free]))
        except (ValueError, mujoco.FatalError):
            pass  # the compiler can tell what is wrong
    for body in free:
        add_free_joint(body)
    return spec.compile()


def _solref(world: World, steps: float) -> list[float]:
    """Time constant and damping ratio with which MuJoCo mends what is violated."""
    return [steps * float(world.time_step or 0.0), 1.0]


@contextmanager
def _same_names() -> Iterator[None]:
    """Parts have the names of the World; MuJoCo warns of that, as it would write them wrongly."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Attaching a spec", UserWarning)
        yield


def _specification() -> Any:
    spec = mujoco.MjSpec()
    spec.compiler.degree = False
    spec.compiler.inertiafromgeom = mujoco.mjtInertiaFromGeom.mjINERTIAFROMGEOM_FALSE
    spec.compiler.alignfree = False
    return spec


def _set_options(spec: Any, world: World, chosen: Chosen) -> None:
    option = spec.option
    option.timestep = world.time_step
    option.gravity = world.gravity
    first_order = "implicitfast" if chosen.integrator == "rk4" else chosen.integrator
    option.integrator = getattr(mujoco.mjtIntegrator, f"mjINT_{first_order.upper()}")
    option.solver = getattr(mujoco.mjtSolver, f"mjSOL_{chosen.solver.upper()}")
    option.iterations = chosen.iterations
    option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    option.impratio = 10.0  # harder friction: less creep on slopes
    if chosen.sleep:
        option.enableflags |= int(mujoco.mjtEnableBit.mjENBL_SLEEP)
        gravity = float(np.linalg.norm(world.gravity))
        option.sleep_tolerance = _SLEEP * gravity * float(world.time_step or 0.0)
    # A run that diverges must fail, not start again; what joints bind may collide, unless they
    # say otherwise.
    option.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_AUTORESET)
    option.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_FILTERPARENT)


class _Builder:
    def __init__(
        self,
        world: World,
        spec: Any,
        forest: Forest,
        joints: dict[int, Joint],
        surfaces: Surfaces,
        impedance: float,
    ) -> None:
        self.world = world
        self.spec = spec
        self.forest = forest
        self.joints = joints
        self.shapes = Shapes(spec, world)
        self.friction = dict(zip(surfaces.table.ids.tolist(), surfaces.own.tolist(), strict=True))
        self.impedance = impedance
        self.slippery = not surfaces.table.dynamic.any()
        self.bodies: dict[int, Any] = {0: spec.worldbody}
        self.hangings: dict[int, Hanging] = {}
        self.free: list[Any] = []  # bodies that have still to get their joints
        self.geoms: list[tuple[Any, int, int]] = []  # with system id and material
        self.motors: list[tuple[Any, float]] = []  # MuJoCo's joints and their speeds
        self.inertias = inertias_of(world)
        self.principals: dict[bytes, tuple[Any, Any]] = {}
        self.rows = {sid: row for row, sid in enumerate(world.sids.tolist())}

    def add_fixed(self) -> None:
        """Fixed bodies: bodies of MuJoCo's without a joint."""
        world = self.world
        for row in np.flatnonzero(world.fixed).tolist():
            sid = int(world.sids[row])
            pose = Pose.of(world.positions[row], world.orientations[row])
            body = self._add_body(sid, self.spec.worldbody, pose)
            self._add_geoms(body, sid)

    def add_in_parts(self, sids: list[int]) -> None:
        """Bodies that are free: each that is added takes a look at all that are in its part."""
        for start in range(0, len(sids), _PART):
            part = _specification()
            for sid in sids[start : start + _PART]:
                self.add_moving(sid, part)
            with _same_names():
                self.spec.attach(part, frame=self.spec.worldbody.add_frame(), prefix="")

    def add_moving(self, sid: int, spec: Any) -> None:
        """A body that moves: free, and then in `spec`, or hanging on another one."""
        link = self.forest.links.get(sid)
        if link is None:
            body = self._add_body(sid, spec.worldbody, ORIGIN)
            self.free.append(body)
        else:
            joint = self.joints[link.joint]
            hanging = hang(joint, link)
            self.hangings[sid] = hanging
            body = self._add_body(sid, self.bodies[link.parent], hanging.zero)
            for number, freedom in enumerate(hanging.freedoms):
                self._add_freedom(body, joint, hanging, freedom, f"joint{joint.sid}.{number}")
        row = self.rows[sid]
        body.mass = float(self.world.masses[row])
        body.ipos = np.zeros(3)
        body.inertia, body.iquat = self._principal(self.inertias[row])
        body.explicitinertial = True
        self._add_geoms(body, sid)

    def _principal(self, inertia: NDArray[np.float64]) -> tuple[Any, Any]:
        """Principal moments and axes, which many bodies have in common."""
        key = inertia.tobytes()
        if key not in self.principals:
            self.principals[key] = principal(inertia)
        return self.principals[key]

    def _add_body(self, sid: int, parent: Any, pose: Pose) -> Any:
        body = parent.add_body()
        body.name = f"body{sid}"
        body.pos = pose.position
        body.quat = pose.orientation
        self.bodies[sid] = body
        return body

    def _add_freedom(
        self, body: Any, joint: Joint, hanging: Hanging, freedom: Freedom, name: str
    ) -> None:
        made = body.add_joint()
        made.name = name
        made.type = getattr(mujoco.mjtJoint, f"mjJNT_{freedom.kind.upper()}")
        made.align = mujoco.mjtAlignFree.mjALIGNFREE_FALSE
        made.pos = hanging.anchor
        made.axis = freedom.axis
        made.solref_limit = _solref(self.world, _HARD)
        if freedom.kind == "slide":
            low, high, spring = joint.linear_min, joint.linear_max, joint.linear_spring
        else:
            low, high, spring = joint.angular_min, joint.angular_max, joint.angular_spring
        stiffness, damping, target = spring
        made.stiffness[0] = stiffness
        made.damping[0] = damping
        if freedom.kind == "ball":
            made.limited = mujoco.mjtLimited.mjLIMITED_FALSE
            return
        speed, strength = joint.motor
        if strength:
            # Friction that holds an axis at a speed instead of at rest (`stepping`).
            made.frictionloss = strength
            made.solimp_friction = [_DRIVEN, _DRIVEN, 1.0, 0.5, 1.0]
            self.motors.append((made, speed))
        made.springref = target
        span = [float(low[freedom.index]), float(high[freedom.index])]
        limited = any(np.isfinite(span))
        made.limited = getattr(mujoco.mjtLimited, f"mjLIMITED_{str(limited).upper()}")
        if limited:
            made.range = [max(span[0], -_FAR), min(span[1], _FAR)]

    def _add_geoms(self, body: Any, sid: int) -> None:
        for shape in shapes_of(self.world, sid):
            geom = self.shapes.add(body, shape, shape.pose)
            geom.friction = [self.friction[shape.material], 0.0, 0.0]
            geom.condim = 1 if self.slippery else 3
            geom.solimp = [self.impedance, self.impedance, 1.0, 0.5, 1.0]
            self.geoms.append((geom, sid, shape.material))

    def add_exclusions(self) -> None:
        """Bodies that joints let interpenetrate never collide."""
        apart: set[tuple[int, int]] = set()
        for joint in self.joints.values():
            if joint.enabled and joint.interpenetrate and joint.body1 and joint.body2:
                one, two = sorted((joint.body1.sid, joint.body2.sid))
                if (one, two) not in apart:
                    exclude = self.spec.add_exclude()
                    exclude.bodyname1, exclude.bodyname2 = f"body{one}", f"body{two}"
                apart.add((one, two))
