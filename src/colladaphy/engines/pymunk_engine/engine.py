"""The engine itself: check, load, step, store."""

from __future__ import annotations

from itertools import combinations_with_replacement
from typing import TYPE_CHECKING, Any

import numpy as np
import pymunk

from colladaphy.engines.clock import Clock
from colladaphy.engines.outlines import HalfPlane
from colladaphy.engines.planar import Planarity, analyse
from colladaphy.engines.protocol import Capabilities, Contact
from colladaphy.engines.pymunk_engine.contacts import contacts_of
from colladaphy.engines.pymunk_engine.links import Link, plan
from colladaphy.engines.pymunk_engine.pairs import materials_of
from colladaphy.engines.pymunk_engine.space import Model, build
from colladaphy.engines.rules import DIVERGED, FRICTIONS, PLANE_FINITE, SIZE, refuse
from colladaphy.engines.state import pack
from colladaphy.errors import EngineError
from colladaphy.findings import Finding, Severity
from colladaphy.world import JointKind, Kind, rotations

if TYPE_CHECKING:
    from colladaphy.world import World

__all__ = ["PymunkEngine"]

_MANY_MATERIALS = 100  # pairs of more materials than these are not looked through for a warning


class PymunkEngine:
    """Runs planar Worlds with pymunk.

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

    def __init__(self) -> None:
        self._model: Model | None = None
        self._plan: Planarity | None = None
        self._heights: Any = np.zeros(0)  # of the bodies that move, as they were loaded
        self._orientations: Any = np.zeros((0, 4))
        self._clock = Clock(0.0, 0, 1.0)
        self._stepped = False

    @property
    def version(self) -> str:
        """Version of pymunk."""
        return str(pymunk.version)

    def check(self, world: World) -> list[Finding]:
        """See `Engine.check`."""
        return _check(world)[2]

    def load(self, world: World, *, seed: int | None = None) -> None:
        """See `Engine.load`."""
        clock = Clock.of(world)
        planarity, links, findings = _check(world)
        errors = [finding for finding in findings if finding.severity is Severity.ERROR]
        if errors:
            raise EngineError(errors)
        self._plan, self._model = planarity, build(world, planarity, links)
        moving = ~world.fixed
        self._heights = planarity.frame.height(world.positions[moving])
        self._orientations = world.orientations[moving]
        self._clock = clock
        self._stepped = False

    def step(self, count: int = 1) -> None:
        """See `Engine.step`."""
        assert self._model is not None
        space, time_step = self._model.space, self._clock.time_step
        for _ in range(count):
            space.step(time_step)
        if count < 1:
            return
        self._stepped = True
        self._clock.advance(count)
        if not np.all(np.isfinite(self._state())):
            message = f"The simulation has diverged by step {self._clock.step_count}."
            raise refuse(DIVERGED, message)

    def _state(self) -> Any:
        """Position, angle, velocity and angular velocity (n, 6) of the bodies that move."""
        assert self._model is not None
        rows = [
            (*body.position, body.angle, *body.velocity, body.angular_velocity)
            for body in self._model.bodies
        ]
        return np.array(rows, dtype=np.float64).reshape(-1, 6)

    def store(self, world: World) -> None:
        """See `Engine.store`."""
        assert self._model is not None and self._plan is not None
        if self._stepped:
            frame, state = self._plan.frame, self._state()
            rows = np.searchsorted(world.sids, np.array(self._model.sids, dtype=np.int64))
            world.positions[rows] = frame.lift(state[:, :2], self._heights)
            world.orientations[rows] = _turned(self._orientations, frame.normal, state[:, 2])
            world.linear_velocities[rows] = frame.lift(state[:, 3:5])
            world.angular_velocities[rows] = state[:, 5:] * frame.normal
            world.sleeping[rows] = [body.is_sleeping for body in self._model.bodies]
            world.forces[rows] = 0.0
            world.torques[rows] = 0.0
        self._clock.store(world)
        pack(world, self.name, self.version)

    def contacts(self) -> list[Contact]:
        """See `Engine.contacts`."""
        if self._model is None or self._plan is None or not self._stepped:
            return []
        return contacts_of(self._model, self._plan.frame)


def _turned(orientations: Any, normal: Any, angles: Any) -> Any:
    turn = rotations.from_axis_angle(normal, angles)
    turned = rotations.normalize(rotations.multiply(turn, orientations))
    return np.where(angles[:, None] == 0.0, orientations, turned)


def _check(world: World) -> tuple[Planarity, list[Link], list[Finding]]:
    """The plane of a World, its joints there, and everything to be said about both."""
    planarity = analyse(world)
    findings = list(planarity.findings)
    links: list[Link] = []
    if any(finding.code == SIZE.code for finding in findings):
        return planarity, links, findings
    for joint in world.joints:
        if joint.enabled:
            link = plan(joint, planarity.frame, planarity.size)
            findings += link.findings
            if not any(finding.code == "engine-joint-inert" for finding in link.findings):
                links.append(link)
    for sid, outlines in planarity.outlines.items():
        if any(isinstance(outline, HalfPlane) for outline in outlines):
            message = f"A thick, finite slab stands for {world.body(sid)!r}."
            findings.append(PLANE_FINITE.at(message=message))
    return planarity, links, findings + _two_frictions(world, planarity)


def _two_frictions(world: World, planarity: Planarity) -> list[Finding]:
    materials = materials_of(world, planarity)
    pairs = combinations_with_replacement(materials[:_MANY_MATERIALS], 2)
    differing = [
        f"{first.name} with {second.name}"
        for first, second in pairs
        if (pair := world.pair(first, second)).static_friction != pair.dynamic_friction
    ]
    if not differing:
        return []
    more = f" and {len(differing) - 3} more pairs" if len(differing) > 3 else ""
    message = f"Static and dynamic friction differ: {', '.join(differing[:3])}{more}."
    return [FRICTIONS.at(message=message)]
