"""The pe profile: in its place and namespace, with values that are some (docs/pe-profile.md)."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from typing import Any

import numpy as np
from lxml import etree
from numpy.typing import NDArray

from colladaphy.findings import Finding
from colladaphy.links.names import COLLADA, PE
from colladaphy.meaning import profile_rules
from colladaphy.meaning.context import Context, FloatRows
from colladaphy.meaning.hits import Hit
from colladaphy.meaning.profile_table import profile_of

__all__ = ["CHECKS"]


Array = NDArray[Any]

_PLACES = {
    "world": ("physics_scene",),
    "body": ("rigid_body",),
    "motion": ("instance_rigid_body",),
    "joint": ("rigid_constraint",),
    "material": ("physics_material", "physics_scene"),
}
_FINITE = (
    "position", "orientation", "linear_velocity", "angular_velocity", "force", "torque", "gravity",
    "time_step", "radius", "radii", "lengths", "length", "normal", "anchor", "displacement",
)  # fmt: skip
_NUMBERS = (
    "mass", "inertia", "min", "max", "stiffness", "damping", "target_value", "density",
    "poisson_ratio", "young_modulus", "damping_normal", "damping_tangential", "dynamic_friction",
    "restitution", "static_friction",
)  # fmt: skip


def places(context: Context) -> Iterator[Hit]:
    """Elements of the profile where nobody reads them."""
    profile = profile_of(context)
    for name, expected in _PLACES.items():
        for element in profile.elements(name).tolist():
            technique = profile.technique(element)
            if technique < 0:
                continue
            if context.columns.attribute_of(technique, "profile") != "pe":
                other = context.columns.attribute_of(technique, "profile")
                message = f"The technique is of the profile {other!r}."
                yield Hit(profile_rules.TECHNIQUE, element, message, (technique,))
                continue
            holder = int(context.parent[technique])
            found = context.name(holder)
            if found == "extra":
                found = context.name(int(context.parent[holder]))
            if found not in expected and int(context.parent[element]) == technique:
                message = f"<pe:{name}> stands in a <{found}>, not in a <{expected[0]}>."
                yield Hit(profile_rules.PLACE, element, message, (holder,))


def namespaces(context: Context) -> Iterator[Finding]:
    """Techniques of the profile with elements of other namespaces."""
    if not context.resource.has_other_spelling:
        return
    for technique in context.resource.tree.iter("{*}technique"):
        if technique.get("profile") != "pe":
            continue
        for child in technique.iterchildren(etree.Element):
            name: Any = etree.QName(child)
            # Those of no namespace, or of COLLADA's, are the thesis's spelling.
            if name.namespace not in (None, PE, COLLADA):
                message = f"<{name.localname}> is of the namespace {name.namespace!r}."
                yield profile_rules.NAMESPACE.at(child, message, file=context.resource.file)


def numbers(context: Context) -> Iterator[Hit]:
    """Values that are none."""
    profile = profile_of(context)
    if profile.is_empty:
        return
    for name in (*_FINITE, *_NUMBERS):
        elements = profile.elements(name)
        if not len(elements):
            continue
        values = context.at(FloatRows, elements).value
        bad = np.isnan(values.values) if name in _NUMBERS else ~np.isfinite(values.values)
        if bad.any():
            owner = np.searchsorted(values.offsets, np.flatnonzero(bad), side="right") - 1
            for row in np.unique(owner).tolist():
                shown = " ".join(f"{value:g}" for value in values[row].tolist())
                yield Hit(profile_rules.NUMBER, int(elements[row]), f"<pe:{name}> is {shown}.")
        if name == "orientation":
            table = values.values.reshape(-1, 4)
            for element in elements[~table.any(axis=1)].tolist():
                yield Hit(profile_rules.QUATERNION, element, "The orientation is 0 0 0 0.")


def ids(context: Context) -> Iterator[Hit]:
    """System ids that are there twice."""
    profile = profile_of(context)
    if profile.is_empty:
        return
    for names in (("body", "shape", "union"), ("joint",)):
        seen: dict[tuple[int, str], int] = {}
        elements = sorted(element for name in names for element in profile.elements(name).tolist())
        if not elements:
            continue
        models = context.ancestor(np.array(elements), "physics_model").tolist()
        for element, model in zip(elements, models, strict=True):
            sid = context.columns.attribute_of(element, "sid")
            if sid is None or model < 0:
                continue
            key = (model, str(int(sid)))
            first = seen.setdefault(key, element)
            if first != element:
                message = f"The system id {sid} is that of another one in the model."
                yield Hit(profile_rules.SYSTEM_ID, element, message, (first,), "sid")


def unions(context: Context) -> Iterator[Hit]:
    """Profiles of bodies with another number of shapes."""
    profile = profile_of(context)
    bodies = profile.elements("body")
    if not len(bodies):
        return
    leaves: defaultdict[int, int] = defaultdict(int)
    shapes = profile.elements("shape")
    top = _holders(context, shapes)
    for body in top.tolist():
        leaves[body] += 1
    stated: defaultdict[int, int] = defaultdict(int)
    own = context.ordinals("shape")
    for body in context.ancestor(own, "rigid_body", "instance_rigid_body").tolist():
        stated[body] += 1
    for element in bodies.tolist():
        body = profile.holder(element)
        if context.name(body) != "rigid_body" or not leaves[element]:
            continue
        if leaves[element] != stated[body]:
            inner = profile.child(element, "union")
            inner = profile.child(element, "shape") if inner < 0 else inner
            message = f"{leaves[element]} shapes in the profile, but {stated[body]} in the body."
            yield Hit(profile_rules.UNION, inner, message, (body,))


def _holders(context: Context, elements: Array) -> Array:
    """The pe:body around each element; -1 for none."""
    codes = set(profile_codes(context))
    index = context.columns.index
    found = index.parent[elements].astype(np.int64)
    while True:
        left = np.flatnonzero((found >= 0) & ~np.isin(index.codes[np.maximum(found, 0)],
                                                      list(codes)))  # fmt: skip
        if not len(left):
            return np.asarray(found)
        found[left] = index.parent[found[left]]


def profile_codes(context: Context) -> tuple[int, ...]:
    """The codes of pe:body."""
    return context.columns.codes_of(f"{{{PE}}}body")


CHECKS = (places, namespaces, numbers, ids, unions)
