"""What became of a World since its document was written: by system id, and to the last bit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.world import World
from colladaphy.world.columns import BODY_FIELDS, JOINT_FIELDS, MEMBER_FIELDS
from colladaphy.world.kinds import Kind
from colladaphy.world.materials import VALUES
from colladaphy.world.table import Table

__all__ = ["Differences", "differences", "same_material", "used_materials"]

Array = NDArray[Any]

_POSE = ("positions", "orientations")
_MOTION = ("linear_velocities", "angular_velocities", "forces", "torques", "sleeping")


@dataclass(slots=True)
class Differences:
    """System ids of bodies that are no members, of joints, and ids of materials."""

    gone: set[int] = field(default_factory=set)
    new: set[int] = field(default_factory=set)
    values: set[int] = field(default_factory=set)
    """Bodies that have become others: in shape, mass, material, name or members."""
    poses: set[int] = field(default_factory=set)
    motions: set[int] = field(default_factory=set)
    joints_gone: set[int] = field(default_factory=set)
    joints_new: set[int] = field(default_factory=set)
    joints_changed: set[int] = field(default_factory=set)
    scene: bool = False
    """Whether anything else differs: gravity, clock, counters, pairs of materials, engine."""

    def __bool__(self) -> bool:
        return self.scene or any((
            self.gone, self.new, self.values, self.poses, self.motions, self.joints_gone,
            self.joints_new, self.joints_changed,
        ))  # fmt: skip


def differences(before: World, after: World) -> Differences:
    """What differs between two Worlds, as `colladaphy.world.compare` does, but by what it means."""
    found = Differences()
    before.dimensions, after.dimensions, before.member_columns, after.member_columns  # noqa: B018
    meshes = _Meshes(before, after)
    _bodies(found, before, after, meshes)
    _members(found, before, after, meshes)
    _names(found, before, after)
    _materials(found, before, after)
    sids = _sids(before.joint_table), _sids(after.joint_table)
    found.joints_gone, found.joints_new = sids[0] - sids[1], sids[1] - sids[0]
    (found.joints_changed,) = _changed(before.joint_table, after.joint_table, [tuple(JOINT_FIELDS)])
    both = sids[0] & sids[1]
    found.joints_changed |= _differing(before.joint_names, after.joint_names) & both
    found.scene = _scene(before) != _scene(after)
    found.values -= found.gone | found.new
    return found


class _Meshes:
    """Which ids of meshes mean the same in two Worlds."""

    def __init__(self, before: World, after: World) -> None:
        self._worlds = before, after
        self._known: dict[tuple[int, int], bool] = {}

    def differ(self, first: Array, second: Array) -> Array:
        made = np.zeros(len(first), np.bool_)
        rows = np.flatnonzero((first >= 0) | (second >= 0))
        for row, pair in zip(rows.tolist(), zip(first[rows].tolist(), second[rows].tolist(),
                                                strict=True), strict=True):  # fmt: skip
            if pair not in self._known:
                one, other = (world.meshes.get(id) for world, id in
                              zip(self._worlds, pair, strict=True))  # fmt: skip
                self._known[pair] = one is other or (
                    one is not None and other is not None and one.same_as(other)
                )
            made[row] = not self._known[pair]
        return made


def _sids(table: Table) -> set[int]:
    return set(table.column("sids").tolist())


def _changed(
    before: Table, after: Table, groups: Sequence[tuple[str, ...]], meshes: _Meshes | None = None
) -> list[set[int]]:
    """System ids in both tables of which some of the columns differ, by groups of columns."""
    one, other = before.column("sids"), after.column("sids")
    if np.array_equal(one, other):
        common = one
        rows: tuple[Any, Any] = (slice(None), slice(None))
    else:
        common, *found = np.intersect1d(one, other, assume_unique=True, return_indices=True)
        rows = (found[0], found[1])
    result = []
    for group in groups:
        differ = np.zeros(len(common), np.bool_)
        for name in group:
            first, second = before.column(name)[rows[0]], after.column(name)[rows[1]]
            if name == "mesh_ids" and meshes is not None:
                differ |= meshes.differ(first, second)
                continue
            if first.dtype == np.float64:
                first = np.ascontiguousarray(first).view(np.int64)
                second = np.ascontiguousarray(second).view(np.int64)
            differ |= (first != second).any(axis=tuple(range(1, first.ndim)))
        result.append(set(common[differ].tolist()))
    return result


def _bodies(found: Differences, before: World, after: World, meshes: _Meshes) -> None:
    one, other = _sids(before.top), _sids(after.top)
    found.gone, found.new = one - other, other - one
    values = tuple(name for name in BODY_FIELDS if name not in (*_POSE, *_MOTION))
    found.values, found.poses, found.motions = _changed(
        before.top, after.top, [values, _POSE, _MOTION], meshes
    )
    # The anchor and the orientation of a plane are values of its shape.
    planes = set(after.sids[after.kinds == Kind.PLANE].tolist())
    found.values |= found.poses & planes
    found.poses -= planes


def _members(found: Differences, before: World, after: World, meshes: _Meshes) -> None:
    one, other = _sids(before.inner), _sids(after.inner)
    changed = _changed(before.inner, after.inner, [tuple(MEMBER_FIELDS)], meshes)[0]
    changed |= (one - other) | (other - one)
    changed |= _differing(before.children, after.children)
    for sid in changed:
        for world in (before, after):
            if sid in world:
                found.values.add(world.root_of(sid))


def _names(found: Differences, before: World, after: World) -> None:
    for sid in _differing(before.names, after.names):
        if sid in before and sid in after:
            found.values.add(after.root_of(sid))


def _differing(before: dict[int, Any], after: dict[int, Any]) -> set[int]:
    if before == after:
        return set()
    return {key for key in before.keys() | after.keys() if before.get(key) != after.get(key)}


def used_materials(world: World) -> Array:
    """The ids of the materials that bodies have, ascending."""
    ids = np.union1d(world.material_ids, world.member_columns.material_ids)
    return ids[ids >= 0]


def _materials(found: Differences, before: World, after: World) -> None:
    """Bodies whose material has other values under the same id."""
    changed = [id for id in used_materials(after).tolist()
               if id not in before.materials or not same_material(before, after, id)]  # fmt: skip
    if not changed:
        return
    tops = after.top.column("sids")[np.isin(after.material_ids, changed)]
    found.values.update(tops.tolist())
    inner = after.member_columns
    assert inner.sids is not None and inner.material_ids is not None
    for sid in inner.sids[np.isin(inner.material_ids, changed)].tolist():
        found.values.add(after.root_of(sid))


def same_material(before: World, after: World, id: int) -> bool:
    """Whether an id is that of a material of the same name and values in two Worlds."""
    one, other = before.materials[id], after.materials[id]
    return one.name == other.name and all(
        getattr(one, name).hex() == getattr(other, name).hex() for name in VALUES
    )


def _scene(world: World) -> list[Any]:
    """Everything else that a World is."""
    used = set(used_materials(world).tolist())
    step = world.time_step
    return [
        world.name, world.unit_name, world.gravity.tobytes(), None if step is None else step.hex(),
        world.time.hex(), world.step_count, world.next_body_sid, world.next_joint_sid,
        world.engine_state,
        [pair for pair in world.pair_overrides if {pair.first, pair.second} <= used],
    ]  # fmt: skip
