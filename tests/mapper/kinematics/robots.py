"""Robots as documents: links one after the other, and where they stand by matrices of our own."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from colladaphy.links.names import COLLADA

__all__ = ["Arm", "Segment", "document", "pose_matrix", "turn_matrix"]

Floats = NDArray[np.float64]


@dataclass
class Segment:
    """A joint on the link before, and the link that it moves."""

    at: tuple[float, float, float] = (0.0, 0.0, 1.0)
    turn: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0)
    """An axis and degrees."""
    kind: str = "revolute"
    axis: tuple[float, float, float] = (0.0, 0.0, 1.0)
    value: float = 0.0
    """Degrees or a length."""
    limits: tuple[float, float] | None = None
    shown_at: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Where the link's node stands behind the joint."""
    info: str = ""
    """What the axis_info holds."""
    mass: str = "<mass>2</mass><inertia>1 1 1</inertia>"
    shape: str = "<sphere><radius>0.1</radius></sphere>"
    joint: str | None = None
    """The whole content of the joint, instead of one axis."""


@dataclass
class Arm:
    """A chain of segments on a base."""

    segments: list[Segment] = field(default_factory=list)
    base_at: tuple[float, float, float] = (0.0, 0.0, 0.0)
    base: Segment = field(default_factory=Segment)
    """Of which mass and shape are used."""
    bound: bool = True
    """Whether the axes are bound to transforms of the nodes."""

    def frames(self) -> list[tuple[Floats, Floats]]:
        """Of each joint the frames before and behind its motion, in the world (4, 4)."""
        here = pose_matrix(self.base_at)
        made = []
        for segment in self.segments:
            before = here @ pose_matrix(segment.at) @ turn_matrix(segment.turn[:3], segment.turn[3])
            if segment.kind == "prismatic":
                unit = np.array(segment.axis) / np.linalg.norm(segment.axis)
                moved = pose_matrix(tuple(unit * segment.value))
            else:
                moved = turn_matrix(segment.axis, segment.value)
            here = before @ moved
            made.append((before, here))
        return made


def pose_matrix(at: tuple[float, ...]) -> Floats:
    """A translation."""
    made = np.eye(4)
    made[:3, 3] = at
    return made


