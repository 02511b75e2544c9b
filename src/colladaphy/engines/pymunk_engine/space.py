"""From a planar World to a space of pymunk: the same World gives the same space, bit by bit."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
import pymunk

from colladaphy.engines.outlines import Disc, Outline, Polygon, Stadium
from colladaphy.engines.planar import Planarity
from colladaphy.engines.pymunk_engine.joining import allowed
from colladaphy.engines.pymunk_engine.links import Link, Rail
from colladaphy.engines.pymunk_engine.pairs import Pairs
from colladaphy.world import rotations

if TYPE_CHECKING:
    from colladaphy.engines.pymunk_engine.settings import PymunkOptions
    from colladaphy.world import World

__all__ = ["Model", "build", "let_joints_have_their_way"]

_LEAST_SPEED = 1e-30  # Chipmunk takes 0 for gravity's own
_SLEEP_AFTER = 0.5  # of the World's unit of time
_SLOP = 1e-3  # allowed overlap against the smallest dimension of a moving body
_UNMENDED = 0.5  # what is left after a step of how far a pivot is off
_ROD = 1e6  # length of the rod that makes a rail, against the size of the scene
_BEHIND = 10.0  # how far the limits of a rail are measured from, against what they allow
_SLEEP = 0.05  # of the velocity that gravity gives in one step
_REACH = 1e3  # half length and half depth of a plane's slab, against the size of the scene


@dataclass(slots=True)
class Model:
    """A space of pymunk and what is what in it."""

    space: pymunk.Space
    bodies: list[pymunk.Body] = field(default_factory=list)
    """Those that move, in ascending order of system ids."""
    sids: list[int] = field(default_factory=list)
    """The system ids of `bodies`."""
    owners: dict[int, int] = field(default_factory=dict)
    """System ids of the top-level bodies by the ids of pymunk's bodies."""
    by_sid: dict[int, pymunk.Body] = field(default_factory=dict)
    """All bodies, by system id."""


def build(
    world: World, plan: Planarity, links: list[Link], options: PymunkOptions, *, fresh: bool
) -> Model:
    """The space of a World that `plan` found to be planar; everything in a fixed order.

    `fresh`: the World was not left by this engine, so that its velocities may contradict joints.
    """
    space = pymunk.Space()
    model = Model(space)
    gravity = plan.frame.flat(world.gravity).tolist()
    space.gravity = (gravity[0], gravity[1])
    space.iterations = options.iterations
    dt = float(world.time_step or 1.0) / options.substeps
    if options.sleep:
        space.sleep_time_threshold = _SLEEP_AFTER
        gravity_step = float(np.hypot(*gravity)) * dt
        space.idle_speed_threshold = max(_SLEEP * gravity_step, _LEAST_SPEED)
    pairs = Pairs(world, plan, options.friction)
    by_sid = model.by_sid = _add_bodies(model, world, plan, pairs)
    pairs.attach(space)
    # What is solved for last is kept best: the joints themselves come after limits and springs.
    made = [_constraints(space, by_sid, link, plan.size, dt) for link in links]
    for number in (0, 1):
        for pair in made:
            space.add(*pair[number])
    if fresh and links:
        let_joints_have_their_way(model, links)
    if options.sleep:
        _put_to_sleep(model, world, links)
    return model


def let_joints_have_their_way(model: Model, links: list[Link]) -> None:
    """Take out of the velocities, by impulses, what `links`, of the poses of now, forbid."""
    by_sid = model.by_sid
    bodies = list(by_sid.values())
    rows = {sid: row for row, sid in enumerate(by_sid)} | {0: len(bodies)}
    places = np.array([*(tuple(body.position) for body in bodies), (0.0, 0.0)])
    motion, inverse = np.zeros((len(bodies) + 1, 3)), np.zeros((len(bodies) + 1, 3))
    for row, body in enumerate(bodies):
        if body.body_type == pymunk.Body.DYNAMIC:
            motion[row] = (*body.velocity, body.angular_velocity)
            inverse[row] = (1 / body.mass, 1 / body.mass, 1 / body.moment)
    new = allowed(links, rows, places, motion, inverse)
    for body, old, (u, v, spin) in zip(bodies, motion, new.tolist(), strict=False):
        if body.body_type == pymunk.Body.DYNAMIC and (u, v, spin) != tuple(old.tolist()):
            body.velocity, body.angular_velocity = (u, v), spin


