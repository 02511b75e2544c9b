"""Whatever is passed to a World, it is taken, or refused with an error of our own."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from colladaphy.errors import WorldError
from colladaphy.world import (
    Body,
    BodyColumns,
    EngineState,
    Joint,
    JointColumns,
    MemberColumns,
    Mesh,
    World,
    compare,
)
from colladaphy.world.materials import VALUES

ORIGIN = (0.0, 0.0, 0.0)
TETRAHEDRON = (
    [(0, 0, 0), (4, 0, 0), (0, 1, 0), (0, 0, 1)],
    [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)],
)

JUNK: dict[str, Any] = {
    "nothing": None,
    "a text": "three",
    "a number as text": "1",
    "bytes": b"1",
    "texts": ["1", "2", "3"],
    "an object": object(),
    "a class": World,
    "a dictionary": {"x": 1},
    "a set": {1, 2, 3},
    "a complex number": 1 + 2j,
    "not a number": float("nan"),
    "too large": 10**400,
    "too large an array": [10**400] * 3,
    "ragged": [[1, 2], [3]],
    "empty": [],
    "nested": [[[1.0]]],
    "nones": (None, None, None),
    "complexes": (1j, 2j, 3j),
    "a function": len,
    "a date": np.array(["2020-01-01"] * 3, dtype="datetime64[D]"),
}


def scene() -> World:
    world = World(name="scene")
    for row in range(4):
        world.create_box(row, (row * 3, 0, 0), (1, 2, 3), "oak", name=f"box {row}")
    world.create_union(9, [world.body(1), world.body(2)], name="pair")
    world.create_mesh(7, (0, 9, 0), *TETRAHEDRON, "iron")
    world.attach_hinge_joint(world.body(3), world.body(5), axis=(0, 0, 1), name="hinge")
    return world


def numbers() -> dict[str, Any]:
    return dict.fromkeys(VALUES, 0.25)


def columns(**changed: Any) -> BodyColumns:
    dimensions = np.tile([1.0, 0, 0, 0], (2, 1))
    return BodyColumns(**{"kinds": np.zeros(2, dtype=int), "dimensions": dimensions, **changed})


Call = Callable[[World, Any], Any]
CALLS: dict[str, Call] = {
    "World gravity": lambda w, x: World(x),
    "World unit": lambda w, x: World(unit=x),
    "World unit name": lambda w, x: World(unit=(x, 1.0)),
    "World unit size": lambda w, x: World(unit=("foot", x)),
    "World up axis": lambda w, x: World(up_axis=x),
    "body": lambda w, x: w.body(x),
    "bodies_by_uid": lambda w, x: w.bodies_by_uid(x),
    "bodies_by_name": lambda w, x: w.bodies_by_name(x),
    "bodies[]": lambda w, x: w.bodies[x],
    "joints[]": lambda w, x: w.joints[x],
    "destroy": lambda w, x: w.destroy(x),
    "destroy_joint": lambda w, x: w.destroy_joint(x),
    "uid": lambda w, x: w.create_sphere(x, ORIGIN, 1, "iron"),
    "position": lambda w, x: w.create_sphere(1, x, 1, "iron"),
    "radius": lambda w, x: w.create_sphere(1, ORIGIN, x, "iron"),
    "material": lambda w, x: w.create_sphere(1, ORIGIN, 1, x),
    "lengths": lambda w, x: w.create_box(1, ORIGIN, x, "iron"),
    "capsule radius": lambda w, x: w.create_capsule(1, ORIGIN, x, 1, "iron"),
    "capsule length": lambda w, x: w.create_capsule(1, ORIGIN, 1, x, "iron"),
    "cylinder radius": lambda w, x: w.create_cylinder(1, ORIGIN, x, 1, "iron"),
    "radii": lambda w, x: w.create_ellipsoid(1, ORIGIN, x, "iron"),
    "normal": lambda w, x: w.create_plane(1, x, 0, "iron"),
    "vertices": lambda w, x: w.create_mesh(1, ORIGIN, x, TETRAHEDRON[1], "iron"),
    "faces": lambda w, x: w.create_mesh(1, ORIGIN, TETRAHEDRON[0], x, "iron"),
    "position of a mesh": lambda w, x: w.create_mesh(1, x, *TETRAHEDRON, "iron"),
    "another mesh": lambda w, x: w.create_mesh(1, ORIGIN, Mesh(*TETRAHEDRON), x, "iron"),
    "members": lambda w, x: w.create_union(1, x),
    "one member": lambda w, x: w.create_union(1, [w.body(3), x]),
    "extend": lambda w, x: w.extend(x),
    "extend_joints": lambda w, x: w.extend_joints(x),
    "add_meshes": lambda w, x: w.add_meshes([x]),
    "material name": lambda w, x: w.create_material(x, **numbers()),
    "material value": lambda w, x: w.create_material("m", **{**numbers(), "density": x}),
    "materials": lambda w, x: w.materials.extend(["m"], {**numbers(), "density": x}),
    "material values": lambda w, x: w.materials.values("density", x),
    "pair": lambda w, x: w.pair(x, "iron"),
    "set_pair": lambda w, x: w.set_pair("iron", x, 0.1),
    "joint to": lambda w, x: w.attach_fixed_joint(w.body(3), x),
    "anchor": lambda w, x: w.attach_ball_joint(w.body(3), w.body(5), (x, 0, 0)),
    "axis": lambda w, x: w.attach_slider_joint(w.body(3), None, axis=x),
    "limits": lambda w, x: w.attach_hinge_joint(w.body(3), None, axis=(1, 0, 0), limits=x),
    "limit": lambda w, x: w.attach_hinge_joint(w.body(3), None, axis=(1, 0, 0), limits=(x, 1)),
    "frame": lambda w, x: w.attach_joint(w.body(3), None, frame1=x),
    "frame position": lambda w, x: w.attach_joint(w.body(3), None, frame1=(x, (1, 0, 0, 0))),
    "frame turn": lambda w, x: w.attach_joint(w.body(3), None, frame2=(ORIGIN, x)),
    "linear_min": lambda w, x: w.attach_joint(w.body(3), None, linear_min=x),
    "rotate": lambda w, x: w.body(3).rotate(x, 0, 0),
    "gravity": lambda w, x: setattr(w, "gravity", x),
    "kinds": lambda w, x: w.extend(BodyColumns(kinds=x)),
    "members of columns": lambda w, x: w.extend(
        columns(sids=np.array([50, 51])), 3 if x is None else x
    ),
}
for option in ("orientation", "fixed", "hollow"):
    CALLS[f"option {option}"] = lambda w, x, option=option: w.create_sphere(
        1, ORIGIN, 1, "iron", **{option: x}
    )
for setting in ("unit_name", "unit_meter", "up_axis", "time", "step_count", "next_body_sid",
                "next_joint_sid"):  # fmt: skip
    CALLS[f"World.{setting}"] = lambda w, x, setting=setting: setattr(w, setting, x)
for column in ("uids", "positions", "orientations", "masses", "inertias", "fixed", "forces"):
    CALLS[f"column {column}"] = lambda w, x, column=column: setattr(w, column, x)
for name in ("uid", "position", "orientation", "linear_velocity", "angular_velocity", "force",
             "torque", "sleeping", "fixed"):  # fmt: skip
    CALLS[f"Body.{name}"] = lambda w, x, name=name: setattr(w.body(3), name, x)
for name in ("uid", "enabled", "interpenetrate"):
    CALLS[f"Joint.{name}"] = lambda w, x, name=name: setattr(w.joints[0], name, x)
# For these None means what is left out.
OPTIONAL: dict[str, Call] = {
    "World name": lambda w, x: World(name=x),
    "World.time_step": lambda w, x: setattr(w, "time_step", x),
    "World.engine_state": lambda w, x: setattr(w, "engine_state", x),
    "Body.name": lambda w, x: setattr(w.body(3), "name", x),
    "Joint.name": lambda w, x: setattr(w.joints[0], "name", x),
    "displacement": lambda w, x: w.create_plane(1, (0, 0, 1), x, "iron"),
    "pair value": lambda w, x: w.set_pair("iron", "oak", x),
    "names": lambda w, x: w.extend(columns(names=x)),
    "joint columns": lambda w, x: w.extend_joints(JointColumns(bodies=[(3, 5)], positions=x)),
    "mesh ids": lambda w, x: w.add_meshes([(*TETRAHEDRON, True)], x),
    "mesh id": lambda w, x: w.add_mesh(*TETRAHEDRON, id=x),
    "material id": lambda w, x: w.create_material("m", id=x, **numbers()),
    "material ids": lambda w, x: w.materials.extend(["m"], {k: [0.2] for k in VALUES}, x),
}
for option in ("sid", "name", "mass", "inertia", "linear_velocity", "angular_velocity"):
    OPTIONAL[f"creator {option}"] = lambda w, x, option=option: w.create_sphere(
        1, ORIGIN, 1, "iron", **{option: x}
    )
for option in ("position", "orientation", "mass", "inertia", "fixed", "sid", "name",
               "linear_velocity", "angular_velocity"):  # fmt: skip
    OPTIONAL[f"union {option}"] = lambda w, x, option=option: w.create_union(
        1, [w.body(3), w.body(4)], **{option: x}
    )
for option in ("linear_spring", "angular_spring", "sid", "name"):
    OPTIONAL[f"joint {option}"] = lambda w, x, option=option: w.attach_joint(
        w.body(3), None, **{option: x}
    )
for column in ("sids", "uids", "positions", "orientations", "linear_velocities", "masses",
               "inertias", "fixed", "material_ids", "hollow", "mesh_ids"):  # fmt: skip
    OPTIONAL[f"extend {column}"] = lambda w, x, column=column: w.extend(columns(**{column: x}))

# Texts, numbers or lists that are what these take; what is silent about an empty list.
TAKEN = {
    "bodies_by_name": ("a text", "a number as text"),
    "World unit name": ("a text", "a number as text"),
    "World up axis": ("a text", "a number as text"),
    "World.unit_name": ("a text", "a number as text"),
    "World.up_axis": ("a text", "a number as text"),
    "World name": ("a text", "a number as text"),
    "World.time_step": ("not a number",),
    "Body.name": ("a text", "a number as text"),
    "Joint.name": ("a text", "a number as text"),
    "material name": ("a text", "a number as text"),
    "creator name": ("a text", "a number as text"),
    "union name": ("a text", "a number as text"),
    "joint name": ("a text", "a number as text"),
    "joint to": ("nothing",),
    "material values": ("nothing", "empty"),
    "column inertias": ("not a number", "nested"),
    "kinds": ("empty",),
    # Assignment to a column is as quick, and as unchecked, as writing into a view of it.
    **{
        f"column {name}": ("not a number",)
        for name in ("positions", "orientations", "masses", "forces")
    },
}


@pytest.mark.parametrize("call", [*CALLS, *OPTIONAL])
def test_junk_is_refused_with_an_error_of_our_own(call: str) -> None:
    world, untouched = scene(), scene()
    action = CALLS.get(call) or OPTIONAL[call]
    for what, junk in JUNK.items():
        if what in TAKEN.get(call, ()) or (junk is None and call in OPTIONAL):
            action(scene(), junk)
            continue
        beyond = call.endswith("[]") and what == "too large"
        with np.errstate(all="raise"), pytest.raises(IndexError if beyond else WorldError):
            action(world, junk)
            pytest.fail(f"{call} takes {what}.")
    assert compare(world, untouched, unused_materials=True) == []
    assert world.meshes.keys() == untouched.meshes.keys()


def test_numbers_of_other_kinds_are_taken() -> None:
    world = World()
    body = world.create_sphere(np.int64(3), np.arange(3, dtype=np.float32), np.float32(1.5), "iron")
    body.position = (Fraction(1, 4), 10**30, np.float64(2))
    assert body.position.tolist() == [0.25, 1e30, 2.0]
    body.fixed, body.uid = np.bool_(True), np.int8(4)
    assert body.fixed is True and body.uid == 4
    world.uids, world.masses = [7.0], 3
    assert body.uid == 7 and body.mass == 3
    assert world.create_box(1, ORIGIN, 2, np.int64(3)).lengths.tolist() == [2, 2, 2]
    assert world.body(np.int64(1)) == body and np.int64(1) in world and body in world
    assert 2**70 not in world and "1" not in world and -1 not in world
    with pytest.raises(WorldError):
        world.body(2**70)


@pytest.mark.parametrize("name", ["materials", "meshes", "names", "children", "top", "joints_of"])
def test_parts_of_a_world_are_not_replaced(name: str) -> None:
    world, other = scene(), scene()
    with pytest.raises(WorldError, match="never replaced"):
        setattr(world, name, getattr(other, name))
    assert compare(world, other) == []


def test_unknown_options_are_errors() -> None:
    world = World()
    with pytest.raises(TypeError, match="radios"):
        world.create_sphere(1, ORIGIN, 1, "iron", radios=3)  # type: ignore[call-arg]
    assert len(world.bodies) == 0


def test_handles_of_other_worlds_are_refused() -> None:
    world, other = scene(), scene()
    stranger, joint = other.body(3), other.joints[0]
    for action in (
        lambda: world.destroy(stranger),
        lambda: world.create_union(1, [stranger]),
        lambda: world.attach_fixed_joint(world.body(3), stranger),
        lambda: world.destroy_joint(joint),
        lambda: world.destroy(joint),  # type: ignore[arg-type]
        lambda: world.destroy_joint(stranger),  # type: ignore[arg-type]
        lambda: world.create_mesh(1, ORIGIN, other.meshes[0], None, "iron"),
        lambda: world.create_sphere(1, ORIGIN, 1, other.create_material("m", **numbers())),
    ):
        with pytest.raises(WorldError):
            action()
    assert stranger not in world and stranger != world.body(3) and joint != world.joints[0]
    assert compare(world, scene()) == []


def test_places_beyond_the_end_are_index_errors() -> None:
    world = scene()
    with pytest.raises(IndexError):
        _ = world.bodies[99]
    assert world.bodies[-1] == world.body(6) and world.bodies[1:3] == list(world.bodies)[1:3]


def test_arrays_that_are_returned_cannot_be_mistaken_for_the_world() -> None:
    world = scene()
    plane = world.create_plane(1, (0, 0, 1), 0, "iron")
    union, joint = world.body(5), world.joints[0]
    for body in (union, union.members[0], world.body(3), world.body(6), plane):
        for name in sorted(vars(Body)):
            value = getattr(body, name, None)
            if isinstance(value, np.ndarray):
                assert not value.flags.writeable, name
    for name in sorted(vars(Joint)):
        value = getattr(joint, name)
        for array in value if isinstance(value, tuple) else [value]:
            assert not isinstance(array, np.ndarray) or not array.flags.writeable, name
    with pytest.raises(ValueError, match="read-only"):
        world.body(3).position[2] += 5
    world.gravity[2] = -9.81
    assert world.gravity.tolist() == [0, 0, -9.81]


def test_bodies_are_found_by_user_id_and_by_name() -> None:
    world = scene()
    extra = world.create_sphere(0, ORIGIN, 1, "iron", name="box 0", sid=40)
    assert world.bodies_by_uid(0) == [world.body(1), extra] == world.bodies_by_name("box 0")
    assert world.bodies_by_uid(9) == [world.body(5)] == world.bodies_by_name("pair")
    assert world.bodies_by_uid(77) == world.bodies_by_name("nobody") == []
    extra.name = None
    assert world.bodies_by_name("box 0") == [world.body(1)]
    assert isinstance(world.member_columns, MemberColumns)
    world.engine_state = EngineState("engine", "1", b"")
    assert world.engine_state.engine == "engine"
