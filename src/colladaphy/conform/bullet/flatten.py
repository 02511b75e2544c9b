"""Physics models without nesting: a list of bodies and constraints for each instance in the scene.

Bullet looks for bodies by their plain sid, over the whole file for constraints, and loses track of
bodies in models of models. So each instance in the scene gets a model of its own that holds all its
bodies, each with a sid of its own (COLLADA 1.5 §instance_physics_model).
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from lxml import etree

from colladaphy.conform.bullet import rules
from colladaphy.conform.bullet.markup import Names, children, copy_of, insert_all
from colladaphy.conform.downgrade.draft import Draft, detach, local
from colladaphy.conform.frames import Matrix

__all__ = ["Body", "Constraint", "Level", "flatten"]


@dataclass(eq=False)
class Body:
    """One body that Bullet will have: its instance and a rigid_body of its own."""

    instance: etree._Element
    element: etree._Element
    level: Level
    sid: str
    """What the rigid_body was called in its model; `instance` has the new one."""
    pose: Matrix = field(default_factory=lambda: np.eye(4))
    """Of the rigid_body's frame, in the world."""
    inner: Matrix = field(default_factory=lambda: np.eye(4))
    """Of the frame that Bullet's body has, in the rigid_body's frame."""
    is_aside: bool = False
    """Whether Bullet cannot have it, so that its instance is only kept."""


@dataclass(eq=False)
class Constraint:
    """One constraint that Bullet will have, with the level that its references start from."""

    instance: etree._Element
    element: etree._Element
    level: Level


@dataclass(eq=False)
class Level:
    """An instance of a physics model, in the scene or in another model."""

    instance: etree._Element
    model: etree._Element
    parents: tuple[str, ...]
    """The urls of the nodes that this instance and those around it stand under."""
    bodies: list[Body] = field(default_factory=list)
    constraints: list[Constraint] = field(default_factory=list)
    inner: list[Level] = field(default_factory=list)
    _by_name: dict[str, Body] | None = None

    def body(self, name: str) -> Body | None:
        """The first body of this level with this sid or id, or whose target has this id."""
        if self._by_name is None:
            self._by_name = {}
            for key in (_sid_of, _id_of, _target_of):
                for body in self.bodies:
                    self._by_name.setdefault(key(body), body)
        return self._by_name.get(name) if name else None

    def everything(self) -> list[Level]:
        """This level and those within."""
        return [self, *(level for inner in self.inner for level in inner.everything())]


def _sid_of(body: Body) -> str:
    return body.sid


def _id_of(body: Body) -> str:
    return "#" + body.element.get("id", "")


def _target_of(body: Body) -> str:
    return "#" + body.instance.get("target", "").strip().removeprefix("#")


class _Models:
    """The physics models as they were, with their members by sid."""

    def __init__(self, models: dict[str, etree._Element]) -> None:
        self.by_id = {name: copy_of(model) for name, model in models.items()}
        self._members: dict[etree._Element, dict[tuple[str, str], etree._Element]] = {}

    def member(self, model: etree._Element, kind: str, sid: str) -> etree._Element | None:
        """The rigid_body or rigid_constraint of this sid in a model."""
        if model not in self._members:
            members = self._members[model] = {}
            for member in children(model, "rigid_body", "rigid_constraint"):
                members.setdefault((local(member), member.get("sid", "")), member)
        return self._members[model].get((kind, sid))


def flatten(draft: Draft, scene: etree._Element) -> list[Level]:
    """Give every instance of a model in `scene` a flat model of its own."""
    models = {model.get("id", ""): model for model in draft.all("physics_model")}
    originals = _Models(models)
    ids = Names(element.get("id", "") for element in draft.everything())
    sids = Names()
    used: set[str] = set()
    levels = []
    for instance in children(scene, "instance_physics_model"):
        name = instance.get("url", "").strip().removeprefix("#")
        if name not in originals.by_id:
            message = f"The physics model {instance.get('url')!r} is not in this file."
            draft.note(rules.EXTERNAL, instance, message)
            detach(instance)
            continue
        target = models[name]
        if name in used:
            target = copy_of(originals.by_id[name])
            _forget_ids(target)
            target.set("id", ids.new(name))
            models[name].addnext(target)
            instance.set("url", "#" + target.get("id", ""))
        used.add(name)
        level = _read(draft, instance, originals, (name,), ())
        _write(draft, level, target, sids)
        levels.append(level)
    return levels


