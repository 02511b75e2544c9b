"""Bodies and constraints that instances of physics models name (COLLADA 1.5 §physics_model)."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.distinct import distinct, rows_among
from colladaphy.errors import ColladaError
from colladaphy.links.addresses import split_reference
from colladaphy.links.names import c
from colladaphy.links.resource import Resource
from colladaphy.links.rules import MISSING
from colladaphy.meaning import link_rules
from colladaphy.meaning.context import Context, texts_of
from colladaphy.meaning.hits import Hit
from colladaphy_schema.rows import Rows

__all__ = ["CHECKS", "Parts", "instanced_bodies", "instanced_constraints", "parts_of"]


_KINDS = {
    "instance_rigid_body": ("body", "rigid_body"),
    "instance_rigid_constraint": ("constraint", "rigid_constraint"),
}

Array = NDArray[Any]


def parts_of(context: Context) -> Parts:
    """The parts of the models of a document and of those that it refers to."""
    parts, rows = Parts(context.resource), context.rows(Rows, "instance_physics_model")
    assert rows.ordinals is not None
    models = _own_models(context)
    here = models >= 0
    parts.know(rows.ordinals[here].tolist(), models[here].tolist())
    return parts


def _own_models(context: Context) -> Array:
    """The models (n,) of the document that instances of models refer to by ``#id``; -1 for none."""
    leads = context.leads("instance_physics_model", "url")
    good = leads.plain & context.is_named(leads.targets, "physics_model")
    return np.where(good, leads.targets, -1)


class Parts:
    """Sids of rigid bodies and constraints, by the physics model that an instance refers to."""

    def __init__(self, resource: Resource) -> None:
        self._resource = resource
        self._own: dict[tuple[int, str], dict[int, dict[str, int]]] = {}
        self._all: dict[tuple[int, int, str], frozenset[str]] = {}
        self._models: dict[tuple[int, int], tuple[Resource, int] | None] = {}
        self._texts: dict[tuple[int, str, str], dict[int, str | None]] = {}

    def text(self, home: Resource, kind: str, element: int, name: str) -> str | None:
        """An attribute of an element of a kind; those of all are read at once."""
        key = (id(home), kind, name)
        if key not in self._texts:
            rows = home.columns.rows(Rows, c(kind))
            assert rows.ordinals is not None
            texts = texts_of(home.columns, rows, name)
            self._texts[key] = dict(zip(rows.ordinals.tolist(), texts, strict=True))
        return self._texts[key].get(element)

    def know(self, instances: list[int], models: list[int]) -> None:
        """The models of the document itself that instances of models in it refer to."""
        home = self._resource
        self._models.update(
            ((id(home), instance), (home, model))
            for instance, model in zip(instances, models, strict=True)
        )

    def model(self, resource: Resource, instance: int) -> tuple[Resource, int] | None:
        """The model that an instance_physics_model refers to; None where it cannot be found."""
        key = (id(resource), instance)
        if key not in self._models:
            url = self.text(resource, "instance_physics_model", instance, "url") or ""
            known = resource.ids.get(url[1:]) if url[:1] == "#" else None
            found: tuple[Resource, int] | None = None
            if known is not None:
                if resource.columns.local_name(known) == "physics_model":
                    found = resource, known
            else:
                try:
                    found = resource.follow(url, instance, "physics_model")
                except ColladaError:
                    found = None
            self._models[key] = found
        return self._models[key]

    def named(self, home: Resource, model: int, kind: str, sid: str) -> int | None:
        """The element of a sid in a model itself."""
        return self.own(home, kind).get(model, {}).get(sid)

    def within(self, home: Resource, model: int, kind: str) -> frozenset[str]:
        """Sids in the model and in the models that it instances, each looked at once."""
        key = (id(home), model, kind)
        if key not in self._all:
            sids: set[str] = set()
            seen = {(id(home), model)}
            waiting = [(home, model)]
            while waiting:
                where, inner = waiting.pop()
                sids |= self.own(where, kind).get(inner, {}).keys()
                for instance in self.own(where, "instance_physics_model").get(inner, {}).values():
                    found = self.model(where, instance)
                    if found is not None and (id(found[0]), found[1]) not in seen:
                        seen.add((id(found[0]), found[1]))
                        waiting.append(found)
            self._all[key] = frozenset(sids)
        return self._all[key]

    def attached(self, home: Resource, model: int, reference: str) -> tuple[Resource, int] | None:
        """The rigid_body that an attachment within a model means; None for what names none.

        It is named by its sid, after the id of the model or the sids of models within it.
        """
        id = self.text(home, "physics_model", model, "id")
        file, head, sids = split_reference(reference)
        if file:
            return None
        path = sids if head == "." or head == id else [head, *sids]
        where: tuple[Resource, int] | None = (home, model)
        for step in path[:-1]:
            where = None if where is None else self._inner(*where, step)
        if where is None or not path:
            return None
        body = self.named(*where, "rigid_body", path[-1])
        return None if body is None else (where[0], body)

    def _inner(self, home: Resource, model: int, name: str) -> tuple[Resource, int] | None:
        """The model that is instanced in one by the sid of the instance, or by its own id."""
        instances = self.own(home, "instance_physics_model").get(model, {}).values()
        for instance in instances:
            if self.text(home, "instance_physics_model", instance, "sid") == name:
                return self.model(home, instance)
        for instance in instances:
            found = self.model(home, instance)
            if found is not None and self.text(found[0], "physics_model", found[1], "id") == name:
                return found
        return None

    def own(self, home: Resource, kind: str) -> dict[int, dict[str, int]]:
        """The elements of a kind by their sids (of instances by their numbers), by parent."""
        key = (id(home), kind)
        if key not in self._own:
            rows = home.columns.rows(Rows, c(kind))
            assert rows.ordinals is not None
            numbers = rows.ordinals.tolist()
            parents = home.columns.index.parent[rows.ordinals]
            texts: list[str | None] = list(map(str, numbers))
            if not kind.startswith("instance_"):
                texts = texts_of(home.columns, rows, "sid")
            cuts = [0, *(np.flatnonzero(np.diff(parents)) + 1).tolist(), len(numbers)]
            found: dict[int, dict[str, int]] = {}
            for first, last in pairwise(cuts):
                # Of those of one sid the first counts.
                each: dict[Any, int] = dict(
                    zip(texts[first:last][::-1], numbers[first:last][::-1], strict=True)
                )
                each.pop(None, None)
                if each:
                    parent = int(parents[first])
                    found[parent] = {**each, **found.get(parent, {})}
            self._own[key] = found
        return self._own[key]