def _add_bodies(
    model: Model, world: World, plan: Planarity, pairs: Pairs
) -> dict[int, pymunk.Body]:
    frame, space = plan.frame, model.space
    sids = world.sids.tolist()
    positions = frame.flat(world.positions)
    linear = frame.flat(world.linear_velocities).tolist()
    angular = frame.height(world.angular_velocities).tolist()
    forces = frame.flat(world.forces).tolist()
    torques = frame.height(world.torques).tolist()
    fixed = world.fixed.tolist()
    normals = rotations.unrotate(world.orientations, np.tile(frame.normal, (len(sids), 1)))
    tensors = np.where(world.fixed[:, None, None], 0.0, world.inertias)
    moments = np.einsum("nij,ni,nj->n", tensors, normals, normals).tolist()
    masses = world.masses.tolist()
    middle = _middle(positions, world)
    smallest = np.inf
    by_sid: dict[int, pymunk.Body] = {}
    for row, sid in enumerate(sids):
        if fixed[row]:
            body = pymunk.Body(body_type=pymunk.Body.STATIC)
        else:
            body = pymunk.Body(masses[row], moments[row])
        center = positions[row]
        body.position = (float(center[0]), float(center[1]))
        shapes = [
            _shape(body, outline, center, middle, plan.size) for outline in plan.outlines[sid]
        ]
        for shape, outline in zip(shapes, plan.outlines[sid], strict=True):
            pairs.dress(shape, outline.material)
        space.add(body, *shapes)
        by_sid[sid] = body
        model.owners[body.id] = sid
        if fixed[row]:
            continue
        body.velocity = (linear[row][0], linear[row][1])
        body.angular_velocity = angular[row]
        if any(forces[row]) or torques[row]:
            body.force, body.torque = (forces[row][0], forces[row][1]), torques[row]
        model.bodies.append(body)
        model.sids.append(sid)
        smallest = min([smallest, *(_thickness(outline) for outline in plan.outlines[sid])])
    if np.isfinite(smallest):
        space.collision_slop = _SLOP * float(smallest)
    return by_sid


def _middle(positions: Any, world: World) -> Any:
    moving = positions[~world.fixed]
    return moving.mean(axis=0) if len(moving) else np.zeros(2)


def _thickness(outline: Outline) -> float:
    match outline:
        case Disc() | Stadium():
            return 2.0 * outline.radius
        case Polygon():
            edges = outline.corners[1:3] - outline.corners[:2]
            return float(np.hypot(edges[:, 0], edges[:, 1]).min())
        case _:
            return float("inf")


def _shape(
    body: pymunk.Body, outline: Outline, center: Any, middle: Any, size: float
) -> pymunk.Shape:
    match outline:
        case Disc():
            return pymunk.Circle(body, outline.radius, _flat(outline.center - center))
        case Polygon():
            return pymunk.Poly(body, [_flat(corner - center) for corner in outline.corners])
        case Stadium():
            start, end = _flat(outline.start - center), _flat(outline.end - center)
            return pymunk.Segment(body, start, end, outline.radius)
        case _:
            # A slab with its surface in the plane, thick enough that nothing shoots through it.
            normal = outline.normal
            along = np.array([-normal[1], normal[0]])
            depth = _REACH * size
            off = middle - outline.point
            foot = outline.point + along * (off[0] * along[0] + off[1] * along[1])
            inner = foot - normal * depth - center
            reach = depth * along
            return pymunk.Segment(body, _flat(inner - reach), _flat(inner + reach), depth)


def _flat(vector: Any) -> tuple[float, float]:
    return float(vector[0]), float(vector[1])


