"""The bodies, and the places of the world, that attachments lead to."""

from __future__ import annotations

from functools import cached_property
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from colladaphy.errors import ColladaError, DocumentError
from colladaphy.links.addresses import split_reference
from colladaphy.links.pool import is_unreachable
from colladaphy.links.poses import Poses
from colladaphy.mapper import rules
from colladaphy.mapper.loading.bodies import LoadedBodies
from colladaphy.mapper.loading.constraints import Constraints
from colladaphy.mapper.loading.instances import Expansion
from colladaphy.mapper.loading.tables import Tables
from colladaphy.meaning.link_rules import BODY_TWICE

__all__ = ["Ends"]

Array = NDArray[Any]

_NONE: Final[dict[str, int]] = {}


class Ends:
    """Finds the bodies that attachments mean."""

    def __init__(
        self, tables: Tables, expansion: Expansion, loaded: LoadedBodies, created: Array,
        read: Constraints,
    ) -> None:  # fmt: skip
        self._tables = tables
        self._expansion = expansion
        self._created = created
        self._read = read
        self._found = loaded.found
        self._model_ids = [tables.models.texts("id")[row] for row in expansion.models.tolist()]

    @cached_property
    def _quick(self) -> dict[int, dict[str, int]]:
        """The bodies of each model by what nearly all references are: the sid of the body, alone
        or behind the id of the model; empty where any sid does not tell the body."""
        found, texts = self._found, self._tables.bodies.texts("sid")
        sids = [texts[row] for row in found.bodies.tolist()]
        known: dict[int, dict[str, int]] = {}
        if not sids:
            return known
        order = np.argsort(found.models, kind="stable")
        models, first = np.unique(found.models[order], return_index=True)
        for model, mine in zip(models.tolist(), np.split(order, first[1:]), strict=True):
            numbers = mine.tolist()
            names = [sids[body] for body in numbers]
            if len(set(names)) < len(names):
                return {}
            known[model] = dict(zip(names, numbers, strict=True))
            known[model] |= {f"{self._model_ids[model]}/{name}": body
                             for name, body in zip(names, numbers, strict=True)}  # fmt: skip
        return known if bool(self._created.all()) else {}

    @cached_property
    def _by_model(self) -> dict[tuple[int, int], list[int]]:
        known: dict[tuple[int, int], list[int]] = {}
        pairs = zip(self._found.models.tolist(), self._found.bodies.tolist(), strict=True)
        for body, pair in enumerate(pairs):
            known.setdefault(pair, []).append(body)
        return known

    @cached_property
    def _by_body(self) -> dict[int, list[int]]:
        known: dict[int, list[int]] = {}
        for body, row in enumerate(self._found.bodies.tolist()):
            known.setdefault(row, []).append(body)
        return known

    @cached_property
    def _by_node(self) -> dict[tuple[int, int], set[int]]:
        known: dict[tuple[int, int], set[int]] = {}
        pairs = zip(self._found.models.tolist(), self._found.nodes.tolist(), strict=True)
        for body, pair in enumerate(pairs):
            known.setdefault(pair, set()).add(body)
        return known

    @cached_property
    def _sids(self) -> dict[tuple[int, str], int]:
        bodies = self._tables.bodies
        known: dict[tuple[int, str], int] = {}
        pairs = zip(bodies.parent_keys.tolist(), bodies.texts("sid"), strict=True)
        for row, pair in enumerate(pairs):
            known.setdefault(pair, row)
        return known

    @cached_property
    def _model_keys(self) -> list[int]:
        keys: list[int] = self._tables.models.keys(self._expansion.models).tolist()
        return keys

    @cached_property
    def _children(self) -> dict[int, list[int]]:
        known: dict[int, list[int]] = {}
        for inner, around in enumerate(self._expansion.around.tolist()):
            known.setdefault(around, []).append(inner)
        return known

    @cached_property
    def _instance_sids(self) -> list[str | None]:
        return self._tables.model_instances.texts("sid")

    def attached(self, constraints: Array, models: Array) -> tuple[Array, Array, Poses]:
        """The numbers of those whose ends are all there, and their bodies (n, 2), -1 for the world.

        Of ends at nodes of the world the poses (2 n) of these are given.
        """
        references = self._read.references
        rows, around = constraints.tolist(), models.tolist()
        sides = [
            [named.get(reference) if (reference := references[2 * row + side]) else -1
             for row, named in zip(rows, [self._quick.get(model, _NONE) for model in around],
                                   strict=True)]
            for side in (0, 1)
        ]  # fmt: skip
        kept = np.ones(len(rows), np.bool_)
        nodes = np.full((len(rows), 2), -1, np.int64)
        for number, quick in enumerate(zip(*sides, strict=True)):
            if None in quick:
                found = self._ends(rows[number], around[number])
                kept[number] = found is not None
                bodies, nodes[number] = found or ((-1, -1), (-1, -1))
                sides[0][number], sides[1][number] = bodies
        flat = nodes[kept].reshape(-1)
        places = Poses.none(len(flat))
        there = np.flatnonzero(flat >= 0)
        if len(there):
            places.put(there, self._tables.placement.poses(flat[there])[0])
        return np.flatnonzero(kept), np.array(sides, np.int64).T[kept], places

    def _ends(self, row: int, model: int) -> tuple[tuple[int, ...], tuple[int, ...]] | None:
        """The bodies at the ends, -1 for the world, and the nodes there; None where it is lost."""
        references = self._read.references[2 * row : 2 * row + 2]
        ends: list[int] = []
        stands: list[int] = []
        try:
            for side, reference in enumerate(references):
                body, node = self._end(row, side, model, reference) if reference else (-1, -1)
                ends.append(body)
                stands.append(node)
        except ColladaError as error:
            self._tables.resource.note_broken(error)
            if is_unreachable(error):
                self._skip(row, references[len(ends)])
            return None
        self._moved(model, ends, stands)
        if -2 in ends:
            self._skip(row, references[ends.index(-2)])
            return None
        return tuple(ends), tuple(stands)

    def _moved(self, model: int, ends: list[int], stands: list[int]) -> None:
        """A node means the body that it moves, unless the other end is that body itself.

        A node that several bodies of the model move means none of them: it is of the world.
        """
        for side in (0, 1):
            if ends[side] == -1 and stands[side] >= 0:
                bodies = self._by_node.get((model, stands[side]), set())
                body = next(iter(bodies)) if len(bodies) == 1 else -1
                if body not in (-1, ends[1 - side]):
                    ends[side] = body if self._created[body] else -2
                    stands[side] = -1

    def _skip(self, row: int, reference: str) -> None:
        home, element = self._place(row)
        message = f"The body {reference!r} was not loaded; the constraint is skipped."
        self._tables.resource.note(rules.CONSTRAINT_SKIPPED, element, message, home=home)

    def _place(self, row: int) -> tuple[Any, int]:
        table = self._tables.constraints
        home = self._tables.pool.resources[int(table.homes(np.array([row]))[0])]
        return home, int(table.ordinals[row])

    def _end(self, row: int, side: int, model: int, reference: str) -> tuple[int, int]:
        """The body that an attachment means, -2 if it was not loaded; or -1 and a node."""
        file, head, sids = split_reference(reference)
        if not file:
            path = sids if head in (".", self._model_ids[model]) else [head, *sids]
            where: int | None = model
            for step in path[:-1]:
                where = None if where is None else self._child(where, step)
            if where is not None and path:
                body = self._sids.get((self._model_keys[where], path[-1]))
                if body is not None:
                    return self._only(self._by_model.get((where, body), ()), row, side), -1
        home, _ = self._place(row)
        origin = int(self._read.origins[row, side])
        target, element = home.follow(reference, origin, ("rigid_body", "node"))
        number = self._tables.pool.number(target)
        if target.columns.local_name(element) == "node":
            node = self._tables.placement.nodes.row_of(number, element)
            _, circles = self._tables.placement.poses(np.array([node]))
            if circles:
                raise circles[node]
            return -1, node
        body = self._tables.bodies.row_of(number, element)
        inside = self._walk(model)
        within = [found for inner in inside for found in self._by_model.get((inner, body), ())]
        return self._only(within or self._by_body.get(body, ()), row, side), -1

    def _child(self, model: int, name: str) -> int | None:
        """The instance within one of a sid, or else of a model's id."""
        children = self._children.get(model, ())
        rows = self._expansion.rows
        for child in children:
            if self._instance_sids[int(rows[child])] == name:
                return child
        for child in children:
            if self._model_ids[child] == name:
                return child
        return None

    def _walk(self, model: int) -> list[int]:
        found = [model]
        for inner in found:
            found += self._children.get(inner, ())
        return found

    def _only(self, bodies: Any, row: int, side: int) -> int:
        if len(bodies) > 1:
            home, _ = self._place(row)
            element = home.element(int(self._read.origins[row, side]))
            reference = self._read.references[2 * row + side]
            message = (
                f"The body {reference!r} is instanced {len(bodies)} times in one instance of its "
                "model, so a constraint cannot tell which one is meant."
            )
            raise DocumentError(BODY_TWICE.at(element, message, file=self._tables.resource.file))
        return bodies[0] if bodies and self._created[bodies[0]] else -2
