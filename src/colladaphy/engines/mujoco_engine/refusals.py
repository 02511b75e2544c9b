"""What MuJoCo cannot run, drops or approximates."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np

from colladaphy.engines.jointed import crossed, fastest, joint_findings, motor_findings
from colladaphy.engines.mujoco_engine.convexity import is_convex
from colladaphy.engines.mujoco_engine.forest import plan
from colladaphy.engines.mujoco_engine.freeing import is_quick
from colladaphy.engines.mujoco_engine.inertia import SLACK, are_points, inertias_of
from colladaphy.engines.mujoco_engine.loops import can_close
from colladaphy.engines.mujoco_engine.settings import MujocoOptions, resolve
from colladaphy.engines.mujoco_engine.shapes import is_round, shapes_of
from colladaphy.engines.rules import (
    INERTIA_ASSUMED,
    INERTIA_TRIANGLE,
    JOINT_APPROXIMATED,
    JOINT_INERT,
    JOINT_LIMITS,
    JOINT_LOOP,
    JOINT_OVERLAP,
    MASS,
    MESH_HULL,
    MOVING_PLANE,
    SETUP,
    SHAPE_APPROXIMATED,
    SIZE,
)
from colladaphy.engines.unused import unused
from colladaphy.world import Kind

if TYPE_CHECKING:
    from colladaphy.engines.mujoco_engine.model import Model
    from colladaphy.findings import Finding
    from colladaphy.world import Body, Joint, World

__all__ = ["MOST", "check", "overlaps"]

_LEAST = 1e-15  # mjMINVAL
MOST = 1e10
"""The largest number that MuJoCo computes with (mjMAXVAL)."""
_MOST_MASS = 1e20
# Seconds for the square of the number of bodies, with joints and without, on a machine of 2024.
_COMPILE = 2.5e-7
_COMPILE_FREE = 3e-8
_LONG = 5.0  # seconds worth a word
_DEEP = 1e-4  # of the size of a body: an overlap worth a word


def check(
    world: World, options: MujocoOptions | None = None, *, fresh: bool = True
) -> list[Finding]:
    """All findings about running `world`; those of severity error are refusals.

    `fresh`: it is not as the engine left it, so that joints may not fit their bodies.
    """
    options = options or MujocoOptions()
    with np.errstate(all="ignore"):
        findings = [*_gravity(world), *_bodies(world), *_shapes(world), *_joints(world, fresh)]
        findings += unused(world, options.friction, sleep=options.sleep)
    return [*resolve(options, world).describe(), *_duration(world), *findings]


def _duration(world: World) -> Iterator[Finding]:
    count = int(np.count_nonzero(~world.fixed))
    if _COMPILE * count**2 <= _LONG:
        return
    seconds = (_COMPILE_FREE if is_quick(plan(world)) else _COMPILE) * count**2
    if seconds > _LONG:
        yield SETUP.at(
            message=f"Setting up {count} bodies takes about {seconds:.0f} s: MuJoCo takes time "
            "for it that grows with the square of their number. The steps then do not."
        )


def _gravity(world: World) -> Iterator[Finding]:
    if np.any(np.abs(world.gravity) > MOST):
        message = f"Gravity is {world.gravity.tolist()}, beyond what MuJoCo computes with."
        yield SIZE.at(message=message)


def _bodies(world: World) -> Iterator[Finding]:
    moving = ~world.fixed
    inertias = inertias_of(world)
    points = moving & are_points(world.masses, np.asarray(world.inertias))
    huge = (np.abs(inertias).max(axis=(1, 2)) > _MOST_MASS) | (world.masses > _MOST_MASS)
    tensors = np.where(huge[:, None, None], np.eye(3), inertias)
    moments = np.linalg.eigvalsh(0.5 * (tensors + np.swapaxes(tensors, 1, 2)))
    massless = moving & ((world.masses <= 0) | (moments[:, 0] <= 0))
    tiny = moving & ~massless & ((world.masses < _LEAST) | (moments[:, 0] < _LEAST))
    sums = moments[:, 0] + moments[:, 1]
    crooked = moving & ~massless & (moments[:, 2] > sums * (1 + SLACK))
    numbers = np.concatenate(
        [world.positions, world.linear_velocities, world.angular_velocities], axis=1
    )
    huge |= np.any(np.abs(numbers) > MOST, axis=1)
    for row, moment in zip(
        np.flatnonzero(points).tolist(), inertias[points, 0, 0].tolist(), strict=True
    ):
        body = world.bodies[row]
        message = f"{body!r} has no inertia: principal moments of {moment:.3g} are assumed."
        yield INERTIA_ASSUMED.at(message=message)
    for row in np.flatnonzero(massless).tolist():
        body = world.bodies[row]
        yield MASS.at(message=f"{body!r} can move, but has the mass {body.mass:g} and the "
                      f"principal moments of inertia {moments[row].tolist()}.")  # fmt: skip
    for row in np.flatnonzero(crooked).tolist():
        body = world.bodies[row]
        yield INERTIA_TRIANGLE.at(message=f"{body!r} has the principal moments of inertia "
                                  f"{moments[row].tolist()}.")  # fmt: skip
    for row in np.flatnonzero(tiny | huge).tolist():
        yield SIZE.at(message=f"{world.bodies[row]!r} has a mass, inertia, position or velocity "
                      "beyond what MuJoCo computes with.")  # fmt: skip


def _shapes(world: World) -> Iterator[Finding]:
    convex: dict[int, bool] = {}
    unusual = np.isin(world.kinds, [Kind.UNION, Kind.MESH, Kind.PLANE, Kind.CAPSULE, Kind.CYLINDER])
    for row in np.flatnonzero(unusual).tolist():
        body: Body = world.bodies[row]
        for shape in shapes_of(world, body.sid):
            if shape.kind is Kind.PLANE and not body.fixed:
                yield MOVING_PLANE.at(message=f"{body!r} holds a plane, but is not fixed.")
            if not is_round(shape):
                yield SHAPE_APPROXIMATED.at(
                    message=f"{body!r} has a {shape.kind.name.lower()} of elliptic section: "
                    "a polyhedron of 32 sides is taken for it."
                )
            if shape.kind is Kind.MESH:
                if shape.mesh not in convex:
                    mesh = world.meshes[shape.mesh]
                    convex[shape.mesh] = mesh.convex or is_convex(mesh)
                if not convex[shape.mesh]:
                    message = f"{body!r} is not convex: its convex hull collides."
                    yield MESH_HULL.at(message=message)


def _joints(world: World, fresh: bool) -> Iterator[Finding]:
    forest = plan(world)
    loops, inert = set(forest.loops), set(forest.inert)
    speeds = fastest(world)
    for joint in world.joints:
        if not joint.enabled:
            continue
        if joint.sid in inert:
            yield JOINT_INERT.at(message=f"{joint!r} binds what cannot move.")
            continue
        yield from motor_findings(joint)
        wrong = joint_findings(joint, speeds, closing=joint.sid in loops)
        yield from (f for f in wrong if fresh or f.code == JOINT_LIMITS.code)
        if crossed(joint):
            continue
        if joint.sid in loops:
            if can_close(joint):
                yield JOINT_APPROXIMATED.at(
                    message=f"{joint!r} closes a loop: a constraint keeps it that gives way a "
                    "little under load."
                )
            else:
                yield JOINT_LOOP.at(message=f"{joint!r} closes a loop.")
        yield from _approximations(joint)


def _approximations(joint: Joint) -> Iterator[Finding]:
    shifts = joint.linear_min != joint.linear_max
    turns = joint.angular_min != joint.angular_max
    limited = turns & ~(np.isinf(joint.angular_min) & np.isinf(joint.angular_max))
    if turns.sum() > 1 and limited.any():
        message = f"{joint!r}: its angles are limited as turns about x, then y, then z."
        yield JOINT_APPROXIMATED.at(message=message)
    for axes, spring, what in (
        (shifts, joint.linear_spring, "linear"),
        (turns, joint.angular_spring, "angular"),
    ):
        if axes.sum() > 1 and any(spring[:2]) and spring[2] != 0.0:
            message = f"{joint!r}: the target of its {what} spring is that of each axis."
            if what == "angular" and axes.all() and not limited.any():
                message = f"{joint!r}: the target of its angular spring is taken for zero."
            yield JOINT_APPROXIMATED.at(message=message)


def overlaps(world: World, model: Model, data: Any) -> Iterator[Finding]:
    """Bodies of joints that overlap, and collide, as `data` has them."""
    joined = {
        (min(one.sid, two.sid), max(one.sid, two.sid))
        for joint in world.joints
        if joint.enabled and not joint.interpenetrate
        and (one := joint.body1) is not None and (two := joint.body2) is not None
    }  # fmt: skip
    if not joined:
        return
    mujoco.mj_kinematics(model.compiled, data)
    mujoco.mj_comPos(model.compiled, data)
    mujoco.mj_collision(model.compiled, data)
    contact, deepest = data.contact, dict[tuple[int, int], float]()
    if not data.ncon:
        return
    geoms = np.array(contact.geom)
    sizes = np.asarray(model.compiled.geom_rbound)[geoms]
    sizes = np.where(sizes > 0, sizes, np.inf).min(axis=1)
    for pair, depth, size in zip(
        model.geom_sids[geoms].tolist(), (-np.array(contact.dist)).tolist(), sizes.tolist(),
        strict=True,
    ):  # fmt: skip
        key = (min(pair), max(pair))
        if key in joined and depth > _DEEP * size:
            deepest[key] = max(depth, deepest.get(key, 0.0))
    for (low, high), depth in deepest.items():
        names = f"{world.body(low)!r} and {world.body(high)!r}"
        yield JOINT_OVERLAP.at(message=f"{names} are joined, and overlap by {depth:g}.")
