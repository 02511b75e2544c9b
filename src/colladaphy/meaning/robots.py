"""Robots as wholes: joints and axes used twice, values and bindings (COLLADA 1.5 §kinematics)."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator

import numpy as np

from colladaphy.columns.distinct import distinct
from colladaphy.meaning import kinematics_rules
from colladaphy.meaning.context import Context, FloatRows, NamedRows, TextRows
from colladaphy.meaning.hits import Hit
from colladaphy_schema.rows import Rows

__all__ = ["CHECKS"]

_HOLDERS = ("min", "max", "value", "speed", "acceleration", "deceleration", "jerk")
_RATES = ("speed", "acceleration", "deceleration", "jerk")
_TURNING = ("rotate", "matrix")
_SLIDING = ("translate", "matrix")
_TRANSFORMS = ("lookat", "matrix", "rotate", "scale", "skew", "translate")
_DEGREES = 1e-6


def numbers(context: Context) -> Iterator[Hit]:
    """Numbers of axes that are none, and rates below zero."""
    elements = context.ordinals("float", "float2", "float3")
    for name in _HOLDERS:
        mine = elements[context.is_within(elements, name)]
        around = context.ancestor(mine, "axis_info", "effector_info", "bind_joint_axis")
        mine = mine[around >= 0]
        if not len(mine):
            continue
        lists = context.at(FloatRows, mine).value
        owner = np.repeat(np.arange(len(mine)), np.diff(lists.offsets))
        for row in distinct(owner[np.isnan(lists.values)]).tolist():
            yield Hit(kinematics_rules.NUMBER, int(mine[row]), f"The {name} is NaN.")
        if name in _RATES:
            for row in distinct(owner[lists.values < 0.0]).tolist():
                shown = " ".join(f"{value:g}" for value in lists[row].tolist())
                yield Hit(kinematics_rules.RATE, int(mine[row]), f"The {name} is {shown}.")


def joints(context: Context) -> Iterator[Hit]:
    """Joints that bind two links, or more; what is in a link that is there twice is so as well."""
    seen: dict[tuple[int, str], int] = {}
    told: set[int] = set()
    for reference in context.references("joint", "attachment_full"):
        model = int(context.ancestor(np.array([reference.element]), "kinematics_model")[0])
        first = seen.setdefault((model, reference.text.strip()), reference.element)
        if first != reference.element and told.isdisjoint(_around(context, reference.element)):
            told.add(reference.element)
            message = f"The joint {reference.text.strip()!r} binds another link already."
            yield Hit(kinematics_rules.JOINT_TWICE, reference.element, message, (first,), "joint")


def _around(context: Context, element: int) -> Iterator[int]:
    """The elements around an element."""
    while (element := int(context.parent[element])) >= 0:
        yield element


def axes(context: Context) -> Iterator[Hit]:
    """Axes that are described twice, or bound to a transform twice."""
    for name, attribute, rule, what in (
        ("axis_info", "axis", kinematics_rules.AXIS_TWICE, "describes the axis"),
        ("bind_joint_axis", "target", kinematics_rules.BOUND_TWICE, "moves the transform"),
    ):
        seen: dict[tuple[int, str], int] = {}
        for reference in context.references(attribute, name):
            text = reference.text.strip()
            above = int(context.parent[reference.element])
            first = seen.setdefault((above, text), reference.element)
            if text and first != reference.element:
                message = f"Another <{name}> {what} {text!r}, too."
                yield Hit(rule, reference.element, message, (first,), attribute)


def bindings(context: Context) -> Iterator[Hit]:
    """Joints at values that they cannot have, or bound to transforms of another kind."""
    rows = context.rows(Rows, "bind_joint_axis")
    if not len(rows):
        return
    assert rows.ordinals is not None
    axes = _texts(context, rows, "axis", "param")
    stated = _texts(context, rows, "axis", "SIDREF")
    sids = context.shared(_parameters)
    floats = context.children(rows, "value", Rows)
    values, places = context.scalars(floats, "float")
    value = dict(zip(floats.owner.tolist(), zip(values, places.tolist(), strict=True), strict=True))
    targets = context.texts(rows, "target")
    for row, element in enumerate(rows.ordinals.tolist()):
        scene = int(context.parent[element])
        address = stated.get(row) or sids.get((scene, axes.get(row, "")), "")
        joint = context.shared(_axes).get(_ending(address), -1)
        if joint < 0:
            continue
        low, high = context.shared(_limits).get(joint, (-np.inf, np.inf))
        number, place = value.get(row, (np.nan, -1))
        if place >= 0 and not np.isnan(number):
            room = _DEGREES * max(abs(low), abs(high), 1.0) if np.isfinite(high - low) else 0.0
            if low < high and not low - room <= number <= high + room:
                message = f"The joint is at {number:g}, but its limits are {low:g} and {high:g}."
                yield Hit(kinematics_rules.VALUE, place, message, (joint,))
        target = _transform(context, targets[row])
        turns = context.name(joint) == "revolute"
        found, kind = context.name(target) if target >= 0 else "", context.name(joint)
        # What is no transform at all is told at the reference.
        if found in _TRANSFORMS and found not in (_TURNING if turns else _SLIDING):
            message = f"The axis is of a <{kind}>, but the target is a <{found}>."
            yield Hit(kinematics_rules.TRANSFORM, element, message, (target, joint), "target")


def _ending(address: str) -> tuple[str, str]:
    """The sids of the joint and of the axis, at the end of an address."""
    head, _, last = address.rpartition("/")
    return head.rpartition("/")[2], last


def _transform(context: Context, text: str | None) -> int:
    """The transform of a node that an address means; -1 for what is written otherwise."""
    head, _, sid = (text or "").strip().removeprefix("#").rpartition("/")
    node = context.resource.ids.get(head, -1)
    found = context.resource.sids.within(node, sid) if node >= 0 else None
    return -1 if found is None else found


def _texts(context: Context, rows: Rows, name: str, inner: str) -> dict[int, str]:
    """The text of an element within a child of each row."""
    outer = context.children(rows, name, Rows)
    found = context.children(outer, inner, TextRows)
    owners = outer.owner[found.owner].tolist()
    return {owner: text.strip() for owner, text in zip(owners, found.value, strict=True)}


def _parameters(context: Context) -> dict[tuple[int, str], str]:
    """The addresses that parameters hold, by the element that declares them and their sid."""
    rows = context.rows(NamedRows, "newparam")
    assert rows.ordinals is not None
    found = context.children(rows, "SIDREF", TextRows)
    above = context.parent[rows.ordinals].tolist()
    sids = list(rows.sid)
    return {
        (above[owner], sids[owner] or ""): text.strip()
        for owner, text in zip(found.owner.tolist(), found.value, strict=True)
    }


def _axes(context: Context) -> dict[tuple[str, str], int]:
    """The axes of joints by the sids of both, or of an instance, where these mean one only."""
    rows = context.rows(NamedRows, "revolute", "prismatic")
    assert rows.ordinals is not None
    above = context.at(NamedRows, distinct(context.parent[rows.ordinals]))
    assert above.ordinals is not None
    names = dict(zip(above.ordinals.tolist(), above.sid, strict=True))
    found: defaultdict[tuple[str, str], list[int]] = defaultdict(list)
    called: defaultdict[int, set[str | None]] = defaultdict(set)
    instances = context.rows(NamedRows, "instance_joint")
    assert instances.ordinals is not None
    targets = context.led("instance_joint", "url")
    for sid, joint in zip(instances.sid, targets.tolist(), strict=True):
        called[joint].add(sid)
    for element, sid in zip(rows.ordinals.tolist(), rows.sid, strict=True):
        joint = int(context.parent[element])
        for name in {names[joint], *called.get(joint, ())}:
            found[name or "", sid or ""].append(element)
    return {key: elements[0] for key, elements in found.items() if len(elements) == 1}


def _limits(context: Context) -> dict[int, tuple[float, float]]:
    """The limits of the axes of joints."""
    rows = context.rows(Rows, "revolute", "prismatic")
    assert rows.ordinals is not None
    limits = context.children(rows, "limits", Rows)
    low, high = (context.scalars(limits, name)[0] for name in ("min", "max"))
    low, high = np.where(np.isnan(low), -np.inf, low), np.where(np.isnan(high), np.inf, high)
    return {
        int(rows.ordinals[owner]): (float(one), float(two))
        for owner, one, two in zip(limits.owner.tolist(), low, high, strict=True)
    }


CHECKS = (numbers, joints, axes, bindings)
