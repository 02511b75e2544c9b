"""Regular bodies straight from the tree into columns, without an object for each.

One pass over a model, one over its instance, one over the scene's nodes; texts are collected per
field and become numbers together. What is not regular is left to `bodies`, and both ways give the
same World.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
from lxml import etree
from numpy.typing import NDArray

from colladaphy.document.names import c
from colladaphy.document.poses import quaternion_from_axis_angle
from colladaphy.mapper.bodies import system_id
from colladaphy.mapper.layouts import (
    BodyLayout,
    InstanceLayout,
    NodeLayout,
    body_layout,
    instance_layout,
    node_layout,
)
from colladaphy.mapper.numbers import DEGREE
from colladaphy.world.columns import BodyColumns
from colladaphy.world.kinds import Kind

if TYPE_CHECKING:
    from colladaphy.document import Document
    from colladaphy.mapper.instances import ModelInstance
    from colladaphy.mapper.materials import MaterialTable

__all__ = ["Nodes", "Rows", "columns_of", "read_rows"]

Array = NDArray[Any]
Layout = TypeVar("Layout")
Record = list[etree._Element]

_ZERO3 = "0 0 0"
_TRUE = ("true", "1")
_TURN_BACK = "0 0 1 -90"


def records(
    parent: etree._Element, tag: str, layout_of: Callable[[tuple[object, ...]], Layout | None]
) -> Iterator[tuple[Record, Layout | None]]:
    """Every child of a name with all its elements in order, and their layout."""
    layouts: dict[tuple[object, ...], Layout | None] = {}
    for child in parent.iterchildren(tag):
        elements = list(child.iter())
        tags = tuple([element.tag for element in elements])
        try:
            layout = layouts[tags]
        except KeyError:
            layout = layouts[tags] = layout_of(tags)
        yield elements, layout


class Nodes:
    """The plain nodes that stand directly in the visual scenes of a document, by id."""

    def __init__(self, document: Document) -> None:
        self._document = document
        self._places: dict[str, tuple[str | None, str | None]] | None = None

    def find(self, reference: str) -> tuple[str | None, str | None] | None:
        """Texts of translate and rotate of the node ``#id``; None for other nodes."""
        if self._places is None:
            self._places = self._read()
        return self._places.get(reference)

    def _read(self) -> dict[str, tuple[str | None, str | None]]:
        places: dict[str, tuple[str | None, str | None]] = {}
        root = self._document.tree.getroot()
        tag = c("node")
        for library in root.iterchildren(c("library_visual_scenes")):
            for scene in library.iterchildren(c("visual_scene")):
                layout: NodeLayout | None
                for elements, layout in records(scene, tag, node_layout):
                    name = elements[0].get("id")
                    if layout is not None and name is not None:
                        places["#" + name] = (
                            elements[layout.translate].text if layout.translate > 0 else None,
                            elements[layout.rotate].text if layout.rotate > 0 else None,
                        )
        return places


@dataclass(slots=True)
class Rows:
    """Regular bodies of one model instance, as they are collected: one entry a body."""

    elements: list[etree._Element] = field(default_factory=list)
    """The instance_rigid_body elements."""
    places: list[int] = field(default_factory=list)
    """Their places among all instances of the model."""
    bodies: list[etree._Element] = field(default_factory=list)
    sids: list[int | None] = field(default_factory=list)
    uids: list[int] = field(default_factory=list)
    names: list[str | None] = field(default_factory=list)
    kinds: list[int] = field(default_factory=list)
    dynamic: list[bool] = field(default_factory=list)
    hollow: list[bool] = field(default_factory=list)
    materials: list[int] = field(default_factory=list)
    masses: list[str] = field(default_factory=list)
    sizes: list[str] = field(default_factory=list)
    """The numbers of the geometry, padded to four."""
    positions: list[str] = field(default_factory=list)
    turns: list[str | None] = field(default_factory=list)
    """Axis and angle of the node."""
    linear: list[str] = field(default_factory=list)
    angular: list[str] = field(default_factory=list)
    orientations: dict[int, str] = field(default_factory=dict)
    """What the pe profile says, by row."""
    exact_angular: dict[int, str] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self.elements)


_SIZES = {
    Kind.SPHERE: "{0} 0 0 0",
    Kind.BOX: "{0} 0",
    Kind.CAPSULE: "{0} {1}",
    Kind.CYLINDER: "{0} {1} 0",
}


