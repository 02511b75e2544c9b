"""The shapes of the bodies that are loaded, with masses, materials and meshes (thesis 5.3)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.links.pool import concatenated, expanded, is_unreachable
from colladaphy.links.poses import Poses
from colladaphy.links.sums import exact_sum
from colladaphy.mapper import rules
from colladaphy.mapper.loading.found import FoundBodies
from colladaphy.mapper.loading.materials import STANDARD_DENSITY, UNSPECIFIED, MaterialTable
from colladaphy.mapper.loading.meshes import Geometries, ShapeFault
from colladaphy.mapper.loading.shapes import (
    EMPTY,
    FLAT,
    MISSING,
    NONE,
    MaterialRefs,
    ShapeColumns,
)
from colladaphy.mapper.loading.tables import Tables
from colladaphy.mapper.loading.values import BodyValues
from colladaphy.world import World
from colladaphy.world.kinds import Kind
from colladaphy.world.shapes import NEEDED, solid_volume

__all__ = ["Members", "complete", "read_members"]

Array = NDArray[Any]


@dataclass(slots=True)
class Members:
    """The shapes that bodies are made of, one a row, those of a body in their order."""

    owner: Array
    """(m,) the body of each, ascending."""
    homes: Array
    """(m,) the document that each stands in."""
    ordinals: Array
    kinds: Array
    dimensions: Array
    poses: Poses
    """Of the World's body frame in the rigid_body."""
    placed: Poses
    """Where the file puts a mesh, whose centre of mass may be elsewhere."""
    hollow: Array
    masses: Array
    """(m,) NaN for planes that say none."""
    densities: Array
    """(m,) what the shape itself gives; NaN for nothing."""
    material: MaterialRefs
    material_rows: Array
    """(m,) rows of the materials that count, once `complete` has found them."""
    mesh_ids: Array
    """(m,) ids of meshes in the World; -1 for none."""
    volumes: Array

    def __len__(self) -> int:
        return len(self.owner)

    def reach(self, rows: Array, world: World, *, centered: bool) -> Array:
        """The largest number among the vertices of meshes (n,), 0 for other shapes.

        As they stand in the file, or about the centre of mass.
        """
        made = np.zeros(len(rows))
        known: dict[tuple[int, bool], float] = {}
        for place in np.flatnonzero(self.mesh_ids[rows] >= 0).tolist():
            row = rows[place]
            key = int(self.mesh_ids[row]), bool(self.hollow[row])
            if key not in known:
                mesh = world.meshes[key[0]]
                points = mesh.vertices - mesh.center_of(key[1]) if centered else mesh.vertices
                known[key] = float(np.max(np.abs(points)))
            made[place] = known[key]
        return made


def read_members(
    tables: Tables,
    bodies: FoundBodies,
    values: BodyValues,
    shapes: tuple[ShapeColumns, ShapeColumns],
    geometries: Geometries,
) -> Members:
    """The shapes of all bodies but those that a World cannot hold, which are noted.

    `shapes` are those of rigid_bodies and of instances; the latter replace the former.
    """
    own, theirs = shapes
    begin = np.searchsorted(own.owner, bodies.bodies, side="left")
    end = np.searchsorted(own.owner, bodies.bodies, side="right")
    every, instanced = own, np.zeros(len(bodies), np.bool_)
    if len(theirs.owner):
        first = np.searchsorted(theirs.owner, bodies.rows, side="left")
        last = np.searchsorted(theirs.owner, bodies.rows, side="right")
        instanced = last > first
        begin = np.where(instanced, first + len(own.owner), begin)
        end = np.where(instanced, last + len(own.owner), end)
        every = concatenated([own, theirs])
    rows, owner = expanded(begin, end)
    homes = np.where(instanced, bodies.homes, bodies.body_homes)[owner]
    whole = len(rows) == len(every.owner) and bool(np.all(rows == np.arange(len(rows))))

    def taken(column: Any) -> Any:
        return column if whole else column.take(rows) if isinstance(column, Poses) else column[rows]

    kinds, dimensions, faults = taken(every.kinds), taken(every.dimensions), taken(every.faults)
    placed, hollow, ordinals = taken(every.poses), taken(every.hollow), taken(every.ordinals)
    count = len(rows)
    mesh_ids = np.full(count, -1, np.int64)
    volumes = np.zeros(count)
    poses = placed
    problems: dict[int, ShapeFault] = {}
    is_mesh = np.flatnonzero(kinds == Kind.MESH)
    if len(is_mesh):
        kinds = kinds.copy()
        poses = _meshes(tables, every, rows, homes, ordinals, hollow, is_mesh, geometries, placed,
                        mesh_ids, volumes, problems, kinds)  # fmt: skip
    for row in np.flatnonzero(faults != NONE).tolist():
        problems[row] = _fault(int(faults[row]), Kind(max(int(kinds[row]), 0)), dimensions[row])
    for kind in np.unique(kinds).tolist():
        if kind in NEEDED:
            mine = slice(None) if bool(np.all(kinds == kind)) else np.flatnonzero(kinds == kind)
            with np.errstate(all="ignore"):
                volumes[mine] = solid_volume(Kind(kind), dimensions[mine])
    mass = np.where(taken(every.has_mass), taken(every.mass), np.nan)
    density = np.where(taken(every.has_density), taken(every.density), np.nan)
    material = every.material if whole else every.material.take(rows)
    members = Members(owner, homes, ordinals, kinds, dimensions, poses, placed, hollow, mass,
                      density, material, np.full(count, UNSPECIFIED), mesh_ids,
                      volumes)  # fmt: skip
    left = np.ones(count, np.bool_)
    left[list(problems)] = False
    if problems:
        _empty_bodies(members, values, problems, left)
        for row in sorted(problems):
            _note(tables, bodies, members, row, problems[row], skipped=not left[row])
        _note_skipped(tables, bodies, members, left)
    weightless = (members.kinds == Kind.EMPTY) & np.isnan(mass) & ~values.has_mass[owner]
    if weightless.any():
        _note_frames(tables, bodies, members, weightless)
        left &= ~weightless
    return members if left.all() else _kept(members, np.flatnonzero(left))


