"""Ids and sids: well formed, unique, and found again by what refers to them."""

from __future__ import annotations

import re
from collections.abc import Mapping

from lxml import etree

from colladaphy.conform import name_rules, reference_rules
from colladaphy.conform.context import NS, Context, local, standard_elements, standard_elements_with
from colladaphy.conform.lexical import name_from
from colladaphy.gate.references import EXPECTED

__all__ = ["mend_ids", "mend_sids", "rename_ids"]

_NCNAME = re.compile(r"[^\W\d][\w.\-]*")
# Attributes that hold a url, and those that hold a path of an id and sids.
_URLS = ("url", "source", "target", "parent", "convex_hull_of", "proxy", "camera_node")
_PATHS = ("target", "rigid_body", "axis", "joint", "link", "node", "ref", "body", "constraint")
_BARE = ("url", "source", "parent", "convex_hull_of", "proxy", "camera_node")
_SOURCES = ("input", "accessor", "skin", "morph", "channel")
_TEXTS = ("skeleton", "SIDREF", "param")
_LISTS = ("IDREF_array", "SIDREF_array")
_OF_TEXTS = {"init_from": ("image",), "skeleton": ("node",)}
_ARRAYS = (
    "bool_array",
    "float_array",
    "IDREF_array",
    "int_array",
    "Name_array",
    "SIDREF_array",
    "token_array",
)


def mend_ids(context: Context) -> None:
    """Make every id an NCName that occurs once, and rewrite what refers to it."""
    by_path = _inputs_by_path(context)
    taken: dict[str, list[etree._Element]] = {}
    for element in standard_elements_with(context.root, "id"):
        taken.setdefault(element.get("id", ""), []).append(element)
    changed: dict[str, _Scope] = {}
    for name, owners in list(taken.items()):
        fresh = _mend_id(context, name, owners, taken)
        if any(new != name for _, new in fresh):
            changed[name] = changed[name.strip()] = _Scope(fresh)
    if changed:
        _rewrite(context.root, changed)
        context.forget_ids()
    for user, meant in by_path:
        old, new = user.get("source"), f"#{meant.get('id')}"
        user.set("source", new)
        message = f"the input {user.get('semantic')} named {old}, a path; is now {new}"
        context.note(reference_rules.INPUT_PATH, user, message)


def rename_ids(root: etree._Element, names: Mapping[str, str]) -> None:
    """Give ids other names, and rewrite what refers to them in the same document."""
    changed: dict[str, _Scope] = {}
    for element in standard_elements_with(root, "id"):
        old = element.get("id", "")
        if old in names:
            element.set("id", names[old])
            changed[old] = _Scope([(element, names[old])])
    _rewrite(root, changed)


def _inputs_by_path(context: Context) -> list[tuple[etree._Element, etree._Element]]:
    """Inputs that name what they mean by a path below an id, and the elements with that id there.

    OpenRAVE gives the vertices of every mesh one id, and tells them apart by their geometry.
    """
    found: list[tuple[etree._Element, etree._Element]] = []
    if not context.wants(reference_rules.INPUT_PATH):
        return found
    below: dict[str, dict[str, etree._Element]] = {}
    for user in context.all("input"):
        head, slash, last = user.get("source", "").removeprefix("#").partition("/")
        outer = context.ids.get(head) if slash else None
        if outer is None:
            continue
        if head not in below:
            inner = [e for e in outer.iterdescendants(etree.Element) if e is not outer]
            below[head] = {}
            for key in ("id", "sid", "name"):
                for element in inner:
                    if value := element.get(key):
                        below[head].setdefault(value, element)
        meant = below[head].get(last.rpartition("/")[2])
        if meant is not None and local(meant) in ("source", "vertices") and meant.get("id"):
            found.append((user, meant))
    return found


def _mend_id(
    context: Context,
    name: str,
    owners: list[etree._Element],
    taken: dict[str, list[etree._Element]],
) -> list[tuple[etree._Element, str]]:
    form = name.strip()
    well_formed = _NCNAME.fullmatch(form) is not None
    fresh: list[tuple[etree._Element, str]] = []
    for position, owner in enumerate(owners):
        if position == 0 and well_formed:
            fresh.append((owner, name))
            continue
        rule = name_rules.ID_DUPLICATE if position else name_rules.ID_FORM
        if not context.wants(rule):
            continue
        if not form:
            del owner.attrib["id"]
            context.note(name_rules.ID_FORM, owner, f"the empty id of <{local(owner)}> was removed")
            continue
        new = _free(form if well_formed else name_from(form), taken, position)
        taken[new] = [owner]
        owner.set("id", new)
        fresh.append((owner, new))
        what = "was used before" if position else "is no NCName"
        context.note(rule, owner, f"id {name!r} of <{local(owner)}> {what}; is now {new!r}")
    return fresh


