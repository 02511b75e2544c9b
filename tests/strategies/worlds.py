"""Hypothesis strategies for any World that can be built."""

from __future__ import annotations

from typing import Any

import numpy as np
from hypothesis import strategies as st
from hypothesis.strategies import DrawFn, SearchStrategy

from colladaphy.errors import WorldError
from colladaphy.world import Body, EngineState, Material, World, rotations

__all__ = ["names", "numbers", "positives", "quaternions", "vectors", "worlds"]

# What XML 1.0 can hold: most of Unicode, but few control characters and no halves of pairs.
_characters = st.characters(
    exclude_categories=["Cs", "Cc"], exclude_characters="\ufffe\uffff"
) | st.sampled_from("\t\n\r &<>\"'")
names = st.text(_characters, max_size=8)

_integers = st.integers(-(2**63), 2**63 - 1)
_calm = st.floats(-1e3, 1e3)
_wild = st.floats(allow_nan=False, allow_infinity=False) | st.sampled_from(
    [-0.0, 5e-324, -5e-324, 2.2250738585072014e-308, 1.7976931348623157e308, 0.1, 1 / 3]
)


def numbers(wild: bool) -> SearchStrategy[float]:
    """Finite floats: all of them, or those of everyday size."""
    return _wild if wild else _calm


def positives(wild: bool) -> SearchStrategy[float]:
    """Positive, finite floats."""
    return st.floats(5e-324, 1.7976931348623157e308) if wild else st.floats(1e-2, 1e2)


def vectors(wild: bool) -> SearchStrategy[tuple[float, float, float]]:
    """Three finite floats."""
    number = numbers(wild)
    return st.tuples(number, number, number)


_directions = st.tuples(*[st.floats(-1, 1)] * 3).filter(lambda v: max(map(abs, v)) > 1e-3)
quaternions = st.just(rotations.IDENTITY) | st.tuples(*[st.floats(-1, 1)] * 4).filter(
    lambda q: max(map(abs, q)) > 1e-3
).map(lambda q: tuple(rotations.normalize(q).tolist()))


@st.composite
def worlds(
    draw: DrawFn,
    *,
    max_bodies: int = 6,
    wild: bool | None = None,
    joints: bool = True,
    meshes: bool = True,
    unions: bool = True,
    engine_states: bool = True,
) -> World:
    """Any World: poses, nested unions, joints, materials, pairs, meshes, forces, names, clock.

    With `wild`, numbers are of any size down to denormal ones, which leaves masses and inertias
    to be given; without, they are of everyday size; None draws which.
    """
    wild = draw(st.booleans()) if wild is None else wild
    world = draw(_empty(wild))
    materials = list(world.materials)[:2] + draw(_materials(world, wild))
    kinds = ["sphere", "box", "capsule", "cylinder", "plane", "ellipsoid", "empty"]
    if meshes:
        kinds.append("mesh")
    count = draw(st.integers(0, max_bodies))
    top: list[Body] = []
    for _ in range(count):
        kind = draw(st.sampled_from(kinds))
        body = draw(_body(world, kind, draw(st.sampled_from(materials)), wild))
        if body is not None:
            top.append(body)
    for _ in range(draw(st.integers(0, 3)) if unions else 0):
        draw(_union(world, top, wild))
    if top and draw(st.booleans()):
        world.destroy(top.pop(draw(st.integers(0, len(top) - 1))))
    for body in top:
        draw(_finish(body, wild))
    if joints:
        for _ in range(draw(st.integers(0, 3)) if top else 0):
            draw(_joint(world, top, wild))
        if len(world.joints) and draw(st.integers(0, 4)) == 0:
            world.destroy_joint(world.joints[0])
    if engine_states and draw(st.integers(0, 3)) == 0:
        world.engine_state = EngineState(draw(names), draw(names), draw(st.binary(max_size=40)))
    return world


