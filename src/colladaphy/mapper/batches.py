"""The bodies of one model instance: regular ones in columns, the others as plans."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.errors import WorldError
from colladaphy.mapper.creation import free_ids, parts_of
from colladaphy.mapper.plans import Part, Plan
from colladaphy.mapper.rows import Nodes, Rows, columns_of, read_rows
from colladaphy.world.columns import BodyColumns
from colladaphy.world.kinds import Kind

if TYPE_CHECKING:
    from lxml import etree

    from colladaphy.document import Document, Prefer
    from colladaphy.mapper.instances import ModelInstance
    from colladaphy.mapper.materials import MaterialTable
    from colladaphy.world import World

__all__ = ["Batch", "RegularBodies", "assign_ids"]

Array = NDArray[Any]


class Batch:
    """What was read of one model instance."""

    def __init__(self, model: ModelInstance) -> None:
        self.model = model
        self.rows = Rows()
        self.columns: BodyColumns | None = None
        self.sids: Array = np.zeros(0, dtype=np.int64)
        """The system ids that the rows get."""
        self.plans: list[tuple[int, Plan]] = []
        """Other bodies, with their places among the model's instances."""

    def __len__(self) -> int:
        return len(self.rows) + len(self.plans)

    def clear(self) -> None:
        """Forget the rows."""
        self.rows, self.columns = Rows(), None

    def extend(self, world: World) -> bool:
        """Create the rows' bodies; False where the World refuses them."""
        if self.columns is None:
            return True
        self.columns.sids = self.sids
        try:
            world.extend(self.columns)
        except WorldError:
            return False
        return True

    def stand_ins(self) -> Iterator[tuple[etree._Element, Plan]]:
        """A plan for every row, with the little that constraints need to know."""
        rows = self.rows
        for kind, sid, body, element in zip(
            rows.kinds, self.sids.tolist(), rows.bodies, rows.elements, strict=False
        ):
            yield body, Plan(Part(Kind(kind), sid=sid), element, self.model.document.file)


class RegularBodies:
    """Reads the regular bodies of model instances."""

    def __init__(self, materials: MaterialTable, prefer: Prefer) -> None:
        self._materials = materials
        self._prefer = prefer
        self._nodes: dict[int, Nodes] = {}

    def read(self, batch: Batch) -> list[tuple[int, etree._Element]]:
        """Put the regular bodies of a model instance into its batch; returns the others."""
        rows, others = read_rows(batch.model, self._nodes_of(batch.model.document), self._materials)
        if not len(rows):
            return others
        try:
            columns, doubtful = columns_of(rows, self._prefer)
        except ValueError:
            return sorted([*others, *zip(rows.places, rows.elements, strict=True)], key=_place)
        if doubtful:
            others += [(rows.places[row], rows.elements[row]) for row in doubtful]
            others.sort(key=_place)
            columns = _without(rows, columns, doubtful)
        batch.rows, batch.columns = rows, columns
        return others

    def _nodes_of(self, document: Document) -> Nodes:
        known = self._nodes.get(id(document))
        if known is None:
            known = self._nodes[id(document)] = Nodes(document)
        return known


def _place(other: tuple[int, object]) -> int:
    return other[0]


def _without(rows: Rows, columns: BodyColumns, doubtful: Sequence[int]) -> BodyColumns:
    """Take rows out, of the lists that are still needed and of the columns."""
    left = sorted(set(range(len(rows))) - set(doubtful))
    for name in ("elements", "places", "bodies", "sids", "names", "kinds"):
        values = getattr(rows, name)
        setattr(rows, name, [values[row] for row in left])
    chosen = {
        name: getattr(columns, name)[left]
        for name in BodyColumns.__slots__
        if isinstance(getattr(columns, name), np.ndarray)
    }
    return BodyColumns(**chosen, names=rows.names)


def assign_ids(batches: Sequence[Batch]) -> None:
    """Give every body its system id: the wanted one, or the next in the document's order."""
    parts = [part for batch in batches for _, plan in batch.plans for part in parts_of(plan.part)]
    wanted = [sid for batch in batches for sid in batch.rows.sids]
    wanted += [part.sid for part in parts]
    known = [sid for sid in wanted if sid is not None and sid > 0]
    if len(known) == len(wanted) and len(set(known)) == len(known):
        for batch in batches:
            batch.sids = np.array(batch.rows.sids, dtype=np.int64)
        return
    order: list[tuple[int, int, int, Part | None]] = []
    for number, batch in enumerate(batches):
        batch.sids = np.zeros(len(batch.rows), dtype=np.int64)
        order += [(number, place, row, None) for row, place in enumerate(batch.rows.places)]
        for place, plan in batch.plans:
            order += [(number, place, 0, part) for part in parts_of(plan.part)]
    order.sort(key=lambda entry: entry[:2])
    claims = [
        batches[number].rows.sids[row] if part is None else part.sid
        for number, _, row, part in order
    ]
    for (number, _, row, part), sid in zip(order, free_ids(claims, ()), strict=True):
        if part is None:
            batches[number].sids[row] = sid
        else:
            part.sid = sid
