"""One number for all that a World holds: equal for equal Worlds, in every process."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from dataclasses import astuple, fields
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from colladaphy.world import World

__all__ = ["digest"]


def digest(world: World) -> str:
    """The sha256, in hexadecimal digits, of the content of `world`.

    Covers what `colladaphy.world.compare` compares, bit by bit, but neither the engine's own state
    nor materials that nothing uses. Meshes count by their content, not by their ids.
    """
    total = hashlib.sha256()
    for name, value in _parts(world):
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
    return total.hexdigest()


def _parts(world: World) -> Iterable[tuple[str, Any]]:
    yield "name", world.name
    yield "unit", (world.unit_name, world.unit_meter)
    yield "up_axis", world.up_axis
    yield "gravity", world.gravity
    yield "clock", (world.time_step, world.time, world.step_count)
    bodies, members = world.columns(), world.member_columns
    for prefix, columns in (("body", bodies), ("member", members)):
        for field in fields(columns):
            value = getattr(columns, field.name)
            if isinstance(value, np.ndarray) and field.name != "mesh_ids":
                yield f"{prefix}.{field.name}", value
    mesh_ids = np.concatenate([np.asarray(bodies.mesh_ids), np.asarray(members.mesh_ids)])
    used, order = np.unique(mesh_ids, return_inverse=True)
    contents = [_mesh(world, int(id)) for id in used]
    yield "meshes", [contents[index] for index in order.tolist()]
    yield "names", sorted(world.names.items())
    yield "children", sorted(world.children.items())
    for name, column in sorted(world.joints.columns().items()):
        yield f"joint.{name}", column
    yield "joint names", sorted(world.joints.names.items())
    yield from _materials(world)


def _mesh(world: World, id: int) -> str | None:
    if id < 0:
        return None
    mesh = world.meshes[id]
    content = hashlib.sha256(f"{mesh.convex} {mesh.vertices.shape} {mesh.faces.shape}".encode())
    content.update(mesh.vertices.astype("<f8").tobytes())
    content.update(mesh.faces.astype("<i8").tobytes())
    return content.hexdigest()


def _materials(world: World) -> Iterable[tuple[str, Any]]:
    overrides = world.pair_overrides
    ids = {id for override in overrides for id in (override.first, override.second)}
    for columns in (world.columns(), world.member_columns):
        ids.update(np.unique(np.asarray(columns.material_ids)).tolist())
    yield "materials", [astuple(world.materials[id]) for id in sorted(ids) if id >= 0]
    yield "pairs", [astuple(override) for override in overrides]