@st.composite
def _empty(draw: DrawFn, wild: bool) -> World:
    world = World(
        gravity=draw(vectors(wild)),
        unit=(draw(names), draw(positives(wild))),
        up_axis=draw(st.sampled_from(["X_UP", "Y_UP", "Z_UP"])),
        time_step=draw(st.none() | positives(wild)),
        name=draw(st.none() | names),
    )
    world.time = draw(numbers(wild))
    world.step_count = draw(st.integers(0, 2**40))
    return world


@st.composite
def _materials(draw: DrawFn, world: World, wild: bool) -> list[Material]:
    positive, unit = positives(wild), st.floats(0, 1)
    not_negative = st.just(0.0) | positive
    ids = st.integers(10, 2**31).filter(lambda id: id not in world.materials)
    made = []
    for _ in range(draw(st.integers(0, 2))):
        name = draw(names.filter(lambda name: name not in world.materials))
        made.append(
            world.create_material(
                name,
                density=draw(positive),
                restitution=draw(unit),
                static_friction=draw(not_negative),
                dynamic_friction=draw(not_negative),
                poisson_ratio=draw(st.floats(-1, 0.5)),
                young_modulus=draw(positive),
                stiffness=draw(positive),
                damping_normal=draw(not_negative),
                damping_tangential=draw(not_negative),
                id=draw(st.none() | ids),
            )
        )
    everything = list(world.materials)
    for _ in range(draw(st.integers(0, 2))):
        world.set_pair(
            draw(st.sampled_from(everything)),
            draw(st.sampled_from(everything)),
            draw(st.none() | unit),
            draw(st.none() | not_negative),
            draw(st.none() | not_negative),
        )
    return made


@st.composite
def _mass_options(draw: DrawFn, wild: bool) -> dict[str, Any]:
    """Wild dimensions lead to masses out of range: then both are given."""
    options: dict[str, Any] = {}
    if wild or draw(st.integers(0, 3)) == 0:
        options["mass"] = draw(positives(wild))
        row = st.tuples(*[numbers(wild)] * 3)
        options["inertia"] = draw(st.tuples(row, row, row))
    return options


@st.composite
def _body(draw: DrawFn, world: World, kind: str, material: Material, wild: bool) -> Body | None:
    positive = positives(wild)
    options: dict[str, Any] = {
        "orientation": draw(quaternions),
        "fixed": draw(st.booleans()),
        "name": draw(st.none() | names),
        **draw(_mass_options(wild)),
    }
    if draw(st.integers(0, 4)) == 0:
        options["sid"] = draw(
            st.integers(1, 50).filter(lambda sid: sid not in world)
            | st.integers(world.next_body_sid, world.next_body_sid + 2**20)
        )
    uid, position = draw(_integers), draw(vectors(wild))
    if kind == "plane":
        for key in ("fixed", "mass", "inertia"):
            options.pop(key, None)
        if draw(st.booleans()):
            options.pop("orientation")
        normal = draw(_directions)
        if draw(st.booleans()):
            distance = draw(numbers(wild))
            return world.create_plane(uid, normal, distance, material, **options)
        with np.errstate(all="ignore"):
            try:
                return world.create_plane(uid, normal, None, material, position=position, **options)
            except WorldError:  # the displacement of a point far away can overflow
                return None
    if kind == "empty":
        options.setdefault("mass", draw(st.just(0.0) | positives(wild)))
        return world.create_body(uid, position, **options)
    options["hollow"] = draw(st.booleans())
    if kind == "mesh":
        return draw(_mesh_body(world, uid, position, material, options))
    three = st.tuples(positive, positive, positive)
    match kind:
        case "sphere":
            return world.create_sphere(uid, position, draw(positive), material, **options)
        case "box":
            return world.create_box(uid, position, draw(three), material, **options)
        case "ellipsoid":
            return world.create_ellipsoid(uid, position, draw(three), material, **options)
        case "capsule":
            radius, length = draw(positive | three), draw(positive)
            return world.create_capsule(uid, position, radius, length, material, **options)
        case _:
            radius, length = draw(positive | st.tuples(positive, positive)), draw(positive)
            return world.create_cylinder(uid, position, radius, length, material, **options)


