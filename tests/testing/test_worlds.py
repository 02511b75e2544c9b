"""The strategy of Worlds: everything occurs, what is narrowed is, and examples become small."""

from __future__ import annotations

import math
import re
import subprocess
import sys
from collections import Counter
from importlib import import_module
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.testing.collecting import USUAL, drawn, smallest

from colladaphy.engines.pymunk_engine import PymunkEngine
from colladaphy.findings import Severity
from colladaphy.testing import JOINTS, SHAPES, crowd, worlds
from colladaphy.testing.making.script import Script
from colladaphy.world import Body, Kind, World, compare


@pytest.fixture(scope="module")
def many() -> list[World]:
    return drawn(worlds(), 300)


def depth(body: Body) -> int:
    return 1 + max((depth(member) for member in body.members), default=0)


def features(world: World) -> set[str]:
    """What a World has of all that one can have."""
    found = {body.kind.name.lower() for body in world.bodies}
    found |= {member.kind.name.lower() for body in world.bodies for member in body.members}
    found |= {f"joint-{joint.kind.name.lower()}" for joint in world.joints}
    found |= {f"depth-{depth(body)}" for body in world.bodies}
    found.add(f"axis-{world.up_axis}")
    size = len(world.bodies)
    joints = list(world.joints)
    meshes = [*world.mesh_ids.tolist(), *world.member_columns.mesh_ids.tolist()]
    meshes = [number for number in meshes if number >= 0]
    numbers = np.concatenate([world.positions.ravel(), world.linear_velocities.ravel()])
    names = "".join(name for name in world.names.values() if name)
    names += world.name or ""
    facts: dict[str, Any] = {
        "one-body": size == 1,
        "hundreds": size >= 100,
        "moving": np.any(world.linear_velocities) and np.any(world.angular_velocities),
        "pushed": np.any(world.forces) or np.any(world.torques),
        "fixed": np.any(world.fixed),
        "sleeping": np.any(world.sleeping),
        "hollow": np.any(world.hollow),
        "denormal": np.any((numbers != 0) & (np.abs(numbers) < 2.3e-308)),
        "huge": np.any(np.abs(numbers) > 1e300),
        "negative-zero": np.any((numbers == 0) & np.signbit(numbers)),
        "gaps": world.next_body_sid > len(world.sids) + len(world.member_columns.parents) + 1,
        "shared-mesh": len(meshes) > len(set(meshes)),
        "new-material": len(world.materials) > len(World().materials),
        "pair": len(world.pair_overrides) > 0,
        "unit": world.unit_meter != 1.0,
        "no-ascii": not names.isascii(),
        "markup": bool(set(names) & set("<&\"'\n\t")),
        "time": world.time != 0.0 and world.step_count != 0,
        "time-step": world.time_step is not None,
        "engine-state": world.engine_state is not None,
        "joint-with-world": any(joint.body1 is None or joint.body2 is None for joint in joints),
        "joint-of-two": any(joint.body1 and joint.body2 for joint in joints),
        "spring": any(np.any([joint.linear_spring, joint.angular_spring]) for joint in joints),
        "limits": any(
            np.any(np.isfinite(joint.angular_max) & (np.array(joint.angular_max) != 0))
            for joint in joints
        ),
        "disabled": any(not joint.enabled for joint in joints),
        "interpenetrate": any(joint.interpenetrate for joint in joints),
    }
    return found | {name for name, holds in facts.items() if holds}


EVERYTHING = {
    *SHAPES, "union", "depth-2", "depth-3", *(f"joint-{kind}" for kind in JOINTS),
    "axis-X_UP", "axis-Y_UP", "axis-Z_UP", "one-body", "hundreds", "moving", "pushed", "fixed",
    "sleeping", "hollow", "denormal", "huge", "negative-zero", "gaps", "shared-mesh",
    "new-material", "pair", "unit", "no-ascii", "markup", "time", "time-step", "engine-state",
    "joint-with-world", "joint-of-two", "spring", "limits", "disabled", "interpenetrate",
}  # fmt: skip


def test_everything_occurs(many: list[World]) -> None:
    counts = Counter(feature for world in many for feature in features(world))
    assert EVERYTHING - counts.keys() == set()
    rare = {name: counts[name] for name in EVERYTHING if counts[name] < 2}
    assert rare == {}


def test_there_is_always_a_body(many: list[World]) -> None:
    assert all(len(world.bodies) >= 1 for world in many)


@pytest.mark.parametrize("shape", SHAPES)
def test_shapes_can_be_chosen(shape: str) -> None:
    for world in drawn(worlds(shapes=[shape], unions=False), 30):
        assert {body.kind.name.lower() for body in world.bodies} == {shape}


@pytest.mark.parametrize("kind", JOINTS)
def test_joints_can_be_chosen(kind: str) -> None:
    made = drawn(worlds(joints=[kind], extreme=False), 60)
    kinds = {joint.kind.name.lower() for world in made for joint in world.joints}
    assert kind in kinds
    # A range that has no width is a joint that fixes, and any limits may happen to be a hinge's.
    if kind != "general":
        assert kinds <= {kind, "fixed"}


def test_content_can_be_left_out() -> None:
    strategy = worlds(
        joints=False, unions=False, materials=False, moving=False, engine_states=False,
        max_bodies=3,
    )  # fmt: skip
    for world in drawn(strategy, 100):
        assert 1 <= len(world.bodies) <= 3
        assert len(world.joints) == 0
        assert Kind.UNION not in world.kinds
        assert len(world.materials) == len(World().materials)
        assert not world.pair_overrides
        assert not np.any(world.linear_velocities)
        assert world.engine_state is None