class Instanced:
    """The instances of bodies, or of constraints, with what they name in their models."""

    def __init__(self, context: Context, name: str) -> None:
        attribute, kind = _KINDS[name]
        rows = context.rows(Rows, name)
        assert rows.ordinals is not None
        self.elements: Array = rows.ordinals.astype(np.int64)
        self._context, self._rows, self._attribute = context, rows, attribute
        self.around: Array = context.parent[rows.ordinals].astype(np.int64)
        """(n,) the instances of models that they stand in."""
        parts, home = context.shared(parts_of), context.resource
        self.lost: Array = np.zeros(len(rows), np.bool_)
        """(n,) which name nothing, though their model is there."""
        self.parts: Array = self._directly(kind)
        """(n,) the elements that they name, in this document; -1 for none."""
        for row in np.flatnonzero(self.parts < 0).tolist():
            sid = self.texts[row].rpartition("/")[2]
            model = parts.model(home, int(self.around[row]))
            if model is None:  # which is reported at its instance
                continue
            if model[0] is home:
                self.parts[row] = parts.own(home, kind).get(model[1], {}).get(sid, -1)
            if self.parts[row] < 0:
                self.lost[row] = sid not in parts.within(*model, kind)

    def _directly(self, kind: str) -> Array:
        """Those that are named by the sid alone, of models of the document."""
        context, columns = self._context, self._context.columns
        models = context.ordinals("instance_physics_model")
        scopes = np.append(_own_models(context), -1)[rows_among(models, self.around)]
        there, ranges = columns.ranges(self._rows, self._attribute)
        every = np.full(len(self.elements), -1, np.int64)
        found = columns.scoped_identifiers.matched(
            ranges, scopes if there is None else scopes[there]
        )
        every[slice(None) if there is None else there] = found
        return np.where(context.is_named(every, kind), every, -1)

    @cached_property
    def texts(self) -> list[str]:
        """What they say."""
        return [text or "" for text in self._context.texts(self._rows, self._attribute)]


def instanced_bodies(context: Context) -> Instanced:
    """The instances of bodies of a document."""
    return context.shared(_bodies)


def instanced_constraints(context: Context) -> Instanced:
    """The instances of constraints of a document."""
    return context.shared(_constraints)


def _bodies(context: Context) -> Instanced:
    return Instanced(context, "instance_rigid_body")


def _constraints(context: Context) -> Instanced:
    return Instanced(context, "instance_rigid_constraint")


def named_parts(context: Context) -> Iterator[Hit]:
    """Instances that name no body, or no constraint, of their model."""
    parts, home = context.shared(parts_of), context.resource
    for found, other in ((instanced_bodies(context), "rigid_constraint"),
                         (instanced_constraints(context), "rigid_body")):  # fmt: skip
        kind = "rigid_body" if other == "rigid_constraint" else "rigid_constraint"
        for row in np.flatnonzero(found.lost).tolist():
            instance, text = int(found.around[row]), found.texts[row]
            model = parts.model(home, instance)
            url = home.columns.attribute_of(instance, "url") or ""
            message = f"The physics model {url!r} has no <{kind}> of sid {text!r}."
            if model and parts.named(*model, other, text.rpartition("/")[2]) is not None:
                message = f"{text!r} is a <{other}> of the model {url!r}, not a <{kind}>."
            attribute = "body" if kind == "rigid_body" else "constraint"
            beside = (model[1],) if model and model[0] is home else ()
            yield Hit(MISSING, int(found.elements[row]), message, beside, attribute)


def constraints_once(context: Context) -> Iterator[Hit]:
    """Constraints that are instanced twice."""
    found = instanced_constraints(context)
    keys = (found.around * len(context.parent) + found.parts)[found.parts >= 0]
    if len(distinct(keys)) == len(keys):
        return
    seen: dict[tuple[int, int], int] = {}
    for element, around, part in zip(
        found.elements.tolist(), found.around.tolist(), found.parts.tolist(), strict=True
    ):
        first = seen.setdefault((around, part), element)
        if part >= 0 and first != element:
            message = f"{context.label(part)} is instanced already in this instance of its model."
            yield Hit(link_rules.CONSTRAINT_TWICE, element, message, (first, part), "constraint")


CHECKS = (named_parts, constraints_once)