def _free(wish: str, taken: dict[str, list[etree._Element]], position: int) -> str:
    if not position and wish not in taken:
        return wish
    number = position + 1
    while f"{wish}-{number}" in taken:
        number += 1
    return f"{wish}-{number}"


class _Scope:
    """For one id of the file: the definitions it had, and which of them a reference means."""

    def __init__(self, owners: list[tuple[etree._Element, str]]) -> None:
        self._owners = owners
        self._below: dict[tuple[str, ...], dict[etree._Element, str]] = {}

    def find(self, element: etree._Element, kinds: tuple[str, ...] = ()) -> str:
        """The new name of the definition of these kinds nearest to `element`.

        That is the one which shares most ancestors with it; where none is of these kinds, all
        are looked at.
        """
        if len(self._owners) > 1:
            if kinds not in self._below:
                self._below[kinds] = self._near(kinds)
            below = self._below[kinds]
            for above in (element, *element.iterancestors()):
                if above in below:
                    return below[above]
        return self._owners[0][1]

    def _near(self, kinds: tuple[str, ...]) -> dict[etree._Element, str]:
        """The definition that counts below every element that holds one."""
        below: dict[etree._Element, str] = {}
        meant = [owner for owner in self._owners if local(owner[0]) in kinds]
        for owner, name in meant or self._owners:
            for above in (owner, *owner.iterancestors()):
                below.setdefault(above, name)
        return below


def _rewrite(root: etree._Element, changed: dict[str, _Scope]) -> None:
    for element in standard_elements(root):
        for key, value in list(element.attrib.items()):
            if key in _URLS or key in _PATHS:
                new = _reference(
                    element,
                    str(value),
                    changed,
                    bare=_may_be_bare(element, str(key)),
                    kinds=_expected(element, str(key)),
                )
                if new is not None:
                    element.set(key, new)
        name = local(element)
        if name in _TEXTS or (name == "init_from" and _in_surface(element)):
            bare, kinds = name == "init_from", _OF_TEXTS.get(name, ())
            text = (element.text or "").strip()
            new = _reference(element, text, changed, bare=bare, kinds=kinds)
            if new is not None:
                element.text = new
        elif name in _LISTS:
            parts = (element.text or "").split()
            new_parts = [_reference(element, p, changed, bare=True) or p for p in parts]
            if parts != new_parts:
                element.text = " ".join(new_parts)


def _may_be_bare(element: etree._Element, key: str) -> bool:
    """Whether an attribute is a url that may have lost its '#'; some sources are sids."""
    return key in _BARE and (key != "source" or local(element) in _SOURCES)


def _expected(element: etree._Element, key: str) -> tuple[str, ...]:
    """The elements that an attribute may refer to."""
    name = local(element)
    if (name, key) == ("input", "source"):
        return ("vertices",) if element.get("semantic") == "VERTEX" else ("source",)
    if (name, key) == ("accessor", "source"):
        return _ARRAYS
    return EXPECTED.get((name, key), ())


def _in_surface(element: etree._Element) -> bool:
    parent = element.getparent()
    return parent is not None and local(parent) == "surface"


def _reference(
    element: etree._Element,
    value: str,
    changed: dict[str, _Scope],
    *,
    bare: bool,
    kinds: tuple[str, ...] = (),
) -> str | None:
    """`value` with the id in it replaced; `bare` where an id may stand without a '#'.

    `kinds` are the elements that a whole reference may lead to; a path only begins at an id.
    """
    mark = "#" if value.startswith("#") else ""
    body = value[len(mark) :]
    scope = changed.get(body) if mark or bare else None
    if scope is not None:
        return mark + scope.find(element, kinds)
    head, slash, rest = body.partition("/")
    scope = changed.get(head) if slash and head not in (".", "") else None
    return None if scope is None else f"{mark}{scope.find(element)}{slash}{rest}"


