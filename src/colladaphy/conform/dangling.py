"""Instances and constraints of what is not there: nothing can be made of them.

They come last, after every way to find out what was meant, and move into an extra. What refers to
other files stays: nothing is known here of those.
"""

from __future__ import annotations

from collections import Counter

from lxml import etree

from colladaphy.conform import reference_rules
from colladaphy.conform.context import NS, Context, local
from colladaphy.conform.targets import is_elsewhere

__all__ = ["set_aside_dangling"]

_INSTANCE_OF_BODY = NS + "instance_rigid_body"
_ATTACHMENTS = (NS + "ref_attachment", NS + "attachment")


def set_aside_dangling(context: Context) -> None:
    """Move what refers to no scene, model, body or constraint into an extra."""
    for kind in ("physics_scene", "physics_model"):
        for instance in context.all(f"instance_{kind}"):
            url = instance.get("url", "")
            found = context.by_url(url) if url.startswith("#") else None
            if (found is None or local(found) != kind) and not is_elsewhere(url):
                _set_aside(context, instance, f"there is no <{kind}> {url!r}")
    for instance in context.all("instance_node"):
        url = instance.get("url", "")
        found = context.by_url(url) if url.startswith("#") else None
        if found is not None and local(found) != "node":
            _set_aside(context, instance, f"{url!r} is a <{local(found)}>, not a <node>")
    models = _Models(context)
    _set_constraints_aside(context, models)
    for kind, key in (("rigid_body", "body"), ("rigid_constraint", "constraint")):
        for user in context.all(f"instance_{kind}"):
            above = user.getparent()
            model = None if above is None else context.by_url(above.get("url"))
            if model is None or local(model) != "physics_model":
                continue  # in another file, or reported already
            sid = user.get(key, "").rpartition("/")[2]
            if sid not in models.sids(model, kind):
                _set_aside(context, user, f"its model has no <{kind}> of sid {sid!r}")
    _set_ambiguous_aside(context)


def _set_ambiguous_aside(context: Context) -> None:
    """A constraint between bodies of which one is there twice says not which is meant."""
    for instance in context.all("instance_physics_model"):
        users = list(instance.iterchildren(NS + "instance_rigid_constraint"))
        model = context.by_url(instance.get("url")) if users else None
        if model is None or not context.wants(reference_rules.AMBIGUOUS_CONSTRAINT):
            continue
        bodies = Counter(u.get("body", "") for u in instance.iterchildren(_INSTANCE_OF_BODY))
        twice = {f"{model.get('id')}/{sid}" for sid, count in bodies.items() if count > 1}
        constraints = {c.get("sid"): c for c in model.iterchildren(NS + "rigid_constraint")}
        for user in users if twice else ():
            constraint = constraints.get(user.get("constraint"))
            ends = () if constraint is None else constraint.iterchildren(*_ATTACHMENTS)
            if found := twice & {end.get("rigid_body") for end in ends}:
                message = (
                    f"constraint {user.get('constraint')!r} holds {min(found)}, which is instanced "
                    "more than once here; which is meant is not said; moved into an extra"
                )
                context.note(reference_rules.AMBIGUOUS_CONSTRAINT, user, message)
                context.stash(user)


def _set_constraints_aside(context: Context, models: _Models) -> None:
    for constraint in context.all("rigid_constraint"):
        for name in _ATTACHMENTS:
            attachment = constraint.find(name)
            if attachment is None:
                continue
            reference = attachment.get("rigid_body", "").strip()
            if reference and not models.holds(reference):
                why = f"its <{local(attachment)}> refers to {reference!r}, no body and no node"
                _set_aside(context, constraint, why)
                break


def _set_aside(context: Context, element: etree._Element, why: str) -> None:
    if context.wants(reference_rules.DANGLING_INSTANCE):
        message = f"<{local(element)}> cannot be followed: {why}; moved into an extra"
        context.note(reference_rules.DANGLING_INSTANCE, element, message)
        context.stash(element)


class _Models:
    """What physics models hold, those that they instance included."""

    def __init__(self, context: Context) -> None:
        self._context = context
        self._sids: dict[tuple[etree._Element, str], set[str]] = {}

    def sids(self, model: etree._Element, kind: str) -> set[str]:
        """The sids of a model's bodies or constraints."""
        if (model, kind) not in self._sids:
            waiting, seen, found = [model], {model}, set[str]()
            for current in waiting:
                found.update(child.get("sid", "") for child in current.iterchildren(NS + kind))
                for instance in current.iterchildren(NS + "instance_physics_model"):
                    inner = self._context.by_url(instance.get("url"))
                    if inner is not None and inner not in seen and local(inner) == "physics_model":
                        seen.add(inner)
                        waiting.append(inner)
            self._sids[model, kind] = found
        return self._sids[model, kind]

    def holds(self, reference: str) -> bool:
        """Whether an address (``model/sid``, ``model/instance/sid``, ``#node``) leads somewhere."""
        if is_elsewhere(reference):
            return True
        head, *steps = reference.removeprefix("#").split("/")
        found = self._context.ids.get(head)
        if found is None or not steps:
            return found is not None and local(found) in ("node", "rigid_body")
        if local(found) == "physics_model":
            return steps[-1] in self.sids(found, "rigid_body")
        return any(inner.get("sid") == steps[-1] for inner in found.iterdescendants(NS + "node"))
