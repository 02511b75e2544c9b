"""The pe profile as the thesis prints it (listings 3 to 5), written as our schema has it.

The thesis writes the names of the profile without a namespace, and shapes as COLLADA has them. A
copy of the tree gets elements of the profile's namespace in their place, so that there is one
profile to read; what does not fit is left out.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from lxml import etree

from colladaphy.conform.trace import Trace
from colladaphy.source.copying import copy_tree

__all__ = ["in_our_spelling"]

_PE = "urn:colladaphy:pe:1"
_PARTS = ("shape", "union")
_USER_IDS = ("uid", "user_id", "userid", "UserID")
_MATERIAL = (
    "density", "poisson_ratio", "young_modulus", "stiffness", "damping_normal",
    "damping_tangential", "dynamic_friction", "restitution", "static_friction",
)  # fmt: skip
_HALF = math.sqrt(0.5)
_Y_TO_X = (_HALF, 0.0, 0.0, _HALF)

Quaternion = tuple[float, float, float, float]
Vector = tuple[float, float, float]


def in_our_spelling(
    tree: etree._ElementTree, trace: Trace | None = None
) -> etree._ElementTree | None:
    """A copy of a tree with the thesis's spelling replaced; None where there is none of it.

    `trace` is told where the elements of the copy come from.
    """
    if not any(_children(technique) for technique in _techniques(tree)):
        return None
    copy = copy_tree(tree)
    if trace is not None:
        trace.begin(copy.getroot())
    for technique in list(_techniques(copy)):
        if _children(technique):
            _rewrite(technique)
    return copy


def _techniques(tree: etree._ElementTree) -> Iterator[etree._Element]:
    for technique in tree.iter("{*}technique"):
        if technique.get("profile") == "pe":
            yield technique


def _children(technique: etree._Element) -> list[etree._Element]:
    """The elements of a technique that are not of the profile's namespace."""
    return [
        child for child in technique.iterchildren(etree.Element)
        if not str(child.tag).startswith(f"{{{_PE}}}")
    ]  # fmt: skip


def _name(element: etree._Element) -> str:
    return etree.QName(element).localname


def _rewrite(technique: etree._Element) -> None:
    children = _children(technique)
    parent = technique.getparent()
    within = "" if parent is None else _name(parent)
    made = None
    if within == "rigid_body":
        made = _body(children)
    elif within in ("extra", "physics_material"):
        made = _material(children)
    for child in children:
        technique.remove(child)
    if made is not None:
        technique.append(made)


def _element(name: str, text: str | None = None) -> etree._Element:
    element = etree.Element(f"{{{_PE}}}{name}", nsmap={"pe": _PE})
    element.text = text
    return element


def _numbers(element: etree._Element) -> list[float] | None:
    try:
        return [float(word) for word in (element.text or "").split()]
    except ValueError:
        return None


def _texts(values: tuple[float, ...] | list[float]) -> str:
    return " ".join(map(repr, values))


# --- materials


def _material(children: list[etree._Element]) -> etree._Element | None:
    holders = [child for child in children if _name(child) == "material"]
    content = list(holders[0].iterchildren(etree.Element)) if holders else children
    values = {}
    for child in content:
        numbers = _numbers(child)
        if _name(child) in _MATERIAL and numbers:
            values[_name(child)] = numbers[0]
    if not values and not holders:
        return None
    made = _element("material")
    if holders and holders[0].get("name") is not None:
        made.set("name", holders[0].get("name", ""))
    for name in _MATERIAL:
        if name in values:
            made.append(_element(name, repr(values[name])))
    return made


# --- bodies


def _body(children: list[etree._Element]) -> etree._Element | None:
    parts = [child for child in children if _name(child) in _PARTS]
    uid = _uid(children)
    if uid is None and parts:
        uid = _uid(list(parts[0].iterchildren(etree.Element)))
    part = _part(parts[0], alone=True) if parts else None
    if part is None and uid is None:
        return None
    made = _element("body")
    if uid is not None:
        made.set("uid", str(uid))
    if part is not None:
        made.append(part)
    return made


def _uid(children: list[etree._Element]) -> int | None:
    for child in children:
        if _name(child) in _USER_IDS:
            try:
                return int((child.text or "").strip())
            except ValueError:
                return None
    return None


def _part(element: etree._Element, *, alone: bool = False) -> etree._Element:
    children = list(element.iterchildren(etree.Element))
    made = _element(_name(element))
    uid = _uid(children)
    if uid is not None:
        made.set("uid", str(uid))
    if element.get("name") is not None:
        made.set("name", element.get("name", ""))
    if _name(element) == "union":
        _place(made, children, None)
        members = [_part(child) for child in children if _name(child) in _PARTS]
        for member in members:
            made.append(member)
        return made
    _shape(made, children, alone=alone)
    return made


def _shape(made: etree._Element, children: list[etree._Element], *, alone: bool) -> None:
    geometry = next((child for child in children if _name(child) in _GEOMETRIES), None)
    mass = next((child for child in children if _name(child) == "mass"), None)
    if mass is not None and not alone:
        made.append(_element("mass", mass.text))
    values = {} if geometry is None else {
        _name(child): numbers for child in geometry.iterchildren(etree.Element)
        if (numbers := _numbers(child))
    }  # fmt: skip
    described = None if geometry is None else _geometry(_name(geometry), values)
    if not alone and described is not None:
        if described[0] == "plane":
            _add_pose(made, *_plane_pose(described[1]))
        else:
            turn = _Y_TO_X if described[0] in ("capsule", "cylinder") else None
            _place(made, children, turn)
    if described is not None:
        made.append(_described(*described, values.get("anchor")))


