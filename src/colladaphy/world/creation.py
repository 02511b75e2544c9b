"""From columns that a caller gives to complete, checked columns of bodies."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.world import rotations
from colladaphy.world import values as checks
from colladaphy.world.columns import BODY_FIELDS, MEMBER_FIELDS, BodyColumns, MemberColumns
from colladaphy.world.kinds import Kind
from colladaphy.world.masses import distinct, mass_and_inertia, rows_of, sized_kinds
from colladaphy.world.materials import Materials
from colladaphy.world.meshes import Mesh
from colladaphy.world.rules import (
    ARGUMENT,
    COLUMNS,
    DIMENSION,
    INERTIA,
    MASS,
    MESH,
    NUMBER,
    UNION_MEMBERS,
    refuse,
)
from colladaphy.world.shapes import COUNTS, NEEDED, principal_inertia, volume
from colladaphy.world.table import Field

__all__ = ["infinite_unions", "prepare", "prepare_members", "prepare_one"]

Array = NDArray[Any]

_PLANE, _MESH, _UNION = int(Kind.PLANE), int(Kind.MESH), int(Kind.UNION)
_EMPTY = int(Kind.EMPTY)

_NO_MASS = "Volume times density is out of the range of numbers."
_NO_INERTIA = "The inertia of a shape is out of the range of numbers."
_FINITE = ("positions", "orientations", "linear_velocities", "angular_velocities", "forces",
           "torques")  # fmt: skip


def prepare(
    columns: BodyColumns, materials: Materials, meshes: Mapping[int, Mesh], *, unions: bool = False
) -> dict[str, Array]:
    """Complete and check columns of bodies (all but the system ids and names).

    What nobody gave and is zero is left out. Only with `unions` may some of them be unions; what
    they are made of is for `prepare_members` to check.
    """
    if not isinstance(columns, BodyColumns):
        raise refuse(ARGUMENT, f"Bodies are made of BodyColumns, not of {type(columns).__name__}.")
    values = _given(columns, BODY_FIELDS)
    kinds = values["kinds"]
    count, united = len(kinds), kinds == _UNION
    if united.any():
        if not unions:
            raise refuse(COLUMNS, "Unions are made from columns together with their members.")
        for name in ("positions", "orientations", "masses", "inertias"):
            if name not in values:
                raise refuse(COLUMNS, f"Rows of unions need the column {name}.")
    values.setdefault("dimensions", np.zeros((count, 4)))
    values.setdefault("hollow", np.zeros(count, dtype=np.bool_))
    empty = kinds == _EMPTY
    if "masses" not in values and empty.any():
        raise refuse(COLUMNS, "Rows without a shape need the column masses.")
    values.setdefault("material_ids", np.where(united | empty, -1, 0))
    values.setdefault("mesh_ids", np.full(count, -1))
    _check(values, materials, meshes)
    _place(values)
    planes = kinds == _PLANE
    values["fixed"] = values["fixed"] | planes if "fixed" in values else planes
    _weigh(values, materials, meshes)
    return values


def prepare_members(
    members: MemberColumns, materials: Materials, meshes: Mapping[int, Mesh]
) -> dict[str, Array]:
    """Check columns of members of unions (all but the system ids and names)."""
    if not isinstance(members, MemberColumns):
        raise refuse(ARGUMENT, f"Members are MemberColumns, not {type(members).__name__}.")
    values = _given(members, MEMBER_FIELDS)
    for name in MEMBER_FIELDS:
        if name not in values:
            raise refuse(COLUMNS, f"Members of unions need the column {name}.")
    _check(values, materials, meshes)
    return values


def infinite_unions(
    sids: Array, values: dict[str, Array], member_sids: Array, members: dict[str, Array]
) -> Array:
    """Which rows are infinite unions (n,), as they hold a plane; WorldError unless all fit."""
    every = np.concatenate([sids, member_sids])
    kinds = np.concatenate([values["kinds"], members["kinds"]])
    order = np.argsort(every, kind="stable")
    places = np.minimum(np.searchsorted(every, members["parents"], sorter=order), len(every) - 1)
    parents = np.concatenate([np.full(len(sids), -1), order[places] if len(every) else places])
    given = members["parents"]
    bad = np.flatnonzero(
        (every[parents[len(sids) :]] != given) | (kinds[parents[len(sids) :]] != _UNION)
    )
    if len(bad):
        raise refuse(UNION_MEMBERS, f"There is no union {given[bad[0]]} among the columns.")
    empty = kinds == _UNION
    empty[parents[len(sids) :]] = False
    if empty.any():
        raise refuse(UNION_MEMBERS, f"The union {every[empty][0]} has no members.")
    above = parents
    for _ in range(len(every).bit_length()):  # twice as far up each time
        above = np.where(above < 0, -1, above[above])
    if np.any(above >= 0):
        raise refuse(UNION_MEMBERS, f"The union {every[above >= 0][0]} is a member of itself.")
    infinite = np.zeros(len(every), dtype=np.bool_)
    level = np.unique(parents[(kinds == _PLANE) & (parents >= 0)])
    while len(level):
        infinite[level] = True
        level = np.unique(parents[level])
        level = level[(level >= 0) & ~infinite[level]]
    return infinite[: len(sids)]


def _given(source: BodyColumns | MemberColumns, fields: Mapping[str, Field]) -> dict[str, Array]:
    """The columns that are given, of the right types and shapes."""
    try:
        kinds = np.asarray(source.kinds)
    except ValueError as error:
        raise refuse(COLUMNS, "The column kinds has one number a body.") from error
    if kinds.ndim != 1 or (len(kinds) and kinds.dtype.kind not in "iu"):
        raise refuse(COLUMNS, "The column kinds has one number a body.")
    if len(kinds) and (kinds.min() < 0 or kinds.max() > max(Kind)):
        raise refuse(COLUMNS, "The column kinds holds a number that is none of Kind.")
    values: dict[str, Array] = {}
    for name, (dtype, shape) in fields.items():
        given = getattr(source, name)
        if given is not None:
            values[name] = checks.column(name, given, dtype, (len(kinds), *shape))
    return values


def _check(values: dict[str, Array], materials: Materials, meshes: Mapping[int, Mesh]) -> None:
    for name in _FINITE:
        if name in values and not np.all(np.isfinite(values[name])):
            raise refuse(NUMBER, f"The column {name} holds numbers that are not finite.")
    if "orientations" in values and not np.all(np.any(values["orientations"] != 0, axis=1)):
        raise refuse(NUMBER, "An orientation is a quaternion of length zero.")
    masses, inertias = values.get("masses"), values.get("inertias")
    if masses is not None and not (np.all(masses >= 0) and np.all(masses < np.inf)):
        raise refuse(MASS, "The column masses holds numbers that are negative or not finite.")
    if inertias is not None and not np.all(np.isfinite(inertias)):
        raise refuse(INERTIA, "The column inertias holds numbers that are not finite.")
    _check_dimensions(values["kinds"], values["dimensions"])
    _check_references(values, materials, meshes)


def _check_dimensions(kinds: Array, dimensions: Array) -> None:
    for kind in sized_kinds(kinds):
        rows = rows_of(kinds, kind)
        sizes = dimensions[rows]
        for column in range(4):
            size = sizes[:, column]
            if column not in NEEDED[kind]:
                if size.any():
                    raise refuse(
                        DIMENSION,
                        f"Dimensions that a {kind.name.lower()} does not have are not zero.",
                    )
            elif not np.all((size > 0) & (size < np.inf)):
                row = np.flatnonzero(~((size > 0) & (size < np.inf)))[0]
                bad = sizes[row, list(NEEDED[kind])].tolist()
                raise refuse(
                    DIMENSION, f"The {COUNTS[kind]} of a {kind.name.lower()} are {bad}: "
                    "all have to be positive.",
                )  # fmt: skip
    planes = dimensions[kinds == _PLANE]
    if not np.all(np.isfinite(planes)) or not np.all(np.any(planes[:, :3] != 0, axis=1)):
        raise refuse(DIMENSION, "The normal of a plane is zero or not finite.")
    if dimensions[(kinds == _MESH) | (kinds == _UNION) | (kinds == _EMPTY)].any():
        raise refuse(DIMENSION, "What is no primitive has dimensions that are not zero.")


def _check_references(
    values: dict[str, Array], materials: Materials, meshes: Mapping[int, Mesh]
) -> None:
    kinds, material_ids, mesh_ids = values["kinds"], values["material_ids"], values["mesh_ids"]
    united = kinds == _UNION
    if np.any(material_ids[united] != -1) or np.any(values["hollow"][united]):
        raise refuse(COLUMNS, "A union has a material, or is hollow: its members are.")
    empty = kinds == _EMPTY
    if np.any(material_ids[empty] != -1) or np.any(values["hollow"][empty]):
        raise refuse(COLUMNS, "A body without a shape has a material, or is hollow.")
    material_ids = material_ids[~(united | empty)]
    materials.rows(distinct(material_ids)[0])
    is_mesh = kinds == _MESH
    for id in distinct(mesh_ids[is_mesh])[0].tolist():
        if id not in meshes:
            raise refuse(MESH, f"There is no mesh with the id {id}.")
    if np.any(mesh_ids[~is_mesh] != -1):
        raise refuse(MESH, "A body that is not a mesh refers to one.")


def _place(values: dict[str, Array]) -> None:
    """Poses that were not given."""
    planes = np.flatnonzero(values["kinds"] == _PLANE)
    normals = values["dimensions"][planes, :3]
    if "positions" not in values and len(planes):
        values["positions"] = np.zeros((len(values["kinds"]), 3))
        values["positions"][planes] = normals * values["dimensions"][planes, 3:]
    if "orientations" not in values:
        values["orientations"] = np.zeros((len(values["kinds"]), 4))
        values["orientations"][:, 0] = 1.0
        if len(planes):
            values["orientations"][planes] = rotations.between((0.0, 0.0, 1.0), normals)


def _weigh(values: dict[str, Array], materials: Materials, meshes: Mapping[int, Mesh]) -> None:
    """Masses and inertias that were not given."""
    if "masses" in values and "inertias" in values:
        return
    masses, inertias = mass_and_inertia(values, values.get("masses"), materials, meshes)
    if "masses" not in values:
        weighty = (masses > 0) & (masses < np.inf)
        if not np.all(weighty | (values["kinds"] == _PLANE)):
            raise refuse(MASS, _NO_MASS)
        values["masses"] = masses
    if "inertias" not in values:
        if not np.all(np.isfinite(inertias)):
            raise refuse(INERTIA, _NO_INERTIA)
        values["inertias"] = inertias


def prepare_one(
    kind: Kind, given: Mapping[str, Any], materials: Materials, meshes: Mapping[int, Mesh]
) -> dict[str, Any]:
    """Complete the values of one body, each checked already: as `prepare`, but quicker."""
    filled = {**given, "kinds": int(kind)}
    mass, inertia = given.get("masses"), given.get("inertias")
    if kind is Kind.PLANE:
        return {**filled, "fixed": True}
    if kind is Kind.EMPTY:
        return {**filled, "inertias": np.zeros((3, 3)) if inertia is None else inertia}
    if kind is Kind.MESH or given["hollow"]:
        needed = ("kinds", "dimensions", "hollow", "mesh_ids", "material_ids")
        row = {name: np.array([filled[name]]) for name in needed}
        if mass is not None:
            row["masses"] = np.array([mass])
        if inertia is not None:
            row["inertias"] = inertia[None]
        _weigh(row, materials, meshes)
        return {**filled, "masses": row["masses"][0], "inertias": row["inertias"][0]}
    sizes = given["dimensions"]
    if mass is None:
        mass = volume(kind, *sizes) * materials[given["material_ids"]].density
        if not 0.0 < mass < np.inf:
            raise refuse(MASS, _NO_MASS)
    if inertia is None:
        x, y, z = principal_inertia(kind, mass, *sizes)
        if not (abs(x) < np.inf and abs(y) < np.inf and abs(z) < np.inf):
            raise refuse(INERTIA, _NO_INERTIA)
        inertia = ((x, 0.0, 0.0), (0.0, y, 0.0), (0.0, 0.0, z))
    return {**filled, "masses": mass, "inertias": inertia}
