"""References to nodes and sources that lead elsewhere, or nowhere."""

from __future__ import annotations

import re
from urllib.parse import unquote

from lxml import etree

from colladaphy.conform import reference_rules
from colladaphy.conform.context import NS, Context, local
from colladaphy.conform.lexical import name_from
from colladaphy.conform.references import mend_urls

__all__ = ["is_elsewhere", "mend_inputs", "mend_parents", "mend_targets"]

_NCNAME = re.compile(r"[^\W\d][\w.\-]*")


def mend_inputs(context: Context) -> None:
    """An input that names an array means the source around it, or the vertices of its mesh."""
    for user in context.all("input"):
        array = context.by_url(user.get("source"))
        if array is None or not local(array).endswith("_array"):
            continue
        meant = array.getparent()
        parent = user.getparent()
        mesh = None if parent is None else parent.getparent()
        if user.get("semantic") == "VERTEX" and mesh is not None:
            vertices = mesh.find(NS + "vertices")
            meant = meant if vertices is None else vertices
        if meant is None or local(meant) not in ("source", "vertices"):
            continue
        if context.wants(reference_rules.INPUT_ARRAY):
            old = user.get("source")
            if not meant.get("id"):
                _name(context, meant, f"{array.get('id')}-{local(meant)}")
            user.set("source", f"#{meant.get('id')}")
            message = (
                f"the input {user.get('semantic')} named the <{local(array)}> {old}; is now the "
                f"<{local(meant)}> #{meant.get('id')}"
            )
            context.note(reference_rules.INPUT_ARRAY, user, message)


def mend_parents(context: Context) -> None:
    """The parent of an instance of a physics model is a node, or there is none."""
    for instance in context.all("instance_physics_model"):
        parent = (instance.get("parent") or "").strip()
        if not parent or is_elsewhere(parent) or not context.wants(reference_rules.PARENT):
            continue
        found = _find(context, parent, instance)
        if found is not None and local(found) == "node":
            continue
        value = instance.attrib.pop("parent")
        what = "not there" if found is None else f"a <{local(found)}>, not a <node>"
        message = f"the parent {parent} is {what}; the attribute moved into an extra"
        context.note(reference_rules.PARENT, instance, message)
        context.keep(instance, "attribute", name="parent", value=str(value))


def mend_targets(context: Context) -> None:
    """A body whose node is not there moves the only one of that name, or an empty new node."""
    made: dict[str, tuple[str, str]] = {}
    named: dict[str, list[etree._Element]] | None = None
    for user in context.all("instance_rigid_body"):
        target = (user.get("target") or "").strip()
        found = context.by_url(target) if target.startswith("#") else None
        if found is not None and local(found) == "node" and target not in made:
            continue
        if not target or is_elsewhere(target) or not context.wants(reference_rules.DANGLING_TARGET):
            continue
        if target not in made:
            found = _find(context, target, user)
            if found is not None and local(found) == "node":
                continue
            if named is None:
                named = _named(context)
            made[target] = _assume(context, target, user, named)
        url, why = made[target]
        user.set("target", url)
        message = f"there is no node {target}; {why}"
        context.note(reference_rules.DANGLING_TARGET, user, message)
    if made:
        mend_urls(context)  # what had no '#' may mean one of the new nodes


def _assume(
    context: Context, target: str, user: etree._Element, named: dict[str, list[etree._Element]]
) -> tuple[str, str]:
    """A node for a target that is not there: its url, and what is to be said about it."""
    name = unquote(target.removeprefix("#").rpartition("/")[2])
    alike = named.get(name, [])
    if len(alike) == 1:
        if not alike[0].get("id"):
            _name(context, alike[0], f"{name_from(name)}-node")
        url = f"#{alike[0].get('id')}"
        return url, f"{url} is taken: it is the only one of that name"
    if not _NCNAME.fullmatch(name) or name in context.ids:
        name = f"{name_from(name or user.get('body') or 'body')}-node"
    node = context.make("node")
    _name(context, node, name)
    context.library("nodes").append(node)
    url = f"#{node.get('id')}"
    return url, f"the empty node {url} was added: the pose is unknown, and identity is assumed"


def _name(context: Context, element: etree._Element, wish: str) -> None:
    name = context.new_id(wish)
    element.set("id", name)
    context.ids[name] = element


def _named(context: Context) -> dict[str, list[etree._Element]]:
    """The nodes by name and by sid."""
    found: dict[str, list[etree._Element]] = {}
    for node in context.all("node"):
        for name in {node.get("name"), node.get("sid")} - {None}:
            found.setdefault(str(name), []).append(node)
    return found


def is_elsewhere(reference: str) -> bool:
    """Whether a reference leads to another file, of which nothing is known here."""
    file, mark, _ = reference.partition("#")
    if mark:
        return bool(file)
    return "://" in file or file.lower().endswith((".dae", ".xml", ".zae"))


def _find(context: Context, reference: str, origin: etree._Element) -> etree._Element | None:
    """What an id with sids after it leads to (COLLADA 1.5 §Address syntax)."""
    head, *sids = (unquote(step) for step in reference.removeprefix("#").split("/"))
    element = origin.getparent() if head == "." else context.ids.get(head)
    for sid in sids:
        if element is None:
            return None
        below = element.iterdescendants(etree.Element)
        element = next((inner for inner in below if inner.get("sid") == sid), None)
    return element