def read_rows(
    model: ModelInstance,
    nodes: Nodes,
    materials: MaterialTable,
) -> tuple[Rows, list[tuple[int, etree._Element]]]:
    """The regular bodies of a model instance, and the other instances with their places."""
    rows = Rows()
    others: list[tuple[int, etree._Element]] = []
    bodies = records(model.model, c("rigid_body"), body_layout)
    instances = records(model.element, c("instance_rigid_body"), instance_layout)
    urls: dict[str, int | None] = {}
    by_sid: dict[str, tuple[Record, BodyLayout | None]] | None = None
    record: tuple[Record, BodyLayout | None] | None
    for place, (elements, layout) in enumerate(instances):
        wanted = elements[0].get("body")
        if by_sid is None:
            record = next(bodies, None)
            if record is None or record[0][0].get("sid") != wanted:
                # The instances are in another order than the bodies.
                by_sid = {}
                again = records(model.model, c("rigid_body"), body_layout)
                for other in again:
                    by_sid.setdefault(other[0][0].get("sid", ""), other)
        if by_sid is not None:
            record = by_sid.get(wanted or "")
        if (
            layout is None
            or record is None
            or record[1] is None
            or not _add(rows, elements, layout, record[0], record[1], nodes, materials, urls, model)
        ):
            others.append((place, elements[0]))
        else:
            rows.places.append(place)
    return rows, others


def _add(
    rows: Rows,
    instance: Record,
    moves: InstanceLayout,
    body: Record,
    layout: BodyLayout,
    nodes: Nodes,
    materials: MaterialTable,
    urls: dict[str, int | None],
    model: ModelInstance,
) -> bool:
    """Collect one body; False where something about it is not regular after all."""
    where = nodes.find(instance[0].get("target", ""))
    if where is None:
        return False
    uid, sid = 0, None
    if layout.profile >= 0:
        profile = body[layout.profile + 1]
        if body[layout.profile].get("profile") != "pe" or profile.get("name") is not None:
            return False
        uid = int(profile.get("uid", "0"))
        stated = profile.get("sid")
        sid = int(stated) if stated is not None else None
        sid = sid or system_id(body[0].get("sid", ""), "Body")
    if moves.profile >= 0:
        if instance[moves.profile].get("profile") != "pe":
            return False
        if instance[moves.profile + 1].get("sleeping") is not None:
            return False
        if moves.orientation >= 0 and where[1] is None:
            return False
    if layout.turn >= 0 and body[layout.turn].text != _TURN_BACK:
        return False
    material = body[layout.material]
    url = material.get("url", "")
    if url not in urls:
        known = materials.record(material, model.model_document)
        urls[url] = None if known is None else materials.id_of(known)
    id = urls[url]
    if id is None:
        return False
    first = body[layout.geometry].text or ""
    if layout.kind in (Kind.SPHERE, Kind.BOX):
        size = _SIZES[layout.kind].format(first)
    else:
        size = _SIZES[layout.kind].format(first, body[layout.geometry + 1].text or "")
        # A capsule without height is an ellipsoid, which is not turned.
        is_flat = float(first) == 0.0
        if layout.kind is Kind.CAPSULE and is_flat == (layout.turn >= 0):
            return False
    row = len(rows.elements)
    name = body[0].get("name")
    rows.names.append(instance[0].get("name") if name is None else name)
    rows.elements.append(instance[0])
    rows.bodies.append(body[0])
    rows.sids.append(sid)
    rows.uids.append(uid)
    rows.kinds.append(layout.kind)
    rows.dynamic.append(_boolean(body, layout.dynamic, default=True))
    rows.hollow.append(_boolean(body, layout.hollow, default=False))
    rows.materials.append(id)
    rows.masses.append(body[layout.mass].text or "")
    rows.sizes.append(size)
    rows.positions.append(where[0] or _ZERO3)
    rows.turns.append(where[1])
    rows.linear.append(_text(instance, moves.linear))
    rows.angular.append(_text(instance, moves.angular))
    if moves.orientation >= 0:
        rows.orientations[row] = instance[moves.orientation].text or ""
    if moves.exact >= 0:
        rows.exact_angular[row] = instance[moves.exact].text or ""
    return True


def _text(record: Record, place: int) -> str:
    """The numbers at a place; an element without text has the standard's default, zero."""
    text = record[place].text if place >= 0 else None
    return text if text and not text.isspace() else _ZERO3


