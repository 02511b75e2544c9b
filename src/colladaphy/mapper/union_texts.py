"""Unions as text: their shapes flattened for everybody, their order and exact poses for pe.

The common profile knows no union of unions, so all primitives stand in one rigid_body, each at
its pose in the outermost union (thesis 4.3). The pe profile holds the tree; its shapes stand for
those of the common profile in their order, and repeat only what those do not say exactly.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.document.poses import Pose, rotate_vector
from colladaphy.mapper.body_texts import (
    ShapeTexts,
    identity,
    inertia_text,
    rotation_texts,
)
from colladaphy.mapper.numbers import float_text, floats_text, same_bits
from colladaphy.world import rotations
from colladaphy.world.columns import MEMBER_FIELDS
from colladaphy.world.kinds import Kind

if TYPE_CHECKING:
    from colladaphy.mapper.options import WriteOptions
    from colladaphy.world import World

__all__ = ["UnionTexts", "mass_frame"]

Array = NDArray[Any]

_NO_TURN = np.array([1.0, 0.0, 0.0, 0.0])


class UnionTexts:
    """Writes the unions of a World, one by one."""

    def __init__(self, world: World, options: WriteOptions) -> None:
        self._world = world
        self._options = options
        members = world.member_columns
        self._columns = {name: getattr(members, name) for name in ("sids", *MEMBER_FIELDS)}
        self._rows = {sid: row for row, sid in enumerate(self._columns["sids"].tolist())}
        self._poses: dict[int, Pose] = {}
        planes: dict[int, tuple[float, ...]] = {}
        for sid, children in world.children.items():
            if sid not in self._rows:
                self._place(children, Pose())
        for row in np.flatnonzero(self._columns["kinds"] == Kind.PLANE).tolist():
            planes[row] = _plane(self._poses[row])
        self._texts = ShapeTexts(world, self._columns, options, planes)
        self._leaf_mass = 0.0
        self.tessellated = self._texts.tessellated
        """The meshes that stand for primitives, by the ids of their geometries."""

    def _place(self, children: tuple[int, ...], outer: Pose) -> None:
        """Remember the pose of every member in its outermost union."""
        for sid in children:
            row = self._rows[sid]
            self._poses[row] = outer.then(self._own_pose(row))
            inner = self._world.children.get(sid)
            if inner is not None:
                self._place(inner, self._poses[row])

    def _own_pose(self, row: int) -> Pose:
        position = self._columns["positions"][row]
        orientation = self._columns["orientations"][row]
        x, y, z = position.tolist()
        a, b, c, d = rotations.normalize(orientation).tolist()
        stands = bool(np.all(same_bits(position, np.zeros(3))))
        unturned = bool(np.all(same_bits(orientation, _NO_TURN)))
        return Pose(None if stands else (x, y, z), None if unturned else (a, b, c, d))

    def shapes(self, sid: int) -> tuple[str, str, float]:
        """Shape elements, the members of the pe:union, and the sum of the shapes' masses."""
        shapes: list[str] = []
        self._leaf_mass = 0.0
        content = self._members(self._world.children[sid], shapes, outermost=True)
        return "".join(shapes), content, self._leaf_mass

    def _members(self, children: tuple[int, ...], shapes: list[str], *, outermost: bool) -> str:
        return "".join(self._member(sid, shapes, outermost=outermost) for sid in children)

    def _member(self, sid: int, shapes: list[str], *, outermost: bool) -> str:
        row = self._rows[sid]
        columns = self._columns
        inner = self._world.children.get(sid)
        who = identity(int(columns["uids"][row]), sid, self._world.names.get(sid))
        if inner is not None:
            values = f"<pe:mass>{float_text(float(columns['masses'][row]))}</pe:mass>"
            values += inertia_text(columns["inertias"][row]) + self._pose(row, position=True)
            content = self._members(inner, shapes, outermost=False)
            return f"<pe:union{who}>{values}{content}</pe:union>"
        self._leaf_mass += float(columns["masses"][row])
        kind = Kind(int(columns["kinds"][row]))
        shapes.append(self._texts.shape(row, self._steps(row, kind)))
        says_position = not outermost or kind in (Kind.MESH, Kind.PLANE)
        values = self._texts.values(row)
        values += self._pose(row, position=says_position or self._options.profile == "full")
        values += self._texts.profile_shape(row, None)
        return f"<pe:shape{who}>{values}</pe:shape>" if values else f"<pe:shape{who}/>"

    def _pose(self, row: int, *, position: bool) -> str:
        text = ""
        if position:
            numbers = floats_text(self._columns["positions"][row].tolist())
            text = f"<pe:position>{numbers}</pe:position>"
        orientation = self._columns["orientations"][row]
        if not np.all(same_bits(orientation, _NO_TURN)) or self._options.profile == "full":
            text += f"<pe:orientation>{floats_text(orientation.tolist())}</pe:orientation>"
        return text

    def _steps(self, row: int, kind: Kind) -> str:
        """Translate and rotate of a member in its rigid_body; a plane's equation has its own."""
        if kind is Kind.PLANE:
            return ""
        pose = self._poses[row]
        text = ""
        if pose.position is not None:
            text = f"<translate>{floats_text(pose.position)}</translate>"
        if pose.orientation is not None:
            text += rotation_texts(np.array([pose.orientation]))[0]
        return text


def _plane(pose: Pose) -> tuple[float, float, float, float]:
    """Normal and displacement of a plane member in the frame of the rigid_body."""
    a, b, c = rotate_vector(pose.rotation, (0.0, 0.0, 1.0))
    x, y, z = pose.translation
    return a, b, c, a * x + b * y + c * z


def mass_frame(inertia: Array) -> str:
    """Mass frame and principal moments of an inertia about the body's origin.

    COLLADA's inertia is diagonal, so the mass frame turns to the principal axes.
    """
    if not np.all(np.isfinite(inertia)) or not np.any(inertia):
        return ""
    symmetric = 0.5 * inertia + 0.5 * inertia.T
    if np.array_equal(symmetric, np.diag(np.diag(symmetric))):
        return f"<inertia>{floats_text(np.diag(symmetric).tolist())}</inertia>"
    scale = float(np.max(np.abs(symmetric)))
    moments, axes = np.linalg.eigh(symmetric / scale)
    if np.linalg.det(axes) < 0:
        axes[:, 2] = -axes[:, 2]
    turn = rotation_texts(rotations.from_matrix(axes)[None])[0]
    with np.errstate(over="ignore"):
        numbers = floats_text((moments * scale).tolist())
    return (
        f"<mass_frame><translate>0 0 0</translate>{turn}</mass_frame><inertia>{numbers}</inertia>"
    )
