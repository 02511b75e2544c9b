"""Joints as kinematics too, for readers that look for robots (COLLADA 1.5 §kinematics).

What is bound together is one kinematics model: its links are the bodies, each hanging on the one
before; what closes a loop is attached at both ends. Links and rigid bodies have the same names.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.links.poses import Poses
from colladaphy.mapper.storing.rows import transforms
from colladaphy.mapper.storing.turns import turns_of
from colladaphy.world import rotations
from colladaphy_schema import document_columns as document
from colladaphy_schema import kinematics_columns as kinematics
from colladaphy_schema import kinematics_model_columns as models
from colladaphy_schema.parameters_columns import (
    CommonBoolOrParamTypeRows,
    CommonFloatOrParamTypeRows,
    CommonSidrefOrParamTypeRows,
)
from colladaphy_schema.rows import Masked

if TYPE_CHECKING:
    from colladaphy.world import Joint, World

__all__ = ["add_kinematics"]

Array = NDArray[Any]

_WORLD = 0


@dataclass(frozen=True, slots=True)
class _Axis:
    """One freedom of a joint, in its own frame."""

    joint: int
    sid: str
    slides: bool
    direction: tuple[float, float, float]
    low: float
    high: float
    value: float
    """Degrees or lengths."""


@dataclass(slots=True)
class _Link:
    """A body, and the joint that it hangs on."""

    sid: int
    pose: Poses
    """Of the body in the joint's frame."""
    joint: int = 0
    at: Poses = field(default_factory=lambda: Poses.none(1))
    """Of the joint's frame in the body that it stands on."""
    inner: list[_Link] = field(default_factory=list)
    ends: list[tuple[str, int, Poses]] = field(default_factory=list)
    """What closes loops here: start or end, the joint, and its frame."""


@dataclass(slots=True)
class _Model:
    root: _Link
    axes: list[_Axis] = field(default_factory=list)
    names: dict[int, str | None] = field(default_factory=dict)


def add_kinematics(root: document.ColladaRows, world: World) -> None:
    """Add the kinematics of all joints that are enabled, and instance them in the scene."""
    found = _models(world)
    if not found:
        return
    count = len(found)
    ids = [f"Kinematics{number}" for number in range(1, count + 1)]
    nothing = np.zeros(count, np.int64)
    made = models.KinematicsModelTypeRows(count, nothing)
    made.id = ids
    made.technique_common = _technique(found, ids)
    root.library_kinematics_models = models.LibraryKinematicsModelsTypeRows(1)
    root.library_kinematics_models.kinematics_model = made
    systems = kinematics.ArticulatedSystemTypeRows(count, nothing)
    systems.id = [f"Robot{number}" for number in range(1, count + 1)]
    systems.kinematics = _system(found, ids)
    root.library_articulated_systems = kinematics.LibraryArticulatedSystemsTypeRows(1)
    root.library_articulated_systems.articulated_system = systems
    scenes = kinematics.KinematicsSceneTypeRows(1)
    scenes.id = ["KinematicsScene1"]
    scenes.instance_articulated_system = placed = kinematics.InstanceArticulatedSystemTypeRows(
        count, nothing
    )
    placed.sid = [f"Robot{number}Instance" for number in range(1, count + 1)]
    placed.url = [f"#Robot{number}" for number in range(1, count + 1)]
    root.library_kinematics_scenes = kinematics.LibraryKinematicsScenesTypeRows(1)
    root.library_kinematics_scenes.kinematics_scene = scenes
    root.scene.instance_kinematics_scene = _effect(found)


# --- joints as trees


def _models(world: World) -> list[_Model]:
    """What is bound together, each as a tree that begins at the world or at the first body."""
    joints = {joint.sid: joint for joint in world.joints if joint.enabled and _holds(joint)}
    at: dict[int, list[int]] = {}
    for sid, joint in joints.items():
        for body in _bodies(joint):
            at.setdefault(body, []).append(sid)
    links: dict[int, _Link] = {}
    done: set[int] = set()
    found: list[_Model] = []
    for start in sorted(at):
        if start in links:
            continue
        model = _Model(_Link(start, Poses.none(1)))
        links[start] = model.root
        found.append(model)
        level = [model.root]
        for link in level:
            for sid in at[link.sid]:
                if sid in done:
                    continue
                done.add(sid)
                joint = joints[sid]
                one, two = _bodies(joint)
                frames = _frame(joint.frame1), _frame(joint.frame2)
                model.names[sid] = joint.name
                backward = link.sid == two
                other = one if backward else two
                if other in links:
                    links[one].ends.append(("attachment_start", sid, frames[0]))
                    links[two].ends.append(("attachment_end", sid, frames[1]))
                    model.axes += _axes(world, joint, backward=False)
                    continue
                outer, inner = frames[::-1] if backward else frames
                links[other] = fresh = _Link(other, inner.inverse(), sid, outer)
                link.inner.append(fresh)
                level.append(fresh)
                model.axes += _axes(world, joint, backward=backward)
    return found


