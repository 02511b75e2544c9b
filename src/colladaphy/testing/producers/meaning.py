"""The World that a scene means, made by the calls that everybody has."""

from __future__ import annotations

from typing import Any

import numpy as np

from colladaphy.testing.producers.markup import SIDES
from colladaphy.testing.producers.truth import (
    Floats,
    Scene,
    Solid,
    mass_properties,
    matrix_of,
)
from colladaphy.world import Body, World, rotations

__all__ = ["world_of"]

# Capsules and cylinders stand along y in a file, and along x in a World.
_ALONG_X = np.array([(0.0, -1.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)])
_FACES = [face for a, b, c, d in SIDES for face in ((a, b, c), (a, c, d))]


def world_of(scene: Scene) -> World:
    """What a loader should come to, but for ids, names, and which frames bodies have.

    Bodies stand in the order of the links, joints in that of the joints; a link of several solids,
    or whose centre of mass is not that of its solid, is a union. Bodies may have other axes of
    their own in a World that is loaded: masses, centres of mass, inertias and joints, all in the
    frame of the world, are what can be compared.
    """
    world = World(
        scene.gravity or (0.0, 0.0, 0.0), unit=("unit", scene.unit), up_axis=scene.up_axis,
        time_step=scene.time_step,
    )  # fmt: skip
    static, dynamic, restitution = scene.friction
    world.create_material(
        "stuff", density=1.0, restitution=restitution, static_friction=static,
        dynamic_friction=dynamic, poisson_ratio=0.25, young_modulus=1.0, stiffness=1.0,
        damping_normal=0.0, damping_tangential=0.0,
    )  # fmt: skip
    bodies = [_body(world, scene, index) for index in range(len(scene.links))]
    for joint in scene.joints:
        ends = [None if joint.first is None else bodies[joint.first], bodies[joint.second]]
        places = [
            (np.eye(4) if index is None else scene.place(index)) @ matrix_of(frame)
            for index, frame in zip((joint.first, joint.second), joint.frames, strict=True)
        ]
        frames = [_within(end, place) for end, place in zip(ends, places, strict=True)]
        angular = np.radians(np.array(joint.angular))
        options: dict[str, Any] = {
            "linear_min": joint.linear[0], "linear_max": joint.linear[1],
            "angular_min": angular[0], "angular_max": angular[1], "name": joint.name,
        }  # fmt: skip
        world.attach_joint(*ends, frame1=frames[0], frame2=frames[1], **options)
    return world


def _body(world: World, scene: Scene, index: int) -> Body:
    link, place = scene.links[index], scene.place(index)
    centre, tensor = mass_properties(link)
    whole = np.eye(4)
    whole[:3, 3] = centre
    only = matrix_of(link.solids[0].steps)
    if len(link.solids) == 1 and np.allclose(only[:3, 3], centre, rtol=0, atol=1e-12):
        body = _solid(world, link.solids[0], place @ only, link.mass, only[:3, :3], tensor)
    else:
        volume = sum(solid.volume for solid in link.solids)
        members = []
        for solid in link.solids:
            inner = np.linalg.inv(whole) @ matrix_of(solid.steps)
            share = link.mass * solid.volume / volume
            members.append(_solid(world, solid, inner, share))
        outer = place @ whole
        body = world.create_union(
            0, members, mass=link.mass, inertia=tensor, position=outer[:3, 3],
            orientation=rotations.from_matrix(outer[:3, :3]), members_are_local=True,
        )  # fmt: skip
    body.name = link.name
    body.fixed = link.fixed
    body.linear_velocity = link.velocity
    body.angular_velocity = link.spin
    return body


def _solid(
    world: World, solid: Solid, frame: Floats, mass: float, turn: Floats | None = None,
    tensor: Floats | None = None,
) -> Body:  # fmt: skip
    """A body of one solid; the tensor is that of its link, in which the solid is turned."""
    axes = _ALONG_X if solid.kind in ("capsule", "cylinder") else np.eye(3)
    own = mass * solid.inertia if turn is None or tensor is None else turn.T @ tensor @ turn
    options: dict[str, Any] = {
        "mass": mass,
        "inertia": axes.T @ own @ axes,
        "orientation": rotations.from_matrix(frame[:3, :3] @ axes),
    }
    position, sizes = frame[:3, 3], solid.size
    match solid.kind:
        case "sphere":
            return world.create_sphere(0, position, sizes[0], "stuff", **options)
        case "box":
            return world.create_box(0, position, 2.0 * np.array(sizes), "stuff", **options)
        case "capsule":
            return world.create_capsule(0, position, sizes[0], sizes[1], "stuff", **options)
        case "cylinder":
            return world.create_cylinder(0, position, sizes[0], sizes[1], "stuff", **options)
    return world.create_mesh(0, position, solid.points, _FACES, "stuff", **options)


def _within(body: Body | None, place: Floats) -> tuple[Floats, Floats]:
    """A place of the world as a position and an orientation in the frame of a body."""
    outer = np.eye(4)
    if body is not None:
        outer[:3, :3] = rotations.to_matrix(body.orientation)
        outer[:3, 3] = body.position
    inner = np.linalg.inv(outer) @ place
    return inner[:3, 3], rotations.from_matrix(inner[:3, :3])
