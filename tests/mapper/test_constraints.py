"""Rigid constraints become joints, and joints constraints (thesis 4.5)."""

from __future__ import annotations

import io
import math

import numpy as np
import pytest
from tests.mapper.documents import body, collada, instance, model, scene

import colladaphy
from colladaphy.mapper import WriteOptions
from colladaphy.world import Joint, JointKind, World, rotations

NODES = (
    '<node id="n"><translate>1 0 0</translate></node>'
    '<node id="k"><translate>0 2 0</translate><rotate>0 0 1 90</rotate></node>'
)


def constraint(
    common: str = "",
    ref: str = ' rigid_body="./a"',
    other: str = ' rigid_body="./b"',
    frames: tuple[str, str] = ("", ""),
) -> str:
    return (
        f'<rigid_constraint sid="c"><ref_attachment{ref}>{frames[0]}</ref_attachment>'
        f"<attachment{other}>{frames[1]}</attachment>"
        f"<technique_common>{common}</technique_common></rigid_constraint>"
    )


START = '<instance_rigid_constraint constraint="c"/>'


def document_of(element: str, bodies: str | None = None, started: str = START) -> bytes:
    bodies = body("a") + body("b") if bodies is None else bodies
    return collada(
        model(bodies, element), scene(instance("a"), instance("b", "#k"), started), NODES
    )


def joint_of(element: str) -> Joint:
    world = colladaphy.read(document_of(element)).load()
    assert len(world.joints) == 1
    return world.joints[0]


def limits(group: str, low: str, high: str) -> str:
    return f"<limits><{group}><min>{low}</min><max>{high}</max></{group}></limits>"


@pytest.mark.parametrize(
    ("common", "kind"),
    [
        ("", JointKind.FIXED),
        (limits("swing_cone_and_twist", "0 0 -30", "0 0 30"), JointKind.HINGE),
        (limits("linear", "-1 0 0", "1 0 0"), JointKind.SLIDER),
        (limits("swing_cone_and_twist", "-INF -INF -INF", "INF INF INF"), JointKind.BALL),
        (limits("linear", "-1 -1 -1", "1 1 1"), JointKind.GENERAL),
    ],
)
def test_kind_is_told_from_the_limits(common: str, kind: JointKind) -> None:
    assert joint_of(constraint(common)).kind is kind


def test_limits_are_read_in_degrees() -> None:
    joint = joint_of(constraint(limits("swing_cone_and_twist", "-45 0 -90", "180 0 INF")))
    assert np.allclose(joint.angular_min, [-math.pi / 4, 0, -math.pi / 2])
    assert np.allclose(joint.angular_max, [math.pi, 0, math.inf])


def test_empty_limits_are_the_default() -> None:
    joint = joint_of(constraint("<limits><linear><min/><max/></linear></limits>"))
    assert joint.kind is JointKind.FIXED


def test_springs() -> None:
    spring = (
        "<spring><angular><stiffness>2</stiffness><damping>1</damping>"
        "<target_value>90</target_value></angular>"
        "<linear><damping>0.5</damping><target_value>3</target_value></linear></spring>"
    )
    joint = joint_of(constraint(spring))
    assert joint.linear_spring == (1.0, 0.5, 3.0)  # the standard's default stiffness
    degree = math.pi / 180.0
    assert joint.angular_spring == pytest.approx((2 / degree, 1 / degree, math.pi / 2))


def test_a_spring_that_does_not_pull_has_no_target() -> None:
    inert = "<stiffness>0</stiffness><damping>2</damping><target_value>INF</target_value>"
    element = constraint(f"<spring><linear>{inert}</linear></spring>")
    assert joint_of(element).linear_spring == (0.0, 2.0, 0.0)
    told = {finding.code for finding in colladaphy.validate(document_of(element))}
    assert "physics-joint-spring" not in told
    pulling = document_of(element).replace(b"<stiffness>0<", b"<stiffness>1<")
    assert "physics-joint-spring" in {finding.code for finding in colladaphy.validate(pulling)}


def test_without_springs_there_are_none() -> None:
    assert joint_of(constraint()).linear_spring == (0.0, 0.0, 0.0)


def test_enabled_and_interpenetrate() -> None:
    joint = joint_of(constraint("<enabled>false</enabled><interpenetrate>true</interpenetrate>"))
    assert not joint.enabled
    assert joint.interpenetrate
    joint = joint_of(constraint("<enabled/><interpenetrate/>"))
    assert joint.enabled
    assert not joint.interpenetrate


def test_bodies_and_frames() -> None:
    frames = (
        "<translate>0 1 0</translate>",
        "<translate>1 0 0</translate><rotate>1 0 0 90</rotate>",
    )
    joint = joint_of(constraint(frames=frames))
    assert joint.body1 is not None
    assert joint.body2 is not None
    assert joint.body1.position.tolist() == [1.0, 0.0, 0.0]
    assert joint.body2.position.tolist() == [0.0, 2.0, 0.0]
    assert joint.frame1[0].tolist() == [0.0, 1.0, 0.0]
    assert joint.frame2[0].tolist() == [1.0, 0.0, 0.0]
    assert np.allclose(joint.frame2[1], rotations.from_axis_angle((1, 0, 0), math.pi / 2))