def _holds(joint: Joint) -> bool:
    """Whether any axis is not free: what holds nothing only lets bodies pass."""
    least = np.concatenate([joint.linear_min, joint.angular_min])
    most = np.concatenate([joint.linear_max, joint.angular_max])
    return not bool(np.all(np.isneginf(least) & np.isposinf(most)))


def _bodies(joint: Joint) -> tuple[int, int]:
    one, two = joint.body1, joint.body2
    return (_WORLD if one is None else one.sid, _WORLD if two is None else two.sid)


def _frame(frame: Any) -> Poses:
    return Poses.of(1, np.asarray(frame[0])[None], rotations.normalize(frame[1])[None])


def _axes(world: World, joint: Joint, *, backward: bool) -> list[_Axis]:
    """The freedoms of a joint in their order, seen from the other body if `backward`."""
    shift, turn = _values(joint)
    made: list[_Axis] = []
    with np.errstate(over="ignore"):  # a limit beyond all degrees is none
        least, most = np.degrees(joint.angular_min), np.degrees(joint.angular_max)
    for slides, low, high, value in (
        (True, joint.linear_min, joint.linear_max, shift),
        (False, least, most, turn),
    ):
        for axis in range(3):
            if low[axis] == high[axis] == 0.0:
                continue
            direction = [0.0, 0.0, 0.0]
            direction[axis] = -1.0 if backward else 1.0
            sid = ("shift" if slides else "turn") + "xyz"[axis]
            made.append(_Axis(joint.sid, sid, slides, (direction[0], direction[1], direction[2]),
                              float(low[axis]), float(high[axis]), float(value[axis])))  # fmt: skip
    if not made:
        made.append(_Axis(joint.sid, "turnz", False, (0.0, 0.0, 1.0), 0.0, 0.0, 0.0))
    return made[::-1] if backward else made


def _values(joint: Joint) -> tuple[Array, Array]:
    """How far frame 2 is moved along, and turned about, the axes of frame 1: x, then y, then z."""
    ends = []
    with np.errstate(over="ignore", invalid="ignore"):
        for body, frame in ((joint.body1, joint.frame1), (joint.body2, joint.frame2)):
            outer = Poses.none(1)
            if body is not None:
                turn = rotations.normalize(body.orientation)
                outer = Poses.of(1, body.position[None], turn[None])
            ends.append(outer.then(_frame(frame)))
        apart = ends[0].inverse().then(ends[1])
    matrix = rotations.to_matrix(apart.orientations[0])
    angles = (
        math.atan2(-matrix[1, 2], matrix[2, 2]),
        math.asin(max(-1.0, min(1.0, float(matrix[0, 2])))),
        math.atan2(-matrix[0, 1], matrix[0, 0]),
    )
    # What is farther apart than numbers go is as far as they go.
    return np.nan_to_num(apart.positions[0]), np.degrees(angles)


# --- rows


def _technique(found: list[_Model], ids: list[str]) -> models.KinematicsModelTechniqueTypeRows:
    rows = models.KinematicsModelTechniqueTypeRows(len(found))
    rows.joint = _joints(found)
    owners = np.arange(len(found))
    rows.link = _links([model.root for model in found], owners, dict(enumerate(ids)))
    return rows


def _joints(found: list[_Model]) -> models.JointTypeRows:
    sids = [(number, sid) for number, model in enumerate(found) for sid in model.names]
    rows = models.JointTypeRows(len(sids), np.array([number for number, _ in sids], np.int64))
    rows.sid = [f"Joint{sid}" for _, sid in sids]
    rows.name = [found[number].names[sid] for number, sid in sids]
    place = {sid: row for row, (_, sid) in enumerate(sids)}
    axes = [axis for model in found for axis in model.axes]
    for slides, kind in ((True, models.PrismaticRows), (False, models.RevoluteRows)):
        mine = [(order, axis) for order, axis in enumerate(axes) if axis.slides == slides]
        owner = np.array([place[axis.joint] for _, axis in mine], np.int64)
        sorting = np.argsort(owner, kind="stable")
        mine = [mine[at] for at in sorting.tolist()]
        made = kind(len(mine), owner[sorting], order=np.array([at for at, _ in mine], np.int64))
        made.sid = [axis.sid for _, axis in mine]
        made.axis = models.AxisTypeRows(len(mine))
        made.axis.value = np.array([axis.direction for _, axis in mine]).reshape(-1, 3)
        made.limits = _limits([(axis.low, axis.high) for _, axis in mine])
        if slides:
            rows.prismatic = made  # type: ignore[assignment]
        else:
            rows.revolute = made  # type: ignore[assignment]
    return rows


