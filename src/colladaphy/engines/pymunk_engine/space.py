"""From a planar World to a space of pymunk: the same World gives the same space, bit by bit."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
import pymunk

from colladaphy.engines.outlines import Disc, Outline, Polygon, Stadium
from colladaphy.engines.planar import Planarity
from colladaphy.engines.pymunk_engine.links import Link
from colladaphy.engines.pymunk_engine.pairs import Pairs
from colladaphy.world import rotations

if TYPE_CHECKING:
    from colladaphy.world import World

__all__ = ["Model", "build"]

_ITERATIONS = 20
_SLEEP_AFTER = 0.5  # of the World's unit of time
_SLOP = 1e-3  # allowed overlap against the smallest dimension of a moving body
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


def build(world: World, plan: Planarity, links: list[Link]) -> Model:
    """The space of a World that `plan` found to be planar; everything in a fixed order."""
    space = pymunk.Space()
    model = Model(space)
    gravity = plan.frame.flat(world.gravity).tolist()
    space.gravity = (gravity[0], gravity[1])
    space.iterations = _ITERATIONS
    space.sleep_time_threshold = _SLEEP_AFTER
    pairs = Pairs(world, plan)
    by_sid = _add_bodies(model, world, plan, pairs)
    pairs.attach(space)
    for link in links:
        _add_link(space, by_sid, link)
    _put_to_sleep(model, world, links)
    return model


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
    inertias = rotations.rotate_tensor(world.orientations, world.inertias)
    moments = np.einsum("nij,i,j->n", inertias, frame.normal, frame.normal).tolist()
    fixed = world.fixed.tolist()
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


def _add_link(space: pymunk.Space, bodies: dict[int, pymunk.Body], link: Link) -> None:
    first = bodies[link.first] if link.first else space.static_body
    second = bodies[link.second] if link.second else space.static_body
    made: list[pymunk.Constraint] = []
    if link.pivot is not None:
        made.append(pymunk.PivotJoint(first, second, *link.pivot))
    if link.groove is not None:
        made.append(pymunk.GrooveJoint(first, second, *link.groove))
    if link.phase is not None:
        made.append(pymunk.GearJoint(first, second, link.phase, 1.0))
    if link.turn is not None:
        made.append(pymunk.RotaryLimitJoint(first, second, *link.turn))
    if link.spring is not None:
        one, two, stiffness, damping = link.spring
        made.append(pymunk.DampedSpring(first, second, one, two, 0.0, stiffness, damping))
    if link.torsion is not None:
        rest, stiffness, damping = link.torsion
        made.append(pymunk.DampedRotarySpring(first, second, -rest, stiffness, damping))
    for constraint in made:
        constraint.collide_bodies = link.collide
    if not link.collide and not made:
        # Nothing holds them, but they pass through each other.
        made.append(pymunk.RotaryLimitJoint(first, second, -np.inf, np.inf))
        made[0].collide_bodies = False
    space.add(*made)


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
