"""Two Worlds compared bit by bit."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.world.columns import BODY_FIELDS, MEMBER_FIELDS
from colladaphy.world.materials import VALUES
from colladaphy.world.world import World

__all__ = ["compare"]

_MOST = 10  # differences named per column; the rest are counted


def compare(first: World, second: World, *, unused_materials: bool = False) -> list[str]:
    """Every difference between two Worlds, one line each; an empty list if there is none.

    Floats are equal if their bits are: zeros of different sign differ, a NaN equals itself.
    Meshes are compared by content, whatever their ids. Materials that no body has are left out,
    with their pairs, unless asked for: a file does not keep them (thesis 5.4).
    """
    found: list[str] = []
    for name in ("name", "unit_name", "up_axis", "step_count", "next_body_sid", "next_joint_sid",
                 "engine_state"):  # fmt: skip
        _values(found, name, getattr(first, name), getattr(second, name))
    for name in ("gravity", "unit_meter", "time_step", "time"):
        _values(found, name, _bits(getattr(first, name)), _bits(getattr(second, name)))
    _columns(found, "body", _top(first), _top(second))
    _columns(found, "member", _inner(first), _inner(second))
    _columns(found, "joint", first.joints.columns(), second.joints.columns())
    _mappings(found, "name of body", first.names, second.names)
    _mappings(found, "name of joint", first.joint_names, second.joint_names)
    _mappings(found, "members of union", first.children, second.children)
    _meshes(found, first, second)
    _materials(found, first, second, unused_materials)
    return found


def _bits(value: Any) -> Any:
    return value if value is None else [number.hex() for number in np.atleast_1d(value).tolist()]


def _values(found: list[str], what: str, first: Any, second: Any) -> None:
    if first != second:
        found.append(f"{what}: {first!r} and {second!r}")


def _mappings(found: list[str], what: str, first: Mapping[Any, Any], second: Any) -> None:
    if first == second:
        return
    for key in sorted(first.keys() | second.keys()):
        _values(found, f"{what} {key}", first.get(key), second.get(key))


def _top(world: World) -> dict[str, NDArray[Any]]:
    names: Iterable[str] = (name for name in BODY_FIELDS if name != "mesh_ids")
    return {name: getattr(world, name) for name in ("sids", *names)}


def _inner(world: World) -> dict[str, NDArray[Any]]:
    columns = world.member_columns
    names: Iterable[str] = (name for name in MEMBER_FIELDS if name != "mesh_ids")
    return {name: getattr(columns, name) for name in ("sids", *names)}


def _columns(
    found: list[str], what: str, first: dict[str, NDArray[Any]], second: dict[str, NDArray[Any]]
) -> None:
    sids = first["sids"]
    if not np.array_equal(sids, second["sids"]):
        here, there = set(sids.tolist()), set(second["sids"].tolist())
        found.append(
            f"system ids, {what}: {len(here)} and {len(there)}, "
            f"only in the first {sorted(here - there)[:_MOST]}, "
            f"only in the second {sorted(there - here)[:_MOST]}"
        )
        return
    for name, column in first.items():
        other = second[name]
        if column.dtype == np.float64:
            same = np.ascontiguousarray(column).view(np.int64) == np.ascontiguousarray(other).view(
                np.int64
            )
        else:
            same = column == other
        rows = np.flatnonzero(~same.all(axis=tuple(range(1, same.ndim))))
        found.extend(
            f"{what} {sids[row]}, {name}: {column[row].tolist()!r} and {other[row].tolist()!r}"
            for row in rows[:_MOST].tolist()
        )
        if len(rows) > _MOST:
            found.append(f"{what}, {name}: {len(rows) - _MOST} more")


def _meshes(found: list[str], first: World, second: World) -> None:
    for table, what in (("top", "body"), ("inner", "member")):
        one, two = getattr(first, table), getattr(second, table)
        sids = one.column("sids")
        if not np.array_equal(sids, two.column("sids")):
            continue
        ids = np.stack([one.column("mesh_ids"), two.column("mesh_ids")], axis=1)
        rows = np.any(ids != -1, axis=1)
        equal: dict[tuple[int, ...], bool] = {}
        for sid, pair in zip(sids[rows].tolist(), map(tuple, ids[rows].tolist()), strict=True):
            if pair not in equal:
                a, b = first.meshes.get(pair[0]), second.meshes.get(pair[1])
                equal[pair] = a is not None and b is not None and a.same_as(b)
            if not equal[pair]:
                found.append(f"{what} {sid}: its mesh differs")


def _materials(found: list[str], first: World, second: World, unused: bool) -> None:
    used = _used(first) | _used(second)
    chosen = [
        [id for id in world.materials.ids.tolist() if unused or id in used]
        for world in (first, second)
    ]
    names = [
        {id: world.materials.names[id] for id in ids}
        for world, ids in zip((first, second), chosen, strict=True)
    ]
    _mappings(found, "name of material", names[0], names[1])
    common = np.array(sorted(names[0].keys() & names[1].keys()), dtype=np.int64)
    values = [
        {"sids": common, **{key: world.materials.values(key, common) for key in VALUES}}
        for world in (first, second)
    ]
    _columns(found, "material", values[0], values[1])
    pairs = [
        {
            (pair.first, pair.second): (
                _bits(pair.restitution), _bits(pair.static_friction), _bits(pair.dynamic_friction)
            )
            for pair in world.pair_overrides
            if unused or {pair.first, pair.second} <= used
        }
        for world in (first, second)
    ]  # fmt: skip
    _mappings(found, "pair of materials", pairs[0], pairs[1])


def _used(world: World) -> set[int]:
    tops = np.unique(world.material_ids).tolist()
    return set(tops) | set(np.unique(world.member_columns.material_ids).tolist())
