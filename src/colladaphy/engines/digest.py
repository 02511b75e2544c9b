"""One number for all that a World holds: equal for equal Worlds, in every process."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from dataclasses import fields
from operator import attrgetter
from typing import TYPE_CHECKING, Any
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from colladaphy.world import Material, PairOverride

if TYPE_CHECKING:
    from colladaphy.world import World

__all__ = ["digest", "static_digest", "static_parts"]

_MOTION = ("linear_velocities", "angular_velocities", "forces", "torques", "sleeping")
_POSE = ("positions", "orientations")
_MATERIAL = attrgetter(*(field.name for field in fields(Material)))
_PAIR = attrgetter(*(field.name for field in fields(PairOverride)))


def digest(world: World, *, motion: bool = True) -> str:
    """The sha256, in hexadecimal digits, of the content of `world`.

    Covers what `colladaphy.world.compare` compares, bit by bit, but not the engine's own state.
    Without `motion`, what changes while a World runs is left out: the poses of bodies that are
    not fixed, velocities, forces, sleep and clock.
    """
    still = static_digest(world)
    if not motion:
        return still
    total = hashlib.sha256(still.encode("ascii"))
    for name, value in _motion(world):
        _add(total, name, value)
    return total.hexdigest()


def static_digest(world: World) -> str:
    """That of all that does not change while `world` runs; computed anew only if it did."""
    parts = static_parts(world)
    known = _KNOWN.get(world)
    if known is not None and known[0] == parts:
        return known[1]
    total = hashlib.sha256()
    for name, value in _static(world):
        _add(total, name, value)
    found = total.hexdigest()
    _KNOWN[world] = parts, found
    return found


_KNOWN: WeakKeyDictionary[World, tuple[list[Any], str]] = WeakKeyDictionary()


def static_parts(world: World) -> list[Any]:
    """Copies of all that does not change while `world` runs, to be compared as a whole."""
    parts: list[Any] = [
        world.name, world.unit_name, world.unit_meter, world.up_axis, world.gravity.tobytes(),
        world.time_step, dict(world.names), dict(world.children), dict(world.joint_names),
        dict(world.meshes),  # which never change themselves
        [_MATERIAL(material) for material in world.materials], list(world.pair_overrides),
    ]  # fmt: skip
    still = world.fixed
    for table, changing in ((world.top, _MOTION), (world.inner, ()), (world.joint_table, ())):
        for name, column in table.views({}).items():
            if column is None or name in changing:
                continue
            if table is world.top and name in _POSE:
                column = column[still]
            parts.append(column.tobytes())
    return parts


def _add(total: Any, name: str, value: Any) -> None:
    if isinstance(value, np.ndarray):
        array = np.ascontiguousarray(value)
        little = array.astype(array.dtype.newbyteorder("<"), copy=False)
        content = little.tobytes()
        kind = f"{little.dtype.str}{little.shape}"
    else:
        content = repr(value).encode("utf-8", "surrogatepass")
        kind = "repr"
    total.update(f"{name}:{kind}:{len(content)}\n".encode())
    total.update(content)


def _motion(world: World) -> Iterable[tuple[str, Any]]:
    yield "clock", (world.time, world.step_count)
    yield "counters", (world.next_body_sid, world.next_joint_sid)
    for name in (*_MOTION, *_POSE):
        yield name, getattr(world, name)


def _static(world: World) -> Iterable[tuple[str, Any]]:
    yield "name", world.name
    yield "unit", (world.unit_name, world.unit_meter)
    yield "up_axis", world.up_axis
    yield "gravity", world.gravity
    yield "time_step", world.time_step
    yield from _arrays(world)
    yield "meshes", _meshes(world)
    yield "names", sorted(world.names.items())
    yield "children", sorted(world.children.items())
    for name, column in sorted(world.joints.columns().items()):
        yield f"joint.{name}", column
    yield "joint names", sorted(world.joint_names.items())
    yield from _materials(world)


def _arrays(world: World) -> Iterable[tuple[str, NDArray[Any]]]:
    still = np.asarray(world.fixed)
    for prefix, columns in (("body", world.columns()), ("member", world.member_columns)):
        for name in sorted(columns.__slots__):
            value = getattr(columns, name)
            if not isinstance(value, np.ndarray) or name == "mesh_ids":
                continue
            if prefix == "body":
                if name in _MOTION:
                    continue
                if name in _POSE:
                    value = value[still]
            yield f"{prefix}.{name}", value


def _meshes(world: World) -> list[str | None]:
    """The content of the meshes, for each body and member: their ids mean nothing."""
    ids = np.concatenate([world.mesh_ids, world.member_columns.mesh_ids])
    used, order = np.unique(ids, return_inverse=True)
    contents = [_mesh(world, id) for id in used.tolist()]
    return [contents[index] for index in order.tolist()]


def _mesh(world: World, id: int) -> str | None:
    if id < 0:
        return None
    mesh = world.meshes[id]
    content = hashlib.sha256(f"{mesh.convex} {mesh.vertices.shape} {mesh.faces.shape}".encode())
    content.update(mesh.vertices.astype("<f8").tobytes())
    content.update(mesh.faces.astype("<i8").tobytes())
    return content.hexdigest()


def _materials(world: World) -> Iterable[tuple[str, Any]]:
    """The materials that are used, and their pairs: a file keeps no others (thesis 5.4)."""
    used = np.union1d(world.material_ids, world.member_columns.material_ids).tolist()
    yield "materials", [_MATERIAL(world.materials[id]) for id in used if id >= 0]
    pairs = [pair for pair in world.pair_overrides if pair.first in used and pair.second in used]
    yield "pairs", [_PAIR(pair) for pair in pairs]
