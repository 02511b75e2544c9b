"""Whether a World stays in one plane, in which plane, and everything that speaks against it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.engines.outlines import HalfPlane, Outline, outlines
from colladaphy.engines.plane import Frame, along
from colladaphy.engines.rules import MASS, MOVING_PLANE, NOT_PLANAR, SIZE
from colladaphy.findings import Finding, Rule
from colladaphy.world import Body, Kind, rotations

if TYPE_CHECKING:
    from colladaphy.world import World

__all__ = ["LARGEST", "SMALLEST", "TOLERANCE", "Planarity", "analyse", "stays_in_plane"]

Floats = NDArray[np.float64]

TOLERANCE = 1e-6
"""Angles, and lengths and speeds against the largest of the scene, that count as zero."""

SMALLEST, LARGEST = 1e-50, 1e50
"""Sizes and masses that the arithmetic of an engine can be trusted with."""

_MOST = 10  # bodies named for one reason; the rest are counted


@dataclass(slots=True)
class Planarity:
    """What the analysis found. The scene is planar if there are no findings."""

    frame: Frame
    findings: list[Finding]
    outlines: dict[int, list[Outline]]
    """Outlines of the shapes of each top-level body, by its system id, in the plane."""
    size: float
    """Largest distance of a moving body from the first, or dimension of one."""


def analyse(world: World) -> Planarity:
    """The plane in which `world` moves, or what speaks against the one that fits best."""
    moving = np.flatnonzero(~world.fixed)
    beyond = _beyond(world, moving)
    if beyond:
        return Planarity(Frame.across(np.array([0.0, 1.0, 0.0])), beyond, {}, 1.0)
    if not len(moving):
        # Nothing moves, and nothing collides.
        nothing: dict[int, list[Outline]] = {sid: [] for sid in world.sids.tolist()}
        return Planarity(Frame.across(np.array([0.0, 1.0, 0.0])), [], nothing, 1.0)
    state = _State(world, moving)
    best: tuple[int, Floats] | None = None
    for normal in _candidates(state):
        count = sum(len(bad) for _, bad in state.reasons(normal))
        if best is None or count < best[0]:
            best = (count, normal)
        if count == 0:
            found = _outlined(state, normal)
            if not found.findings:
                return found
    assert best is not None
    return _outlined(state, best[1])


def _beyond(world: World, moving: NDArray[Any]) -> list[Finding]:
    """Refusals of bodies whose numbers are too large or too small to calculate with."""
    findings: list[Finding] = []
    with np.errstate(all="ignore"):
        large = np.zeros(len(world.bodies), dtype=np.bool_)
        for column in (world.positions, world.dimensions):
            large |= _too_large(column)
        for column in (
            world.linear_velocities, world.angular_velocities, world.forces, world.torques,
            world.inertias,
        ):  # fmt: skip
            large[moving] |= _too_large(column[moving])
        large[moving] |= ~_in_range(world.masses[moving]) & (world.masses[moving] > 0)
        large |= ((world.dimensions != 0) & ~_in_range(world.dimensions)).any(axis=1) & (
            world.kinds != Kind.PLANE
        )
        bodies = [world.bodies[row] for row in np.flatnonzero(large).tolist()]
        members = world.member_columns
        inner = _too_large(members.positions) | _too_large(members.dimensions)
        inner |= ((members.dimensions != 0) & ~_in_range(members.dimensions)).any(axis=1) & (
            members.kinds != Kind.PLANE
        )
        bodies += [world.body(sid) for sid in members.sids[inner].tolist()]
        findings += _named(SIZE, "A number is too large or too small for the engine", bodies)
        if bool(_too_large(world.gravity[None])[0]):
            findings.append(SIZE.at(message=f"Gravity is {world.gravity.tolist()}."))
    return findings


def _too_large(values: Floats) -> NDArray[np.bool_]:
    good = np.abs(values) <= LARGEST
    return np.asarray(~good.all(axis=tuple(range(1, values.ndim))))


def _in_range(values: Floats) -> NDArray[np.bool_]:
    size = np.abs(values)
    return np.asarray((size >= SMALLEST) & (size <= LARGEST))


class _State:
    """The moving bodies of a World as columns."""

    def __init__(self, world: World, moving: NDArray[Any]) -> None:
        self.world = world
        self.moving = moving
        self.sids = world.sids[moving]
        self.positions = world.positions[moving]
        self.gravity = world.gravity
        self.linear = world.linear_velocities[moving]
        self.angular = world.angular_velocities[moving]
        self.forces = world.forces[moving]
        self.torques = world.torques[moving]
        self.inertias = rotations.rotate_tensor(world.orientations[moving], world.inertias[moving])
        reach = self.positions - self.positions[:1]
        members = world.member_columns
        finite = members.kinds != Kind.PLANE
        parts = (world.dimensions[moving], members.dimensions[finite], members.positions[finite])
        self.size = max(_largest(reach), *map(_largest, parts)) or 1.0

    def offset(self, normal: Floats) -> float:
        """Where most centres are along `normal`, that of one of the bodies."""
        heights = np.sort(along(self.positions, normal))
        return float(heights[len(heights) // 2])

    def reasons(self, normal: Floats) -> list[tuple[str, NDArray[Any]]]:
        """What speaks against a plane: a text, and the places of the bodies that it is true of."""
        heights = along(self.positions, normal) - self.offset(normal)
        weighed = np.einsum("nij,j->ni", self.inertias, normal)
        tilt = weighed - along(weighed, normal)[:, None] * normal
        everything = np.arange(len(self.moving))
        pulled = abs(float(along(self.gravity, normal))) > TOLERANCE * _largest(self.gravity)
        checks = [
            ("Gravity points out of the plane for", everything[: len(everything) * pulled]),
            ("The centre lies out of the plane", _above(heights, self.size)),
            ("The velocity points out of the plane", _leaving(self.linear, normal)),
            ("The force points out of the plane", _leaving(self.forces, normal)),
            ("The angular velocity is not across the plane", _turning(self.angular, normal)),
            ("The torque is not across the plane", _turning(self.torques, normal)),
            (
                "The normal of the plane is no principal axis of the inertia",
                np.flatnonzero(
                    np.abs(tilt).max(axis=1, initial=0.0)
                    > TOLERANCE * np.abs(weighed).max(axis=1, initial=0.0)
                ),
            ),
        ]
        return [(text, bad) for text, bad in checks if len(bad)]


def _largest(values: Floats) -> float:
    return float(np.max(np.abs(values), initial=0.0))


def _above(heights: Floats, size: float) -> NDArray[Any]:
    return np.flatnonzero(np.abs(heights) > TOLERANCE * size)


def _leaving(vectors: Floats, normal: Floats) -> NDArray[Any]:
    return np.flatnonzero(np.abs(along(vectors, normal)) > TOLERANCE * _largest(vectors))


def _turning(vectors: Floats, normal: Floats) -> NDArray[Any]:
    flat = vectors - along(vectors, normal)[:, None] * normal
    return np.flatnonzero(np.abs(flat).max(axis=1, initial=0.0) > TOLERANCE * _largest(vectors))


def stays_in_plane(frame: Frame, ahead: Iterable[Floats], about: Iterable[Floats]) -> bool:
    """True if the vectors (n, 3) of `ahead` lie in the plane, and those of `about` across it."""
    normal = frame.normal
    return not any(v.any() and len(_leaving(v, normal)) for v in ahead) and not any(
        v.any() and len(_turning(v, normal)) for v in about
    )


def _candidates(state: _State) -> list[Floats]:
    """Unit normals that are worth a try, the likely ones first."""
    found = [np.array(axis) for axis in ((0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0))]
    spins = (spin for spin in (state.angular, state.torques) if len(spin))
    found += [spin[int(np.argmax(np.abs(spin).max(axis=1)))] for spin in spins]
    reach = state.positions - state.positions[:1]
    groups = (reach, state.linear, state.forces, state.gravity[None])
    flat = [group / _largest(group) for group in groups if _largest(group) > 0]
    if flat:
        spanned = np.concatenate(flat)
        # The direction of least extent of everything that has to lie in the plane.
        found.append(np.linalg.eigh(spanned.T @ spanned)[1][:, 0])
    for row in state.moving[:3].tolist():
        found.extend(rotations.to_matrix(state.world.orientations[row]).T)
    for joint in state.world.joints[:3]:
        body = joint.body1
        turn = joint.frame1[1]
        if body is not None:
            turn = rotations.multiply(body.orientation, turn)
        found.extend(rotations.to_matrix(turn).T)
    unique: list[Floats] = []
    for candidate in found:
        length = float(np.linalg.norm(candidate))
        if length == 0.0:
            continue
        normal = candidate / length
        # By the sine: the cosine of an angle as small as the tolerance is 1 in all bits but one.
        apart = (float(np.linalg.norm(np.cross(normal, other))) for other in unique)
        if all(sine > TOLERANCE / 1000 for sine in apart):
            unique.append(normal)
    return unique


def _outlined(state: _State, normal: Floats) -> Planarity:
    """The full analysis for one normal, shapes included."""
    frame = Frame.across(normal, state.offset(normal))
    world = state.world
    findings: list[Finding] = []
    for text, bad in state.reasons(normal):
        findings += _named(NOT_PLANAR, text, [world.body(int(state.sids[i])) for i in bad])
    found: dict[int, list[Outline]] = {sid: [] for sid in world.sids.tolist()}
    reasons: dict[str, list[Body]] = {}
    moves = set(state.sids.tolist())
    for root, sid, shape in outlines(world, frame, TOLERANCE, state.size):
        if isinstance(shape, str):
            reasons.setdefault(shape, []).append(world.body(sid))
            continue
        if isinstance(shape, HalfPlane) and root in moves:
            findings += _named(MOVING_PLANE, "A plane cannot move", [world.body(sid)])
        found[root].append(shape)
    for text, bodies in reasons.items():
        findings += _named(NOT_PLANAR, text, bodies)
    spin = np.einsum("nij,i,j->n", state.inertias, normal, normal)
    light = np.flatnonzero(~((world.masses[state.moving] > 0) & (spin > 0)))
    bodies = [world.body(int(state.sids[i])) for i in light]
    findings += _named(MASS, "Mass or inertia is not positive", bodies)
    return Planarity(frame, findings, found, state.size)


def _named(rule: Rule, text: str, bodies: list[Body]) -> list[Finding]:
    found = [rule.at(message=f"{text}: {body!r}.") for body in bodies[:_MOST]]
    if len(bodies) > _MOST:
        found.append(rule.at(message=f"{text}: {len(bodies) - _MOST} more bodies."))
    return found