def _empty_bodies(
    members: Members, values: BodyValues, problems: dict[int, ShapeFault], left: Array
) -> None:
    """Keep bodies of which no shape is left, but which state their mass and inertia."""
    whole = np.bincount(members.owner[left], minlength=len(values.mass)) == 0
    whole &= values.has_mass & values.has_inertia
    seen: set[int] = set()
    for row in sorted(problems):
        body = int(members.owner[row])
        if whole[body] and body not in seen:
            seen.add(body)
            members.kinds, members.dimensions = members.kinds.copy(), members.dimensions.copy()
            members.kinds[row], members.mesh_ids[row] = Kind.EMPTY, -1
            members.dimensions[row] = 0.0
            left[row] = True


def _note_skipped(tables: Tables, bodies: FoundBodies, members: Members, left: Array) -> None:
    """Note the bodies of which nothing is left, one by one."""
    kept = np.bincount(members.owner[left], minlength=len(bodies))
    for body in np.unique(members.owner[~left]).tolist():
        if kept[body]:
            continue
        row = int(bodies.bodies[body])
        name = tables.bodies.texts("name")[row] or tables.bodies.texts("sid")[row] or "?"
        home = tables.pool.resources[int(bodies.homes[body])]
        ordinal = int(tables.body_instances.ordinals[bodies.rows[body]])
        message = f"The body {name!r} is skipped: none of its shapes can be represented."
        tables.resource.note(rules.BODY_SKIPPED, ordinal, message, home=home)


def _note_frames(tables: Tables, bodies: FoundBodies, members: Members, weightless: Array) -> None:
    """Note the bodies that have neither shape nor mass."""
    count = np.bincount(members.owner[~weightless], minlength=len(bodies))
    noted: set[int] = set()
    for body in np.unique(members.owner[weightless]).tolist():
        row = int(bodies.bodies[body])
        if count[body] or row in noted:
            continue
        noted.add(row)
        name = tables.bodies.texts("name")[row] or tables.bodies.texts("sid")[row] or "?"
        home = tables.pool.resources[int(bodies.body_homes[body])]
        message = f"The body {name!r} has neither a shape nor a mass."
        tables.resource.note(rules.NO_BODY, int(tables.bodies.ordinals[row]), message, home=home)


def _kept(members: Members, rows: Array) -> Members:
    values = {}
    for name in Members.__dataclass_fields__:
        column = getattr(members, name)
        by_row = isinstance(column, np.ndarray)
        values[name] = column[rows] if by_row else column.take(rows)
    return Members(**values)


def _meshes(
    tables: Tables,
    every: ShapeColumns,
    rows: Array,
    homes: Array,
    ordinals: Array,
    hollow: Array,
    places: Array,
    geometries: Geometries,
    placed: Poses,
    mesh_ids: Array,
    volumes: Array,
    problems: dict[int, ShapeFault],
    kinds: Array,
) -> Poses:
    """Find the meshes of shapes; gives the poses of their centres of mass."""
    urls = [every.urls[row] for row in rows[places].tolist()]
    found, errors = tables.pool.follow(
        tables.geometries, urls, homes[places], ordinals[places], "geometry", needed=False
    )
    for at, error in errors.items():
        if is_unreachable(error):
            tables.resource.note_broken(error)
        problems[int(places[at])] = ShapeFault(error.findings[0].message)
    good = np.flatnonzero(found >= 0)
    centers = np.zeros((len(places), 3))
    for at, mesh in zip(good.tolist(), geometries.meshes(found[good]), strict=True):
        place = int(places[at])
        if isinstance(mesh, ShapeFault):
            problems[place] = mesh
            continue
        if mesh is None:
            kinds[place] = Kind.EMPTY
            continue
        mesh_ids[place] = mesh.id
        centers[at] = mesh.center_of(bool(hollow[place]))
        volumes[place] = mesh.volume
    inner = Poses.of(len(places), centers, moved=np.any(centers != 0.0, axis=1))
    settled = placed.take(places).then(inner)
    settled.moved &= np.any(settled.positions != 0.0, axis=1)
    settled.positions[~settled.moved] = 0.0
    poses = placed.take(np.arange(len(placed)))
    poses.put(places, settled)
    return poses


