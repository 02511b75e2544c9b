"""A World against what the author of its file meant: poses, masses, extents, joints."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from colladaphy import World
from colladaphy.testing.producers.truth import Link, Scene, mass_properties, matrix_of
from colladaphy.world import Body, Kind

__all__ = ["assert_body", "assert_means"]

Floats = NDArray[np.float64]
_RANDOM = np.random.default_rng(20090101)
DIRECTIONS: Floats = np.concatenate([np.eye(3), -np.eye(3), _RANDOM.normal(size=(20, 3))])
DIRECTIONS /= np.linalg.norm(DIRECTIONS, axis=1)[:, None]
NEAR = 1e-7


def turn_of(quaternion: Floats) -> Floats:
    """A rotation matrix, by the textbook."""
    w, x, y, z = quaternion / np.linalg.norm(quaternion)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def reach_of_body(body: Body) -> Floats:
    """How far a body of the World reaches along the directions."""
    if body.kind is Kind.UNION:
        return np.max([reach_of_body(member) for member in body.members], axis=0)
    turn = turn_of(body.orientation)
    local = DIRECTIONS @ turn
    base = DIRECTIONS @ body.position
    match body.kind:
        case Kind.SPHERE:
            return base + body.radius
        case Kind.BOX:
            return base + np.abs(local) @ (body.lengths / 2)
        case Kind.MESH:
            return base + np.max(local @ body.mesh.body_vertices.T, axis=1)
        case Kind.CAPSULE:
            return base + np.abs(local[:, 0]) * body.length / 2 + body.radius
        case Kind.CYLINDER:
            across = np.hypot(local[:, 1], local[:, 2])
            return base + np.abs(local[:, 0]) * body.length / 2 + across * body.radius
    raise AssertionError(body.kind)


def reach_of_link(link: Link, place: Floats) -> Floats:
    """How far it was meant to reach."""
    reaches = []
    for solid in link.solids:
        frame = place @ matrix_of(solid.steps)
        reaches.append(DIRECTIONS @ frame[:3, 3] + solid.support(DIRECTIONS @ frame[:3, :3]))
    return np.max(reaches, axis=0)


def assert_body(body: Body, scene: Scene, index: int) -> None:
    """One body is what was meant by a link."""
    link, place = scene.links[index], scene.place(index)
    centre, tensor = mass_properties(link)
    turn = place[:3, :3]
    size = 1.0 + float(np.max(np.abs(place[:3, 3]))) + float(np.max(np.abs(centre)))
    where = place[:3, :3] @ centre + place[:3, 3]
    assert np.allclose(body.position, where, rtol=0, atol=NEAR * size), "centre of mass"
    assert math.isclose(body.mass, link.mass, rel_tol=1e-9), "mass"
    assert body.fixed == link.fixed, "fixed"
    found = turn_of(body.orientation) @ body.inertia @ turn_of(body.orientation).T
    wanted = turn @ tensor @ turn.T
    assert np.allclose(found, wanted, rtol=0, atol=NEAR * (1 + np.abs(wanted).max())), "inertia"
    assert np.allclose(reach_of_body(body), reach_of_link(link, place), rtol=0, atol=NEAR * size), (
        "shape"
    )
    assert np.allclose(body.linear_velocity, link.velocity, rtol=0, atol=1e-9), "velocity"
    assert np.allclose(body.angular_velocity, link.spin, rtol=0, atol=1e-9), "spin"


def assert_means(world: World, scene: Scene) -> None:
    """A World is what was meant by a scene."""
    assert len(world.bodies) == len(scene.links)
    for index, body in enumerate(world.bodies):
        assert_body(body, scene, index)
    gravity = (0.0, 0.0, 0.0) if scene.gravity is None else scene.gravity
    assert np.allclose(world.gravity, gravity, rtol=1e-12, atol=0), "gravity"
    assert world.unit_meter == scene.unit
    assert world.up_axis == scene.up_axis
    assert world.time_step == scene.time_step
    assert_joints(world, scene)


def assert_joints(world: World, scene: Scene) -> None:
    """Joints bind the same bodies at the same places within the same limits."""
    assert len(world.joints) == len(scene.joints)
    bodies = [body.sid for body in world.bodies]
    for found, meant in zip(world.joints, scene.joints, strict=True):
        ends = ((found.body1, meant.first, found.frame1), (found.body2, meant.second, found.frame2))
        for side, (body, index, (position, quaternion)) in enumerate(ends):
            assert (None if body is None else bodies.index(body.sid)) == index
            inner = np.eye(4)
            inner[:3, :3], inner[:3, 3] = turn_of(quaternion), position
            outer = np.eye(4)
            if body is not None:
                outer[:3, :3], outer[:3, 3] = turn_of(body.orientation), body.position
            place = np.eye(4) if index is None else scene.place(index)
            wanted = place @ matrix_of(meant.frames[side])
            size = 1 + np.abs(wanted).max()
            assert np.allclose(outer @ inner, wanted, rtol=0, atol=NEAR * size), "frame"
        assert np.allclose([found.linear_min, found.linear_max], meant.linear, rtol=1e-9)
        angles = np.radians(np.array(meant.angular))
        assert np.allclose([found.angular_min, found.angular_max], angles, rtol=1e-9)