def turn_matrix(axis: tuple[float, ...], degrees: float) -> Floats:
    """A rotation, by Rodrigues' formula."""
    made = np.eye(4)
    length = math.hypot(*axis)
    if length == 0.0:
        return made
    x, y, z = (number / length for number in axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    angle = math.radians(degrees)
    made[:3, :3] = np.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross
    return made


def _text(numbers: tuple[float, ...]) -> str:
    return " ".join(map(repr, map(float, numbers)))


def _joint(number: int, segment: Segment) -> str:
    if segment.joint is not None:
        return f'<joint sid="j{number}" name="joint {number}">{segment.joint}</joint>'
    limits = ""
    if segment.limits is not None:
        low, high = segment.limits
        limits = f"<limits><min>{low!r}</min><max>{high!r}</max></limits>"
    return (
        f'<joint sid="j{number}" name="joint {number}"><{segment.kind} sid="axis0">'
        f"<axis>{_text(segment.axis)}</axis>{limits}</{segment.kind}></joint>"
    )


def _node(arm: Arm, number: int) -> str:
    """The node of a segment, with all that follow in it."""
    if number == len(arm.segments):
        return ""
    segment = arm.segments[number]
    before = arm.segments[number - 1].shown_at if number else (0.0, 0.0, 0.0)
    back = tuple(-value for value in before)
    if segment.kind == "prismatic":
        unit = np.array(segment.axis) / np.linalg.norm(segment.axis)
        moved = f'<translate sid="value">{_text(tuple(unit * segment.value))}</translate>'
    else:
        moved = f'<rotate sid="value">{_text((*segment.axis, segment.value))}</rotate>'
    return (
        f'<node id="n{number}" sid="n{number}"><translate>{_text(back)}</translate>'
        f"<translate>{_text(segment.at)}</translate><rotate>{_text(segment.turn)}</rotate>{moved}"
        f"<translate>{_text(segment.shown_at)}</translate>{_node(arm, number + 1)}</node>"
    )


def _link(arm: Arm, number: int) -> str:
    if number == len(arm.segments):
        return ""
    segment = arm.segments[number]
    return (
        f'<attachment_full joint="km/j{number}"><translate>{_text(segment.at)}</translate>'
        f'<rotate>{_text(segment.turn)}</rotate><link sid="l{number}" name="link {number}">'
        f"{_link(arm, number + 1)}</link></attachment_full>"
    )


def _body(sid: str, name: str, segment: Segment) -> str:
    return (
        f'<rigid_body sid="{sid}" name="{name}"><technique_common>{segment.mass}'
        f"<shape>{segment.shape}</shape></technique_common></rigid_body>"
    )


def document(arm: Arm, *, model: str = "", constraints: str = "", scene: str = "") -> bytes:
    """The document of an arm, as OpenRAVE and ROS bind it together.

    `model` is put at the end of the kinematics model, `constraints` at the end of the physics
    model, `scene` in place of what binds the kinematics.
    """
    count = len(arm.segments)
    joints = "".join(_joint(number, segment) for number, segment in enumerate(arm.segments))
    bodies = _body("base", "base", arm.base) + "".join(
        _body(f"b{number}", f"link {number}", segment)
        for number, segment in enumerate(arm.segments)
    )
    instances = '<instance_rigid_body body="base" target="#base"><technique_common/>'
    instances += "</instance_rigid_body>" + "".join(
        f'<instance_rigid_body body="b{number}" target="#n{number}"><technique_common/>'
        "</instance_rigid_body>"
        for number in range(count)
    )
    news = "".join(
        f'<newparam sid="k_j{number}"><SIDREF>robot/inst/j{number}/axis0</SIDREF></newparam>'
        f'<newparam sid="k_j{number}_value"><float>{float(segment.value)!r}</float></newparam>'
        for number, segment in enumerate(arm.segments)
    )
    infos = "".join(
        f'<axis_info axis="km/j{number}/axis0">{segment.info}</axis_info>'
        for number, segment in enumerate(arm.segments)
    )
    binds = "".join(
        f'<bind symbol="s_j{number}{end}"><param ref="robot/k_j{number}{end}"/></bind>'
        for number in range(count)
        for end in ("", "_value")
    )
    path = ["base"]
    axes = ""
    for number in range(count):
        path.append(f"n{number}")
        target = f' target="{"/".join(path)}/value"' if arm.bound else ""
        axes += (
            f"<bind_joint_axis{target}><axis><param>s_j{number}</param></axis>"
            f"<value><param>s_j{number}_value</param></value></bind_joint_axis>"
        )
    whole = scene or (
        '<instance_kinematics_scene url="#ks"><bind_kinematics_model node="base">'
        f"<param>s_model</param></bind_kinematics_model>{axes}</instance_kinematics_scene>"
    )
    return f"""<COLLADA xmlns="{COLLADA}" version="1.5.0">
<asset><created>2020-01-01T00:00:00Z</created><modified>2020-01-01T00:00:00Z</modified>
<up_axis>Z_UP</up_axis></asset>
<library_visual_scenes><visual_scene id="vs"><node id="base" sid="base">
<translate>{_text(arm.base_at)}</translate>{_node(arm, 0)}</node></visual_scene>
</library_visual_scenes>
<library_kinematics_models><kinematics_model id="km" name="arm"><technique_common>
{joints}<link sid="base" name="base">{_link(arm, 0)}</link>{model}
</technique_common></kinematics_model></library_kinematics_models>
<library_articulated_systems><articulated_system id="robot"><kinematics>
<instance_kinematics_model url="#km" sid="inst">
<newparam sid="k_model"><SIDREF>robot/inst</SIDREF></newparam>{news}</instance_kinematics_model>
<technique_common>{infos}<frame_origin link="km/base"/><frame_tip link="km/base"/>
</technique_common></kinematics></articulated_system></library_articulated_systems>
<library_kinematics_scenes><kinematics_scene id="ks">
<instance_articulated_system sid="robot_inst" url="#robot">
<bind symbol="s_model"><param ref="robot/k_model"/></bind>{binds}
</instance_articulated_system></kinematics_scene></library_kinematics_scenes>
<library_physics_models><physics_model id="pm">{bodies}{constraints}</physics_model>
</library_physics_models>
<library_physics_scenes><physics_scene id="ps"><instance_physics_model url="#pm">{instances}
{_constraint_instance(constraints)}</instance_physics_model><technique_common/></physics_scene>
</library_physics_scenes>
<scene><instance_physics_scene url="#ps"/><instance_visual_scene url="#vs"/>{whole}</scene>
</COLLADA>""".encode()


def _constraint_instance(constraints: str) -> str:
    return '<instance_rigid_constraint constraint="c"/>' if constraints else ""
