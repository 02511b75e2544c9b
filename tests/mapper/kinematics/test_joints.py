"""Kinematic joints as joints of a World, against frames that are computed on their own."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.mapper.kinematics.robots import Arm, Segment, document, pose_matrix

import colladaphy
from colladaphy.engines import create_engine
from colladaphy.world import JointKind, World, rotations

_lengths = st.floats(-2, 2).map(lambda value: round(value, 3))
_points = st.tuples(_lengths, _lengths, _lengths)
_directions = st.tuples(*[st.floats(-1, 1)] * 3).filter(lambda v: max(map(abs, v)) > 0.1)
_segments = st.builds(
    Segment,
    at=_points,
    turn=st.tuples(*[st.floats(-1, 1)] * 3, st.floats(-180, 180)).filter(
        lambda turn: max(map(abs, turn[:3])) > 0.1
    ),
    kind=st.sampled_from(["revolute", "prismatic"]),
    axis=_directions,
    value=st.floats(-3, 3) | st.just(0.0),
    limits=st.none() | st.tuples(st.floats(-200, -5), st.floats(5, 200)),
    shown_at=_points,
)
_arms = st.builds(
    Arm, segments=st.lists(_segments, min_size=1, max_size=4), base_at=_points, bound=st.booleans()
)


def load(arm: Arm, **options: Any) -> tuple[World, list[str]]:
    """The World of an arm, and the codes of what is noted of its kinematics."""
    read = colladaphy.read(document(arm, **options))
    world = read.load()
    return world, [f.code for f in read.report.findings if f.code.startswith("kinematics")]


def frames_of(world: World, number: int) -> list[np.ndarray[Any, Any]]:
    """The two frames of a joint in the world (4, 4)."""
    joint = world.joints[number]
    made = []
    for body, (point, turn) in (
        (joint.body1, joint.frame1),
        (joint.body2, joint.frame2),
    ):
        outer = np.eye(4)
        if body is not None:
            outer[:3, :3], outer[:3, 3] = rotations.to_matrix(body.orientation), body.position
        inner = np.eye(4)
        inner[:3, :3], inner[:3, 3] = rotations.to_matrix(turn), point
        made.append(outer @ inner)
    return made


@settings(max_examples=40, deadline=None)
@given(_arms)
def test_joints_stand_where_forward_kinematics_puts_them(arm: Arm) -> None:
    if not arm.bound:  # the model's own chain ends in links, not in what they show
        for segment in arm.segments:
            segment.shown_at = (0.0, 0.0, 0.0)
    world, codes = load(arm)
    assert codes == []
    assert len(world.joints) == len(arm.segments)
    for number, (segment, (before, after)) in enumerate(
        zip(arm.segments, arm.frames(), strict=True)
    ):
        joint = world.joints[number]
        unit = np.array(segment.axis) / np.linalg.norm(segment.axis)
        outer, inner = frames_of(world, number)
        assert np.allclose(outer[:3, 3], before[:3, 3], atol=1e-9)
        assert np.allclose(inner[:3, 3], after[:3, 3], atol=1e-9)
        assert np.allclose(outer[:3, 2], before[:3, :3] @ unit, atol=1e-9)
        assert np.allclose(inner[:3, 2], after[:3, :3] @ unit, atol=1e-9)
        # What lies between the frames is the value of the axis, along or about z.
        apart = np.linalg.inv(outer) @ inner
        slides = segment.kind == "prismatic"
        shift = (0, 0, segment.value if slides else 0)
        assert np.allclose(apart[:3, 3], shift, atol=1e-9)
        angle = 0.0 if slides else math.radians(segment.value)
        cosine, sine = math.cos(angle), math.sin(angle)
        assert np.allclose(apart[:2, :2], [[cosine, -sine], [sine, cosine]], atol=1e-9)
        low, high = segment.limits or (-math.inf, math.inf)
        scale = 1.0 if slides else math.pi / 180
        ends = (joint.linear_min, joint.linear_max) if slides else (
            joint.angular_min, joint.angular_max)  # fmt: skip
        assert np.allclose([end[2] for end in ends], [low * scale, high * scale], rtol=1e-15)
        assert joint.kind is (JointKind.SLIDER if slides else JointKind.HINGE)
        assert joint.interpenetrate
        assert joint.name == f"joint {number}"


def test_it_binds_the_bodies_of_the_links() -> None:
    world, _ = load(Arm([Segment(), Segment()]))
    names = [(joint.body1.name, joint.body2.name) for joint in world.joints
             if joint.body1 and joint.body2]  # fmt: skip
    assert names == [("base", "link 0"), ("link 0", "link 1")]


@pytest.mark.parametrize(
    ("limits", "axis", "info"),
    [
        ((0.0, 0.0), (0, 0, 0), ""),
        ((0.0, 0.0), (0, 0, 1), ""),
        (None, (0, 0, 1), "<locked><bool>true</bool></locked>"),
    ],
)
@pytest.mark.parametrize("bound", [True, False])
def test_what_does_not_move_is_fixed_as_it_stands(
    limits: Any, axis: Any, info: str, bound: bool
) -> None:
    arm = Arm([Segment(limits=limits, axis=axis, info=info, value=30.0)], bound=bound)
    world, codes = load(arm)
    (joint,) = world.joints
    assert (joint.kind, codes) == (JointKind.FIXED, [])
    outer, inner = frames_of(world, 0)
    assert np.allclose(outer, inner, atol=1e-12)


def test_the_articulated_system_has_the_last_word_on_limits() -> None:
    info = "<limits><min><float>-10</float></min><max><float>20</float></max></limits>"
    world, _ = load(Arm([Segment(limits=(-90.0, 90.0), info=info)]))
    (joint,) = world.joints
    assert joint.angular_min[2] == pytest.approx(math.radians(-10), rel=1e-15)
    assert joint.angular_max[2] == pytest.approx(math.radians(20), rel=1e-15)


def _axis(kind: str, direction: str, limits: str = "") -> str:
    return f'<{kind} sid="axis0"><axis>{direction}</axis>{limits}</{kind}>'


def test_two_axes_at_right_angles_are_a_universal_joint() -> None:
    limits = "<limits><min>-10</min><max>20</max></limits>"
    joint = _axis("revolute", "0 1 0", limits) + _axis("revolute", "0 0 -2").replace("axis0", "a1")
    world, _ = load(Arm([Segment(joint=joint)], bound=False))
    (made,) = world.joints
    assert np.allclose(np.degrees([made.angular_min[0], made.angular_max[0]]), [-10, 20])
    assert np.isinf([made.angular_min[1], made.angular_max[1]]).all()
    assert made.angular_min[2] == made.angular_max[2] == 0.0
    outer, _ = frames_of(world, 0)
    assert np.allclose(outer[:3, :2].T, [(0, 1, 0), (0, 0, -1)], atol=1e-12)


def test_a_third_axis_the_other_way_round_has_its_limits_turned_round() -> None:
    limits = "<limits><min>-10</min><max>20</max></limits>"
    joint = "".join([
        _axis("revolute", "1 0 0"), _axis("revolute", "0 1 0").replace("axis0", "a1"),
        _axis("revolute", "0 0 -1", limits).replace("axis0", "a2"),
    ])  # fmt: skip
    (made,) = load(Arm([Segment(joint=joint)], bound=False))[0].joints
    assert np.allclose(np.degrees([made.angular_min[2], made.angular_max[2]]), [-20, 10])


def test_turning_and_sliding_along_one_axis_is_a_cylindrical_joint() -> None:
    joint = _axis("revolute", "1 0 0") + _axis("prismatic", "-1 0 0",
        "<limits><min>-1</min><max>3</max></limits>").replace("axis0", "a1")  # fmt: skip
    (made,) = load(Arm([Segment(joint=joint)], bound=False))[0].joints
    assert (made.linear_min[2], made.linear_max[2]) == (-3.0, 1.0)
    assert np.isinf([made.angular_min[2], made.angular_max[2]]).all()


@pytest.mark.parametrize(
    "joint",
    [
        _axis("revolute", "1 0 0") + _axis("revolute", "1 1 0").replace("axis0", "a1"),
        _axis("revolute", "1 0 0") + _axis("revolute", "-1 0 0").replace("axis0", "a1"),
        _axis("revolute", "1 0 0") + _axis("prismatic", "0 1 0").replace("axis0", "a1"),
    ],
)
def test_what_a_world_has_no_joint_for_is_said(joint: str) -> None:
    world, codes = load(Arm([Segment(joint=joint)], bound=False))
    assert (len(world.joints), codes) == (0, ["kinematics-joint-skipped"])


def test_a_joint_that_a_constraint_holds_is_not_doubled() -> None:
    constraint = (
        '<rigid_constraint sid="c"><ref_attachment rigid_body="base"/>'
        '<attachment rigid_body="b0"/><technique_common/></rigid_constraint>'
    )
    world, codes = load(Arm([Segment(), Segment()]), constraints=constraint)
    assert len(world.joints) == 2
    assert codes == ["kinematics-joint-doubled"]


def test_formulas_are_said_not_to_be_kept() -> None:
    formula = (
        '<formula sid="f"><target><param>km/j1/axis0</param></target><technique_common>'
        '<math xmlns="http://www.w3.org/1998/Math/MathML"><ci>x</ci></math></technique_common>'
        "</formula>"
    )
    world, codes = load(Arm([Segment(), Segment()]), model=formula)
    assert (len(world.joints), codes) == (2, ["kinematics-joint-follows"])


def _with_pairs(pairs: str) -> tuple[World, list[Any]]:
    """Three links on a base that overlap, and whose neighbours but one are on another line."""
    extra = f'<extra type="collision"><technique profile="OpenRAVE">{pairs}</technique></extra>'
    data = document(Arm([Segment(at=at) for at in ((0.1, 0, 0), (-0.02, 0.1, 0), (9, 0, 0))]))
    read = colladaphy.read(
        data.replace(b"</kinematics_model>", f"{extra}</kinematics_model>".encode())
    )
    world = read.load()
    return world, [found for found in read.report if found.code.startswith("kinematics")]


def test_pairs_that_are_not_to_collide_pass_by_joints_that_hold_nothing() -> None:
    pair = '<ignore_link_pair link0="km/base" link1="km/l1"/>'
    neighbours = '<ignore_link_pair link0="km/l0" link1="km/l1"/>'
    world, (finding,) = _with_pairs(pair * 2 + neighbours)
    assert finding.code == "kinematics-pairs-pass"
    assert finding.line
    assert finding.message.startswith("1 pairs of links")
    assert all(joint.interpenetrate for joint in world.joints)
    free = world.joints[3]
    assert (len(world.joints), free.kind) == (4, JointKind.GENERAL)
    assert {free.body1, free.body2} == {world.bodies[0], world.bodies[2]}
    assert np.isinf([free.linear_min, free.linear_max, free.angular_min, free.angular_max]).all()


@pytest.mark.parametrize("pairs", ["", '<ignore_link_pair link0="base" link1="link 1"/>'])
def test_links_that_overlap_and_may_pass_stay_at_rest(pairs: str) -> None:
    pytest.importorskip("mujoco")
    world, _ = _with_pairs(pairs)
    world.gravity, world.time_step = (0, 0, 0), 0.002
    engine = create_engine("mujoco")
    before = world.positions.copy()
    engine.load(world)
    engine.step(200)
    engine.store(world)
    assert (np.abs(world.positions - before).max() < 1e-9) == bool(pairs)


def test_pairs_of_links_that_are_not_there_are_told() -> None:
    world, (finding,) = _with_pairs('<ignore_link_pair link0="km/base" link1="km/none"/>')
    assert (len(world.joints), finding.code) == (3, "kinematics-pairs-collide")
    assert finding.line


def test_models_that_no_scene_instances_make_no_joints_and_that_is_said() -> None:
    data = document(Arm([Segment()]), scene=" ")
    read = colladaphy.read(data)
    assert len(read.load().joints) == 0
    assert "kinematics-not-instanced" in [finding.code for finding in read.report.findings]


def test_a_base_without_mass_and_shape_is_the_world() -> None:
    nothing = Segment(mass="", shape='<instance_geometry url="#none"/>')
    data = document(Arm([Segment(), Segment()], base_at=(1.0, 2.0, 3.0), base=nothing))
    geometry = (
        b'<library_geometries><geometry id="none"><convex_mesh/></geometry></library_geometries>'
    )
    read = colladaphy.read(data.replace(b"<library_kinematics_models>", geometry
                                        + b"<library_kinematics_models>"))  # fmt: skip
    world = read.load()
    assert [joint.body1 is None for joint in world.joints] == [True, False]
    outer, _ = frames_of(world, 0)
    assert np.allclose(outer, pose_matrix((1, 2, 4)), atol=1e-12)
    assert "kinematics-link-in-world" in [finding.code for finding in read.report.findings]


def test_nodes_that_stand_elsewhere_than_the_model_count_and_that_is_said() -> None:
    data = document(Arm([Segment(), Segment()]))
    moved = data.replace(
        b'<attachment_full joint="km/j1"><translate>0.0 0.0 1.0',
        b'<attachment_full joint="km/j1"><translate>0.0 0.5 1.0',
    )
    assert moved != data
    read = colladaphy.read(moved)
    world = read.load()
    outer, _ = frames_of(world, 1)
    assert np.allclose(outer[:3, 3], (0, 0, 2), atol=1e-12)
    assert "kinematics-joint-frames" in [finding.code for finding in read.report.findings]


def test_joints_of_a_library_are_instanced() -> None:
    data = document(Arm([Segment(limits=(-10.0, 20.0))]))
    joint = data[data.index(b"<joint ") : data.index(b"</joint>") + len(b"</joint>")]
    library = (
        b"<library_joints>" + joint.replace(b'sid="j0"', b'id="shared"') + b"</library_joints>"
    )
    moved = data.replace(joint, b'<instance_joint sid="j0" name="mine" url="#shared"/>').replace(
        b"<library_kinematics_models>", library + b"<library_kinematics_models>"
    )
    read = colladaphy.read(moved)
    (made,) = read.load().joints
    assert made.name == "mine"
    assert np.allclose(np.degrees([made.angular_min[2], made.angular_max[2]]), [-10, 20])
    assert [f.code for f in read.report if f.code.startswith("kinematics")] == []


def _closing(data: bytes, start: bytes, end: bytes) -> bytes:
    """The document with a joint between the base and the last link."""
    joint = b'<joint sid="loop"><revolute sid="axis0"><axis>0 1 0</axis></revolute></joint>'
    data = data.replace(b'<link sid="base"', joint + b'<link sid="base"')
    last = b'<link sid="l1" name="link 1">'
    data = data.replace(last, last + end)
    head, mark, tail = data.rpartition(b"</link>")
    return head + start + mark + tail


def test_attachments_at_both_ends_close_a_loop() -> None:
    start = b'<attachment_start joint="km/loop"><translate>0 0 2.5</translate></attachment_start>'
    end = b'<attachment_end joint="km/loop"><translate>0 0 0.5</translate></attachment_end>'
    read = colladaphy.read(_closing(document(Arm([Segment(), Segment()])), start, end))
    world = read.load()
    assert [joint.name for joint in world.joints] == ["joint 0", "joint 1", "loop"]
    outer, inner = frames_of(world, 2)
    assert np.allclose(outer[:3, 3], (0, 0, 2.5), atol=1e-12)
    assert np.allclose(inner, outer, atol=1e-12)
    names = {body.name for body in (world.joints[2].body1, world.joints[2].body2) if body}
    assert names == {"base", "link 1"}
    assert [f.code for f in read.report if f.code.startswith("kinematics")] == []


def test_what_is_attached_at_one_end_only_is_said() -> None:
    start = b'<attachment_start joint="km/loop"><translate>0 0 0</translate></attachment_start>'
    read = colladaphy.read(_closing(document(Arm([Segment(), Segment()])), start, b""))
    assert len(read.load().joints) == 2
    assert [f.code for f in read.report if f.code.startswith("kin")] == ["kinematics-joint-skipped"]


def test_a_path_that_leads_nowhere_is_said_with_its_line() -> None:
    data = document(Arm([Segment()])).replace(b'attachment_full joint="km/j0"',
                                              b'attachment_full joint="km/j9"')  # fmt: skip
    read = colladaphy.read(data)
    assert len(read.load().joints) == 0
    (finding,) = [f for f in read.report if f.code == "kinematics-reference"]
    assert finding.line
    assert "km/j9" in finding.message


def test_a_model_that_is_instanced_twice_makes_two_robots() -> None:
    one = document(Arm([Segment(value=10.0)]))
    # The second stands beside, with nodes, bodies and parameters of its own.
    text = one.decode()
    base = text[text.index('<node id="base"') : text.index("</visual_scene>")]
    other = base.replace(
        'id="base" sid="base">', 'id="base2" sid="base2"><translate>9 0 0</translate>'
    )
    other = other.replace('"n0"', '"m0"').replace("1.0 10.0</rotate>", "1.0 -20.0</rotate>")
    text = text.replace("</visual_scene>", other + "</visual_scene>")
    system = text[text.index("<articulated_system ") : text.index("</library_articulated_systems>")]
    twin = system.replace('id="robot"', 'id="robot2"').replace("robot/", "robot2/")
    text = text.replace("</library_articulated_systems>", twin + "</library_articulated_systems>")
    placed = text[text.index("<instance_articulated_system") : text.index("</kinematics_scene>")]
    twin = placed.replace('"robot_inst"', '"robot2_inst"').replace("#robot", "#robot2")
    twin = twin.replace('symbol="s_', 'symbol="t_').replace("robot/", "robot2/")
    text = text.replace("</kinematics_scene>", twin + "</kinematics_scene>")
    binds = text[text.index("<bind_kinematics_model") : text.index("</instance_kinematics_scene>")]
    twin = binds.replace('node="base"', 'node="base2"').replace("<param>s_", "<param>t_")
    twin = twin.replace("base/n0/value", "base2/m0/value")
    models = [binds[: binds.index("<bind_joint_axis")], twin[: twin.index("<bind_joint_axis")]]
    axes = [binds[binds.index("<bind_joint_axis") :], twin[twin.index("<bind_joint_axis") :]]
    text = text.replace(binds, "".join(models + axes))
    placed = text[text.index("<instance_physics_model") : text.index("</instance_physics_model>")]
    twin = placed.replace('"#base"', '"#base2"').replace('"#n0"', '"#m0"')
    end = "</instance_physics_model>"
    text = text.replace(end, f"{end}{twin}{end}", 1)
    read = colladaphy.read(text.encode())
    world = read.load()
    assert [f.code for f in read.report if f.code.startswith("kinematics")] == []
    assert len(world.joints) == 2
    places, angles = [], []
    for number, joint in enumerate(world.joints):
        assert joint.body1 is not None
        assert joint.body2 is not None
        outer, inner = frames_of(world, number)
        assert np.allclose(outer[:3, 3], joint.body1.position + np.array((0, 0, 1)), atol=1e-12)
        apart = np.linalg.inv(outer) @ inner
        places.append(outer[0, 3])
        angles.append(math.degrees(math.atan2(apart[1, 0], apart[0, 0])))
    assert np.allclose(places, [0, 9], atol=1e-12)
    assert np.allclose(angles, [10, -20], atol=1e-9)


_MATH = "http://www.w3.org/1998/Math/MathML"
_LINEAR = (
    '<apply><plus/><apply><times/><cn>2</cn><csymbol encoding="COLLADA">km/j0/axis0</csymbol>'
    "</apply><cn>5</cn></apply>"
)


def _formula(math: str, target: str = "km/j1/a1", more: str = "") -> str:
    return (
        f'<formula sid="f">{more}<target><param>{target}</param></target><technique_common>'
        f'<math xmlns="{_MATH}">{math}</math></technique_common></formula>'
    )


def _two_axes() -> Arm:
    joint = _axis("revolute", "1 0 0") + _axis("revolute", "0 1 0").replace("axis0", "a1")
    return Arm([Segment(value=30.0), Segment(joint=joint)], bound=False)


@pytest.mark.parametrize(
    ("math", "more", "angle"),
    [
        (_LINEAR, "", 65.0),
        ("<apply><minus/><ci>x</ci></apply>",
         '<newparam sid="x"><SIDREF>km/j0/axis0</SIDREF></newparam>', -30.0),
        ("<apply><divide/><apply><minus/><ci>x</ci><ci>y</ci></apply><cn>4</cn></apply>",
         '<newparam sid="x"><SIDREF>km/j0/axis0</SIDREF></newparam>'
         '<newparam sid="y"><float>10</float></newparam>', 5.0),
    ],
)  # fmt: skip
def test_an_axis_that_follows_begins_where_its_formula_puts_it(
    math: str, more: str, angle: float
) -> None:
    world, codes = load(_two_axes(), model=_formula(math, more=more))
    outer, inner = frames_of(world, 1)
    apart = np.linalg.inv(outer) @ inner
    assert math_degrees(apart[0, 2], apart[2, 2]) == pytest.approx(angle, abs=1e-9)
    assert codes == ["kinematics-joint-follows"]


def test_an_axis_whose_formula_is_a_number_does_not_move() -> None:
    world, codes = load(_two_axes(), model=_formula("<cn>-12</cn>"))
    assert ([joint.kind for joint in world.joints], codes) == ([JointKind.HINGE] * 2, [])


def math_degrees(sine: float, cosine: float) -> float:
    return math.degrees(math.atan2(sine, cosine))


@pytest.mark.parametrize(
    "math",
    [
        "<apply><sin/><csymbol>km/j0/axis0</csymbol></apply>",
        "<apply><times/><csymbol>km/j0/axis0</csymbol><csymbol>km/j0/axis0</csymbol></apply>",
        "<apply><plus/><csymbol>km/nothing</csymbol><cn>1</cn></apply>",
    ],
)
def test_formulas_that_are_not_linear_are_counted(math: str) -> None:
    data = document(_two_axes(), model=_formula(math))
    read = colladaphy.read(data)
    outer, inner = frames_of(read.load(), 1)
    assert np.allclose((np.linalg.inv(outer) @ inner)[:3, :3], np.eye(3), atol=1e-9)
    (finding,) = [found for found in read.report if found.code == "kinematics-joint-follows"]
    assert "1 formulas are not linear" in finding.message


def test_formulas_of_formulas_are_followed_and_circles_are_not() -> None:
    second = _formula("<csymbol>km/j1/a1</csymbol>", target="km/j1/axis0").replace(
        'sid="f"', 'sid="g"'
    )
    world, _ = load(_two_axes(), model=_formula("<csymbol>km/j0/axis0</csymbol>") + second)
    outer, inner = frames_of(world, 1)
    apart = np.linalg.inv(outer) @ inner
    assert math_degrees(-apart[1, 2], apart[2, 2]) == pytest.approx(
        math.degrees(math.atan2(math.sin(math.radians(30)), math.cos(math.radians(30))))
    )
    circle = _formula("<apply><plus/><csymbol>km/j1/axis0</csymbol><cn>9</cn></apply>")
    world, _ = load(_two_axes(), model=circle + second)
    outer, inner = frames_of(world, 1)
    assert np.allclose((np.linalg.inv(outer) @ inner)[:3, :3], np.eye(3), atol=1e-9)


def test_links_stand_where_their_nodes_show_them_though_nothing_is_bound_to_these() -> None:
    arm = Arm([Segment(value=30.0), Segment(kind="prismatic", axis=(1, 0, 0), value=0.4)],
              base_at=(3.0, 0.0, 0.0), bound=False)  # fmt: skip
    text = document(arm).decode().replace(' node="base"', "")
    for number in (0, 1):
        start = text.index(f'<newparam sid="k_j{number}_value">')
        end = text.index("</newparam>", start)
        text = f'{text[:start]}<newparam sid="k_j{number}_value"><float>0</float>{text[end:]}'
    read = colladaphy.read(text.encode())
    world = read.load()
    assert [f.code for f in read.report if f.code.startswith("kinematics")] == []
    for number, (before, after) in enumerate(arm.frames()):
        outer, inner = frames_of(world, number)
        assert np.allclose(outer[:3, 3], before[:3, 3], atol=1e-12)
        assert np.allclose(inner[:3, 3], after[:3, 3], atol=1e-12)


def test_a_target_may_end_in_what_of_the_transform_is_meant() -> None:
    data = document(Arm([Segment(value=30.0)])).replace(b'/value"', b'/value.ANGLE"')
    read = colladaphy.read(data)
    outer, inner = frames_of(read.load(), 0)
    apart = np.linalg.inv(outer) @ inner
    assert math_degrees(apart[1, 0], apart[0, 0]) == pytest.approx(30.0)
    assert [f.code for f in read.report if f.code.startswith("kinematics")] == []


@pytest.mark.parametrize(
    ("segment", "ends"),
    [
        (Segment(value=30.0, limits=(-10.0, 10.0)), (-10.0, 30.0)),
        (Segment(value=30.0, limits=(40.0, 90.0)), (30.0, 90.0)),
        (Segment(kind="prismatic", value=-0.5, limits=(0.0, 1.0)), (-0.5, 1.0)),
    ],
)
def test_limits_give_way_to_the_pose_of_the_file(
    segment: Segment, ends: tuple[float, float]
) -> None:
    world, codes = load(Arm([segment]))
    assert codes == ["kinematics-joint-beyond"]
    (joint,) = world.joints
    slides = segment.kind == "prismatic"
    found = (
        (joint.linear_min[2], joint.linear_max[2])
        if slides
        else tuple(np.degrees([joint.angular_min[2], joint.angular_max[2]]))
    )
    assert np.allclose(found, ends, atol=1e-9)
    world.gravity, world.time_step = (0, 0, 0), 0.002
    pytest.importorskip("mujoco")
    engine = create_engine("mujoco")
    before = world.positions.copy()
    engine.load(world)
    engine.step(1000)
    engine.store(world)
    assert np.abs(world.positions - before).max() < 1e-9


@settings(max_examples=15, deadline=None)
@given(
    _arms, st.lists(st.sampled_from([None, (0.0, 0.0), (10.0, 90.0), (-90.0, -5.0)]), min_size=4)
)
def test_a_robot_rests_whatever_its_limits_are(arm: Arm, limits: list[Any]) -> None:
    pytest.importorskip("mujoco")
    for segment, span in zip(arm.segments, limits, strict=False):
        segment.limits = span
        segment.shape = "<sphere><radius>0.001</radius></sphere>"  # nothing touches
        if not arm.bound:
            segment.shown_at = (0.0, 0.0, 0.0)
    world, _ = load(arm)
    assert len(world.joints) == len(arm.segments)
    world.gravity, world.time_step = (0, 0, 0), 0.002
    before = world.positions.copy()
    engine = create_engine("mujoco")
    engine.load(world)
    engine.step(200)
    engine.store(world)
    assert np.abs(world.positions - before).max() < 1e-7
