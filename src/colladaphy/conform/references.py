"""References of physics: found as real files write them, written as the standard says."""

from __future__ import annotations

import re
from typing import cast

from lxml import etree

from colladaphy.conform import reference_rules
from colladaphy.conform.context import NS, Context, local
from colladaphy.conform.lexical import name_from
from colladaphy.conform.structure import typed_elements
from colladaphy.gate.references import EXPECTED

__all__ = ["complete_instances", "mend_attachments", "mend_instances", "mend_urls"]

_NCNAME = re.compile(r"[^\W\d][\w.\-]*")
_USER = NS + "instance_rigid_body"
_ATTACHMENTS = ("ref_attachment", "attachment")
_URLS = ("url", "convex_hull_of", "parent", "source", "target")
# One search each: a union is sorted, which takes longer than all the rest.
_BARE = [etree.XPath(f"//@{name}[not(starts-with(., '#'))]", smart_strings=False) for name in _URLS]


class _Members:
    """Bodies or constraints of one physics model, by sid, id and name."""

    def __init__(self, model: etree._Element, kind: str) -> None:
        self.all = list(model.iterchildren(NS + kind))
        self.by_key: dict[str, dict[str, etree._Element]] = {}
        for key in ("sid", "id", "name"):
            table = self.by_key[key] = {}
            for member in self.all:
                if value := member.get(key):
                    table.setdefault(value, member)

    def find(self, value: str) -> tuple[etree._Element | None, str]:
        """The member that a reference means, and the form in which it was written."""
        value = value.strip()
        sids = self.by_key["sid"]
        if value in sids:
            return sids[value], "sid"
        plain = value.removeprefix("#").removeprefix("./")
        mark = value[: len(value) - len(plain)]
        if plain in sids:
            return sids[plain], f"{mark}sid"
        for form, table in (("id", self.by_key["id"]), ("name", self.by_key["name"])):
            if plain in table:
                return table[plain], f"{mark}{form}"
        last = plain.rpartition("/")[2]
        if last != plain and last in sids:
            return sids[last], f"{mark}path/sid"
        last = plain.rpartition(":")[2]
        if last != plain and last in sids:
            return sids[last], f"{mark}name:sid"
        spelled = name_from(plain)
        return (sids[spelled], "sid in another spelling") if spelled in sids else (None, "")


class _Index:
    """The members of every model, made when they are first asked for."""

    def __init__(self, context: Context) -> None:
        self.context = context
        self._known: dict[tuple[etree._Element, str], _Members] = {}
        self._targets: dict[etree._Element | None, dict[str, set[str]]] | None = None

    def of(self, model: etree._Element, kind: str) -> _Members:
        if (model, kind) not in self._known:
            self._known[model, kind] = _Members(model, kind)
        return self._known[model, kind]

    def moved_by(self, model: etree._Element, url: str) -> str | None:
        """The sid of the body of a model that moves a node; None unless it is just one."""
        if self._targets is None:
            self._targets = {}
            for instance in self.context.all("instance_physics_model"):
                moved = self.context.by_url(instance.get("url"))
                for user in () if moved is None else instance.iterchildren(_USER):
                    sid = user.get("body", "").rpartition("/")[2]
                    targets = self._targets.setdefault(moved, {})
                    targets.setdefault(user.get("target", ""), set()).add(sid)
        sids = self._targets.get(model, {}).get(url, set())
        return next(iter(sids)) if len(sids) == 1 else None


def mend_urls(context: Context) -> None:
    """References within the document begin with '#'."""
    if all(context.ids.keys().isdisjoint(cast("list[str]", find(context.root))) for find in _BARE):
        return
    for element, kind in typed_elements(context.root):
        for key in _URLS:
            known = kind.attributes.get(key)
            if known is not None and known.type.name in ("xs:anyURI", "urifragment_type"):
                _hash(context, element, key)


def _hash(context: Context, element: etree._Element, key: str) -> None:
    value = element.get(key, "")
    if not value or value.startswith("#") or value not in context.ids:
        return
    kinds = EXPECTED.get((local(element), key))
    if kinds is not None and local(context.ids[value]) not in kinds:
        return  # no reference of this kind can mean that id
    if context.wants(reference_rules.HASH):
        element.set(key, f"#{value}")
        message = f"{key}={value!r} of <{local(element)}> is an id; is now '#{value}'"
        context.note(reference_rules.HASH, element, message)


def complete_instances(context: Context) -> None:
    """An instance without a body or a target gets those that the model and the scene suggest."""
    for instance in context.all("instance_physics_model"):
        model = context.by_url(instance.get("url"))
        if model is None or local(model) != "physics_model":
            continue
        for kind, key in (("rigid_body", "body"), ("rigid_constraint", "constraint")):
            members = [m for m in model.iterchildren(NS + kind) if m.get("sid")]
            users = list(instance.iterchildren(NS + "instance_" + kind))
            used = {user.get(key) for user in users}
            free = [member for member in members if member.get("sid") not in used]
            for user in users:
                if user.get(key) is None and free and context.wants(reference_rules.MISSING_BODY):
                    _choose(context, user, key, free)
    _give_targets(context)


def _choose(context: Context, user: etree._Element, key: str, free: list[etree._Element]) -> None:
    hint = (user.get("target") or user.get("name") or user.get("sid") or "").lstrip("#")
    alike = [m for m in free if hint and hint in (m.get("sid"), m.get("name"), m.get("id"))]
    member = (alike or free)[0]
    why = (
        "its target has that name"
        if alike
        else "it is the only one"
        if len(free) == 1
        else "it is the next in order"
    )
    free.remove(member)
    sid = member.get("sid", "")
    user.set(key, sid)
    message = f"<{local(user)}> had no {key}; {sid!r} of its model is assumed: {why}"
    context.note(reference_rules.MISSING_BODY, user, message)


