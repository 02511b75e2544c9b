"""Models of a document that are loaded into one World one after the other (thesis 5.3)."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.conform.documents import ASSET, NS_1_5
from tests.mapper.kinematics.robots import Arm, Segment
from tests.mapper.kinematics.robots import document as robot

import colladaphy
from colladaphy.world import World, compare

_COUNT = 4
_ends = st.tuples(st.integers(0, _COUNT - 1), st.integers(-1, _COUNT - 1)).filter(
    lambda pair: pair[0] != pair[1]
)


def document(ends: list[tuple[int, int]], *, broken: int | None = None) -> bytes:
    """Models of two bodies each; each joint is of its first end's model, -1 is the world."""
    models, instances, nodes = "", "", ""
    for number in range(_COUNT):
        radius = 0 if number == broken else 1
        shape = f"<shape><mass>1</mass><sphere><radius>{radius}</radius></sphere></shape>"
        bodies = "".join(
            f'<rigid_body sid="{name}" name="{name}{number}"><technique_common>{shape}'
            "</technique_common></rigid_body>"
            for name in ("a", "b")
        )
        constraints = placed = ""
        for at, (one, two) in enumerate(ends):
            if one != number:
                continue
            other = f"#m{two}/b" if two >= 0 else ""
            constraints += (
                f'<rigid_constraint sid="c{at}" name="joint {at}"><ref_attachment rigid_body="a">'
                f'<translate>{at} 1 0</translate></ref_attachment><attachment rigid_body="{other}">'
                f"<translate>0 {at} 2</translate></attachment><technique_common/>"
                "</rigid_constraint>"
            )
            placed += f'<instance_rigid_constraint constraint="c{at}"/>'
        models += f'<physics_model id="m{number}">{bodies}{constraints}</physics_model>'
        instances += (
            f'<instance_physics_model url="#m{number}">'
            f'<instance_rigid_body body="a" target="#a{number}"><technique_common/>'
            f'</instance_rigid_body><instance_rigid_body body="b" target="#b{number}">'
            f"<technique_common/></instance_rigid_body>{placed}</instance_physics_model>"
        )
        nodes += "".join(
            f'<node id="{name}{number}"><translate>{number} {at} 0</translate></node>'
            for at, name in enumerate(("a", "b"))
        )
    return (
        f'<COLLADA xmlns="{NS_1_5}" version="1.5.0">{ASSET}'
        f'<library_visual_scenes><visual_scene id="vs">{nodes}</visual_scene>'
        f"</library_visual_scenes><library_physics_models>{models}</library_physics_models>"
        f'<library_physics_scenes><physics_scene id="ps">{instances}<technique_common/>'
        '</physics_scene></library_physics_scenes><scene><instance_physics_scene url="#ps"/>'
        '<instance_visual_scene url="#vs"/></scene></COLLADA>'
    ).encode()


def joints_of(world: World) -> list[tuple[object, ...]]:
    """What every joint binds, and where."""
    made: list[tuple[object, ...]] = []
    for joint in world.joints:
        names = [None if body is None else body.name for body in (joint.body1, joint.body2)]
        places = [tuple(point.tolist()) for point, _ in (joint.frame1, joint.frame2)]
        made.append((joint.name, *names, *places))
    return sorted(made, key=repr)


@settings(max_examples=40, deadline=None)
@given(st.lists(_ends, max_size=6), st.permutations(range(_COUNT)), st.booleans())
def test_joints_appear_once_both_ends_are_there(
    ends: list[tuple[int, int]], order: list[int], edited: bool
) -> None:
    read = colladaphy.read(document(ends))
    if edited:  # what is looked at as a tree is read anew each time
        assert read.tree is not None
    world: World | None = None
    loaded: set[int] = set()
    for number in order:
        world = read.scenes["ps"].models[f"m{number}"].load(world)
        loaded.add(number)
        there = [f"joint {at}" for at, (one, two) in enumerate(ends)
                 if one in loaded and (two < 0 or two in loaded)]  # fmt: skip
        assert sorted(joint.name or "" for joint in world.joints) == sorted(there)
        assert len(world.bodies) == 2 * len(loaded)
    assert world is not None
    whole = colladaphy.read(document(ends)).load()
    assert joints_of(world) == joints_of(whole)
    places = sorted(map(tuple, world.positions.tolist()))
    assert places == sorted(map(tuple, whole.positions.tolist()))


