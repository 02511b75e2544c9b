"""The pe profile as it is read: typed, and in either spelling.

Our own elements stand in a namespace and are checked by schema/pe-profile.xsd. The thesis writes
the same names without it (listings 3 to 5); those are read as COLLADA elements with a few more
children, and what does not fit is passed over.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

from lxml import etree

from colladaphy.document.names import PE, c, local_name, p
from colladaphy.document.nodes import floats_of, pose_of_steps, text_of
from colladaphy.document.poses import Pose, Quaternion, Vector, unit_quaternion

__all__ = ["ProfileBody", "ProfilePart", "pe_child", "read_profile_body", "techniques"]

_BODY = p("body")
_THESIS_PARTS = ("shape", "union")


@dataclass(slots=True)
class ProfilePart:
    """A shape or a union of the pe profile; None for what it does not say."""

    uid: int | None = None
    sid: int | None = None
    name: str | None = None
    fixed: bool | None = None
    hollow: bool | None = None
    mass: float | None = None
    inertia: tuple[float, ...] | None = None
    position: Vector | None = None
    orientation: Quaternion | None = None
    geometry: str | None = None
    """sphere, box, capsule, cylinder, ellipsoid or plane."""
    dimensions: tuple[float, ...] | None = None
    """As `colladaphy.world.shapes` lays them out."""
    anchor: Vector | None = None
    members: list[ProfilePart] | None = None
    thesis: etree._Element | None = None
    """A shape in the thesis's spelling: a COLLADA shape, complete in itself."""

    @property
    def pose(self) -> Pose:
        """The pose in the union, as far as it is said."""
        turn = None if self.orientation is None else unit_quaternion(self.orientation)
        return Pose(self.position, turn)

    def leaves(self) -> Iterable[ProfilePart]:
        """The shapes of a union, the outermost first, in their order."""
        if self.members is None:
            yield self
        else:
            for member in self.members:
                yield from member.leaves()


@dataclass(slots=True)
class ProfileBody(ProfilePart):
    """What the pe profile says of a rigid_body."""

    part: ProfilePart | None = field(default=None)
    """The shape or the union that the body is."""


def techniques(parent: etree._Element, *, extra: bool = False) -> Iterable[etree._Element]:
    """The techniques of the pe profile below `parent` (or below its extra elements)."""
    holders = parent.iterchildren(c("extra")) if extra else (parent,)
    for holder in holders:
        for technique in holder.iterchildren(c("technique")):
            if technique.get("profile") == "pe":
                yield technique


def pe_child(parent: etree._Element, name: str) -> etree._Element | None:
    """The element of the pe profile in the technique of `parent`."""
    tag = p(name)
    for technique in techniques(parent):
        found = technique.find(tag)
        if found is not None:
            return found
    return None


def read_profile_body(rigid_body: etree._Element) -> ProfileBody | None:
    """What the techniques of a rigid_body say, in our spelling or in the thesis's."""
    for technique in techniques(rigid_body):
        for child in technique:
            if child.tag == _BODY:
                return _body(child)
        thesis = _thesis_body(technique)
        if thesis is not None:
            return thesis
    return None


def numbers(element: etree._Element) -> tuple[float, ...]:
    """The numbers of an element's text."""
    return tuple(floats_of(element))


def vector(element: etree._Element) -> Vector:
    """Three numbers."""
    x, y, z = numbers(element)
    return x, y, z


def quaternion(element: etree._Element) -> Quaternion:
    """Four numbers."""
    w, x, y, z = numbers(element)
    return w, x, y, z


def boolean(element: etree._Element) -> bool:
    """xs:boolean; an element without text is true, the default of COLLADA's."""
    return (text_of(element).strip() or "true") in ("true", "1")


def _integer(element: etree._Element, name: str) -> int | None:
    value = element.get(name)
    return None if value is None else int(value)


def _fill(part: ProfilePart, element: etree._Element) -> ProfilePart:
    part.uid = _integer(element, "uid")
    part.sid = _integer(element, "sid")
    part.name = element.get("name")
    for child in element:
        match local_name(child.tag):
            case "fixed":
                part.fixed = boolean(child)
            case "hollow":
                part.hollow = boolean(child)
            case "mass":
                part.mass = numbers(child)[0]
            case "inertia":
                part.inertia = numbers(child)
            case "position":
                part.position = vector(child)
            case "orientation":
                part.orientation = quaternion(child)
    return part