def _constraints(
    space: pymunk.Space, bodies: dict[int, pymunk.Body], link: Link, size: float, dt: float
) -> tuple[list[pymunk.Constraint], list[pymunk.Constraint]]:
    """What pushes and pulls in a joint, and what holds it together."""
    first = bodies[link.first] if link.first else space.static_body
    second = bodies[link.second] if link.second else space.static_body
    soft: list[pymunk.Constraint] = []
    made: list[pymunk.Constraint] = []
    if link.pivot is not None:
        pivot = pymunk.PivotJoint(first, second, *link.pivot)
        # Mending so much in a step makes of Chipmunk's projections nearly the SHAKE method: a
        # pendulum keeps its swing. (For a rail it would take energy away.)
        pivot.error_bias = _UNMENDED ** (1.0 / dt)
        made.append(pivot)
    if link.rail is not None:
        rod, ends = _rail(first, second, link.rail, size)
        made.append(rod)
        soft += ends
    if link.phase is not None:
        made.append(pymunk.GearJoint(first, second, link.phase, 1.0))
    if link.turn is not None:
        soft.append(pymunk.RotaryLimitJoint(first, second, *link.turn))
    if link.spring is not None:
        one, two, stiffness, damping = link.spring
        soft.append(pymunk.DampedSpring(first, second, one, two, 0.0, stiffness, damping))
    if link.torsion is not None:
        rest, stiffness, damping = link.torsion
        soft.append(pymunk.DampedRotarySpring(first, second, -rest, stiffness, damping))
    if link.motor is not None:
        speed, strength = link.motor
        motor = pymunk.SimpleMotor(first, second, -speed)  # Chipmunk counts from the other side
        motor.max_force = strength
        soft.append(motor)
    if not link.collide and not made and not soft:
        # Nothing holds them, but they pass through each other.
        soft.append(pymunk.RotaryLimitJoint(first, second, -np.inf, np.inf))
    for constraint in (*soft, *made):
        constraint.collide_bodies = link.collide
    return soft, made


def _rail(
    first: pymunk.Body, second: pymunk.Body, rail: Rail, size: float
) -> tuple[pymunk.Constraint, list[pymunk.Constraint]]:
    """A rod so long that its end moves on a straight line, and another one for the limits.

    Chipmunk's own GrooveJoint is no constraint across the groove alone: it takes the sliding for
    an error, and adds energy without bound.
    """
    base, along = np.array(rail.base), np.array(rail.along)
    long = _ROD * size
    far = base + long * np.array([-along[1], along[0]])
    rod = pymunk.PinJoint(first, second, _flat(far), rail.arm)
    rod.distance = long
    ends: list[pymunk.Constraint] = []
    if np.isfinite(rail.limits).any():
        reach = size + max(abs(end) for end in rail.limits if np.isfinite(end))
        behind = _BEHIND * reach
        low, high = (behind + max(-reach * _BEHIND, min(_ROD * reach, end)) for end in rail.limits)
        back = _flat(base - behind * along)
        ends.append(pymunk.SlideJoint(first, second, back, rail.arm, max(low, 0.0), high))
    return rod, ends


def _put_to_sleep(model: Model, world: World, links: list[Link]) -> None:
    """Let bodies sleep that slept, all of those together that joints hold together."""
    rows = np.searchsorted(world.sids, np.array(model.sids, dtype=np.int64))
    pushed = np.any(world.forces[rows] != 0, axis=1) | np.any(world.torques[rows] != 0, axis=1)
    asleep = dict(zip(model.sids, (world.sleeping[rows] & ~pushed).tolist(), strict=True))
    bodies = dict(zip(model.sids, model.bodies, strict=True))
    group = {sid: sid for sid in model.sids}

    def root(sid: int) -> int:
        while group[sid] != sid:
            group[sid] = group[group[sid]]
            sid = group[sid]
        return sid

    for link in links:
        if link.first in group and link.second in group:
            one, two = sorted((root(link.first), root(link.second)))
            group[two] = one
    members: dict[int, list[int]] = {}
    for sid in model.sids:
        members.setdefault(root(sid), []).append(sid)
    for sids in members.values():
        if all(asleep[sid] for sid in sids):
            bodies[sids[0]].sleep()
            for sid in sids[1:]:
                bodies[sid].sleep_with_group(bodies[sids[0]])
