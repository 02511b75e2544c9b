"""The engine itself: check, load, step, store."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
import pymunk
from numpy.typing import NDArray

from colladaphy.engines.bounds import Bounds
from colladaphy.engines.clock import Clock
from colladaphy.engines.digest import digest
from colladaphy.engines.edits import run_of
from colladaphy.engines.jointed import fastest, joint_findings
from colladaphy.engines.options import Value
from colladaphy.engines.outlines import HalfPlane
from colladaphy.engines.planar import Planarity, analyse, stays_in_plane
from colladaphy.engines.protocol import Capabilities, Contact
from colladaphy.engines.pymunk_engine.batches import Batch
from colladaphy.engines.pymunk_engine.contacts import contacts_of
from colladaphy.engines.pymunk_engine.links import Link, plan
from colladaphy.engines.pymunk_engine.moving import Moved
from colladaphy.engines.pymunk_engine.settings import PymunkOptions
from colladaphy.engines.pymunk_engine.space import Model, build, let_joints_have_their_way
from colladaphy.engines.rules import JOINT_LIMITS, JOINT_OVERLAP, PLANE_FINITE, SIZE
from colladaphy.engines.state import pack, unpack
from colladaphy.engines.unused import unused
from colladaphy.errors import EngineError
from colladaphy.findings import Finding, Severity
from colladaphy.world import JointKind, Kind, rotations

if TYPE_CHECKING:
    from colladaphy.world import World

__all__ = ["PymunkEngine"]

_DEEP = 1e-4  # of the size of the scene: an overlap worth a word


class PymunkEngine:
    """Runs planar Worlds with pymunk; options are those of `PymunkOptions`.

    A rotation is counted from the pose at `load`, where every angle is zero, so that `load` needs
    nothing but the World. pymunk's caches of contacts and of joints are not kept: a run that was
    stored and loaded differs in the last bits from one that was not.
    """

    name = "pymunk"
    capabilities = Capabilities(
        planar=True,
        kinds=frozenset(Kind) - {Kind.ELLIPSOID, Kind.MESH},
        joints=frozenset(JointKind),
        restitution=True,
        two_frictions=False,
    )

    def __init__(self, **options: Any) -> None:
        self._options = PymunkOptions.of(options)
        self._checked: tuple[Any, tuple[Planarity, list[Link], list[Finding]]] | None = None
        self.notices: list[Finding] = []
        """What was found at the last load."""
        self._model: Model | None = None
        self._plan: Planarity | None = None
        self._heights: Any = np.zeros(0)  # of the bodies that move, as they were loaded
        self._orientations: Any = np.zeros((0, 4))
        self._rows: Any = slice(0)  # of the World's columns, of the bodies that move
        self._clock = Clock(0.0, 0, 1.0)
        self._bounds = Bounds(np.inf, 0.0)
        self._batch = Batch(pymunk.Space(), [])
        self._latest: Any = np.zeros((0, 6))  # the state after the last step
        self._poses = self._speeds = (b"", b"")  # as the World and pymunk last agreed in
        self._joined: frozenset[int] = frozenset()  # system ids
        self._stepped = False

    @property
    def options(self) -> dict[str, Value]:
        """The options that the engine was made with."""
        return self._options.plain()

    @property
    def version(self) -> str:
        """Version of pymunk."""
        return str(pymunk.version)

    def check(self, world: World) -> list[Finding]:
        """See `Engine.check`."""
        return list(self._check(world)[2])

    def load(self, world: World, *, seed: int | None = None) -> None:
        """See `Engine.load`."""
        clock = Clock.of(world)
        planarity, links, findings = self._check(world)
        errors = [finding for finding in findings if finding.severity is Severity.ERROR]
        if errors:
            raise EngineError(errors)
        fresh = self._is_fresh(world)
        model = build(world, planarity, links, self._options, fresh=fresh)
        self._plan, self._model = planarity, model
        self._batch = Batch(model.space, model.bodies)
        self.notices = list(_overlaps(world, model, links, planarity.size)) if fresh else []
        self._bounds = Bounds.of(world, clock.time_step)
        self._poses, self._speeds = _poses(world), _speeds(world)
        moving = ~world.fixed
        self._rows = run_of(np.flatnonzero(moving))
        self._heights = planarity.frame.height(world.positions[moving])
        self._orientations = world.orientations[moving].copy()
        self._joined = frozenset(sid for link in links for sid in (link.first, link.second))
        self._clock = clock
        self._stepped = False

    def step(self, count: int = 1) -> None:
        """See `Engine.step`."""
        assert self._model is not None
        space, parts = self._model.space, self._options.substeps
        time_step = self._clock.time_step / parts
        for _ in range(count):
            pushes = [(body.force, body.torque) for body in self._model.bodies] if parts > 1 else []
            for part in range(parts):
                if part:  # forces act during the whole step, and pymunk drops them after a part
                    for body, (force, torque) in zip(self._model.bodies, pushes, strict=True):
                        body.force, body.torque = force, torque
                space.step(time_step)
        if count < 1:
            return
        self._stepped = True
        self._clock.advance(count)
        state = self._latest = self._batch.state()
        self._bounds.check(state[:, 3:5], state, step=self._clock.step_count)

    def store(self, world: World) -> None:
        """See `Engine.store`."""
        self.observe(world)
        pack(world, self.name, self.version, options=self.options)

    def observe(self, world: World) -> None:
        """See `Steerable.observe`."""
        assert self._model is not None and self._plan is not None
        if self._stepped:
            frame, state = self._plan.frame, self._latest
            rows = self._rows
            world.positions[rows] = frame.lift(state[:, :2], self._heights)
            world.orientations[rows] = _turned(self._orientations, frame.normal, state[:, 2])
            world.linear_velocities[rows] = frame.lift(state[:, 3:5])
            world.angular_velocities[rows] = state[:, 5:] * frame.normal
            world.sleeping[rows] = False
            if self._options.sleep:
                asleep = np.array([body.is_sleeping for body in self._model.bodies], np.bool_)
                world.sleeping[rows] = asleep
                # Chipmunk keeps the velocity with which a body fell asleep; but it stands still.
                still = np.flatnonzero(~world.fixed)[asleep]
                world.linear_velocities[still] = 0.0
                world.angular_velocities[still] = 0.0
            world.forces[rows] = 0.0
            world.torques[rows] = 0.0
        self._clock.store(world)
        self._poses, self._speeds = _poses(world), _speeds(world)

    def steer(self, world: World) -> bool:
        """See `Steerable.steer`. Poses of jointed bodies need a load, as joints begin there."""
        if self._model is None or self._plan is None or self._options.sleep:
            return False
        if Clock.of(world) != self._clock:
            return False
        frame, model = self._plan.frame, self._model
        poses = _poses(world)
        moved = None if poses == self._poses else self._moved(world)
        if moved is not None and not moved.fits:
            return False
        rows, speeds = self._rows, _speeds(world)
        kicked = speeds != self._speeds  # or else they would be rounded
        linear, angular = world.linear_velocities[rows], world.angular_velocities[rows]
        forces, torques = world.forces[rows], world.torques[rows]
        ahead, about = ((linear, forces), (angular, torques)) if kicked else ((forces,), (torques,))
        if not stays_in_plane(frame, ahead, about):
            return False  # the load says so, and names the bodies
        if kicked:
            for row in np.flatnonzero(self._kicked(world)[~world.fixed]).tolist():
                body = model.bodies[row]
                u, v = frame.flat(linear[row]).tolist()
                body.velocity, body.angular_velocity = (u, v), float(frame.height(angular[row]))
            if links := _planned(world, self._plan):
                let_joints_have_their_way(model, links)
        if moved is not None:
            moved.put(model)
            self._heights[moved.rows] = moved.heights
            self._poses, self._bounds = poses, Bounds.of(world, self._clock.time_step)
        self._speeds = speeds
        self._batch.push(frame.flat(forces), frame.height(torques))
        self._bounds = self._bounds.widened(world)
        return True

    def _kicked(self, world: World) -> NDArray[np.bool_]:
        """Which bodies have other velocities than when the World and pymunk agreed."""
        now = world.linear_velocities, world.angular_velocities
        before = (np.frombuffer(known).reshape(-1, 3) for known in self._speeds)
        apart = [np.any(one != other, axis=1) for one, other in zip(now, before, strict=True)]
        return np.asarray(apart[0] | apart[1])

    def _moved(self, world: World) -> Moved:
        """The bodies that were moved by hand since the World and pymunk agreed."""
        assert self._plan is not None
        before = [np.frombuffer(known).reshape(-1, width)
                  for known, width in zip(self._poses, (3, 4), strict=True)]  # fmt: skip
        loaded = self._heights, self._orientations
        return Moved.of(world, self._plan, (before[0], before[1]), loaded, self._joined)

    def contacts(self) -> list[Contact]:
        """See `Engine.contacts`."""
        if self._model is None or self._plan is None or not self._stepped:
            return []
        return contacts_of(self._model, self._plan.frame)

    def _is_fresh(self, world: World) -> bool:
        """True unless the World is as this engine left it."""
        return unpack(world, self.name, self.version, self.options).data is None

    def _check(self, world: World) -> tuple[Planarity, list[Link], list[Finding]]:
        """The plane of a World, its joints there, and everything to be said about both."""
        key = digest(world), self._is_fresh(world)
        if self._checked is None or self._checked[0] != key:
            self._checked = key, self._look(world)
        return self._checked[1]

    def _look(self, world: World) -> tuple[Planarity, list[Link], list[Finding]]:
        planarity = analyse(world)
        findings = list(planarity.findings)
        links: list[Link] = []
        if any(finding.code == SIZE.code for finding in findings):
            return planarity, links, findings
        speeds, fresh = fastest(world), self._is_fresh(world)
        for joint in world.joints:
            if not joint.enabled:
                continue
            link = plan(joint, planarity.frame, planarity.size)
            findings += link.findings
            if link.is_inert:
                continue
            links.append(link)
            wrong = list(joint_findings(joint, speeds))
            findings += wrong if fresh else [f for f in wrong if f.code == JOINT_LIMITS.code]
        for sid, outlines in planarity.outlines.items():
            if any(isinstance(outline, HalfPlane) for outline in outlines):
                message = f"A thick, finite slab stands for {world.body(sid)!r}."
                findings.append(PLANE_FINITE.at(message=message))
        findings += unused(world, self._options.friction, sleep=self._options.sleep)
        return planarity, links, [self._options.describe(), *findings]


def _planned(world: World, planarity: Planarity) -> list[Link]:
    """The joints as they stand now."""
    links = (plan(joint, planarity.frame, planarity.size) for joint in world.joints
             if joint.enabled)  # fmt: skip
    return [link for link in links if not link.is_inert]


def _overlaps(world: World, model: Model, links: list[Link], size: float) -> Iterator[Finding]:
    """Bodies of joints that overlap, and collide."""
    shapes = {sid: body.shapes for body, sid in zip(model.bodies, model.sids, strict=True)}
    for link in links:
        if not link.collide:
            continue
        others = shapes.get(link.second, ())
        depths = [
            -point.distance
            for shape in shapes.get(link.first, ())
            for met in model.space.shape_query(shape)
            if met.shape in others
            for point in met.contact_point_set.points
        ]
        if depths and max(depths) > _DEEP * size:
            one, two = world.body(link.first), world.body(link.second)
            message = f"{one!r} and {two!r} are joined, and overlap by {max(depths):g}."
            yield JOINT_OVERLAP.at(message=message)


def _poses(world: World) -> tuple[bytes, bytes]:
    return world.positions.tobytes(), world.orientations.tobytes()


def _speeds(world: World) -> tuple[bytes, bytes]:
    return world.linear_velocities.tobytes(), world.angular_velocities.tobytes()


def _turned(orientations: Any, normal: Any, angles: Any) -> Any:
    """Orientations (n, 4) turned by angles (n,) about one axis."""
    half = 0.5 * angles[:, None]
    cosines, sines = np.cos(half), np.sin(half)
    x, y, z = normal.tolist()
    # The product of the axis, as a quaternion without a real part, with another one.
    by_axis = np.array([(0, -x, -y, -z), (x, 0, -z, y), (y, z, 0, -x), (z, -y, x, 0)])
    crossed = sum(orientations[:, i, None] * by_axis[:, i] for i in range(4))
    turned = rotations.normalize(cosines * orientations + sines * crossed)
    return np.where(half == 0.0, orientations, turned)