def _boolean(record: Record, place: int, *, default: bool) -> bool:
    if place < 0:
        return default
    text = (record[place].text or "").strip()
    return text in _TRUE or not text


def floats(texts: list[str], width: int) -> Array:
    """The numbers of texts, (n, width); ValueError where there are not so many."""
    values = np.fromstring(" ".join(texts), dtype=np.float64, sep=" ")
    if len(values) != width * len(texts):
        raise ValueError(f"there are {len(values)} numbers in {len(texts)} texts of {width}")
    return values.reshape(-1, width)


def columns_of(rows: Rows, prefer: str) -> tuple[BodyColumns, list[int]]:
    """The columns of the rows, and the rows whose pe profile may be older than the common one."""
    columns = BodyColumns(kinds=np.array(rows.kinds, dtype=np.int8))
    columns.uids = np.array(rows.uids, dtype=np.int64)
    columns.names = rows.names
    columns.masses = floats(rows.masses, 1)[:, 0]
    columns.fixed = ~np.array(rows.dynamic, dtype=np.bool_)
    columns.hollow = np.array(rows.hollow, dtype=np.bool_)
    columns.material_ids = np.array(rows.materials, dtype=np.int64)
    columns.positions = floats(rows.positions, 3)
    columns.linear_velocities = floats(rows.linear, 3)
    columns.angular_velocities = floats(rows.angular, 3) * DEGREE
    columns.kinds, columns.dimensions = _dimensions(columns.kinds, floats(rows.sizes, 4))
    columns.orientations, doubtful = _orientations(rows, prefer)
    if rows.exact_angular and prefer != "common":
        where = np.array(list(rows.exact_angular))
        exact = floats(list(rows.exact_angular.values()), 3)
        stated = columns.angular_velocities[where]
        with np.errstate(all="ignore"):
            size = np.maximum(np.abs(exact), np.abs(stated))
            same = np.all(np.abs(exact - stated) <= 4e-15 * size, axis=1)
        columns.angular_velocities[where] = exact
        doubtful += where[~same].tolist()
    return columns, sorted(set(doubtful))


def _dimensions(kinds: Array, sizes: Array) -> tuple[Array, Array]:
    """Kinds and dimensions as the World lays them out."""
    made = sizes.copy()
    boxes = kinds == Kind.BOX
    made[boxes] = 2.0 * sizes[boxes]
    capsules = kinds == Kind.CAPSULE
    flat = capsules & (sizes[:, 0] == 0.0)
    made[capsules] = sizes[capsules][:, [2, 1, 3, 0]]
    made[flat] = sizes[flat][:, [1, 2, 3, 0]]
    made[flat, 3] = 0.0
    cylinders = kinds == Kind.CYLINDER
    made[cylinders] = sizes[cylinders][:, [3, 1, 2, 0]]
    return np.where(flat, np.int8(Kind.ELLIPSOID), kinds), made


def _orientations(rows: Rows, prefer: str) -> tuple[Array, list[int]]:
    made = np.zeros((len(rows), 4))
    made[:, 0] = 1.0
    kept = {} if prefer == "common" else rows.orientations
    for row, turn in enumerate(rows.turns):
        if turn is not None and row not in kept:
            x, y, z, angle = map(float, turn.split())
            quaternion = quaternion_from_axis_angle(x, y, z, angle)
            if quaternion is not None:
                made[row] = quaternion
    if not kept:
        return made, []
    where = np.array(list(kept))
    exact = floats(list(kept.values()), 4)
    stated = floats([rows.turns[row] or "" for row in kept], 4)
    made[where] = exact
    return made, where[~_same_turns(exact, stated)].tolist()


def _same_turns(quaternions: Array, turns: Array) -> Array:
    """Where axes and angles in degrees are surely the same rotations as quaternions."""
    with np.errstate(all="ignore"):
        axes = turns[:, :3] / np.linalg.norm(turns[:, :3], axis=1, keepdims=True)
        half = 0.5 * DEGREE * turns[:, 3]
        made = np.column_stack([np.cos(half), axes * np.sin(half)[:, None]])
        unit = quaternions / np.linalg.norm(quaternions, axis=1, keepdims=True)
        distance = np.minimum(
            np.linalg.norm(unit - made, axis=1), np.linalg.norm(unit + made, axis=1)
        )
        return np.asarray(distance <= 3e-14)