_GEOMETRIES = ("sphere", "box", "capsule", "cylinder", "plane")


def _geometry(name: str, values: dict[str, list[float]]) -> tuple[str, list[float]] | None:
    """What a shape is and its numbers: radii, lengths, radii and length, or normal and place."""
    try:
        match name:
            case "sphere":
                radii = values["radius"]
                return ("sphere", radii[:1]) if len(set(radii)) == 1 else ("ellipsoid", radii[:3])
            case "box":
                return "box", [2.0 * value for value in values["half_extents"][:3]]
            case "capsule":
                x, y, z = _radii(values["radius"], 3)
                if values["height"][0] == 0.0:
                    return "ellipsoid", [x, y, z]
                return "capsule", [y, x, z, values["height"][0]]
            case "cylinder":
                x, z = _radii(values["radius"], 2)
                return "cylinder", [0.0, x, z, values["height"][0]]
            case _:
                return _plane(values)
    except (KeyError, ValueError, IndexError):
        return None


def _radii(values: list[float], count: int) -> list[float]:
    return values[:count] if len(values) >= count else values[:1] * count


def _plane(values: dict[str, list[float]]) -> tuple[str, list[float]] | None:
    if "normal" in values:
        x, y, z = values["normal"]
        if "displacement" in values:
            return "plane", [x, y, z, values["displacement"][0]]
        a, b, c = values["anchor"]
        return "plane", [x, y, z, x * a + y * b + z * c]
    x, y, z, constant = values["equation"]
    return "plane", [x, y, z, -constant]


def _plane_pose(plane: list[float]) -> tuple[Vector, Quaternion]:
    """Where a plane stands: z turned onto its normal, at the point next to the origin."""
    length = math.hypot(*plane[:3]) or 1.0
    x, y, z = (value / length for value in plane[:3])
    shift = plane[3] / length
    if z < -0.999999:
        return (x * shift, y * shift, z * shift), (0.0, 1.0, 0.0, 0.0)
    norm = math.sqrt((1.0 + z) ** 2 + x * x + y * y)
    return (x * shift, y * shift, z * shift), ((1.0 + z) / norm, -y / norm, x / norm, 0.0)


def _described(kind: str, numbers: list[float], anchor: list[float] | None) -> etree._Element:
    made = _element(kind)
    match kind:
        case "sphere":
            made.append(_element("radius", _texts(numbers)))
        case "box":
            made.append(_element("lengths", _texts(numbers)))
        case "ellipsoid":
            made.append(_element("radii", _texts(numbers)))
        case "plane":
            made.append(_element("normal", _texts(numbers[:3])))
            if anchor is not None and len(anchor) == 3:
                made.append(_element("anchor", _texts(anchor)))
            made.append(_element("displacement", repr(numbers[3])))
        case _:
            made.append(_element("radii", _texts(numbers[:3])))
            made.append(_element("length", repr(numbers[3])))
    return made


# --- poses


def _place(made: etree._Element, children: list[etree._Element], turn: Quaternion | None) -> None:
    """The pose of translate and rotate elements in their order, then a turn of the axis."""
    steps = [child for child in children if _name(child) in ("translate", "rotate")]
    if (
        turn is not None
        and steps
        and _name(steps[-1]) == "rotate"
        and (_numbers(steps[-1]) == [0.0, 0.0, 1.0, -90.0])
    ):
        steps, turn = steps[:-1], None
    position: Vector | None = None
    orientation: Quaternion | None = None
    for step in steps:
        numbers = _numbers(step)
        if _name(step) == "translate" and numbers is not None and len(numbers) == 3:
            moved: Vector = (numbers[0], numbers[1], numbers[2])
            moved = moved if orientation is None else _rotated(orientation, moved)
            x, y, z = position or (0.0, 0.0, 0.0)
            position = moved if position is None else (x + moved[0], y + moved[1], z + moved[2])
        elif _name(step) == "rotate" and numbers is not None and len(numbers) == 4:
            orientation = _turned(orientation, _quaternion(*numbers))
    if turn is not None:
        orientation = _turned(orientation, turn)
    _add_pose(made, position, orientation)


def _add_pose(
    made: etree._Element, position: Vector | None, orientation: Quaternion | None
) -> None:
    if position is not None:
        made.append(_element("position", _texts(position)))
    if orientation is not None:
        made.append(_element("orientation", _texts(orientation)))


def _quaternion(x: float, y: float, z: float, degrees: float) -> Quaternion | None:
    length = math.sqrt(x * x + y * y + z * z)
    if degrees == 0.0 or not 0.0 < length < math.inf or not math.isfinite(degrees):
        return None
    half = math.fmod(degrees, 720.0) * (math.pi / 180.0) * 0.5
    scale = math.sin(half) / length
    return math.cos(half), x * scale, y * scale, z * scale


def _turned(outer: Quaternion | None, inner: Quaternion | None) -> Quaternion | None:
    if outer is None or inner is None:
        return inner if outer is None else outer
    aw, ax, ay, az = outer
    bw, bx, by, bz = inner
    return (
        aw * bw - ax * bx - ay * by - az * bz,
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
    )


def _rotated(q: Quaternion, v: Vector) -> Vector:
    w, x, y, z = q
    tx = 2.0 * (y * v[2] - z * v[1])
    ty = 2.0 * (z * v[0] - x * v[2])
    tz = 2.0 * (x * v[1] - y * v[0])
    return (
        v[0] + w * tx + y * tz - z * ty,
        v[1] + w * ty + z * tx - x * tz,
        v[2] + w * tz + x * ty - y * tx,
    )