_TETRAHEDRON = ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2))


@st.composite
def _mesh_body(
    draw: DrawFn, world: World, uid: int, position: Any, material: Material, options: dict[str, Any]
) -> Body:
    if world.meshes and draw(st.booleans()):
        mesh = draw(st.sampled_from(list(world.meshes.values())))
        return world.create_mesh(uid, position, mesh, None, material, **options)
    x, y, z, shift = (draw(st.floats(0.01, 10)) for _ in range(4))
    points = np.array([(0, 0, 0), (x, 0, 0), (0, y, 0), (shift, shift, z)]) + draw(vectors(False))
    return world.create_mesh(
        uid, position, points, _TETRAHEDRON, material, convex=draw(st.booleans()), **options
    )


@st.composite
def _union(draw: DrawFn, world: World, top: list[Body], wild: bool) -> None:
    if not top:
        return
    members = draw(st.lists(st.sampled_from(top), min_size=1, max_size=3, unique=True))
    options: dict[str, Any] = {"name": draw(st.none() | names)}
    if wild:
        options.update(draw(_mass_options(wild)))
        options["position"] = draw(vectors(wild))
        options["orientation"] = draw(quaternions)
        options["members_are_local"] = True
    elif draw(st.booleans()):
        options["orientation"] = draw(quaternions)
    union = world.create_union(draw(_integers), members, **options)
    for member in members:
        top.remove(member)
    top.append(union)


@st.composite
def _finish(draw: DrawFn, body: Body, wild: bool) -> None:
    """What can be set on any body after its creation."""
    body.linear_velocity = draw(vectors(wild))
    body.angular_velocity = draw(st.just((0.0, 0.0, 0.0)) | vectors(wild))
    if draw(st.integers(0, 3)) == 0:
        body.force, body.torque = draw(vectors(wild)), draw(vectors(wild))
    if draw(st.integers(0, 3)) == 0:
        body.sleeping = draw(st.booleans())
    if draw(st.integers(0, 3)) == 0:
        body.fixed = draw(st.booleans())
    if draw(st.integers(0, 3)) == 0:
        body.rotate(*(draw(st.floats(-7, 7)) for _ in range(3)))


_limits = st.just((0.0, 0.0)) | st.tuples(
    st.floats(allow_nan=False), st.floats(allow_nan=False)
).map(lambda pair: (min(pair), max(pair)))


@st.composite
def _joint(draw: DrawFn, world: World, top: list[Body], wild: bool) -> None:
    body1 = draw(st.sampled_from([*top, None]))
    body2 = draw(st.sampled_from([body for body in (*top, None) if body != body1]))
    options: dict[str, Any] = {
        "uid": draw(_integers),
        "name": draw(st.none() | names),
        "enabled": draw(st.booleans()),
        "interpenetrate": draw(st.booleans()),
    }
    spring = st.none() | st.tuples(*[numbers(wild)] * 3)
    options["linear_spring"], options["angular_spring"] = draw(spring), draw(spring)
    kind = draw(st.sampled_from(["fixed", "hinge", "slider", "ball", "general"]))
    if kind == "general" or wild:
        linear = [draw(_limits) for _ in range(3)]
        angular = [draw(_limits) for _ in range(3)]
        world.attach_joint(
            body1,
            body2,
            frame1=(draw(vectors(wild)), draw(quaternions)),
            frame2=(draw(vectors(wild)), draw(quaternions)),
            linear_min=[pair[0] for pair in linear],
            linear_max=[pair[1] for pair in linear],
            angular_min=[pair[0] for pair in angular],
            angular_max=[pair[1] for pair in angular],
            **options,
        )
    elif kind == "fixed":
        world.attach_fixed_joint(body1, body2, draw(st.none() | vectors(False)), **options)
    elif kind == "ball":
        world.attach_ball_joint(body1, body2, **options)
    else:
        attach = world.attach_hinge_joint if kind == "hinge" else world.attach_slider_joint
        attach(body1, body2, axis=draw(_directions), **options)
