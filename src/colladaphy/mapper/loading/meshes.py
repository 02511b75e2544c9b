"""Geometries as meshes of a World, each read once (COLLADA 1.5 §mesh, §convex_mesh)."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.errors import DocumentError, WorldError
from colladaphy.mapper import rules
from colladaphy.mapper.hull import convex_hull
from colladaphy.mapper.loading.closedness import are_closed
from colladaphy.mapper.loading.surfaces import Surface, read_surfaces
from colladaphy.mapper.loading.tables import Tables
from colladaphy.world import Mesh, World

__all__ = ["Geometries", "ShapeFault"]

Array = NDArray[Any]

_OUR_ID = re.compile(r"(?:.*-)?Mesh(\d{1,18})\Z")


@dataclass(frozen=True, slots=True)
class ShapeFault:
    """Why a World cannot hold a shape; `empty` where it has no volume."""

    message: str
    empty: bool = False


@dataclass(slots=True)
class _Read:
    """A geometry with its surface, before it is a mesh."""

    surface: Surface
    convex: bool
    hull_of: str | None
    origin: int
    nothing: bool
    """Whether there are no points at all: the hull of nothing stands for no shape."""


class Geometries:
    """The meshes of a World that is being loaded, by the rows of their geometries."""

    def __init__(self, tables: Tables, world: World) -> None:
        self._tables = tables
        self._world = world
        self._read: dict[int, _Read | None] = {}
        self._known: dict[int, Mesh | ShapeFault | None] = {}

    def meshes(self, rows: Array) -> list[Mesh | ShapeFault | None]:
        """The meshes of geometries, created in this order; None for the hull of nothing."""
        listed = rows.tolist()
        fresh = list(dict.fromkeys(row for row in listed if row not in self._known))
        if fresh:
            self._add(fresh)
        return [self._known[row] for row in listed]

    def rows_of_meshes(self) -> dict[int, int]:
        """The first row of a geometry by the id of the mesh that it became."""
        found: dict[int, int] = {}
        for row, mesh in self._known.items():
            if isinstance(mesh, Mesh):
                found.setdefault(mesh.id, row)
        return found

    def _add(self, rows: list[int]) -> None:
        self._gather(rows)
        made: list[tuple[int, Array, Array, bool]] = []
        for row in rows:
            surface = self._surface(row, [])
            if surface is None or isinstance(surface, ShapeFault):
                self._known[row] = surface
                continue
            vertices, faces, convex, is_hull = surface
            name = self._tables.geometries.texts("id")[row]
            if is_hull:
                message = f"The convex hull of geometry {name!r} has {len(faces)} triangles."
                home, element = self._place(row)
                self._tables.resource.note(rules.HULL, element, message, home=home)
            if not len(faces):
                self._known[row] = ShapeFault(f"The geometry {name!r} has no faces.")
                continue
            made.append((row, vertices, faces, convex))
        self._create(self._closed(made))

    def _closed(
        self, made: list[tuple[int, Array, Array, bool]]
    ) -> list[tuple[int, Array, Array, bool]]:
        """The same with the hull in place of what encloses no volume; our own were asked before."""
        names = self._tables.geometries.texts("id")
        foreign = [place for place, (row, *_) in enumerate(made)
                   if _OUR_ID.match(names[row] or "") is None]  # fmt: skip
        closed = are_closed([made[place][1:3] for place in foreign])
        left = list(made)
        dropped: set[int] = set()
        for place in np.array(foreign, np.int64)[~closed].tolist():
            row, vertices, faces, _ = made[place]
            hull = convex_hull(vertices[np.unique(faces)])
            home, element = self._place(row)
            if hull is None:
                self._known[row] = ShapeFault(
                    f"The geometry {names[row]!r} has no volume.", empty=True
                )
                dropped.add(place)
                continue
            message = f"The surface of geometry {names[row]!r} has holes: its convex hull counts."
            self._tables.resource.note(rules.OPEN, element, message, home=home)
            left[place] = (row, *hull, True)
        return [one for place, one in enumerate(left) if place not in dropped]

    def _create(self, made: list[tuple[int, Array, Array, bool]]) -> None:
        """Create the meshes, one by one where the World does not take all of them."""
        if not made:
            return
        ids = self._ids([row for row, *_ in made])
        with np.errstate(all="ignore"):
            try:
                meshes = self._world.add_meshes([source[1:] for source in made], ids)
            except (WorldError, OverflowError):
                if len(made) > 1:
                    middle = len(made) // 2
                    self._create(made[:middle])
                    self._create(made[middle:])
                    return
                self._known[made[0][0]] = self._fault(made[0], ids[0])
                return
        for (row, *_), mesh in zip(made, meshes, strict=True):
            self._known[row] = mesh

    def _fault(self, made: tuple[int, Array, Array, bool], id: int) -> ShapeFault:
        _, vertices, faces, convex = made
        try:
            self._world.add_mesh(vertices, faces, convex=convex, id=id)
        except OverflowError:
            return ShapeFault("The mesh is too large for arithmetic.")
        except WorldError as error:
            return ShapeFault(error.findings[0].message, empty="volume" in str(error))
        raise AssertionError("a mesh that was refused is taken")

    def _ids(self, rows: list[int]) -> list[int]:
        """The ids that meshes had in the World that was stored, where they are free."""
        names = self._tables.geometries.texts("id")
        taken = set(self._world.meshes)
        ids: list[int | None] = []
        for row in rows:
            ours = _OUR_ID.match(names[row] or "")
            id = None if ours is None else int(ours.group(1))
            if id in taken:
                id = None
            if id is not None:
                taken.add(id)
            ids.append(id)
        last = max(taken, default=-1)
        made = []
        for id in ids:
            if id is None:
                last += 1
                id = last
            made.append(id)
        return made

    # --- surfaces

    def _place(self, row: int) -> tuple[Any, int]:
        table = self._tables.geometries
        home = int(table.homes(np.array([row]))[0])
        return self._tables.pool.resources[home], int(table.ordinals[row])

    def _gather(self, rows: list[int]) -> None:
        """Read the surfaces of geometries that are not read yet, document by document."""
        table = self._tables.geometries
        todo = np.array(sorted(row for row in rows if row not in self._read), np.int64)
        homes = table.homes(todo)
        for home in np.unique(homes).tolist():
            mine = todo[homes == home]
            part = table.parts[home].select(mine - table.start(home))
            for row in mine.tolist():
                self._read[row] = None
            for name in ("mesh", "convex_mesh"):
                found = getattr(part, name)
                if not len(found):
                    continue
                hulls = found.convex_hull_of if name == "convex_mesh" else [None] * len(found)
                surfaces = read_surfaces(found)
                bare = np.ones(len(found), np.bool_)
                bare[found.source.owner] = False
                bare &= name == "convex_mesh"
                for row, origin, surface, hull_of, nothing in zip(
                    mine[found.owner].tolist(), found.ordinals.tolist(), surfaces, hulls,
                    bare.tolist(), strict=True,
                ):  # fmt: skip
                    self._read[row] = _Read(
                        surface, name == "convex_mesh", hull_of, origin, nothing
                    )

    def _surface(
        self, row: int, path: list[int]
    ) -> tuple[Array, Array, bool, bool] | ShapeFault | None:
        """Vertices, faces, whether they are convex, and whether they are a computed hull.

        None where there is nothing, on purpose.
        """
        name = self._tables.geometries.texts("id")[row]
        if row in path:
            return ShapeFault(f"The geometry {name!r} is a convex hull of itself.")
        if row not in self._read:
            self._gather([row])
        read = self._read[row]
        if read is None:
            return ShapeFault(f"The geometry {name!r} is not a mesh.")
        if read.hull_of is not None:
            table = self._tables.geometries
            home = table.homes(np.array([row]))
            found, errors = self._tables.pool.follow(
                table, [read.hull_of], home, np.array([read.origin]), "geometry", needed=False
            )
            if errors:
                return ShapeFault(_message(errors[0]))
            outer = self._surface(int(found[0]), [*path, row])
            return _hull_of(outer[0]) if isinstance(outer, tuple) else outer
        if read.nothing:
            return None
        if read.surface.fault is not None:
            return ShapeFault(read.surface.fault)
        vertices, faces = read.surface.vertices, read.surface.faces
        if read.convex and not len(faces):
            return _hull_of(vertices)
        return vertices, faces, read.convex, False


def _message(error: DocumentError) -> str:
    return error.findings[0].message


def _hull_of(points: Array) -> tuple[Array, Array, bool, bool] | ShapeFault:
    hull = convex_hull(points)
    if hull is None:
        return ShapeFault("The convex hull has no volume.", empty=True)
    return *hull, True, True