def one_by_one(read: colladaphy.Document, *numbers: int) -> World:
    world: World | None = None
    for number in numbers:
        world = read.scenes["ps"].models[f"m{number}"].load(world)
    assert world is not None
    return world


def test_what_is_read_again_is_not_told_again() -> None:
    read = colladaphy.read(document([(0, 1), (0, 2)]))
    one_by_one(read, 0, 1, 2)
    codes = [finding.code for finding in read.report]
    assert codes.count("load-constraint-skipped") == 2
    assert codes.count("load-joint-late") == 2
    assert codes.count("load-material-assumed") == len(
        {(f.message, f.line) for f in read.report if f.code == "load-material-assumed"}
    )


def test_bodies_that_are_gone_are_not_bound() -> None:
    read = colladaphy.read(document([(0, 1)]))
    world = one_by_one(read, 0)
    world.destroy(world.bodies_by_name("a0")[0])
    read.scenes["ps"].models["m1"].load(world)
    assert len(world.joints) == 0
    assert "are not in the World now" in read.report.findings[-1].message


def test_bodies_that_moved_meanwhile_keep_the_frames_of_the_file() -> None:
    read = colladaphy.read(document([(0, 1)]))
    world = one_by_one(read, 0)
    world.positions += 5.0
    world.bodies[0].uid = 77
    read.scenes["ps"].models["m1"].load(world)
    (joint,) = world.joints
    assert (joint.body1, joint.body1.uid if joint.body1 else 0) == (world.bodies[0], 77)
    assert np.allclose(joint.frame1[0], (0, 1, 0))
    assert np.allclose(world.bodies[0].position, (5, 5, 5))


def test_a_model_that_is_loaded_twice_is_bound_once_each() -> None:
    read = colladaphy.read(document([(0, -1)]))
    world = one_by_one(read, 0, 0)
    assert (len(world.bodies), len(world.joints)) == (4, 2)


def test_worlds_do_not_share_what_waits() -> None:
    read = colladaphy.read(document([(0, 1)]))
    one, other = one_by_one(read, 0), one_by_one(read, 1)
    assert (len(one.joints), len(other.joints)) == (0, 0)
    read.scenes["ps"].models["m1"].load(one)
    assert (len(one.joints), len(other.joints)) == (1, 0)


@pytest.mark.parametrize("si", [True, False])
def test_the_unit_of_the_world_holds_for_what_comes_late(si: bool) -> None:
    data = document([(0, 1)]).replace(b"</asset>", b'<unit name="cm" meter="0.01"/></asset>', 1)
    read = colladaphy.read(data)
    world = read.scenes["ps"].models["m0"].load(None, si=si)
    read.scenes["ps"].models["m1"].load(world)
    (joint,) = world.joints
    whole = colladaphy.read(data).load(si=si)
    assert np.array_equal(joint.frame1[0], whole.joints[0].frame1[0])


def test_scenes_one_by_one_and_broken_bodies_go_on_as_before() -> None:
    read = colladaphy.read(document([(0, 1)], broken=1))
    world = one_by_one(read, 0, 1)
    assert (len(world.bodies), len(world.joints)) == (2, 0)
    assert compare(world, one_by_one(colladaphy.read(document([], broken=1)), 0)) == []


def test_joints_of_a_robot_wait_for_its_links_too() -> None:
    text = robot(Arm([Segment(value=20.0)])).decode()
    start = text.index('<rigid_body sid="b0"')
    body = text[start : text.index("</physics_model>")]
    text = text.replace(body, "").replace(
        "</library_physics_models>",
        f'<physics_model id="pm2">{body}</physics_model></library_physics_models>',
    )
    start = text.index('<instance_rigid_body body="b0"')
    instance = text[start : text.index("</instance_physics_model>")]
    text = text.replace(instance, "").replace(
        "</instance_physics_model>",
        f'</instance_physics_model><instance_physics_model url="#pm2">{instance}'
        "</instance_physics_model>",
    )
    whole = colladaphy.read(text.encode()).load()
    read = colladaphy.read(text.encode())
    world = read.scenes["ps"].models["pm"].load()
    assert len(world.joints) == 0
    read.scenes["ps"].models["pm2"].load(world)
    assert joints_of(world) == joints_of(whole)
    assert len(world.joints) == 1
