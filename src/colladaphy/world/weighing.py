"""Bodies of another mass, inertia or material; unions follow their members.

A union whose mass is set passes it on: its members get the same share of the new one.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from colladaphy.world import values
from colladaphy.world.kinds import Kind
from colladaphy.world.masses import mass_and_inertia
from colladaphy.world.rules import INERTIA, KIND, MASS, KindError, refuse
from colladaphy.world.storage import Storage
from colladaphy.world.table import Table
from colladaphy.world.unions import sums
from colladaphy.world.uniting import add_up_again

__all__ = ["differing_unions", "set_inertia", "set_mass", "set_material"]

_SAME = 1e-6
"""Of masses, of what bodies reach, and of inertias, what files round away."""


def set_mass(storage: Storage, sid: int, mass: float) -> None:
    """Give a body another mass; its inertia is scaled with it."""
    value = values.mass(mass)
    if storage.is_infinite(sid):
        raise refuse(MASS, f"The body {sid} is infinite: it has no mass that could be set.")
    table, row = storage.locate(sid)
    old = float(table.raw("masses")[row])
    if old > 0.0:
        _scale(storage, sid, value, value / old)
    elif value > 0.0:
        _give(storage, table, row, value)
    _follow(storage, sid)


def _scale(storage: Storage, sid: int, mass: float, factor: float) -> None:
    table, row = storage.locate(sid)
    with np.errstate(over="ignore", invalid="ignore"):
        inertia = table.raw("inertias")[row] * factor
    if not np.all(np.isfinite(inertia)):
        raise refuse(INERTIA, f"The inertia of the body {sid} gets out of the range of numbers.")
    for member in storage.children.get(sid, ()):
        table_of, row_of = storage.locate(member)
        _scale(storage, member, float(table_of.raw("masses")[row_of]) * factor, factor)
    table.raw("inertias")[row] = inertia
    table.raw("masses")[row] = mass


def _give(storage: Storage, table: Table, row: int, mass: float) -> None:
    """A mass to a body that has none: its inertia is that of its shape."""
    kind = Kind(int(table.raw("kinds")[row]))
    if kind is Kind.UNION:
        message = "A union without any mass gets one by its members: set theirs."
        raise refuse(MASS, message)
    if kind is not Kind.EMPTY:
        names = ("kinds", "dimensions", "hollow", "mesh_ids", "material_ids")
        shape = {name: table.raw(name)[row : row + 1] for name in names}
        weights = np.array([mass])
        inertia = mass_and_inertia(shape, weights, storage.materials, storage.meshes)[1][0]
        if not np.all(np.isfinite(inertia)):
            raise refuse(INERTIA, "The inertia gets out of the range of numbers.")
        table.raw("inertias")[row] = inertia
    table.raw("masses")[row] = mass


def set_inertia(storage: Storage, sid: int, inertia: ArrayLike) -> None:
    """Give a body another inertia, (3, 3) about its centre in its own frame, or its diagonal."""
    tensor = values.inertia(inertia)
    if storage.is_infinite(sid):
        raise refuse(INERTIA, f"The body {sid} is infinite: it has no inertia.")
    table, row = storage.locate(sid)
    table.raw("inertias")[row] = tensor
    _follow(storage, sid)


def set_material(storage: Storage, sid: int, id: int) -> None:
    """Give a body, or all members of a union, another material. Masses stay as they are."""
    table, row = storage.locate(sid)
    kind = Kind(int(table.raw("kinds")[row]))
    if kind is Kind.EMPTY:
        raise KindError(KIND.at(message="What has no shape has no material."))
    if kind is Kind.UNION:
        for member in storage.children[sid]:
            if _has_shape(storage, member):
                set_material(storage, member, id)
        return
    table.raw("material_ids")[row] = id


def _has_shape(storage: Storage, sid: int) -> bool:
    table, row = storage.locate(sid)
    return int(table.raw("kinds")[row]) != Kind.EMPTY


def _follow(storage: Storage, sid: int) -> None:
    parent = storage.parent_of(sid)
    if parent is not None:
        add_up_again(storage, parent)


def differing_unions(storage: Storage) -> list[int]:
    """System ids of the unions that are not the sum of their members.

    They can have been given other values, or their members were changed through columns.
    """
    inner, top = storage.inner, storage.top
    owners = inner.column("parents")
    if not len(owners):
        return []
    unions, owner = np.unique(owners, return_inverse=True)
    infinite = inner.column("kinds") == Kind.PLANE
    for row in np.flatnonzero(inner.column("kinds") == Kind.UNION).tolist():
        infinite[row] = storage.is_infinite(int(inner.column("sids")[row]))
    places = inner.column("positions")
    reach = np.zeros(len(unions))
    np.maximum.at(reach, owner, np.abs(places).max(axis=1))
    own_masses = _of(top, inner, unions, "masses")
    own_inertias = _of(top, inner, unions, "inertias")
    with np.errstate(all="ignore"):
        masses, centers, inertias = sums(
            owner, len(unions), places, inner.column("orientations"), inner.column("masses"),
            inner.column("inertias"), infinite,
        )  # fmt: skip
        wrong = np.abs(own_masses - masses) > _SAME * masses
        wrong |= np.abs(centers).max(axis=1) > _SAME * reach
        sizes = np.abs(inertias).max(axis=(1, 2))
        wrong |= np.abs(own_inertias - inertias).max(axis=(1, 2)) > _SAME * sizes
    finite = np.ones(len(unions), np.bool_)
    finite[np.unique(owner[infinite])] = False
    found: list[int] = unions[wrong & finite].tolist()
    return found


def _of(top: Table, inner: Table, sids: NDArray[np.int64], name: str) -> Any:
    rows = top.find_all(sids)
    inside = inner.find_all(sids)
    values_of = inner.column(name)[np.maximum(inside, 0)]
    outside = rows >= 0
    values_of[outside] = top.column(name)[rows[outside]]
    return values_of
