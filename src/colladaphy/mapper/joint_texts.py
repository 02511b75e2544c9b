"""Joints as rigid constraints (thesis 4.5, COLLADA 1.5 §rigid_constraint).

The reference body is body 1. Frames and linear limits are exact in the common profile; what is an
angle (orientations, angular limits, angular springs) is exact in the pe profile.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.mapper.body_texts import identity, kept_name, rotation_texts
from colladaphy.mapper.markup import attribute, pe_technique
from colladaphy.mapper.numbers import DEGREE, degrees_exactly, floats_text, same_bits
from colladaphy.world import rotations
from colladaphy.world.kinds import JointKind, Kind

if TYPE_CHECKING:
    from colladaphy.mapper.options import WriteOptions
    from colladaphy.world import Joint, World

__all__ = ["joint_texts"]

Array = NDArray[Any]

_NO_TURN = np.array([1.0, 0.0, 0.0, 0.0])


def joint_texts(
    world: World, options: WriteOptions, address: Callable[[int], str]
) -> list[tuple[int, str]]:
    """The system id of body 1 (or 2, if 1 is the world) and the element of each joint.

    `address` gives the SID path of the rigid_body of a system id.
    """
    columns = world.joints.columns()
    texts = []
    for row, joint in enumerate(world.joints):
        bodies = columns["bodies"][row].tolist()
        texts.append((bodies[0] or bodies[1], _joint(joint, columns, row, options, address)))
    return texts


def _joint(
    joint: Joint,
    columns: dict[str, Array],
    row: int,
    options: WriteOptions,
    address: Callable[[int], str],
) -> str:
    positions, orientations = columns["positions"][row], columns["orientations"][row]
    attachments = ""
    planes = [body is not None and body.kind is Kind.PLANE for body in (joint.body1, joint.body2)]
    if any(planes):
        with np.errstate(all="ignore"):
            positions, orientations = _beside_planes(joint, positions, orientations, planes)
    for side, name in enumerate(("ref_attachment", "attachment")):
        sid = int(columns["bodies"][row][side])
        where = f' rigid_body="{address(sid)}"' if sid else ""
        steps = ""
        if not np.all(same_bits(positions[side], np.zeros(3))):
            steps = f"<translate>{floats_text(positions[side].tolist())}</translate>"
        steps += rotation_texts(orientations[side][None])[0]
        attachments += f"<{name}{where}>{steps}</{name}>" if steps else f"<{name}{where}/>"
    common, exact = _common(joint, columns, row, options)
    technique = ""
    if options.profile != "none":
        technique = pe_technique(_profile(joint, columns, row, exact, planes, options))
    return (
        f'<rigid_constraint sid="Joint{joint.sid}"{attribute("name", joint.name)}>'
        f"{attachments}{common}{technique}</rigid_constraint>"
    )


def _beside_planes(
    joint: Joint, positions: Array, orientations: Array, planes: list[bool]
) -> tuple[Array, Array]:
    """The frames as a rigid_body has them: that of a plane is the world's, not the plane's own."""
    positions, orientations = positions.copy(), orientations.copy()
    for side, body in enumerate((joint.body1, joint.body2)):
        if planes[side] and body is not None:
            turned = rotations.rotate(body.orientation, positions[side])
            positions[side] = body.position + turned
            orientations[side] = rotations.multiply(
                rotations.normalize(body.orientation), orientations[side]
            )
    return positions, orientations


def _common(
    joint: Joint, columns: dict[str, Array], row: int, options: WriteOptions
) -> tuple[str, bool]:
    """technique_common, and whether its angular limits are exact."""
    content = ""
    if not joint.enabled or options.redundant:
        content += f"<enabled>{str(joint.enabled).lower()}</enabled>"
    if joint.interpenetrate or options.redundant:
        content += f"<interpenetrate>{str(joint.interpenetrate).lower()}</interpenetrate>"
    linear, angular = columns["linear_limits"][row], columns["angular_limits"][row]
    degrees, exact = degrees_exactly(angular)
    # A fixed joint is what the defaults say (thesis 5.4).
    nothing = np.zeros((2, 3))
    limits = ""
    if options.redundant or not np.all(same_bits(angular, nothing)):
        limits += f"<swing_cone_and_twist>{_range(degrees)}</swing_cone_and_twist>"
    if options.redundant or not np.all(same_bits(linear, nothing)):
        limits += f"<linear>{_range(linear)}</linear>"
    if limits:
        content += f"<limits>{limits}</limits>"
    springs = ""
    angular_spring = columns["angular_springs"][row]
    if not np.all(same_bits(angular_spring, np.zeros(3))):
        # Per degree, as COLLADA has it.
        with np.errstate(over="ignore"):
            values = angular_spring * np.array([DEGREE, DEGREE, 1.0 / DEGREE])
        springs += f"<angular>{_spring(np.nan_to_num(values))}</angular>"
    if not np.all(same_bits(columns["linear_springs"][row], np.zeros(3))):
        springs += f"<linear>{_spring(columns['linear_springs'][row])}</linear>"
    if springs:
        content += f"<spring>{springs}</spring>"
    text = f"<technique_common>{content}</technique_common>" if content else "<technique_common/>"
    return text, bool(np.all(exact))


def _range(limits: Array) -> str:
    low, high = (floats_text(row) for row in limits.tolist())
    return f"<min>{low}</min><max>{high}</max>"


def _spring(values: Array, prefix: str = "") -> str:
    names = ("stiffness", "damping", "target_value")
    return "".join(
        f"<{prefix}{name}>{floats_text((value,))}</{prefix}{name}>"
        for name, value in zip(names, values.tolist(), strict=True)
    )


def _profile(
    joint: Joint,
    columns: dict[str, Array],
    row: int,
    exact: bool,
    planes: list[bool],
    options: WriteOptions,
) -> str:
    full = options.profile == "full"
    content = ""
    for side, name in enumerate(("frame1", "frame2")):
        orientation = columns["orientations"][row][side]
        frame = ""
        if full or planes[side]:
            numbers = floats_text(columns["positions"][row][side].tolist())
            frame = f"<pe:position>{numbers}</pe:position>"
        if full or planes[side] or not np.all(same_bits(orientation, _NO_TURN)):
            frame += f"<pe:orientation>{floats_text(orientation.tolist())}</pe:orientation>"
        if frame:
            content += f"<pe:{name}>{frame}</pe:{name}>"
    limits = {"angular": not exact, "linear": False}
    for name, needed in limits.items():
        if needed or full:
            low, high = columns[f"{name}_limits"][row].tolist()
            content += (
                f"<pe:{name}_limits><pe:min>{floats_text(low)}</pe:min>"
                f"<pe:max>{floats_text(high)}</pe:max></pe:{name}_limits>"
            )
    for name, always in (("angular", True), ("linear", full)):
        values = columns[f"{name}_springs"][row]
        if always and not np.all(same_bits(values, np.zeros(3))):
            content += f"<pe:{name}_spring>{_spring(values, 'pe:')}</pe:{name}_spring>"
    kind = attribute("kind", JointKind(joint.kind).name.lower())
    who = kind + identity(joint.uid, None, kept_name(joint.name))
    return f"<pe:joint{who}>{content}</pe:joint>" if content else f"<pe:joint{who}/>"
