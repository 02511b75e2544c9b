"""The pe profile: in its place and namespace, with values that are some (docs/pe-profile.md)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from lxml import etree
from numpy.typing import NDArray

from colladaphy.columns.distinct import distinct, numbered
from colladaphy.findings import Finding, Severity
from colladaphy.links.names import COLLADA, PE
from colladaphy.meaning import profile_rules
from colladaphy.meaning.context import Context, TextRows
from colladaphy.meaning.counterparts import counterparts
from colladaphy.meaning.hits import Hit
from colladaphy.meaning.links import reference_hits
from colladaphy.meaning.profile_table import profile_of
from colladaphy_schema.rows import Column, Masked, Rows

__all__ = ["CHECKS", "are_broken"]


Array = NDArray[Any]

_PLACES = {
    "world": ("physics_scene",),
    "body": ("rigid_body",),
    "motion": ("instance_rigid_body",),
    "joint": ("rigid_constraint",),
    "material": ("physics_material", "physics_scene"),
}
_RANGES = {
    "mass": 0.0,
    "density": 0.0,
    "radius": -1.0,
    "radii": 0.0,
    "lengths": -1.0,
    "time_step": -1.0,
    "strength": 0.0,
    "length": 0.0,
}
"""Values that may not be negative; -1 where they may not be zero either."""
_OF_MATERIALS = {
    "restitution": (0.0, 1.0),
    "static_friction": (0.0, np.inf),
    "dynamic_friction": (0.0, np.inf),
    "poisson_ratio": (-1.0, 0.5),
    "young_modulus": (0.0, np.inf),
    "stiffness": (0.0, np.inf),
    "damping_normal": (0.0, np.inf),
    "damping_tangential": (0.0, np.inf),
}
_OF_PAIRS = {name: _OF_MATERIALS[name]
             for name in ("restitution", "static_friction", "dynamic_friction")}  # fmt: skip
_FINITE = (
    "position", "orientation", "linear_velocity", "angular_velocity", "force", "torque", "gravity",
    "time_step", "speed", "radius", "radii", "lengths", "length", "normal", "anchor",
    "displacement", "mass", "inertia", "density",
)  # fmt: skip
_NUMBERS = (
    "min", "max", "stiffness", "damping", "target_value", "strength",
    "poisson_ratio", "young_modulus", "damping_normal", "damping_tangential", "dynamic_friction",
    "restitution", "static_friction",
)  # fmt: skip


class _SystemIds(Rows):
    """Elements with system ids (thesis 6.1)."""

    __slots__ = ()
    sid: Column[Masked[Array]] = Column("sid", "attribute", "integer", optional=True)


def places(context: Context) -> Iterator[Hit]:
    """Elements of the profile where nobody reads them; a technique of another one is told once."""
    profile = profile_of(context)
    told: set[int] = set()
    for name, expected in _PLACES.items():
        elements = profile.elements(name)
        techniques = context.ancestor(elements, "technique")
        elements, techniques = elements[techniques >= 0], techniques[techniques >= 0]
        if not len(elements):
            continue
        first, inverse = numbered(techniques)
        numbers, texts = context.columns.factorized(context.at(Rows, techniques[first]), "profile")
        ours = np.array([text == "pe" for text in texts], np.bool_)[numbers][inverse]
        for row in np.flatnonzero(~ours).tolist():
            if int(techniques[row]) in told:
                continue
            told.add(int(techniques[row]))
            other = texts[int(numbers[inverse[row]])]
            message = f"The technique is of the profile {other!r}."
            yield Hit(profile_rules.TECHNIQUE, int(elements[row]), message, (int(techniques[row]),))
        holders = context.parent[techniques]
        outer = np.where(context.is_named(holders, "extra"), context.parent[holders], holders)
        wrong = ours & ~context.is_named(outer, *expected)
        wrong &= context.parent[elements] == techniques
        for row in np.flatnonzero(wrong).tolist():
            found = context.name(int(outer[row]))
            message = f"<pe:{name}> stands in a <{found}>, not in a <{expected[0]}>."
            yield Hit(profile_rules.PLACE, int(elements[row]), message, (int(holders[row]),))


def namespaces(context: Context) -> Iterator[Finding]:
    """Techniques of the profile with elements of other namespaces."""
    if context.resource.has_other_spelling:
        for child, message in strangers(context.resource.tree):
            yield profile_rules.NAMESPACE.at(child, message, file=context.resource.file)


def strangers(tree: etree._ElementTree) -> Iterator[tuple[etree._Element, str]]:
    """The first element of each other namespace in techniques of the profile, and what to say.

    A prefix that is declared wrongly is one fault, however often it is used.
    """
    found: dict[str, list[etree._Element]] = {}
    for technique in tree.iter("{*}technique"):
        if technique.get("profile") != "pe":
            continue
        for child in technique.iterchildren(etree.Element):
            namespace = etree.QName(child).namespace
            # Those of no namespace, or of COLLADA's, are the thesis's spelling.
            if namespace not in (None, PE, COLLADA):
                found.setdefault(str(namespace), []).append(child)
    for namespace, children in found.items():
        message = f"<{etree.QName(children[0]).localname}> is of the namespace {namespace!r}."
        if len(children) > 1:
            message += f" {len(children) - 1} more elements are so."
        yield children[0], message


def numbers(context: Context) -> Iterator[Hit]:
    """Values that are none."""
    profile = profile_of(context)
    if profile.is_empty:
        return
    for name in (*_FINITE, *_NUMBERS):
        elements = profile.elements(name)
        if not len(elements):
            continue
        values = profile.lists(name)
        bad = np.isnan(values.values) if name in _NUMBERS else ~np.isfinite(values.values)
        if bad.any():
            owner = np.searchsorted(values.offsets, np.flatnonzero(bad), side="right") - 1
            rows = distinct(owner)
            beside = counterparts(context, elements[rows])
            for row, related in zip(rows.tolist(), beside, strict=True):
                shown = " ".join(f"{value:g}" for value in values[row].tolist())
                message = f"<pe:{name}> is {shown}."
                yield Hit(profile_rules.NUMBER, int(elements[row]), message, related)
        if name == "normal":
            flat = ~values.values.reshape(-1, 3).any(axis=1)
            flat = elements[flat]
            for element, related in zip(flat.tolist(), counterparts(context, flat), strict=True):
                yield Hit(profile_rules.VALUE, element, "The normal is 0 0 0.", related)
        if name == "orientation":
            table = values.values.reshape(-1, 4)
            for element in elements[~table.any(axis=1)].tolist():
                yield Hit(profile_rules.QUATERNION, element, "The orientation is 0 0 0 0.")


def ranges(context: Context) -> Iterator[Hit]:
    """Values out of their ranges."""
    profile = profile_of(context)
    for name, least in _RANGES.items():
        elements = profile.elements(name)
        if not len(elements):
            continue
        lists = profile.lists(name)
        low = lists.values < 0.0 if least == 0.0 else lists.values <= 0.0
        rows = distinct(np.searchsorted(lists.offsets, np.flatnonzero(low), side="right") - 1)
        beside = counterparts(context, elements[rows])
        for row, related in zip(rows.tolist(), beside, strict=True):
            shown = " ".join(f"{value:g}" for value in lists[row].tolist())
            message = f"<pe:{name}> is {shown}."
            yield Hit(profile_rules.VALUE, int(elements[row]), message, related)
    for name, (least, most) in _OF_MATERIALS.items():
        elements, _, values = profile.values(name, 1, "material")
        rows = np.flatnonzero((values[:, 0] < least) | (values[:, 0] > most))
        beside = counterparts(context, elements[rows])
        for row, related in zip(rows.tolist(), beside, strict=True):
            message = (
                f"<pe:{name}> is {values[row, 0]:g}; loading takes the nearest value there is."
            )
            yield Hit(profile_rules.VALUE, int(elements[row]), message, related,
                      severity=Severity.WARNING)  # fmt: skip
    tensors, _, values = profile.values("inertia", 9, "body", "shape", "union")
    sizes = np.abs(values).max(axis=1, initial=0.0)
    some = np.flatnonzero((sizes > 0.0) & (sizes < np.inf))
    matrices = (values[some] / sizes[some, None]).reshape(-1, 3, 3)
    moments = np.linalg.eigvalsh((matrices + matrices.transpose(0, 2, 1)) / 2.0)
    rows = np.flatnonzero(are_broken(moments))
    beside = counterparts(context, tensors[some[rows]])
    for row, related in zip(rows.tolist(), beside, strict=True):
        shown = " ".join(f"{moment * sizes[some[row]]:g}" for moment in moments[row])
        message = f"The principal moments of inertia are {shown}."
        yield Hit(profile_rules.VALUE, int(tensors[some[row]]), message, related)
    for name in ("linear_limits", "angular_limits"):
        lower, around, low_values = profile.values("min", 3, name)
        _, _, high_values = profile.values("max", 3, name)
        rows = np.flatnonzero((low_values > high_values).any(axis=1))
        beside = counterparts(context, lower[rows])
        for row, related in zip(rows.tolist(), beside, strict=True):
            shown = " ".join(f"{value:g}" for value in low_values[row].tolist())
            message = f"The lower limits are {shown}, above the upper ones."
            yield Hit(profile_rules.VALUE, int(lower[row]), message, (int(around[row]), *related))


def are_broken(moments: Array) -> Array:
    """Which principal moments of inertia (n, 3), ascending, no body has (n,)."""
    one, two, three = moments.T
    return np.asarray((one < -1e-9 * np.abs(three)) | (one + two < three * (1.0 - 1e-3)))


def pairs(context: Context) -> Iterator[Hit]:
    """Values of pairs of materials, and times of worlds, that are none."""
    profile = profile_of(context)
    for name, keys in (("pair", _OF_PAIRS), ("world", {"time": (-np.inf, np.inf)})):
        for element in profile.elements(name).tolist():
            for key, (least, most) in keys.items():
                text = context.columns.attribute_of(element, key)
                if text is None:
                    continue
                value = float(text)
                if not np.isfinite(value):
                    yield Hit(profile_rules.NUMBER, element, f"The {key} is {value:g}.", (), key)
                elif not least <= value <= most:
                    yield Hit(profile_rules.VALUE, element, f"The {key} is {value:g}.", (), key)


def links(context: Context) -> Iterator[Hit]:
    """Pairs of materials that are not there, and states that are broken."""
    profile = profile_of(context)
    for element in profile.elements("pair").tolist():
        for key in ("first", "second"):
            text = context.columns.attribute_of(element, key) or ""
            yield from reference_hits(
                context, element, key, text, ("physics_material",), severity=Severity.ERROR
            )
    states = profile.elements("engine_state").tolist()
    if states:
        import base64
        import hashlib
    for element in states:
        text = context.at(TextRows, np.array([element])).value[0]
        wanted = (context.columns.attribute_of(element, "sha256") or "").lower()
        try:
            data = base64.b64decode("".join(text.split()), validate=True)
        except ValueError:
            data = b""
        if hashlib.sha256(data).hexdigest() != wanted:
            yield Hit(profile_rules.ENGINE_STATE, element, "The checksum is of another state.")


def ids(context: Context) -> Iterator[Hit]:
    """System ids that are there twice."""
    profile = profile_of(context)
    if profile.is_empty:
        return
    for names in (("body", "shape", "union"), ("joint",)):
        elements = np.sort(np.concatenate([profile.elements(name) for name in names]))
        if not len(elements):
            continue
        sids = context.at(_SystemIds, elements).sid
        elements, ids = elements[sids.present], sids.values[sids.present]
        for element in elements[ids < 1].tolist():
            message = "A system id is a positive number; the next free one is taken."
            yield Hit(profile_rules.SYSTEM_ID, element, message, (), "sid")
        models = context.ancestor(elements, "physics_model")
        order = np.argsort(ids, kind="stable")
        order = order[np.argsort(models[order], kind="stable")]
        elements, ids, models = elements[order], ids[order], models[order]
        again = np.flatnonzero((ids[1:] == ids[:-1]) & (models[1:] == models[:-1])) + 1
        starts = np.ones(len(ids), np.bool_)
        starts[again] = False
        first = np.maximum.accumulate(np.where(starts, np.arange(len(ids)), 0))
        for row in again[models[again] >= 0].tolist():
            message = f"The system id {ids[row]} is that of another one in the model."
            other = int(elements[first[row]])
            yield Hit(profile_rules.SYSTEM_ID, int(elements[row]), message, (other,), "sid")


def once(context: Context) -> Iterator[Hit]:
    """Profiles of one element that are there twice."""
    profile = profile_of(context)
    for name in ("world", "body", "motion", "joint", "material"):
        elements = profile.elements(name)
        techniques = context.ancestor(elements, "technique")
        direct = context.parent[elements] == techniques
        holders = np.where(techniques >= 0, context.parent[techniques], -1)
        if name == "material":  # a world has many
            direct &= context.is_named(holders, "physics_material", "extra")
        elements, holders = elements[direct], holders[direct]
        if len(distinct(holders)) == len(holders):
            continue
        seen: dict[int, int] = {}
        for element, holder in zip(elements.tolist(), holders.tolist(), strict=True):
            if holder in seen:
                message = f"There is a <pe:{name}> of {context.label(holder)} already."
                yield Hit(profile_rules.TWICE, element, message, (seen[holder], holder))
            seen.setdefault(holder, element)


def unions(context: Context) -> Iterator[Hit]:
    """Profiles of bodies with another number of shapes."""
    profile = profile_of(context)
    bodies, shapes = profile.elements("body"), profile.elements("shape")
    if not len(bodies) or not len(shapes):
        return
    top = _holders(context, shapes)
    leaves = np.bincount(np.searchsorted(bodies, top[top >= 0]), minlength=len(bodies))
    techniques = context.ancestor(bodies, "technique")
    holders = np.where(techniques >= 0, context.parent[techniques], -1)
    own = context.ancestor(context.ordinals("shape"), "rigid_body", "instance_rigid_body")
    begin, end = np.searchsorted(own, holders), np.searchsorted(own, holders, side="right")
    wrong = (leaves > 0) & (leaves != end - begin) & context.is_named(holders, "rigid_body")
    for row in np.flatnonzero(wrong).tolist():
        element = int(bodies[row])
        inner = profile.child(element, "union")
        inner = profile.child(element, "shape") if inner < 0 else inner
        message = f"{leaves[row]} shapes in the profile, but {end[row] - begin[row]} in the body."
        yield Hit(profile_rules.UNION, inner, message, (int(holders[row]),))


def _holders(context: Context, elements: Array) -> Array:
    """The pe:body around each element; -1 for none."""
    codes = context.columns.codes_of(f"{{{PE}}}body")
    found = context.parent[elements].astype(np.int64)
    while True:
        left = np.flatnonzero((found >= 0) & ~context.columns.have_code(found, codes))
        if not len(left):
            return np.asarray(found)
        found[left] = context.parent[found[left]]


CHECKS = (places, namespaces, numbers, ranges, pairs, links, ids, once, unions)