def _give_targets(context: Context) -> None:
    for user in context.all("instance_rigid_body"):
        if user.get("target") is not None or not context.wants(reference_rules.MISSING_TARGET):
            continue
        names = [user.get("body", ""), user.get("name", "")]
        node = next(
            (found for name in names if local(found := context.ids.get(name, user)) == "node"), None
        )
        if node is None:
            name = context.new_id(name_from(f"{user.get('body') or 'body'}-node"))
            node = context.make("node", id=name)
            library = context.library("nodes")
            library.append(node)
            context.ids[name] = node
            why = "an empty node was added, which puts it at the origin"
        else:
            why = "it has the body's name"
        user.set("target", f"#{node.get('id')}")
        message = f"<instance_rigid_body> had no target; #{node.get('id')} is assumed: {why}"
        context.note(reference_rules.MISSING_TARGET, user, message)


def mend_instances(context: Context) -> None:
    """`body` and `constraint` of instances are plain sids."""
    index = _Index(context)
    for kind, key in (("rigid_body", "body"), ("rigid_constraint", "constraint")):
        for user in context.all("instance_" + kind):
            value = user.get(key)
            if value is None or not context.wants(reference_rules.BODY_REFERENCE):
                continue
            instance = user.getparent()
            model = None if instance is None else context.by_url(instance.get("url"))
            member, form = (None, "")
            if model is not None and local(model) == "physics_model":
                member, form = index.of(model, kind).find(value)
            sid = None if member is None else member.get("sid")
            if sid is not None and sid != value:
                user.set(key, sid)
                message = f"{key}={value!r} of <{local(user)}> was read as {form}; is now {sid!r}"
                context.note(reference_rules.BODY_REFERENCE, user, message)
            elif sid is None and not _NCNAME.fullmatch(value):
                sid = name_from(value.rstrip("/").rpartition("/")[2])
                user.set(key, sid)
                message = f"{key}={value!r} of <{local(user)}> names nothing; is now {sid!r}"
                context.note(reference_rules.BODY_REFERENCE, user, message)


def mend_attachments(context: Context) -> None:
    """Attachments name their body as ``model-id/sid``, a node as ``#id``, the world as ``""``.

    A node that a body of the model moves means that body, unless the other end is the body itself:
    then it is a place of the world.
    """
    index = _Index(context)
    for constraint in context.all("rigid_constraint"):
        model = constraint.getparent()
        if model is None or local(model) != "physics_model":
            continue
        ends = [e for name in _ATTACHMENTS if (e := constraint.find(NS + name)) is not None]
        found = [_address(context, index, model, end.get("rigid_body") or "") for end in ends]
        for number, (new, _) in enumerate(found):
            sid = index.moved_by(model, new) if new and new.startswith("#") else None
            address = None if sid is None else f"{_id_of(context, model)}/{sid}"
            if address is not None and all(other != address for other, _ in found):
                found[number] = (address, "the node that it moves")
        for end, (new, form) in zip(ends, found, strict=True):
            value = end.get("rigid_body")
            if not value or new is None or new == value:
                continue
            if context.wants(reference_rules.ATTACHMENT_REFERENCE):
                end.set("rigid_body", new)
                message = (
                    f"rigid_body={value!r} of <{local(end)}> was read as {form}; is now {new!r}"
                )
                context.note(reference_rules.ATTACHMENT_REFERENCE, end, message)


def _address(
    context: Context, index: _Index, model: etree._Element, value: str
) -> tuple[str | None, str]:
    plain = value.strip().removeprefix("#").removeprefix("./")
    steps = plain.split("/")
    if value.strip() in ("", "#", "./", "."):
        return "", "the world"
    if len(steps) > 1:
        found = _through_instances(context, index, model, steps)
        if found is not None:
            return found
    member, form = index.of(model, "rigid_body").find(value)
    node = context.ids.get(plain)
    if node is not None and local(node) == "node" and (member is None or form.endswith("name")):
        return f"#{plain}", "id of a node"
    if member is None:
        return None, ""
    return f"{_id_of(context, model)}/{member.get('sid')}", form


def _through_instances(
    context: Context, index: _Index, model: etree._Element, steps: list[str]
) -> tuple[str, str] | None:
    """An address through models instanced in the model (and through other models' ids)."""
    if steps[0] == model.get("id"):
        steps = steps[1:]
    current, path = model, [_id_of(context, model)]
    for step in steps[:-1]:
        instance = next(
            (
                i
                for i in current.iterchildren(NS + "instance_physics_model")
                if i.get("sid") == step
            ),
            None,
        )
        if instance is None:
            break
        inner = context.by_url(instance.get("url"))
        if inner is None or local(inner) != "physics_model":
            return None
        current, path = inner, [*path, step]
    else:
        member, form = index.of(current, "rigid_body").find(steps[-1])
        if member is None:
            return None
        kind = "instance/sid" if len(path) > 1 else "model/sid"
        return "/".join([*path, member.get("sid", "")]), kind if form == "sid" else form
    other = context.ids.get(steps[0])
    if other is not None and other is not model and local(other) == "physics_model":
        member, _ = index.of(other, "rigid_body").find(steps[-1])
        if member is not None:
            return f"{steps[0]}/{member.get('sid')}", "model/sid"
    return None


def _id_of(context: Context, model: etree._Element) -> str:
    if not model.get("id"):
        model.set("id", context.new_id(name_from(model.get("name") or "physics_model")))
        message = f"<physics_model> had no id for its bodies' addresses; is now {model.get('id')!r}"
        context.note(reference_rules.ATTACHMENT_REFERENCE, model, message)
    return model.get("id", "")
