"""What bodies refer to: materials and geometries of the document, or new ones beside them."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
from lxml import etree

from colladaphy.document.updating.differences import same_material
from colladaphy.document.updating.elements import name_after, put
from colladaphy.document.updating.owning import Owner
from colladaphy.document.updating.stored import Stored
from colladaphy.links.names import c
from colladaphy.mapper import Loaded
from colladaphy.world import World

__all__ = ["Sources"]

_MATERIAL = re.compile(r"#Material(\d+)\Z")
_MESH = re.compile(r"#Mesh(\d+)\Z")
_NO_SHAPE = re.compile(r"(?:.*-)?NoShape\Z")


class Sources:
    """The urls of materials and geometries, by their ids in the World."""

    def __init__(self, loaded: Loaded, world: World, owner: Owner) -> None:
        self._loaded, self._world, self._owner = loaded, world, owner
        self._materials = loaded.materials.rows_of_ids()
        self._meshes = loaded.geometries.rows_of_meshes()
        self._urls: dict[str, str] = {}

    def resolve(self, element: etree._Element, stored: Stored) -> None:
        """Let a stored element refer to what the document has; what it lacks is added."""
        for inner in element.iter(c("instance_physics_material"), c("instance_geometry")):
            url = inner.get("url", "")
            if url not in self._urls:
                self._urls[url] = self._found(url) or self._added(url, stored)
            inner.set("url", self._urls[url])

    def material(self, id: int) -> str | None:
        """The url of a material of the World that the document has, whatever id it would get."""
        known = self._urls.get(f"#Material{id}")
        return known or self._known(self._loaded.tables.materials, self._materials.get(id))

    def _found(self, url: str) -> str | None:
        material = _MATERIAL.match(url)
        if material:
            id = int(material[1])
            row = self._materials.get(id)
            if row is None or not self._loaded.materials.keeps_id(row, id):
                return None
            if not same_material(self._loaded.world, self._world, id):
                return None
            return self._known(self._loaded.tables.materials, row)
        mesh = _MESH.match(url)
        if not mesh:
            return self._no_shape()
        before = self._loaded.world.meshes.get(int(mesh[1]))
        after = self._world.meshes[int(mesh[1])]
        if before is None or not (before is after or before.same_as(after)):
            return None
        return self._known(self._loaded.tables.geometries, self._meshes.get(before.id))

    def _no_shape(self) -> str | None:
        """The geometry of ours that stands for no shape."""
        table = self._loaded.tables.geometries
        ids = enumerate(table.texts("id"))
        ours = (row for row, id in ids if id is not None and _NO_SHAPE.match(id))
        return self._known(table, next(ours, None))

    def _known(self, table: Any, row: int | None) -> str | None:
        if row is None:
            return None
        home = int(table.homes(np.array([row]))[0])
        id = table.texts("id")[row]
        return None if id is None else f"{self._owner.prefix(home)}#{id}"

    def _added(self, url: str, stored: Stored) -> str:
        known = url.removeprefix("#")
        if _MATERIAL.match(url):
            made, library = (
                stored.materials[int(known.removeprefix("Material"))],
                "physics_material",
            )
            names = "library_physics_materials"
        else:
            made, library, names = stored.geometries[known], "geometry", "library_geometries"
        ids: dict[str, str] = {}
        for inner in made.iter(etree.Element):
            old = inner.get("id")
            if old is not None:
                ids[old] = name_after(old, self._owner.taken)
                inner.set("id", ids[old])
        for inner in made.iter(etree.Element):
            source = inner.get("source", "")
            if source.removeprefix("#") in ids:
                inner.set("source", f"#{ids[source.removeprefix('#')]}")
        put(self._owner.library(names), made, ("asset", library))
        return f"#{ids[known]}"