def _read(
    draft: Draft,
    instance: etree._Element,
    models: _Models,
    path: tuple[str, ...],
    parents: tuple[str, ...],
) -> Level:
    model = models.by_id[path[-1]]
    own = instance.get("parent", "").strip()
    level = Level(instance, model, (*parents, own) if own else parents)
    for inner in children(model, "instance_physics_model"):
        name = inner.get("url", "").strip().removeprefix("#")
        if name in models.by_id and name not in path:
            level.inner.append(_read(draft, inner, models, (*path, name), level.parents))
        else:
            message = f"The model {inner.get('url')!r} is not in this file, or holds itself."
            draft.note(rules.EXTERNAL, instance, message)
    for user in children(instance, "instance_rigid_body"):
        sid = user.get("body", "")
        found = (models.member(each.model, "rigid_body", sid) for each in level.everything())
        body = next((element for element in found if element is not None), None)
        if body is None:
            message = f"The model {model.get('id')!r} has no body {sid!r}."
            draft.note(rules.NO_BODY, user, message)
        else:
            level.bodies.append(Body(copy_of(user), copy_of(body), level, sid))
    for user in children(instance, "instance_rigid_constraint"):
        sid = user.get("constraint", "")
        constraint = models.member(model, "rigid_constraint", sid)
        if constraint is None:
            message = f"The model {model.get('id')!r} has no constraint {sid!r}."
            draft.note(rules.CONSTRAINT_LEFT_OUT, user, message)
        else:
            level.constraints.append(Constraint(copy_of(user), copy_of(constraint), level))
    return level


def _write(draft: Draft, top: Level, model: etree._Element, sids: Names) -> None:
    """Make `model` hold what all the levels have, and the instance too."""
    levels = top.everything()
    bodies = [body for level in levels for body in level.bodies]
    constraints = [constraint for level in levels for constraint in level.constraints]
    if len(levels) > 1:
        message = f"{len(levels) - 1} nested physics models became part of {model.get('id')!r}."
        draft.note(rules.FLATTENED, top.instance, message)
    own = {body.sid for body in top.bodies} | {c.element.get("sid", "") for c in top.constraints}
    spare = [
        member
        for member in children(model, "rigid_body", "rigid_constraint")
        if member.get("sid") not in own
    ]
    sids.take(member.get("sid", "") for member in spare)
    extras = children(model, "extra")
    for child in children(model, "rigid_body", "rigid_constraint", "instance_physics_model"):
        detach(child)
    for body in bodies:
        _name(draft, body.instance, "body", body.element, sids, top.instance)
    for constraint in constraints:
        _name(draft, constraint.instance, "constraint", constraint.element, sids, top.instance)
    members = [
        *(body.element for body in bodies),
        *(member for member in spare if local(member) == "rigid_body"),
        *(constraint.element for constraint in constraints),
        *(member for member in spare if local(member) == "rigid_constraint"),
    ]
    position = model.index(extras[0]) if extras else len(model)
    insert_all(model, position, members)
    _write_instance(top, bodies, constraints)


def _name(
    draft: Draft,
    instance: etree._Element,
    key: str,
    element: etree._Element,
    sids: Names,
    where: etree._Element,
) -> None:
    old = element.get("sid", "")
    new = sids.new(old)
    if new != old:
        _forget_ids(element)
        element.set("sid", new)
        draft.note(rules.BODY_COPIED, where, f"The {key} {old!r} is there more than once: {new!r}.")
    instance.set(key, new)


def _forget_ids(copy: etree._Element) -> None:
    """A second copy of something has no ids of its own."""
    for element in copy.iter(etree.Element):
        element.attrib.pop("id", "")


def _write_instance(top: Level, bodies: list[Body], constraints: list[Constraint]) -> None:
    fields = [
        copy_of(force) for inner in top.everything()[1:]
        for force in children(inner.instance, "instance_force_field")
    ]  # fmt: skip
    for child in children(top.instance, "instance_rigid_body", "instance_rigid_constraint"):
        detach(child)
    position = len(children(top.instance, "instance_force_field"))
    parts = [
        *fields,
        *(body.instance for body in bodies),
        *(constraint.instance for constraint in constraints),
    ]
    insert_all(top.instance, position, parts)
