"""Scenes with contacts, joints and sleeping bodies, for tests that compare runs bit by bit."""

from __future__ import annotations

from colladaphy.world import World

__all__ = ["SCENES", "chain", "general", "pile", "walker"]


def pile() -> World:
    """Planar: boxes that come to rest, and are hit by a sphere later."""
    world = World((0, 0, -9.81), time_step=1 / 240)
    world.create_plane(1, (0, 0, 1), 0, "granite")
    for i in range(5):
        world.create_box(i, (0.1 * i, 0, 0.6 + 1.1 * i), (1, 1, 1), "oak")
    world.create_sphere(9, (-9, 0, 2.5), 0.4, "iron", linear_velocity=(6, 0, 3))
    return world


def chain() -> World:
    """Planar: a chain of hinges with limits and a spring, hung up on one end, on the ground."""
    world = World((0, 0, -9.81), time_step=1 / 240)
    world.create_plane(1, (0, 0, 1), 0, "granite")
    before = None
    for i in range(5):
        link = world.create_box(i, (0.5 + i, 0, 1.5), (0.8, 0.2, 0.2), "fir")
        anchor = (0, 0, 1.5) if before is None else (0.5, 0, 0)
        world.attach_hinge_joint(
            before, link, anchor1=anchor, axis=(0, 1, 0), limits=(-1.0, 1.0), interpenetrate=True
        )
        before = link
    bob = world.create_sphere(7, (3, 0, 4), 0.3, "iron")
    world.attach_slider_joint(
        None, bob, anchor1=(3, 0, 4), axis=(0, 0, 1), linear_spring=(9000.0, 50.0, -0.5)
    )
    return world


def walker() -> World:
    """Planar: a union that tumbles with a body fixed to it by a joint."""
    world = World((0, 0, -9.81), time_step=1 / 240)
    world.create_plane(1, (0, 0, 1), 0, "granite")
    union = world.create_union(
        1,
        [
            world.create_sphere(2, (0, 0, 1.5), 0.3, "iron"),
            world.create_box(3, (0.6, 0, 1.5), (1, 0.3, 0.3), "oak"),
        ],
        angular_velocity=(0, 3, 0),
    )
    foot = world.create_sphere(4, (1.4, 0, 1.5), 0.2, "copper")
    world.attach_fixed_joint(union, foot)
    return world


def general() -> World:
    """In three dimensions: every kind of body and joint, a loop, and materials of their own."""
    world = World((0, 0, -9.81), time_step=1 / 240)
    world.create_material(
        "rubber", density=1100, restitution=0, static_friction=0.4, dynamic_friction=0.4,
        poisson_ratio=0.49, young_modulus=0.05, stiffness=0.05, damping_normal=0,
        damping_tangential=0,
    )  # fmt: skip
    world.set_pair("rubber", "granite", dynamic_friction=0.9, static_friction=0.9)
    world.create_plane(1, (0, 0.1, 1), 0, "granite")
    world.create_capsule(2, (0, 0, 1), 0.2, 0.6, "rubber", angular_velocity=(1, 2, 3))
    world.create_ellipsoid(3, (0.4, 0.1, 2), (0.3, 0.2, 0.25), "copper")
    world.create_cylinder(4, (0, 0.8, 1), 0.3, 0.4, "oak", linear_velocity=(1, -1, 0))
    corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    faces = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
    world.create_mesh(5, (2, 0, 1), corners, faces, "rubber", angular_velocity=(0.5, 0, 1))
    union = world.create_union(
        6,
        [
            world.create_sphere(7, (-2, 0, 1.5), 0.3, "iron"),
            world.create_box(8, (-1.5, 0.1, 1.6), (1, 0.3, 0.4), "oak"),
        ],
    )
    arm = world.create_capsule(9, (-2, 1, 1.5), 0.1, 0.8, "fir")
    hand = world.create_sphere(10, (-2, 1.5, 1.5), 0.15, "fir", linear_velocity=(0, 1, 1))
    world.attach_ball_joint(union, arm, anchor2=(-0.5, 0, 0))
    world.attach_hinge_joint(hand, arm, axis=(0, 0, 1), limits=(-0.5, 0.5))
    ring = [world.create_box(20 + i, (4 + i % 2, i // 2, 1), (0.9, 0.9, 0.2), "oak")
            for i in range(4)]  # fmt: skip
    for one, two in ((0, 1), (1, 3), (3, 2)):
        world.attach_fixed_joint(ring[one], ring[two])
    world.attach_ball_joint(ring[2], ring[0], anchor2=(0, 0.5, 0))
    door = world.create_box(30, (7, 0, 2), (1, 0.1, 2), "oak", angular_velocity=(0, 0, 2))
    world.attach_joint(
        None, door, frame1=((6.5, 0, 2), (1, 0, 0, 0)), frame2=((-0.5, 0, 0), (1, 0, 0, 0)),
        linear_min=(0, 0, -0.2), linear_max=(0, 0, 0.2), angular_min=(0, 0, -2),
        angular_max=(0, 0, 2), angular_spring=(500.0, 10.0, 0.3),
    )  # fmt: skip
    return world


SCENES = {"pile": pile, "chain": chain, "walker": walker, "general": general}
PLANAR = ("pile", "chain", "walker")
