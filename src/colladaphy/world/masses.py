"""Volumes, masses and inertias of many primitives at once, solid or hollow."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.world.kinds import Kind
from colladaphy.world.materials import Materials
from colladaphy.world.meshes import Mesh, complete_shells, inertia_about
from colladaphy.world.shapes import NEEDED, principal_inertia, solid_volume
from colladaphy.world.surfaces import hollow_moments

__all__ = ["distinct", "mass_and_inertia", "sized_kinds", "volumes"]

Array = NDArray[Any]
Floats = NDArray[np.float64]

_MESH = int(Kind.MESH)  # numpy is slow to compare with an enumeration
_AXES = np.arange(3)


def volumes(values: Mapping[str, Array], meshes: Mapping[int, Mesh]) -> Floats:
    """Enclosed volumes (n,) of primitives from `kinds`, `dimensions`, `mesh_ids`; 0 of planes."""
    kinds, dimensions = values["kinds"], values["dimensions"]
    result = np.zeros(len(kinds))
    for kind in sized_kinds(kinds):
        rows = rows_of(kinds, kind)
        result[rows] = solid_volume(kind, dimensions[rows])
    rows = np.flatnonzero(kinds == _MESH)
    used, where = distinct(values["mesh_ids"][rows])
    result[rows] = np.array([meshes[id].volume for id in used.tolist()], dtype=np.float64)[where]
    return result


def mass_and_inertia(
    values: Mapping[str, Array],
    masses: Floats | None,
    materials: Materials,
    meshes: Mapping[int, Mesh],
) -> tuple[Floats, Floats]:
    """Masses (n,), computed unless given, and inertias (n, 3, 3) of primitives."""
    kinds, dimensions, hollow = values["kinds"], values["dimensions"], values["hollow"]
    inertias = np.zeros((len(kinds), 3, 3))
    with np.errstate(all="ignore"):
        if masses is None:
            used, where = distinct(values["material_ids"])
            densities = materials.values("density", used)[where]
            masses = volumes(values, meshes) * densities
        for kind in sized_kinds(kinds):
            rows = rows_of(kinds, kind)
            sizes, weights = dimensions[rows], masses[rows]
            columns = (sizes[:, 0], sizes[:, 1], sizes[:, 2], sizes[:, 3])
            for axis, inertia in enumerate(principal_inertia(kind, weights, *columns)):
                inertias[rows, axis, axis] = inertia
            rows = np.flatnonzero(hollow & (kinds == int(kind)))
            if len(rows):
                means = hollow_moments(kind, dimensions[rows])
                around = means.sum(axis=1, keepdims=True) - means
                inertias[rows[:, None], _AXES, _AXES] = masses[rows][:, None] * around
        rows = np.flatnonzero(kinds == _MESH)
        for shell in (False, True):
            part = rows[hollow[rows] == shell]
            used, where = distinct(values["mesh_ids"][part])
            if len(used):
                found = [meshes[id] for id in used.tolist()]
                if shell:
                    complete_shells(found)
                second = np.array([mesh.mean_squares(hollow=shell) for mesh in found])
                inertias[part] = inertia_about(second[where], masses[part])
    return masses, inertias


def rows_of(kinds: Array, kind: Kind) -> Any:
    """The rows of a kind; all of them, where it is the only one, without copying any."""
    rows = np.flatnonzero(kinds == int(kind))
    return slice(None) if len(rows) == len(kinds) else rows


def sized_kinds(kinds: Array) -> list[Kind]:
    """The kinds with dimensions that there are."""
    return [
        kind for kind in map(Kind, np.flatnonzero(np.bincount(kinds)).tolist()) if kind in NEEDED
    ]


def distinct(ids: Array) -> tuple[Array, Array]:
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
