"""The regular bodies of models, as columns, and the others, to be read one by one."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from lxml import etree
from numpy.typing import NDArray

from colladaphy.document.names import c
from colladaphy.mapper.batches import Batch, Rows
from colladaphy.mapper.columns.bodies import BodyTable
from colladaphy.mapper.columns.joined import Joined
from colladaphy.mapper.columns.motions import MotionTable
from colladaphy.mapper.columns.nodes import NodeTable

if TYPE_CHECKING:
    from colladaphy.document import Document, Prefer
    from colladaphy.mapper.materials import MaterialTable

__all__ = ["RegularBodies"]

Array = NDArray[Any]


class Chosen(Sequence[etree._Element]):
    """Some of the elements of a table, of which none is made before it is asked for."""

    def __init__(self, table: BodyTable | MotionTable, rows: Array) -> None:
        self._table = table
        self._rows = rows

    def __len__(self) -> int:
        return len(self._rows)

    def __getitem__(self, index: Any) -> Any:
        if isinstance(index, slice):
            return [self._table.elements[row] for row in self._rows[index].tolist()]
        return self._table.elements[int(self._rows[index])]


class RegularBodies:
    """Reads the regular bodies of model instances."""

    def __init__(self, document: Document, materials: MaterialTable, prefer: Prefer) -> None:
        self._document = document
        self._materials = materials
        self._prefer = prefer
        self._tables: dict[etree._Element, BodyTable] = {}
        self._nodes: NodeTable | None = None
        self._ids: dict[str, int] = {}
        self._known: dict[str, etree._Element] | None = None

    def read(self, batch: Batch) -> Iterator[tuple[int, etree._Element]]:
        """Put the regular bodies of a model instance into its batch.

        Gives the other instances with their places, each when it is its turn: materials become
        the World's in the order in which bodies use them.
        """
        model, document = batch.model, self._document
        if model.parents or model.document is not document or model.model_document is not document:
            yield from enumerate(model.element.iterchildren(c("instance_rigid_body")))
            return
        motions, table, materials = self._gather(batch)
        assert self._nodes is not None
        joined = Joined(motions, table, self._nodes, materials, self._prefer)
        first: dict[str, int] = {}
        for place, url in zip(joined.rows.tolist(), joined.materials, strict=True):
            first.setdefault(url, place)
        urls = {place: url for url, place in first.items()}
        for place in sorted([*urls, *np.flatnonzero(~joined.regular).tolist()]):
            if place in urls:
                self._use(urls[place], materials[urls[place]])
            else:
                yield place, motions.elements[place]
        if not len(joined.rows):
            return
        batch.columns = columns = joined.columns(self._ids)
        batch.rows = Rows(
            Chosen(motions, joined.rows),
            joined.rows.tolist(),
            Chosen(table, joined.bodies),
            joined.sids,
            columns.kinds.tolist(),
        )

    def _gather(self, batch: Batch) -> tuple[MotionTable, BodyTable, dict[str, etree._Element]]:
        model = batch.model
        table = self._tables.get(model.model)
        if table is None:
            table = self._tables[model.model] = BodyTable(model.model)
        root = self._document.tree.getroot()
        if self._nodes is None:
            self._nodes = NodeTable(root)
        if self._known is None:
            self._known = {
                f"#{material.get('id')}": material
                for library in root.iterchildren(c("library_physics_materials"))
                for material in library.iterchildren(c("physics_material"))
            }
        return MotionTable(model.element), table, self._known

    def _use(self, url: str, material: etree._Element) -> None:
        if url not in self._ids:
            record = self._materials.record(material, self._document)
            assert record is not None
            self._ids[url] = self._materials.id_of(record)