def _fault(code: int, kind: Kind, dimensions: Array) -> ShapeFault:
    if code == MISSING:
        return ShapeFault("The shape has no geometry.")
    if code == FLAT:
        return ShapeFault("The normal of the plane has no length.", empty=True)
    assert code == EMPTY
    text = " ".join(str(float(dimensions[place])) for place in NEEDED[kind])
    return ShapeFault(f"The {kind.name.lower()} has the dimensions {text}.", empty=True)


def _note(
    tables: Tables, bodies: FoundBodies, members: Members, row: int, problem: ShapeFault, *,
    skipped: bool,
) -> None:  # fmt: skip
    body = int(bodies.bodies[members.owner[row]])
    name = tables.bodies.texts("name")[body] or tables.bodies.texts("sid")[body] or "?"
    rule = rules.EMPTY_SHAPE if problem.empty else rules.NO_GEOMETRY
    left = "is skipped" if skipped else "is left out, its mass and inertia are kept"
    message = f"{problem.message} The shape of body {name!r} {left}."
    home = tables.pool.resources[int(members.homes[row])]
    tables.resource.note(rule, int(members.ordinals[row]), message, home=home)


def complete(
    tables: Tables,
    bodies: FoundBodies,
    members: Members,
    values: BodyValues,
    instance_values: BodyValues,
    materials: MaterialTable,
    shares: Array,
) -> None:
    """Give every shape a mass and a material (thesis 5.3: redistribution).

    `shares` (n,) marks bodies whose mass their shapes share in proportion to theirs.
    """
    members.material_rows = _material_rows(bodies, members, values, instance_values, materials)
    owner = members.owner
    bare = np.isnan(members.masses) & (members.kinds == Kind.EMPTY)
    members.masses[bare] = 0.0
    missing = np.isnan(members.masses) & (members.kinds != Kind.PLANE)
    if missing.any():
        _by_density(tables, bodies, members, values, materials, np.flatnonzero(missing))
    wanted = np.flatnonzero(shares & values.has_mass)
    if not len(wanted):
        return
    starts = np.searchsorted(owner, wanted, side="left")
    stops = np.searchsorted(owner, wanted, side="right")
    for body, start, stop in zip(wanted.tolist(), starts.tolist(), stops.tolist(), strict=True):
        # The whole has a mass of its own, which the shapes share in proportion to theirs.
        mass = float(values.mass[body])
        listed = np.nan_to_num(members.masses[start:stop]).tolist()
        volumes = members.volumes[start:stop].tolist()
        total = exact_sum(listed)
        weights = listed if total > 0.0 else volumes
        whole = total if total > 0.0 else exact_sum(volumes)
        if whole > 0.0 and total != mass:
            for row, weight in zip(range(start, stop), weights, strict=True):
                if members.kinds[row] != Kind.PLANE:
                    members.masses[row] = mass * (weight / whole)


def _material_rows(
    bodies: FoundBodies,
    members: Members,
    values: BodyValues,
    instance_values: BodyValues,
    materials: MaterialTable,
) -> Array:
    """Which material counts: that of the instance, of the body, or of the shape."""
    refs = members.material
    outer = np.full(len(bodies), UNSPECIFIED, np.int64)
    given = np.zeros(len(bodies), np.bool_)
    for source, homes in ((instance_values.material, bodies.homes),
                          (values.material, bodies.body_homes)):  # fmt: skip
        mine = np.flatnonzero((source.ordinals >= 0) & ~given)
        if len(mine):
            outer[mine] = materials.rows(source.take(mine), homes[mine])
            given[mine] = True
    if not given.any():
        return materials.rows(refs, members.homes)
    rows = outer[members.owner]
    inner = np.flatnonzero(~given[members.owner])
    rows[inner] = materials.rows(refs.take(inner), members.homes[inner])
    return rows


def _by_density(
    tables: Tables,
    bodies: FoundBodies,
    members: Members,
    values: BodyValues,
    materials: MaterialTable,
    places: Array,
) -> None:
    density = members.densities[places]
    unknown = np.isnan(density)
    density[unknown] = materials.densities(members.material_rows[places[unknown]])
    assumed = np.isnan(density)
    density[assumed] = STANDARD_DENSITY
    with np.errstate(all="ignore"):
        members.masses[places] = members.volumes[places] * density
    noted: set[int] = set()
    owners = members.owner[places[assumed]]
    for body in owners[~values.has_mass[owners]].tolist():
        row = int(bodies.bodies[body])
        if row not in noted:
            noted.add(row)
            home = tables.pool.resources[int(bodies.body_homes[body])]
            element = int(tables.bodies.ordinals[row])
            tables.resource.note(rules.DENSITY_ASSUMED, element, home=home)
