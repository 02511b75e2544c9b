"""What rigid_constraints say, read column by column (COLLADA 1.5 §rigid_constraint)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.links.poses import DEGREE, Poses
from colladaphy.links.steps import poses_of
from colladaphy.mapper.loading.profile import countable, first_of

__all__ = ["SIDES", "Constraints", "read_constraints"]

Array = NDArray[Any]

SIDES = ("ref_attachment", "attachment")
"""The two attachments, in the order of the schema."""
_LARGEST = 1.7e308


@dataclass(slots=True)
class Constraints:
    """The rigid_constraints of a document; what the profile does not say is masked out."""

    references: list[str]
    """(2 n,) what the two attachments of each refer to, empty for the world."""
    origins: Array
    """(n, 2) the elements of the attachments; -1 for none."""
    frames: Poses
    """(2 n,) in the rigid_bodies."""
    enabled: Array
    interpenetrate: Array
    linear: Array
    """(n, 2, 3) limits."""
    angular: Array
    """(n, 2, 3) in radians."""
    springs: Array
    """(n, 2, 3) stiffness, damping, target: linear, angular per radian."""
    has_spring: Array
    kept: Array
    """(n,) whether the profile has a joint."""
    large: Array
    """(n,) whether an id of that has more than 64 bits."""
    uids: Array
    kept_sids: Array
    kept_names: list[str | None]
    exact_frames: Poses
    """(2 n,)."""
    exact_linear: Array
    has_linear: Array
    exact_angular: Array
    has_angular: Array
    exact_springs: Array
    has_exact_spring: Array
    motors: Array
    """(n, 2) speed and strength; only the profile has them."""


def read_constraints(constraints: Any, home: int, start: int) -> Constraints:
    """The constraints of a document; see `Table.gather`."""
    count = len(constraints)
    references = [""] * (2 * count)
    origins = np.full((count, 2), -1, np.int64)
    frames = Poses.none(2 * count)
    for side, name in enumerate(SIDES):
        attachment = getattr(constraints, name)
        rows = attachment.owner
        origins[rows, side] = attachment.ordinals
        for row, reference in zip(rows.tolist(), attachment.rigid_body, strict=True):
            references[2 * row + side] = reference or ""
        frames.put(2 * rows + side, poses_of(attachment))
    common = constraints.technique_common
    enabled = _flag(common, common.enabled, count, True)
    interpenetrate = _flag(common, common.interpenetrate, count, False)
    limits = common.limits
    linear = _limits(common, limits, limits.linear, count)
    angular = _limits(common, limits, limits.swing_cone_and_twist, count) * DEGREE
    springs = np.zeros((count, 2, 3))
    has_spring = np.zeros((count, 2), np.bool_)
    outer = common.spring
    for side, name in enumerate(("linear", "angular")):
        inner = getattr(outer, name)
        if not len(inner):
            continue
        rows = common.owner[outer.owner[inner.owner]]
        springs[rows, side] = np.column_stack([
            _spring_value(inner, part, default)
            for part, default in (("stiffness", 1.0), ("damping", 0.0), ("target_value", 0.0))
        ])  # fmt: skip
        has_spring[rows, side] = True
    # Where a spring does not pull at all, it does not matter where to; some write INF.
    inert = (springs[:, :, 0] == 0.0) & np.isinf(springs[:, :, 2])
    springs[:, :, 2][inert] = 0.0
    with np.errstate(all="ignore"):
        per_radian = springs[:, 1, :2] / DEGREE
        springs[:, 1, :2] = np.where(np.isinf(per_radian), np.copysign(_LARGEST, per_radian),
                                     per_radian)  # fmt: skip
        springs[:, 1, 2] *= DEGREE
    return Constraints(references, origins, frames, enabled, interpenetrate, linear, angular,
                        springs, has_spring, **_profile(constraints, count))  # fmt: skip


def _flag(common: Any, child: Any, count: int, default: bool) -> Array:
    made = np.full(count, default)
    if len(child):
        made[common.owner[child.owner]] = child.value
    return made


def _limits(common: Any, limits: Any, group: Any, count: int) -> Array:
    made = np.zeros((count, 2, 3))
    for place, name in enumerate(("min", "max")):
        child = getattr(group, name)
        if len(child):
            rows = common.owner[limits.owner[group.owner[child.owner]]]
            made[rows, place] = child.value
    return made


def _spring_value(group: Any, name: str, default: float) -> Array:
    child = getattr(group, name)
    made = np.full(len(group), default)
    made[child.owner] = child.value
    return made


def _profile(constraints: Any, count: int) -> dict[str, Any]:
    """What the pe profile says of constraints."""
    joints, owner = first_of(constraints, constraints.technique, "joint")
    kept = np.zeros(count, np.bool_)
    kept[owner] = True
    uids, sids = np.zeros(count, np.int64), np.full(count, -1, np.int64)
    uid, has_uid, large_uid = countable(joints.uid, len(joints))
    sid, has_sid, large_sid = countable(joints.sid, len(joints))
    large = np.zeros(count, np.bool_)
    large[owner] = large_uid | large_sid
    uids[owner] = np.where(has_uid, uid, 0)
    sids[owner] = np.where(has_sid, sid, -1)
    names: list[str | None] = [None] * count
    for row, name in zip(owner.tolist(), joints.name, strict=True):
        names[row] = name
    frames = Poses.none(2 * count)
    for side, attribute in enumerate(("frame1", "frame2")):
        frame = getattr(joints, attribute)
        if len(frame):
            at, turn = frame.position, frame.orientation
            poses = Poses.of(
                len(frame), at.values, turn.values, moved=at.present, turned=turn.present
            )
            frames.put(2 * owner[frame.owner] + side, poses)
    made: dict[str, Any] = {
        "kept": kept, "large": large, "uids": uids, "kept_sids": sids, "kept_names": names,
        "exact_frames": frames,
        "exact_springs": np.zeros((count, 2, 3)),
        "has_exact_spring": np.zeros((count, 2), np.bool_),
        "motors": np.zeros((count, 2)),
    }  # fmt: skip
    if len(joints.motor):
        motor = joints.motor
        made["motors"][owner[motor.owner]] = np.column_stack([motor.speed, motor.strength])
    for name in ("linear", "angular"):
        exact, has = np.zeros((count, 2, 3)), np.zeros(count, np.bool_)
        limits = getattr(joints, f"{name}_limits")
        if len(limits):
            rows = owner[limits.owner]
            exact[rows, 0], exact[rows, 1] = limits.min, limits.max
            has[rows] = True
        made[f"exact_{name}"], made[f"has_{name}"] = exact, has
        spring = getattr(joints, f"{name}_spring")
        if len(spring):
            rows, side = owner[spring.owner], int(name == "angular")
            values = np.column_stack([spring.stiffness, spring.damping, spring.target_value])
            made["exact_springs"][rows, side] = values
            made["has_exact_spring"][rows, side] = True
    return made
