"""Bodies and constraints that instances of physics models name (COLLADA 1.5 §physics_model)."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.errors import ColladaError
from colladaphy.links.addresses import split_reference
from colladaphy.links.names import c
from colladaphy.links.resource import Resource
from colladaphy.links.rules import MISSING
from colladaphy.meaning import link_rules
from colladaphy.meaning.context import Context, NamedRows
from colladaphy.meaning.hits import Hit
from colladaphy.meaning.links import reference_hits
from colladaphy_schema.rows import Rows

__all__ = ["CHECKS", "Parts", "ends", "instanced_bodies", "instanced_constraints", "parts_of"]


_KINDS = {
    "instance_rigid_body": ("body", "rigid_body"),
    "instance_rigid_constraint": ("constraint", "rigid_constraint"),
}
Array = NDArray[Any]


def parts_of(context: Context) -> Parts:
    """The parts of the models of a document and of those that it refers to."""
    return Parts(context.resource)


class Parts:
    """Sids of rigid bodies and constraints, by the physics model that an instance refers to."""

    def __init__(self, resource: Resource) -> None:
        self._resource = resource
        self._own: dict[tuple[int, str], dict[int, dict[str, int]]] = {}
        self._all: dict[tuple[int, int, str], frozenset[str]] = {}
        self._models: dict[tuple[int, int], tuple[Resource, int] | None] = {}
        self._texts: dict[tuple[int, int, str], str | None] = {}

    def _text(self, home: Resource, element: int, name: str) -> str | None:
        """An attribute of an element, which is asked for again and again."""
        key = (id(home), element, name)
        if key not in self._texts:
            self._texts[key] = home.columns.attribute_of(element, name)
        return self._texts[key]

    def model(self, resource: Resource, instance: int) -> tuple[Resource, int] | None:
        """The model that an instance_physics_model refers to; None where it cannot be found."""
        key = (id(resource), instance)
        if key not in self._models:
            url = resource.columns.attribute_of(instance, "url") or ""
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
        file, head, sids = split_reference(reference)
        if file:
            return None
        id = self._text(home, model, "id")
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
            if self._text(home, instance, "sid") == name:
                return self.model(home, instance)
        for instance in instances:
            found = self.model(home, instance)
            if found is not None and self._text(*found, "id") == name:
                return found
        return None

    def own(self, home: Resource, kind: str) -> dict[int, dict[str, int]]:
        """The elements of a kind by their sids (of instances by their numbers), by parent."""
        key = (id(home), kind)
        if key not in self._own:
            found: defaultdict[int, dict[str, int]] = defaultdict(dict)
            rows = home.columns.rows(Rows, c(kind))
            assert rows.ordinals is not None
            numbers = rows.ordinals.tolist()
            parents = home.columns.index.parent[rows.ordinals].tolist()
            texts: list[str | None] = list(map(str, numbers))
            if not kind.startswith("instance_"):
                texts = home.columns.column(rows, NamedRows.sid)
            for number, parent, text in zip(numbers, parents, texts, strict=True):
                if text is not None:
                    found[parent].setdefault(text, number)
            self._own[key] = dict(found)
        return self._own[key]


class Instanced:
    """The instances of bodies, or of constraints, with what they name in their models."""

    def __init__(self, context: Context, name: str) -> None:
        attribute, kind = _KINDS[name]
        rows = context.rows(Rows, name)
        assert rows.ordinals is not None
        self.elements: Array = rows.ordinals.astype(np.int64)
        self.texts = [text or "" for text in context.texts(rows, attribute)]
        self.around: Array = context.parent[rows.ordinals].astype(np.int64)
        """(n,) the instances of models that they stand in."""
        parts, home = context.shared(parts_of), context.resource
        self.parts: Array = np.full(len(rows), -1, np.int64)
        """(n,) the elements that they name, in this document; -1 for none."""
        self.lost: Array = np.zeros(len(rows), np.bool_)
        """(n,) which name nothing, though their model is there."""
        cuts = np.flatnonzero(self.around[1:] != self.around[:-1]) + 1
        for mine in np.split(np.arange(len(rows)), cuts) if len(rows) else ():
            model = parts.model(home, int(self.around[mine[0]]))
            if model is None:
                continue  # reported at the instance
            known = parts.own(model[0], kind).get(model[1], {})
            sids = [self.texts[row].rpartition("/")[2] for row in mine.tolist()]
            found = np.array([known.get(sid, -1) for sid in sids], np.int64)
            lost = found < 0
            if lost.any():
                within = parts.within(*model, kind)
                for place in np.flatnonzero(lost).tolist():
                    self.lost[mine[place]] = sids[place] not in within
            if model[0] is home:
                self.parts[mine] = found


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
            yield Hit(MISSING, int(found.elements[row]), message, (), attribute)


def constraints_once(context: Context) -> Iterator[Hit]:
    """Constraints that are instanced twice."""
    found = instanced_constraints(context)
    seen: dict[tuple[int, int], int] = {}
    for element, around, part in zip(
        found.elements.tolist(), found.around.tolist(), found.parts.tolist(), strict=True
    ):
        first = seen.setdefault((around, part), element)
        if part >= 0 and first != element:
            message = f"{context.label(part)} is instanced already in this instance of its model."
            yield Hit(link_rules.CONSTRAINT_TWICE, element, message, (first, part), "constraint")


def _broken(context: Context) -> set[int]:
    """Instances of models with an instance of a body that is not there."""
    found = instanced_bodies(context)
    return set(found.around[found.lost].tolist())


def attachments(context: Context) -> Iterator[Hit]:
    """What the attachments of constraints refer to; the empty reference is the world."""
    parts, home = context.shared(parts_of), context.resource
    for name in ("ref_attachment", "attachment"):
        for reference in context.references("rigid_body", name):
            text = reference.text.strip()
            if not text:
                continue
            model = int(context.parent[context.parent[reference.element]])
            if parts.attached(home, model, text) is None:
                yield from reference_hits(
                    context, reference.element, "rigid_body", text, ("rigid_body", "node"),
                    addressed=True,
                )  # fmt: skip


def ends(context: Context) -> Iterator[Hit]:
    """Constraints in effect whose bodies are there twice, or not at all."""
    parts = context.shared(parts_of)
    home = context.resource
    if not len(context.ordinals("instance_rigid_constraint")):
        return
    bodies: defaultdict[tuple[int, int], list[int]] = defaultdict(list)
    there = instanced_bodies(context)
    for around, part, element in zip(
        there.around.tolist(), there.parts.tolist(), there.elements.tolist(), strict=True
    ):
        bodies[around, part].append(element)
    attached = {
        name: {int(context.parent[r.element]): r for r in context.references("rigid_body", name)}
        for name in ("ref_attachment", "attachment")
    }
    nested = set(context.parent[context.ordinals("instance_physics_model")].tolist())
    told: set[int] = set()
    broken = context.shared(_broken)
    for reference in context.references("constraint", "instance_rigid_constraint"):
        instance = int(context.parent[reference.element])
        model = parts.model(home, instance)
        if model is None or model[0] is not home:
            continue
        constraint = parts.named(*model, "rigid_constraint", reference.text.rpartition("/")[2])
        if constraint is None:
            continue
        for name, ends in attached.items():
            end = ends.get(constraint)
            text = "" if end is None else end.text.strip()
            meant = parts.attached(*model, text) if text else None
            if end is None or meant is None or meant[0] is not home:
                continue
            body = meant[1]
            if context.parent[body] != model[1]:
                continue  # in a model within the model
            sid = home.columns.attribute_of(body, "sid") or ""
            found = bodies.get((instance, body), [])
            if len(found) > 1 and found[1] not in told:
                told.add(found[1])
                message = (
                    f"The body {sid!r} is instanced {len(found)} times in one instance of its "
                    f"model, so the constraint {reference.text!r} cannot tell which one is meant."
                )
                yield Hit(link_rules.BODY_TWICE, found[1], message, (found[0], end.element), "body")
            elif (
                not found
                and model[1] not in nested
                and instance not in broken
                and reference.element not in told
            ):
                told.add(reference.element)
                message = (
                    f"The constraint {reference.text!r} attaches to the body {sid!r} ({name}), "
                    "which this instance of the model does not instance."
                )
                related = (end.element, body)
                yield Hit(
                    link_rules.BODY_NOT_INSTANCED, reference.element, message, related, "constraint"
                )


CHECKS = (named_parts, constraints_once, attachments, ends)