def _limits(pairs: list[tuple[float, float]]) -> models.JointLimitsTypeRows:
    there = np.flatnonzero([any(map(math.isfinite, pair)) for pair in pairs])
    rows = models.JointLimitsTypeRows(len(there), there)
    for side, name in enumerate(("min", "max")):
        values = np.array([pairs[row][side] for row in there.tolist()])
        finite = np.flatnonzero(np.isfinite(values))
        child = models.MinmaxTypeRows(len(finite), finite)
        child.value = values[finite]
        setattr(rows, name, child)
    return rows


def _links(links: list[_Link], owner: Array, ids: dict[int, str]) -> models.LinkTypeRows:
    """Links and all that hang on them; `ids` are those of the models, by the row of the link."""
    rows = models.LinkTypeRows(len(links), owner)
    rows.sid = ["World" if link.sid == _WORLD else f"Body{link.sid}" for link in links]
    rows.translate, rows.rotate = _steps([link.pose for link in links])
    held = [(row, inner) for row, link in enumerate(links) for inner in link.inner]
    full = models.LinkTypeAttachmentFullRows(
        len(held), np.array([row for row, _ in held], np.int64)
    )
    full.joint = [f"{ids[row]}/Joint{inner.joint}" for row, inner in held]
    full.translate, full.rotate = _steps([inner.at for _, inner in held], always=True)
    if held:
        inner_ids = {at: ids[row] for at, (row, _) in enumerate(held)}
        full.link = _links([inner for _, inner in held], np.arange(len(held)), inner_ids)
        rows.attachment_full = full
    for name, kind in (
        ("attachment_start", models.LinkTypeAttachmentStartRows),
        ("attachment_end", models.LinkTypeAttachmentEndRows),
    ):
        ends = [(row, sid, pose) for row, link in enumerate(links)
                for side, sid, pose in link.ends if side == name]  # fmt: skip
        if ends:
            part = kind(len(ends), np.array([row for row, _, _ in ends], np.int64))
            part.joint = [f"{ids[row]}/Joint{sid}" for row, sid, _ in ends]
            part.translate, part.rotate = _steps([pose for _, _, pose in ends], always=True)
            setattr(rows, name, part)
    return rows


def _steps(poses: list[Poses], *, always: bool = False) -> Any:
    joined = Poses.joined(poses) if poses else Poses.none(0)
    turns, turned = turns_of(joined.orientations)
    moved = np.any(joined.positions != 0.0, axis=1) | always
    return transforms((joined.positions, moved), (turns, turned))


def _system(found: list[_Model], ids: list[str]) -> kinematics.KinematicsTypeRows:
    count = len(found)
    rows = kinematics.KinematicsTypeRows(count)
    rows.instance_kinematics_model = made = kinematics.InstanceKinematicsModelTypeRows(
        count, np.arange(count)
    )
    made.sid = ["Model"] * count
    made.url = [f"#{id}" for id in ids]
    rows.technique_common = common = kinematics.KinematicsTechniqueTypeRows(count)
    axes = [(number, axis) for number, model in enumerate(found) for axis in model.axes]
    common.axis_info = infos = kinematics.KinematicsAxisInfoTypeRows(
        len(axes), np.array([number for number, _ in axes], np.int64)
    )
    infos.axis = [f"{ids[number]}/Joint{axis.joint}/{axis.sid}" for number, axis in axes]
    for name, flag in (("active", True), ("locked", False)):
        child = CommonBoolOrParamTypeRows(len(axes))
        child.bool = Masked(np.full(len(axes), flag), np.ones(len(axes), np.bool_))
        setattr(infos, name, child)
    for name in ("frame_origin", "frame_tip"):
        frame = kinematics.KinematicsFrameTypeRows(count)
        frame.link = [
            f"{id}/" + ("World" if model.root.sid == _WORLD else f"Body{model.root.sid}")
            for id, model in zip(ids, found, strict=True)
        ]
        setattr(common, name, frame)
    return rows


def _effect(found: list[_Model]) -> kinematics.InstanceKinematicsSceneTypeRows:
    rows = kinematics.InstanceKinematicsSceneTypeRows(1)
    rows.url = ["#KinematicsScene1"]
    nothing = np.zeros(len(found), np.int64)
    rows.bind_kinematics_model = binds = kinematics.BindKinematicsModelTypeRows(len(found), nothing)
    binds.node = [None if m.root.sid == _WORLD else f"Node{m.root.sid}" for m in found]
    binds.SIDREF = [f"Robot{number}/Model" for number in range(1, len(found) + 1)]
    axes = [(number, axis) for number, model in enumerate(found, 1) for axis in model.axes]
    rows.bind_joint_axis = bound = kinematics.BindJointAxisTypeRows(
        len(axes), np.zeros(len(axes), np.int64)
    )
    bound.axis = address = CommonSidrefOrParamTypeRows(len(axes))
    address.SIDREF = [f"Robot{number}/Model/Joint{axis.joint}/{axis.sid}" for number, axis in axes]
    bound.value = value = CommonFloatOrParamTypeRows(len(axes))
    value.float = Masked(np.array([axis.value for _, axis in axes]), np.ones(len(axes), np.bool_))
    return rows