def _body(element: etree._Element) -> ProfileBody:
    body = ProfileBody()
    _fill(body, element)
    for child in element:
        if child.tag == p("shape"):
            body.part = _shape(child)
        elif child.tag == p("union"):
            body.part = _union(child)
    return body


def _union(element: etree._Element) -> ProfilePart:
    union = _fill(ProfilePart(), element)
    union.members = []
    for child in element:
        if child.tag == p("shape"):
            union.members.append(_shape(child))
        elif child.tag == p("union"):
            union.members.append(_union(child))
    return union


def _shape(element: etree._Element) -> ProfilePart:
    shape = _fill(ProfilePart(), element)
    for child in element:
        name = local_name(child.tag)
        if name in ("sphere", "box", "capsule", "cylinder", "ellipsoid", "plane"):
            shape.geometry = name
            values = {local_name(value.tag): numbers(value) for value in child}
            shape.dimensions = _dimensions(name, values)
            anchor = values.get("anchor")
            shape.anchor = None if anchor is None else (anchor[0], anchor[1], anchor[2])
    return shape


def _dimensions(
    name: str, values: dict[str, tuple[float, ...]]
) -> tuple[float, float, float, float] | None:
    match name:
        case "sphere":
            return (*values["radius"], 0.0, 0.0, 0.0)  # type: ignore[return-value]
        case "box":
            x, y, z = values["lengths"]
            return x, y, z, 0.0
        case "ellipsoid":
            x, y, z = values["radii"]
            return x, y, z, 0.0
        case "capsule" | "cylinder":
            length = values["length"][0]
            if "radii" in values:
                x, y, z = values["radii"]
            else:
                x = y = z = values["radius"][0]
                x = x if name == "capsule" else 0.0
            return x, y, z, length
        case _:
            return plane_dimensions(values)


def plane_dimensions(
    values: dict[str, tuple[float, ...]],
) -> tuple[float, float, float, float] | None:
    """Normal and displacement of a plane of the profile; the anchor gives a missing one.

    None where the normal is missing, which then is that of the common profile.
    """
    normal = values.get("normal")
    if normal is None or len(normal) != 3:
        return None
    x, y, z = normal
    if "displacement" in values:
        return x, y, z, values["displacement"][0]
    if "anchor" not in values:
        return None
    a, b, d = values["anchor"]
    return x, y, z, x * a + y * b + z * d


# --- the thesis's spelling


def _thesis_body(technique: etree._Element) -> ProfileBody | None:
    parts = [child for child in technique if _is_thesis(child, _THESIS_PARTS)]
    ids = [child for child in technique if _is_thesis(child, _USER_IDS)]
    if not parts and not ids:
        return None
    body = ProfileBody()
    body.uid = _thesis_uid(technique)
    if parts:
        body.part = _thesis_part(parts[0])
        if body.uid is None:
            body.uid = body.part.uid
    return body


_USER_IDS = ("uid", "user_id", "userid", "UserID")


def _is_thesis(element: etree._Element, names: tuple[str, ...]) -> bool:
    tag = element.tag
    return isinstance(tag, str) and not tag.startswith(f"{{{PE}}}") and local_name(tag) in names


def _thesis_uid(parent: etree._Element) -> int | None:
    for child in parent:
        if _is_thesis(child, _USER_IDS):
            try:
                return int((child.text or "").strip())
            except ValueError:
                return None
    return None


def _thesis_part(element: etree._Element) -> ProfilePart:
    part = ProfilePart(uid=_thesis_uid(element), name=element.get("name"))
    if local_name(element.tag) == "union":
        part.members = [
            _thesis_part(child) for child in element if _is_thesis(child, _THESIS_PARTS)
        ]
        pose = pose_of_steps(in_collada_names(element))
        part.position, part.orientation = pose
    else:
        part.thesis = in_collada_names(element)
    return part


def in_collada_names(element: etree._Element) -> etree._Element:
    """A copy with every name in COLLADA's namespace, in which the thesis leaves them."""
    fresh = etree.Element(c(local_name(element.tag)))
    for name, value in element.items():
        fresh.set(name, value)
    fresh.text = element.text
    for child in element:
        if isinstance(child.tag, str):
            fresh.append(in_collada_names(child))
    return fresh