@pytest.mark.parametrize(("fewest", "most"), [(0, 0), (2, 2), (3, 5), (20, 40), (7, 400)])
def test_bodies_are_as_many_as_asked_for(fewest: int, most: int) -> None:
    sizes = [len(world.bodies) for world in drawn(worlds(min_bodies=fewest, max_bodies=most), 60)]
    assert fewest <= min(sizes) <= max(sizes) <= most
    assert min(sizes) == fewest


def test_many_bodies_of_a_shape_that_no_crowd_has() -> None:
    for world in drawn(worlds(shapes=["plane"], min_bodies=8, max_bodies=10), 10):
        assert 8 <= len(world.bodies) <= 10


def test_everyday_numbers_are_everyday() -> None:
    for world in drawn(worlds(extreme=False, max_bodies=4, unions=False), 100):
        assert np.all(np.abs(world.linear_velocities) <= 1e3)
        assert np.all(world.masses < 1e16)


def test_physical_inertias_are_those_of_bodies() -> None:
    for world in drawn(worlds(physical=True, unions=False, shapes=["box", "empty"]), 100):
        for inertia in world.inertias:
            moments = np.linalg.eigvalsh(inertia)
            assert moments[0] >= 0
            assert moments[2] <= (moments[0] + moments[1]) * (1 + 1e-9)


@settings(deadline=None)
@given(worlds(planar=True))
def test_planar_worlds_run_in_the_plane(world: World) -> None:
    engine = PymunkEngine()
    assert [f for f in engine.check(world) if f.severity is Severity.ERROR] == []


def test_planar_worlds_have_everything_planar() -> None:
    found = {name for world in drawn(worlds(planar=True), 200) for name in features(world)}
    wanted = {"sphere", "box", "capsule", "cylinder", "plane", "union", "moving", "pushed",
              "joint-hinge", "joint-slider", "joint-ball", "joint-fixed", "spring"}  # fmt: skip
    assert wanted - found == set()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"shapes": ["cube"]}, r"no shape 'cube' here; there are sphere, box"),
        ({"joints": "weld"}, r"no joint 'weld' here; there are fixed, hinge"),
        ({"shapes": ["mesh"], "planar": True}, r"no shape 'mesh' here; there are sphere, box"),
        ({"shapes": []}, "bodies need a shape"),
        ({"min_bodies": 3, "max_bodies": 2}, "no World has 3 to 2 bodies"),
        ({"min_bodies": -1}, "no World has -1 to 300 bodies"),
        ({"planar": True, "extreme": True}, "everyday size"),
    ],
)
def test_unknown_wishes_are_refused(options: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        worlds(**options)


MOST = 300 if settings().max_examples >= 2000 else 60
"""Bodies of the Worlds that shrink; from hundreds it takes minutes."""
SIMPLEST = "world = World()\nbody1 = world.create_sphere(0, (0.0, 0.0, 0.0), 1.0, 'iron')"


def script_of(condition: object) -> list[str]:
    """The lines of Python that hypothesis prints for the simplest World of a condition."""

    @settings(USUAL, max_examples=2000)
    @given(worlds(max_bodies=MOST))
    def fails(world: World) -> None:
        assert not condition(world)  # type: ignore[operator]

    with pytest.raises(AssertionError) as caught:
        fails()
    notes = "\n".join(caught.value.__notes__)
    return notes[: notes.index("Failing test case")].splitlines()


def test_the_simplest_world_is_a_sphere() -> None:
    world = smallest(worlds(), lambda world: True)
    assert [body.kind for body in world.bodies] == [Kind.SPHERE]
    assert script_of(lambda world: True) == SIMPLEST.splitlines()


@pytest.mark.parametrize(
    "condition",
    [
        lambda world: len(world.joints) > 0,
        lambda world: Kind.MESH in world.kinds,
        lambda world: any(depth(body) == 3 for body in world.bodies),
        lambda world: np.any(world.linear_velocities[:, 0] > 1),
    ],
    ids=["joint", "mesh", "nested", "moving"],
)
def test_failing_examples_are_short(condition: object) -> None:
    lines = script_of(condition)
    assert len(lines) <= 8, lines
    assert sum("create_" in line for line in lines) <= 5


def test_what_is_printed_makes_the_world() -> None:
    """The program that stands beside a failing example, run, gives that World."""
    kept: list[tuple[World, str]] = []

    @settings(USUAL, max_examples=60)
    @given(st.data())
    def collect(data: st.DataObject) -> None:
        texts: list[Script] = []
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(import_module("colladaphy.testing.worlds"), "note", texts.append)
            world = data.draw(worlds())
        kept.append((world, repr(texts[0])))

    collect()
    for world, text in kept:
        names: dict[str, Any] = {"World": World, "math": math, "crowd": crowd}
        state = re.search(r"^world.engine_state = (EngineState\(.*\))$", text, re.M)
        if state:
            from colladaphy.world import EngineState

            names["EngineState"] = EngineState
        exec(compile(text, "the example", "exec"), names)
        assert compare(world, names["world"], unused_materials=True) == []


def test_a_crowd_is_the_same_each_time() -> None:
    first, second = World(), World()
    for world in (first, second):
        crowd(world, 50, 7)
    assert compare(first, second) == []
    assert set(first.kinds.tolist()) == {0, 1, 2, 3, 5}


def test_worlds_are_drawn_outside_of_tests_too() -> None:
    code = (
        "import warnings; warnings.simplefilter('ignore')\n"
        "from colladaphy.testing import worlds; assert len(worlds().example().bodies)"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
