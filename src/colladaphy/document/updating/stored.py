"""Parts of a World as elements: what storing makes of some of its bodies and joints."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

import numpy as np
from lxml import etree
from numpy.typing import NDArray

from colladaphy.columns.writing import document_bytes
from colladaphy.links.names import c
from colladaphy.mapper import WriteOptions
from colladaphy.mapper.storing import columns_of, motion_columns, world_columns
from colladaphy.world import World
from colladaphy.world.columns import BODY_FIELDS, JOINT_FIELDS, MEMBER_FIELDS

__all__ = ["Stored", "stored_motions", "stored_scene"]

Array = NDArray[Any]


class Stored:
    """Bodies and joints as `colladaphy.mapper.store` writes them, by system id."""

    def __init__(
        self, world: World, bodies: Collection[int], joints: Collection[int], options: WriteOptions
    ) -> None:
        root = _parsed(columns_of(_part(world, bodies, joints), options))
        self.rigid_bodies = _by_number(root, "rigid_body", "sid", "Body")
        self.instances = _by_number(root, "instance_rigid_body", "body", "Body")
        self.nodes = _by_number(root, "node", "id", "Node")
        self.constraints = _by_number(root, "rigid_constraint", "sid", "Joint")
        self.materials = _by_number(root, "physics_material", "id", "Material")
        self.geometries = {element.get("id", ""): element for element in root.iter(c("geometry"))}


def stored_motions(world: World, sids: Array, options: WriteOptions) -> list[etree._Element]:
    """The instance_rigid_body elements of bodies (n,), which say how they move."""
    if not len(sids):
        return []
    rows = np.searchsorted(world.sids, sids)
    root = _parsed(motion_columns(world, rows, options))
    return list(root.iter(c("instance_rigid_body")))


def stored_scene(world: World, options: WriteOptions) -> etree._Element:
    """The physics_scene without what it instances: gravity, time step and the pe:world."""
    return next(_parsed(world_columns(world, options)).iter(c("physics_scene")))


def _parsed(columns: Any) -> etree._Element:
    parser = etree.XMLParser(resolve_entities=False, no_network=True, huge_tree=True,
                             remove_blank_text=True)  # fmt: skip
    return etree.fromstring(document_bytes(columns), parser)


def _by_number(root: etree._Element, name: str, key: str, prefix: str) -> dict[int, etree._Element]:
    return {
        int(element.get(key, "").removeprefix(prefix)): element for element in root.iter(c(name))
        if element.get(key, "").removeprefix(prefix).isdigit()
    }  # fmt: skip


def _part(world: World, bodies: Collection[int], joints: Collection[int]) -> World:
    """Some bodies with their members, and some joints with the bodies at their ends."""
    part = World(world.gravity, unit=(world.unit_name, world.unit_meter), up_axis=world.up_axis)
    storage = vars(part)["_storage"]
    storage.materials, storage.meshes = world.materials, world.meshes
    storage.names, storage.joint_names = world.names, world.joint_names
    chosen = np.isin(world.joint_table.column("sids"), sorted(joints))
    ends = world.joint_table.column("bodies")[chosen].reshape(-1)
    tops = sorted({*bodies, *ends[ends != 0].tolist()})
    world.dimensions, world.member_columns  # noqa: B018 - brings moved planes up to date
    _copy(world.top, part.top, np.isin(world.sids, tops), BODY_FIELDS)
    inside: set[int] = set()
    for top in tops:
        waiting = [top] if top in world.children else []
        while waiting:
            union = waiting.pop()
            part.children[union] = members = world.children[union]
            inside.update(members)
            waiting += [member for member in members if member in world.children]
    _copy(world.inner, part.inner, np.isin(world.inner.column("sids"), sorted(inside)),
          MEMBER_FIELDS)  # fmt: skip
    _copy(world.joint_table, part.joint_table, chosen, JOINT_FIELDS)
    return part


def _copy(source: Any, target: Any, rows: Array, fields: Any) -> None:
    target.extend(source.column("sids")[rows], {name: source.column(name)[rows] for name in fields})
