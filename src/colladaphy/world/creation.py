"""From columns that a caller gives to complete, checked columns of primitives."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.world import rotations
from colladaphy.world.columns import BODY_FIELDS, BodyColumns
from colladaphy.world.kinds import Kind
from colladaphy.world.materials import Materials
from colladaphy.world.meshes import Mesh
from colladaphy.world.rules import (
    COLUMNS,
    DIMENSION,
    INERTIA,
    MASS,
    MATERIAL_UNKNOWN,
    MESH,
    NUMBER,
    refuse,
)
from colladaphy.world.shapes import COUNTS, NEEDED, solid_inertia, solid_volume
from colladaphy.world.surfaces import hollow_moments

__all__ = ["mass_and_inertia", "prepare", "prepare_one"]

Array = NDArray[Any]

_PLANE, _MESH = int(Kind.PLANE), int(Kind.MESH)  # numpy is slow to compare with an enumeration

_NO_MASS = "Volume times density is out of the range of numbers."
_NO_INERTIA = "The inertia of a shape is out of the range of numbers."
_DEFAULTS: Mapping[str, float] = {"mesh_ids": -1}
_FINITE = ("positions", "orientations", "linear_velocities", "angular_velocities", "forces",
           "torques")  # fmt: skip


def prepare(
    columns: BodyColumns, materials: Materials, meshes: Mapping[int, Mesh]
) -> dict[str, Array]:
    """Complete and check columns of primitives (all but the system ids and names)."""
    kinds = np.asarray(columns.kinds)
    if kinds.ndim != 1:
        raise refuse(COLUMNS, "The column kinds has one number a body.")
    if len(kinds) and (kinds.min() < 0 or kinds.max() >= Kind.UNION):
        raise refuse(COLUMNS, "Only primitives are made from columns; unions join them later.")
    count = len(kinds)
    values: dict[str, Array] = {}
    for name, (dtype, shape) in BODY_FIELDS.items():
        given = getattr(columns, name)
        if given is None:
            values[name] = np.full((count, *shape), _DEFAULTS.get(name, 0), dtype=dtype)
            continue
        array = np.asarray(given)
        if array.shape != (count, *shape):
            raise refuse(
                COLUMNS, f"The column {name} has the shape {array.shape}, not {(count, *shape)}."
            )
        values[name] = array.astype(dtype, copy=False)
    for name in _FINITE:
        if not np.all(np.isfinite(values[name])):
            raise refuse(NUMBER, f"The column {name} holds numbers that are not finite.")
    _check_dimensions(values)
    _check_references(values, materials, meshes)
    _place(values, columns)
    values["fixed"] = values["fixed"] | (values["kinds"] == _PLANE)
    _weigh(values, columns, materials, meshes)
    return values


def _check_dimensions(values: dict[str, Array]) -> None:
    kinds, dimensions = values["kinds"], values["dimensions"]
    for kind in _sized_kinds(kinds):
        needed, rows = NEEDED[kind], kinds == int(kind)
        sizes = dimensions[rows][:, needed]
        good = (sizes > 0) & (sizes < np.inf)
        if not good.all():
            bad = sizes[~good.all(axis=1)][0].tolist()
            raise refuse(
                DIMENSION, f"The {COUNTS[kind]} of a {kind.name.lower()} are {bad}: "
                "all have to be positive.",
            )  # fmt: skip
        others = [column for column in range(4) if column not in needed]
        if dimensions[rows][:, others].any():
            raise refuse(
                DIMENSION, f"Dimensions that a {kind.name.lower()} does not have are not zero."
            )
    planes = dimensions[kinds == _PLANE]
    if not np.all(np.isfinite(planes)) or not np.all(np.any(planes[:, :3] != 0, axis=1)):
        raise refuse(DIMENSION, "The normal of a plane is zero or not finite.")


def _check_references(
    values: dict[str, Array], materials: Materials, meshes: Mapping[int, Mesh]
) -> None:
    for id in _distinct(values["material_ids"])[0].tolist():
        if id not in materials:
            raise refuse(MATERIAL_UNKNOWN, f"There is no material with the id {id}.")
    is_mesh = values["kinds"] == _MESH
    for id in _distinct(values["mesh_ids"][is_mesh])[0].tolist():
        if id not in meshes:
            raise refuse(MESH, f"There is no mesh with the id {id}.")
    if np.any(values["mesh_ids"][~is_mesh] != -1):
        raise refuse(MESH, "A body that is not a mesh refers to one.")


def _place(values: dict[str, Array], columns: BodyColumns) -> None:
    """Poses that were not given."""
    planes = np.flatnonzero(values["kinds"] == _PLANE)
    normals = values["dimensions"][planes, :3]
    if columns.positions is None and len(planes):
        values["positions"][planes] = normals * values["dimensions"][planes, 3:]
    if columns.orientations is None:
        values["orientations"][:, 0] = 1.0
        for row, normal in zip(planes.tolist(), normals, strict=True):
            values["orientations"][row] = rotations.between((0.0, 0.0, 1.0), normal)
    elif not np.all(np.any(values["orientations"] != 0, axis=1)):
        raise refuse(NUMBER, "An orientation is a quaternion of length zero.")


def _weigh(
    values: dict[str, Array],
    columns: BodyColumns,
    materials: Materials,
    meshes: Mapping[int, Mesh],
) -> None:
    masses, inertias = values["masses"], values["inertias"]
    if columns.masses is not None and not (np.all(masses >= 0) and np.all(masses < np.inf)):
        raise refuse(MASS, "The column masses holds numbers that are negative or not finite.")
    if columns.inertias is not None and not np.all(np.isfinite(inertias)):
        raise refuse(INERTIA, "The column inertias holds numbers that are not finite.")
    if columns.masses is not None and columns.inertias is not None:
        return
    got_masses, got_inertias = mass_and_inertia(
        values, masses if columns.masses is not None else None, materials, meshes
    )
    if columns.masses is None:
        finite = values["kinds"] != Kind.PLANE
        if not np.all((got_masses[finite] > 0) & (got_masses[finite] < np.inf)):
            raise refuse(MASS, _NO_MASS)
        values["masses"] = got_masses
    if columns.inertias is None:
        if not np.all(np.isfinite(got_inertias)):
            raise refuse(INERTIA, _NO_INERTIA)
        values["inertias"] = got_inertias


def prepare_one(
    kind: Kind, given: Mapping[str, Any], materials: Materials, meshes: Mapping[int, Mesh]
) -> dict[str, Any]:
    """Complete the values of one body, each checked already: as `prepare`, but quicker."""
    if kind not in NEEDED or given["hollow"]:
        columns = BodyColumns(kinds=np.array([kind], dtype=np.int8))
        for key, value in given.items():
            setattr(columns, key, np.asarray(value)[None])
        return {key: value[0] for key, value in prepare(columns, materials, meshes).items()}
    mass, inertia = given.get("masses"), given.get("inertias")
    sizes = np.array([given["dimensions"]])
    with np.errstate(all="ignore"):
        if mass is None:
            mass = solid_volume(kind, sizes)[0] * materials[given["material_ids"]].density
            if not 0.0 < mass < np.inf:
                raise refuse(MASS, _NO_MASS)
        if inertia is None:
            inertia = np.diag(solid_inertia(kind, sizes, np.array([mass]))[0])
            if not np.isfinite(inertia).all():
                raise refuse(INERTIA, _NO_INERTIA)
    return {**given, "kinds": kind, "masses": mass, "inertias": inertia}


def mass_and_inertia(
    values: Mapping[str, Array],
    masses: Array | None,
    materials: Materials,
    meshes: Mapping[int, Mesh],
) -> tuple[Array, Array]:
    """Masses (n,), computed unless given, and inertias (n, 3, 3) of primitives."""
    kinds, dimensions = values["kinds"], values["dimensions"]
    count = len(kinds)
    out_masses = np.zeros(count) if masses is None else masses
    inertias = np.zeros((count, 3, 3))
    densities = _densities(values["material_ids"], materials) if masses is None else None
    diagonal = np.arange(3)
    with np.errstate(all="ignore"):
        for kind in _sized_kinds(kinds):
            rows = np.flatnonzero(kinds == int(kind))
            if densities is not None:
                out_masses[rows] = solid_volume(kind, dimensions[rows]) * densities[rows]
            inertias[rows[:, None], diagonal, diagonal] = solid_inertia(
                kind, dimensions[rows], out_masses[rows]
            )
            for row in rows[values["hollow"][rows]].tolist():
                mean = hollow_moments(kind, tuple(dimensions[row].tolist()))
                inertias[row, diagonal, diagonal] = out_masses[row] * (mean.sum() - mean)
        for row in np.flatnonzero(kinds == _MESH).tolist():
            mesh = meshes[int(values["mesh_ids"][row])]
            if densities is not None:
                out_masses[row] = mesh.volume * densities[row]
            mass = float(out_masses[row])
            hollow = bool(values["hollow"][row])
            inertias[row] = mesh.hollow_inertia(mass) if hollow else mesh.inertia(mass)
    return out_masses, inertias


def _sized_kinds(kinds: Array) -> list[Kind]:
    """The kinds with dimensions that there are."""
    return [
        kind for kind in map(Kind, np.flatnonzero(np.bincount(kinds)).tolist()) if kind in NEEDED
    ]


def _densities(ids: Array, materials: Materials) -> Array:
    used, where = _distinct(ids)
    return np.array([materials[id].density for id in used.tolist()])[where]


def _distinct(ids: Array) -> tuple[Array, Array]:
    """The different ids, and which of them each one is."""
    low, high = (int(ids.min()), int(ids.max())) if len(ids) else (0, 0)
    if high - low > 2 * len(ids):
        return np.unique(ids, return_inverse=True)
    # Close together, as they mostly are: counting is faster than sorting.
    offsets = ids - low
    used = np.flatnonzero(np.bincount(offsets))
    places = np.zeros(high - low + 1, dtype=np.int64)
    places[used] = np.arange(len(used))
    return used + low, places[offsets]
