"""Which records are regular: recognised by the names of their elements, in order.

A document is schema-valid when it is loaded, so the order of names in a record tells where each of
them stands. A layout says at which place of a record its values are; records of any other form
are read by `bodies`, which understands everything.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from colladaphy.document.names import COLLADA, PE
from colladaphy.world.kinds import Kind

__all__ = ["BodyLayout", "InstanceLayout", "NodeLayout", "body_layout", "instance_layout",
           "node_layout"]  # fmt: skip

_BODY = re.compile(
    r"rigid_body technique_common (?P<dynamic>dynamic )?(?P<mass>mass )?"
    r"(?P<material>instance_physics_material )?"
    r"shape (?P<hollow>hollow )?(?P<shape_mass>mass )?"
    r"(?P<shape_material>instance_physics_material )?"
    r"(?P<geometry>sphere radius |box half_extents |capsule height radius |"
    r"cylinder height radius )(?P<turn>rotate )?(?P<profile>technique pe:body )?\Z"
)
_INSTANCE = re.compile(
    r"instance_rigid_body technique_common (?P<angular>angular_velocity )?"
    r"(?P<linear>velocity )?(?P<profile>technique pe:motion (?P<orientation>pe:orientation )?"
    r"(?P<exact>pe:angular_velocity )?)?\Z"
)
_NODE = re.compile(r"node (?P<translate>translate )?(?P<rotate>rotate )?\Z")

_KINDS = {
    "sphere": Kind.SPHERE,
    "box": Kind.BOX,
    "capsule": Kind.CAPSULE,
    "cylinder": Kind.CYLINDER,
}
_PREFIXES = {COLLADA: "", PE: "pe:"}


def _match(pattern: re.Pattern[str], tags: tuple[object, ...]) -> re.Match[str] | None:
    names = []
    for tag in tags:
        if not isinstance(tag, str):
            return None
        namespace, _, name = tag[1:].partition("}")
        names.append(_PREFIXES.get(namespace, "?:") + name)
    return pattern.match(" ".join(names) + " ")


def _place(match: re.Match[str], group: str, offset: int = 0) -> int:
    """The number of the element that a group matched, -1 for none."""
    start = match.start(group)
    return -1 if start < 0 else match.string.count(" ", 0, start) + offset


@dataclass(frozen=True, slots=True)
class BodyLayout:
    """Places of the values of a rigid_body among its elements, -1 for none."""

    kind: Kind
    dynamic: int
    mass: int
    material: int
    hollow: int
    geometry: int
    """The first value of the geometry; that of the radius follows a height."""
    turn: int
    profile: int
    """The technique; the pe:body follows it."""


def body_layout(tags: tuple[object, ...]) -> BodyLayout | None:
    """The layout of a rigid_body with one primitive, a mass and a material; else None."""
    match = _match(_BODY, tags)
    if match is None:
        return None
    kind = _KINDS[match["geometry"].split()[0]]
    mass, material = _place(match, "mass"), _place(match, "material")
    mass = _place(match, "shape_mass") if mass < 0 else mass
    material = _place(match, "shape_material") if material < 0 else material
    turn = _place(match, "turn")
    if mass < 0 or material < 0 or (turn >= 0 and kind in (Kind.SPHERE, Kind.BOX)):
        return None
    if kind is Kind.CYLINDER and turn < 0:
        return None
    return BodyLayout(
        kind,
        _place(match, "dynamic"),
        mass,
        material,
        _place(match, "hollow"),
        _place(match, "geometry", 1),
        turn,
        _place(match, "profile"),
    )


@dataclass(frozen=True, slots=True)
class InstanceLayout:
    """Places of the values of an instance_rigid_body, -1 for none."""

    angular: int
    linear: int
    profile: int
    orientation: int
    exact: int


def instance_layout(tags: tuple[object, ...]) -> InstanceLayout | None:
    """The layout of an instance that says only how the body moves; else None."""
    match = _match(_INSTANCE, tags)
    if match is None:
        return None
    return InstanceLayout(
        _place(match, "angular"),
        _place(match, "linear"),
        _place(match, "profile"),
        _place(match, "orientation"),
        _place(match, "exact"),
    )


@dataclass(frozen=True, slots=True)
class NodeLayout:
    """Places of the transforms of a node, -1 for none."""

    translate: int
    rotate: int


def node_layout(tags: tuple[object, ...]) -> NodeLayout | None:
    """The layout of a node that is moved, then turned, and holds nothing; else None."""
    match = _match(_NODE, tags)
    if match is None:
        return None
    return NodeLayout(_place(match, "translate"), _place(match, "rotate"))