def mend_sids(context: Context) -> None:
    """Make every sid an NCName; empty ones go, and physics sids get a name where one is needed."""
    renamed: dict[str, str] = {}
    for element in standard_elements_with(context.root, "sid"):
        sid = element.get("sid", "")
        if not sid.strip():
            _empty_sid(context, element)
        elif not _NCNAME.fullmatch(sid.strip()) and context.wants(name_rules.SID_FORM):
            new = name_from(sid)
            renamed[sid.strip()] = new
            element.set("sid", new)
            message = f"sid {sid!r} of <{local(element)}> is no NCName; is now {new!r}"
            context.note(name_rules.SID_FORM, element, message)
    if renamed:
        _rename_sids(context.root, renamed)
    _unique_sids(context)


def _empty_sid(context: Context, element: etree._Element) -> None:
    if not context.wants(name_rules.SID_EMPTY):
        return
    del element.attrib["sid"]
    kind = local(element)
    if kind == "technique":
        element.set("sid", "common")
        message = "the sid of <technique> was empty; is now 'common'"
    else:
        message = f"the empty sid of <{kind}> was removed"
    context.note(name_rules.SID_EMPTY, element, message)


def _with_new_sids(value: str, renamed: dict[str, str]) -> str:
    """A path with old sids replaced; an old sid may itself hold the signs that divide a path."""
    starts = [0, *(i + 1 for i, sign in enumerate(value) if sign in "/#")]
    ends = [*(i for i, sign in enumerate(value) if sign in "/.("), len(value)]
    made, done = [], 0
    for start in starts:
        if start < done:
            continue
        for end in reversed(ends):
            if end > start and (new := renamed.get(value[start:end])) is not None:
                made += [value[done:start], new]
                done = end
                break
    return "".join([*made, value[done:]])


def _rename_sids(root: etree._Element, renamed: dict[str, str]) -> None:
    """Rewrite references that end in an old sid, by the longest old sid that fits."""

    def new(value: str) -> str:
        return _with_new_sids(value, renamed)

    for element in standard_elements(root):
        for key, value in list(element.attrib.items()):
            if key in _PATHS and new(str(value)) != value:
                element.set(key, new(str(value)))
        name = local(element)
        if (
            (name in _TEXTS or name in _LISTS)
            and element.text
            and new(element.text) != element.text
        ):
            element.text = new(element.text)


def _unique_sids(context: Context) -> None:
    """Siblings have different sids; where bodies shared one, the k-th instance means the k-th."""
    families: dict[etree._Element, dict[str, list[etree._Element]]] = {}
    for element in standard_elements_with(context.root, "sid"):
        family = element.getparent()
        if family is not None and (sid := element.get("sid")):
            families.setdefault(family, {}).setdefault(sid, []).append(element)
    for parent, seen in families.items():
        for sid, owners in list(seen.items()):
            if len(owners) > 1 and context.wants(name_rules.SID_DUPLICATE):
                names = _separate(context, sid, owners, seen)
                for kind in ("rigid_body", "rigid_constraint"):
                    same = [(o, n) for o, n in zip(owners, names, strict=True) if local(o) == kind]
                    if len(same) > 1:
                        _distribute(context, parent, kind, sid, [name for _, name in same])


def _separate(
    context: Context,
    sid: str,
    owners: list[etree._Element],
    seen: dict[str, list[etree._Element]],
) -> list[str]:
    names, number = [sid], 2
    for owner in owners[1:]:
        while f"{sid}-{number}" in seen:
            number += 1
        names.append(f"{sid}-{number}")
        seen[names[-1]] = [owner]
        owner.set("sid", names[-1])
        message = f"sid {sid!r} of <{local(owner)}> was used before here; is now {names[-1]!r}"
        context.note(name_rules.SID_DUPLICATE, owner, message)
    return names


def _distribute(
    context: Context, model: etree._Element, kind: str, sid: str, names: list[str]
) -> None:
    attribute = "body" if kind == "rigid_body" else "constraint"
    for instance in context.all("instance_physics_model"):
        if instance.get("url", "").lstrip("#") != model.get("id"):
            continue
        users = [
            user
            for user in instance.iterchildren(NS + "instance_" + kind)
            if user.get(attribute) == sid
        ]
        for user, name in zip(users, names, strict=False):
            if name != sid:
                user.set(attribute, name)
                message = f"{attribute}={sid!r} is the next of that sid; is now {name!r}"
                context.note(name_rules.SID_DUPLICATE, user, message)
