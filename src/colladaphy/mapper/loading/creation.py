"""Parts become bodies of a World: system ids first, then everything at once."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.errors import WorldError
from colladaphy.mapper import rules
from colladaphy.mapper.loading.bodies import LoadedBodies
from colladaphy.mapper.loading.parts import Parts
from colladaphy.mapper.loading.tables import Tables
from colladaphy.world import BodyColumns, MemberColumns, World
from colladaphy.world.kinds import Kind
from colladaphy.world.masses import mass_and_inertia
from colladaphy.world.unions import steiner, sums
from colladaphy.world.values import are_distinct

__all__ = ["assign_ids", "create_bodies", "free_ids"]

Array = NDArray[Any]


def free_ids(wanted: Sequence[int | None], taken: Iterable[int]) -> list[int]:
    """System ids: the wanted ones where they are free, and their order always (thesis 6.1).

    Those that want none come after all others, in their own order.
    """
    used = set(taken)
    ready = [sid for sid in wanted if sid is not None and sid > 0]
    if len(ready) == len(wanted) and not used and len(set(ready)) == len(ready):
        return ready
    given: list[int | None] = [None] * len(wanted)
    order = sorted(
        (place for place, sid in enumerate(wanted) if sid is not None),
        key=lambda place: (wanted[place], place),
    )
    last = 0
    for place in order:
        sid = wanted[place]
        assert sid is not None
        sid = max(sid, 1)
        if sid <= last or sid in used:
            sid = max(last + 1, sid)
            while sid in used:
                sid += 1
        given[place] = last = sid
    last = max(last, max(used, default=0))
    made = []
    for sid in given:
        if sid is None:
            last += 1
            sid = last
        made.append(sid)
    return made


def assign_ids(parts: Parts) -> None:
    """Give every part its system id: the wanted one, or the next in the order of the bodies."""
    sids = parts.sids
    if bool(np.all(sids > 0)) and are_distinct(sids):
        return
    order = np.argsort(parts.body, kind="stable")
    claims = [None if sid == -1 else sid for sid in sids[order].tolist()]
    parts.sids[order] = free_ids(claims, ())


def create_bodies(tables: Tables, loaded: LoadedBodies, world: World) -> Array:
    """Create all bodies; which of them the World took (n,). The others are noted."""
    parts = loaded.parts
    with np.errstate(all="ignore"):
        _weigh(parts, world)
    created = np.ones(len(loaded.found), np.bool_)
    order = np.argsort(parts.body, kind="stable")
    starts = np.searchsorted(parts.body[order], np.arange(len(loaded.found)), side="left")
    stops = np.searchsorted(parts.body[order], np.arange(len(loaded.found)), side="right")
    _create(tables, loaded, world, order, starts, stops, 0, len(loaded.found), created)
    return created


def _create(
    tables: Tables, loaded: LoadedBodies, world: World, order: Array, starts: Array, stops: Array,
    begin: int, end: int, created: Array,
) -> None:  # fmt: skip
    """Create a range of the bodies, by halves where the World does not take all of it."""
    if begin == end:
        return
    rows = order[starts[begin] : stops[end - 1]]
    try:
        world.extend(*_columns(loaded, rows, begin, end))
    except WorldError as error:
        if end - begin == 1:
            created[begin] = False
            found = loaded.found
            name = tables.bodies.texts("sid")[int(found.bodies[begin])] or "?"
            message = f"The body {name!r} is skipped: {error.findings[0].message}"
            home = tables.pool.resources[int(found.homes[begin])]
            ordinal = int(tables.body_instances.ordinals[found.rows[begin]])
            tables.resource.note(rules.BAD_VALUE, ordinal, message, home=home)
            return
        middle = (begin + end) // 2
        _create(tables, loaded, world, order, starts, stops, begin, middle, created)
        _create(tables, loaded, world, order, starts, stops, middle, end, created)


def _columns(
    loaded: LoadedBodies, rows: Array, begin: int, end: int
) -> tuple[BodyColumns, MemberColumns | None]:
    """The columns of a range of the bodies, and those of their members."""
    parts, tops = loaded.parts, loaded.tops[begin:end]
    span = slice(begin, end)
    named = any(name is not None for name in parts.names)
    columns = BodyColumns(
        kinds=parts.kinds[tops],
        sids=parts.sids[tops],
        uids=parts.uids[tops],
        positions=parts.poses.positions[tops],
        orientations=parts.poses.orientations[tops],
        linear_velocities=loaded.linear[span],
        angular_velocities=loaded.angular[span],
        forces=loaded.force[span],
        torques=loaded.torque[span],
        masses=parts.masses[tops],
        inertias=parts.inertias[tops].reshape(-1, 3, 3),
        fixed=loaded.fixed[span],
        sleeping=loaded.sleeping[span],
        material_ids=parts.material_ids[tops],
        dimensions=parts.dimensions[tops],
        hollow=parts.hollow[tops],
        mesh_ids=parts.mesh_ids[tops],
        names=[parts.names[row] for row in tops.tolist()] if named else None,
    )
    if len(rows) == len(tops):
        return columns, None
    inner = rows[parts.parents[rows] >= 0]
    members = MemberColumns(
        kinds=parts.kinds[inner],
        sids=parts.sids[inner],
        uids=parts.uids[inner],
        parents=parts.sids[parts.parents[inner]],
        positions=parts.poses.positions[inner],
        orientations=parts.poses.orientations[inner],
        masses=parts.masses[inner],
        inertias=parts.inertias[inner].reshape(-1, 3, 3),
        material_ids=parts.material_ids[inner],
        dimensions=parts.dimensions[inner],
        hollow=parts.hollow[inner],
        mesh_ids=parts.mesh_ids[inner],
        names=[parts.names[row] for row in inner.tolist()] if named else None,
    )
    return columns, members


def _weigh(parts: Parts, world: World) -> None:
    """Masses and inertias that nobody says: of primitives by shape and mass, of unions by sums."""
    solid = parts.kinds != Kind.UNION
    bare = solid & np.isnan(parts.masses)
    parts.masses[bare & (parts.kinds == Kind.PLANE)] = 0.0
    missing = np.flatnonzero(solid & np.isnan(parts.inertias[:, 0]))
    if len(missing):
        rows = slice(None) if len(missing) == len(parts) else missing
        values = {
            "kinds": parts.kinds[rows], "dimensions": parts.dimensions[rows],
            "hollow": parts.hollow[rows], "mesh_ids": parts.mesh_ids[rows],
            "material_ids": parts.material_ids[rows],
        }  # fmt: skip
        _, inertias = mass_and_inertia(values, parts.masses[rows], world.materials, world.meshes)
        parts.inertias[rows] = inertias.reshape(-1, 9)
    unions = np.flatnonzero(~solid)
    if not len(unions):
        return
    endless = _endless(parts)
    todo = unions[np.isnan(parts.masses[unions]) | np.isnan(parts.inertias[unions, 0])]
    if len(todo):
        for level in _levels(parts, todo):
            _add_up(parts, level, endless)


def _endless(parts: Parts) -> Array:
    """Which parts are planes or hold one (n,)."""
    endless: Array = np.asarray(parts.kinds == Kind.PLANE)
    above = parts.parents[endless]
    while len(above := np.unique(above[above >= 0])):
        above = above[~endless[above]]
        endless[above] = True
        above = parts.parents[above]
    return endless


def _levels(parts: Parts, unions: Array) -> list[Array]:
    """Unions, the innermost first."""
    depth = np.zeros(len(unions), np.int64)
    above = parts.parents[unions]
    while bool(np.any(above >= 0)):
        depth += above >= 0
        above = np.where(above >= 0, parts.parents[above], -1)
    return [unions[depth == level] for level in range(int(depth.max()), -1, -1)]


def _add_up(parts: Parts, unions: Array, endless: Array) -> None:
    place = np.full(len(parts) + 1, -1, np.int64)
    place[unions] = np.arange(len(unions))
    inner = np.flatnonzero(place[parts.parents] >= 0)
    owner = place[parts.parents[inner]]
    order = np.argsort(owner, kind="stable")
    inner, owner = inner[order], owner[order]
    masses, centers, inertias = sums(
        owner, len(unions), parts.poses.positions[inner], parts.poses.orientations[inner],
        parts.masses[inner], parts.inertias[inner].reshape(-1, 3, 3), endless[inner],
    )  # fmt: skip
    # Inertias are about the origin of the union, which need not be its centre.
    away = (masses != 0.0) & np.any(centers != 0.0, axis=1)
    inertias[away] += steiner(masses[away], centers[away])
    missing = np.isnan(parts.masses[unions])
    parts.masses[unions[missing]] = masses[missing]
    missing = np.isnan(parts.inertias[unions, 0])
    parts.inertias[unions[missing]] = inertias[missing].reshape(-1, 9)