def test_frames_are_those_of_the_rigid_body_not_of_the_shape() -> None:
    off = (
        "<shape><mass>1</mass><cylinder><height>2</height><radius>1 1</radius></cylinder>"
        "<translate>0 3 0</translate></shape>"
    )
    data = document_of(
        constraint(frames=("<translate>0 1 0</translate>", "")), body("a", off) + body("b")
    )
    joint = colladaphy.read(data).load().joints[0]
    assert joint.body1 is not None
    place = joint.body1.position + rotations.rotate(joint.body1.orientation, joint.frame1[0])
    assert np.allclose(place, [1.0, 1.0, 0.0])


@pytest.mark.parametrize(
    "reference", ["./a", "m/a", "a", "#m/a"], ids=["relative", "id/sid", "sid", "uri"]
)
def test_addresses_of_bodies(reference: str) -> None:
    joint = joint_of(constraint(ref=f' rigid_body="{reference}"'))
    assert joint.body1 is not None
    assert joint.body1.sid == 1


def test_attached_to_the_world_or_a_node() -> None:
    joint = joint_of(constraint(ref=""))
    assert joint.body1 is None
    joint = joint_of(
        constraint(ref=' rigid_body="#k"', frames=("<translate>1 0 0</translate>", ""))
    )
    assert joint.body1 is None
    assert np.allclose(joint.frame1[0], [0.0, 3.0, 0.0])


def test_a_path_through_nested_instances() -> None:
    inner = model(body("x"), id="inner")
    started = [
        f'<instance_physics_model url="#inner" sid="{sid}">{instance("x", target)}'
        "</instance_physics_model>"
        for sid, target in (("left", "#n"), ("right", "#k"))
    ]
    element = constraint(ref=' rigid_body="./left/x"', other=' rigid_body="./right/x"')
    data = collada(inner + model(element, *started), scene(START), NODES)
    joint = colladaphy.read(data).load().joints[0]
    assert joint.body1 is not None
    assert joint.body2 is not None
    assert joint.body1.position.tolist() == [1.0, 0.0, 0.0]
    assert joint.body2.position.tolist() == [0.0, 2.0, 0.0]


def test_a_model_instanced_twice_binds_within_each() -> None:
    each = f"{instance('a')}{instance('b', '#k')}{START}"
    instanced = f'<instance_physics_model url="#m">{each}</instance_physics_model>' * 2
    data = collada(model(body("a"), body("b"), constraint()), scene(instanced), NODES)
    world = colladaphy.read(data).load()
    pairs = [(joint.body1.sid, joint.body2.sid) for joint in world.joints]  # type: ignore[union-attr]
    assert pairs == [(1, 2), (3, 4)]


def test_a_body_instanced_twice_is_an_error() -> None:
    data = document_of(constraint(), started=instance("a", "#k") + START)
    document = colladaphy.read(data)
    with pytest.raises(colladaphy.DocumentError) as caught:
        document.load()
    assert [finding.code for finding in caught.value.findings] == ["link-body-twice"]


def test_constraints_that_are_not_instanced_are_not_loaded() -> None:
    assert len(colladaphy.read(document_of(constraint(), started="")).load().joints) == 0


def test_constraint_of_a_skipped_body_is_skipped_and_reported() -> None:
    empty = "<shape><sphere><radius>0</radius></sphere></shape>"
    document = colladaphy.read(document_of(constraint(), body("a", empty) + body("b")))
    world = document.load()
    assert len(world.bodies) == 1
    assert len(world.joints) == 0
    assert "load-constraint-skipped" in [finding.code for finding in document.report]


def test_a_body_bound_to_itself_is_skipped_and_reported() -> None:
    document = colladaphy.read(document_of(constraint(other=' rigid_body="./a"')))
    assert len(document.load().joints) == 0
    assert "load-constraint-faulty" in [finding.code for finding in document.report]


def test_missing_constraint_is_an_error() -> None:
    document = colladaphy.read(document_of(""))
    with pytest.raises(colladaphy.DocumentError) as caught:
        document.load()
    assert caught.value.findings[0].code == "link-missing"


def joints_world() -> World:
    world = World()
    iron = world.materials["iron"]
    bodies = [world.create_sphere(n, (3 * n, 0, 0), 1.0, iron) for n in range(3)]
    world.attach_fixed_joint(bodies[0], bodies[1])
    world.attach_hinge_joint(bodies[1], bodies[2], axis=(0, 0, 1), limits=(-0.5, 0.5))
    world.attach_slider_joint(bodies[0], None, axis=(0, 0, 1))
    world.attach_ball_joint(None, bodies[2])
    return world


def test_other_readers_see_the_limits() -> None:
    stream = io.BytesIO()
    colladaphy.write(joints_world(), stream, options=WriteOptions(profile="none"))
    again = colladaphy.read(stream.getvalue()).load()
    kinds = [joint.kind for joint in again.joints]
    assert kinds == [JointKind.FIXED, JointKind.HINGE, JointKind.SLIDER, JointKind.BALL]
    assert again.joints[1].angular_max[2] == pytest.approx(0.5)


def test_a_fixed_joint_is_what_the_defaults_say() -> None:
    stream = io.BytesIO()
    colladaphy.write(joints_world(), stream)
    text = stream.getvalue().decode()
    first = text[text.index('sid="Joint1"') : text.index('sid="Joint2"')]
    assert "<technique_common/>" in first
    stream = io.BytesIO()
    colladaphy.write(joints_world(), stream, options=WriteOptions(redundant=True))
    text = stream.getvalue().decode()
    first = text[text.index('sid="Joint1"') : text.index('sid="Joint2"')]
    assert "<min>0 0 0</min>" in first
