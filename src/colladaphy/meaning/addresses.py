"""Addresses by scoped ids, which lead through instances too (COLLADA 1.5 §Address syntax).

Kinematics refers to joints, links and axes of models that are instanced, in several spellings; an
address is only called wrong where a name in it is there nowhere at all.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

import numpy as np

from colladaphy.findings import Severity
from colladaphy.links.rules import MISSING, WRONG_TYPE
from colladaphy.meaning.context import Context, NamedRows, TextRows
from colladaphy.meaning.hits import Hit
from colladaphy.meaning.links import expected_text
from colladaphy.meaning.references import ADDRESSES, PARAMETERS

__all__ = ["CHECKS", "lost_in"]

_EXPECTED = {
    ("attachment_full", "joint"): ("joint", "instance_joint"),
    ("attachment_start", "joint"): ("joint", "instance_joint"),
    ("attachment_end", "joint"): ("joint", "instance_joint"),
    ("frame_origin", "link"): ("link",),
    ("frame_tip", "link"): ("link",),
    ("frame_tcp", "link"): ("link",),
    ("frame_object", "link"): ("link",),
    ("axis_info", "axis"): ("revolute", "prismatic", "axis_info"),
    ("bind_kinematics_model", "node"): ("node",),
    ("bind_joint_axis", "target"): (
        "rotate", "translate", "matrix", "scale", "lookat", "skew",
    ),
}  # fmt: skip
_BOUND = {
    "axis": ("revolute", "prismatic", "axis_info", "newparam"),
    "bind_kinematics_model": (
        "kinematics_model", "instance_kinematics_model", "articulated_system",
        "instance_articulated_system", "kinematics_scene", "newparam",
    ),
}  # fmt: skip
"""What addresses in texts mean, by what these stand in."""
_HOLDERS = ("axis", "value", "active", "locked", "min", "max", "bind_kinematics_model")
_CSYMBOL = "{http://www.w3.org/1998/Math/MathML}csymbol"
_MEMBER = re.compile(r"(\.[A-Za-z_]+|(?:\(\d+\))+)\Z")


def addresses(context: Context) -> Iterator[Hit]:
    """Addresses with names that are there nowhere, or of elements of another type."""
    for name, attribute in ADDRESSES:
        for reference in context.references(attribute, name):
            text = reference.text.strip()
            if not text:
                message = f"The attribute {attribute!r} is empty, so it refers to nothing."
                yield Hit(MISSING, reference.element, message, (), attribute, Severity.WARNING)
                continue
            if _is_elsewhere(context, reference.element):
                continue
            lost = lost_in(context, text)
            if lost is not None:
                message = f"{text!r} leads nowhere: there is no {lost!r}."
                yield Hit(MISSING, reference.element, message, (), attribute, Severity.WARNING)
                continue
            target = _through(context, text)
            expected = _EXPECTED.get((name, attribute))
            if target >= 0 and expected and context.name(target) not in expected:
                found = context.name(target)
                if found == "newparam":
                    continue  # it stands for what it refers to
                message = f"{text!r} is a <{found}>, not {expected_text(expected)}."
                yield Hit(WRONG_TYPE, reference.element, message, (target,), attribute,
                          Severity.WARNING)  # fmt: skip


def _is_elsewhere(context: Context, element: int) -> bool:
    """Whether what a parameter is of is an effect, or in another document."""
    holder = int(context.parent[element])
    if context.name(holder) == "setparam":
        holder = int(context.parent[holder])
    if context.name(element) not in ("setparam", "connect_param"):
        return False
    url = context.columns.attribute_of(holder, "url")
    return context.name(holder) == "instance_effect" or (bool(url) and context.target(url) < 0)


def formulas(context: Context) -> Iterator[Hit]:
    """Addresses in formulas: of what they compute, and of what they compute it from."""
    rows = context.rows(TextRows, "param")
    assert rows.ordinals is not None
    mine = rows.ordinals[np.flatnonzero(context.is_within(rows.ordinals, "target"))]
    symbols = [context.columns.index.rows(code) for code in context.columns.codes_of(_CSYMBOL)]
    for elements in (mine, *symbols):
        for element, text in zip(
            elements.tolist(), context.at(TextRows, elements).value, strict=True
        ):
            address = text.strip()
            # A single word may be a function or a parameter of another program.
            lost = lost_in(context, address) if "/" in address else None
            if lost is not None:
                message = f"{address!r} leads nowhere: there is no {lost!r}."
                yield Hit(MISSING, element, message, severity=Severity.WARNING)


def sidrefs(context: Context) -> Iterator[Hit]:
    """Texts that are addresses."""
    rows = context.rows(TextRows, "SIDREF")
    assert rows.ordinals is not None
    for element, text in zip(rows.ordinals.tolist(), rows.value, strict=True):
        lost = lost_in(context, text.strip()) if text.strip() else None
        if lost is not None:
            message = f"{text.strip()!r} leads nowhere: there is no {lost!r}."
            yield Hit(MISSING, element, message, severity=Severity.WARNING)
            continue
        expected = _BOUND.get(context.name(int(context.parent[element])))
        target = _through(context, text.strip()) if expected else -1
        if expected and target >= 0 and context.name(target) not in expected:
            message = f"{text.strip()!r} is a <{context.name(target)}>, not "
            message += f"{expected_text(expected)}."
            yield Hit(WRONG_TYPE, element, message, (target,), severity=Severity.WARNING)


def axes(context: Context) -> Iterator[Hit]:
    """Parameters that are bound for axes, and hold the address of something else."""
    rows = context.rows(TextRows, "param")
    assert rows.ordinals is not None
    mine = rows.ordinals[np.flatnonzero(context.is_within(rows.ordinals, "axis"))]
    names = [text.strip() for text in context.at(TextRows, mine).value]
    scenes = context.ancestor(mine, "instance_kinematics_scene").tolist()
    wanted = set(zip(scenes, names, strict=True))
    if not wanted:
        return
    held = context.rows(NamedRows, "newparam")
    assert held.ordinals is not None
    addresses = context.children(held, "SIDREF", TextRows)
    assert addresses.ordinals is not None
    above, sids = context.parent[held.ordinals].tolist(), list(held.sid)
    for element, owner, text in zip(
        addresses.ordinals.tolist(), addresses.owner.tolist(), addresses.value, strict=True
    ):
        if (above[owner], sids[owner]) not in wanted:
            continue
        target = _through(context, text.strip())
        if target >= 0 and context.name(target) not in _BOUND["axis"]:
            message = f"{text.strip()!r} is a <{context.name(target)}>, not an axis."
            yield Hit(WRONG_TYPE, element, message, (target,), severity=Severity.WARNING)


def parameters(context: Context) -> Iterator[Hit]:
    """Parameters of kinematics that nobody declares."""
    for reference in context.references("ref", "param"):
        if context.name(int(context.parent[reference.element])) == "bind":
            yield from _undeclared(context, reference.element, reference.text, "ref")
    rows = context.rows(TextRows, "param")
    if not len(rows):
        return
    assert rows.ordinals is not None
    mine = np.flatnonzero(context.is_within(rows.ordinals, *_HOLDERS))
    if not len(mine):
        return
    texts = context.at(TextRows, rows.ordinals[mine]).value
    for element, text in zip(rows.ordinals[mine].tolist(), texts, strict=True):
        yield from _undeclared(context, element, text, None)


def _undeclared(context: Context, element: int, text: str, attribute: str | None) -> Iterator[Hit]:
    name = text.strip()
    last = name.rpartition("/")[2]
    if name and not {name, last, last.rpartition(".")[2]} & context.shared(_declared):
        message = f"No <newparam> or <bind> declares the parameter {name!r}."
        yield Hit(MISSING, element, message, (), attribute, Severity.WARNING)


def _declared(context: Context) -> frozenset[str]:
    found: set[str] = set()
    for name in PARAMETERS:
        for attribute in ("sid", "symbol", "ref"):
            found.update(reference.text for reference in context.references(attribute, name))
    return frozenset(found)


def _sids(context: Context) -> frozenset[str]:
    return frozenset(context.columns.with_attribute("sid")[1])


def lost_in(context: Context, text: str) -> str | None:
    """The first name in an address that is there nowhere; None where there is none."""
    sids = context.shared(_sids)
    head, *rest = text.removeprefix("#").split("/")
    if ".dae" in text or "://" in text:
        return None  # of another document
    ids = context.resource.ids
    if head != "." and not {head, _MEMBER.sub("", head)} & (ids.keys() | sids):
        return head
    for sid in rest:
        if sid not in sids and _MEMBER.sub("", sid) not in sids:
            return sid
    return None


def _through(context: Context, text: str) -> int:
    """The element that an address leads to, through instances as well; -1 where it does not."""
    head, *rest = text.removeprefix("#").split("/")
    target = context.resource.ids.get(head, -1)
    for sid in rest:
        if target < 0:
            return -1
        inner = context.resource.sids.within(target, sid)
        if inner is None and context.name(target).startswith("instance_"):
            target = context.target(context.columns.attribute_of(target, "url"))
            inner = context.resource.sids.within(target, sid) if target >= 0 else None
        target = -1 if inner is None else inner
    return target


CHECKS = (addresses, formulas, sidrefs, axes, parameters)
