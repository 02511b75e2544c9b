"""The bodies of one model instance: regular ones in columns, the others as plans."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.errors import WorldError
from colladaphy.mapper.creation import free_ids, parts_of
from colladaphy.mapper.plans import Part, Plan
from colladaphy.world.columns import BodyColumns
from colladaphy.world.kinds import Kind

if TYPE_CHECKING:
    from lxml import etree

    from colladaphy.mapper.instances import ModelInstance
    from colladaphy.world import World

__all__ = ["Batch", "Rows", "assign_ids"]

Array = NDArray[Any]


@dataclass(slots=True)
class Rows:
    """The bodies in columns, as far as ids and constraints need them; one entry a body."""

    elements: Sequence[etree._Element] = ()
    """The instance_rigid_body elements."""
    places: list[int] = field(default_factory=list)
    """Their places among all instances of the model."""
    bodies: Sequence[etree._Element] = ()
    """The rigid_body elements."""
    sids: list[int | None] = field(default_factory=list)
    """The system ids that are wanted."""
    kinds: list[int] = field(default_factory=list)

    def __len__(self) -> int:
        return len(self.elements)


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
