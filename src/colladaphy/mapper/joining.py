"""Putting a World that was loaded into one that is there already (thesis 5.3, 6.1).

System ids are kept where they are free, and their order always; materials are shared where their
values are the same, and get another name where theirs is taken.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.links.resource import Resource
from colladaphy.mapper import rules
from colladaphy.mapper.loading.creation import free_ids
from colladaphy.mapper.loading.materials import unique_name
from colladaphy.world import World
from colladaphy.world.columns import BODY_FIELDS, MEMBER_FIELDS
from colladaphy.world.joints import JOINT_FIELDS
from colladaphy.world.materials import VALUES

__all__ = ["join", "join_joints"]


Array = NDArray[Any]


def join(world: World, fresh: World, document: Resource) -> dict[int, int]:
    """Move everything of `fresh` into `world`, which keeps its own gravity and clock.

    Returns the system ids of the bodies there, by those in `fresh`.
    """
    materials = _materials(world, fresh, document)
    meshes = {
        id: world.add_mesh(mesh.vertices, mesh.faces, convex=mesh.convex).id
        for id, mesh in sorted(fresh.meshes.items())
    }
    old = [*fresh.top.column("sids").tolist(), *fresh.inner.column("sids").tolist()]
    order = sorted(old)
    taken = [*world.top.column("sids").tolist(), *world.inner.column("sids").tolist()]
    ids = dict(zip(order, free_ids(order, taken), strict=True))
    moved = sum(1 for sid, new in ids.items() if sid != new)
    if moved:
        message = f"{moved} of {len(ids)} bodies got new system ids, in the same order."
        document.note(rules.SYSTEM_ID_TAKEN, message=message)
    lookup = np.vectorize(ids.__getitem__, otypes=[np.int64])
    for source, target, fields in (
        (fresh.top, world.top, BODY_FIELDS),
        (fresh.inner, world.inner, MEMBER_FIELDS),
    ):
        if not len(source):
            continue
        values = {name: source.column(name) for name in fields}
        values["material_ids"] = _renamed(values["material_ids"], materials)
        values["mesh_ids"] = _renamed(values["mesh_ids"], meshes)
        if "parents" in values:
            values["parents"] = lookup(values["parents"])
        target.extend(lookup(source.column("sids")), values)
    for sid, members in fresh.children.items():
        world.children[ids[sid]] = tuple(ids[member] for member in members)
    for sid, name in fresh.names.items():
        world.names[ids[sid]] = name
    world.next_body_sid = max(world.next_body_sid, max(ids.values(), default=0) + 1)
    values = {name: fresh.joint_table.column(name) for name in JOINT_FIELDS}
    values["bodies"] = _renamed(values["bodies"].reshape(-1), {0: 0, **ids}).reshape(-1, 2)
    old = fresh.joint_table.column("sids").tolist()
    join_joints(world, old, values, fresh.joint_names, document)
    return ids


def _materials(world: World, fresh: World, document: Resource) -> dict[int, int]:
    """The ids of the fresh World's materials in the old one."""
    used = set(np.unique(fresh.top.column("material_ids")).tolist())
    used |= set(np.unique(fresh.inner.column("material_ids")).tolist())
    ids = {-1: -1}
    for material in fresh.materials:
        if material.id not in used:
            continue
        values = {name: getattr(material, name) for name in VALUES}
        if material.name in world.materials:
            same = world.materials[material.name]
            if all(getattr(same, name) == value for name, value in values.items()):
                ids[material.id] = same.id
                continue
        name = unique_name(material.name, world.materials)
        if name != material.name:
            message = f"There is another material {material.name!r}; this one is called {name!r}."
            document.note(rules.MATERIAL_RENAMED, message=message)
        id = None if material.id in world.materials else material.id
        ids[material.id] = world.create_material(name, id=id, **values).id
    for pair in fresh.pair_overrides:
        if pair.first in ids and pair.second in ids:
            world.set_pair(
                ids[pair.first],
                ids[pair.second],
                pair.restitution,
                pair.static_friction,
                pair.dynamic_friction,
            )
    return ids


def _renamed(column: Array, ids: dict[int, int]) -> Array:
    known, where = np.unique(column, return_inverse=True)
    renamed = np.array([ids.get(id, id) for id in known.tolist()], dtype=np.int64)
    return np.asarray(renamed[where])


def join_joints(
    world: World, old: list[int], values: dict[str, Array], names: Mapping[int, str],
    document: Resource,
) -> None:  # fmt: skip
    """Add joints whose columns name bodies of `world`; `old` are the ids that they had."""
    if not old:
        return
    new = dict(zip(old, free_ids(old, world.joint_table.column("sids").tolist()), strict=True))
    moved = sum(1 for sid, other in new.items() if sid != other)
    if moved:
        message = f"{moved} of {len(new)} joints got new system ids, in the same order."
        document.note(rules.SYSTEM_ID_TAKEN, message=message)
    world.joint_table.extend(np.array(list(new.values()), dtype=np.int64), values)
    for sid, pair in zip(new.values(), values["bodies"].tolist(), strict=True):
        for body in pair:
            if body:
                world.joints_of.setdefault(body, []).append(sid)
    for sid, name in names.items():
        if sid in new:
            world.joint_names[new[sid]] = name
    world.next_joint_sid = max(world.next_joint_sid, max(new.values()) + 1)
