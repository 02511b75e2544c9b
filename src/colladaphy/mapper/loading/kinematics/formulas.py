"""Formulas that make an axis follow others, as far as they are linear (COLLADA 1.5 §formula).

Angles are in degrees, as in all that the kinematics say. Axes are named by the path of their
sids (`csymbol`), or by a parameter of the formula (`ci`).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from graphlib import CycleError, TopologicalSorter

from lxml import etree

from colladaphy.links.names import c, local_name
from colladaphy.links.pool import Pool
from colladaphy.mapper.loading.kinematics.models import Place
from colladaphy.mapper.loading.kinematics.references import References

__all__ = ["Following", "following_of", "values_of"]

_DEPTH = 64


@dataclass(frozen=True, slots=True)
class Following:
    """One axis as a sum of a number and of other axes, each times a number."""

    target: Place
    constant: float
    slopes: dict[Place, float] = field(default_factory=dict)


@dataclass(slots=True)
class _Sum:
    """A number, and the slope of each name."""

    constant: float = 0.0
    slopes: dict[str, float] = field(default_factory=dict)

    def plus(self, other: _Sum, times: float) -> _Sum:
        slopes = dict(self.slopes)
        for name, slope in other.slopes.items():
            slopes[name] = slopes.get(name, 0.0) + times * slope
        return _Sum(self.constant + times * other.constant, slopes)

    def times(self, factor: float) -> _Sum:
        return _Sum().plus(self, factor)


def values_of(
    stated: Mapping[Place, float], following: Mapping[Place, Following]
) -> dict[Place, float]:
    """The values of axes where some follow others; what follows itself keeps what is stated."""
    leaders: dict[Place, set[Place]] = {one: set(found.slopes) for one, found in following.items()}
    order: list[Place] | None = None
    while order is None:
        try:
            order = list(TopologicalSorter(leaders).static_order())
        except CycleError as error:
            for one in error.args[1]:
                leaders.pop(one, None)
    values = dict(stated)
    for one in order:
        if one in leaders:
            found = following[one]
            terms = (slope * values.get(axis, 0.0) for axis, slope in found.slopes.items())
            values[one] = found.constant + sum(terms)
    return values


def following_of(pool: Pool, references: References, place: Place) -> Following | None:
    """What the formula (or the instance of one) at a place says; None where it is not linear."""
    values: dict[str, etree._Element] = {}
    home, element = place
    holder = pool.resources[home].element(element)
    origins = {holder: place}
    if local_name(holder.tag) == "instance_formula":
        inner = references.instance_of(place)
        if inner is None:
            return None
        values = {str(one.get("ref")): one for one in holder.iterchildren(c("setparam"))}
        home, element = inner
        holder = pool.resources[home].element(element)
        origins[holder] = inner
    for one in holder.iterchildren(c("newparam")):
        values.setdefault(str(one.get("sid")), one)
    origin = home, element

    def meaning(name: str) -> float | Place | None:
        """The number or the axis that a name stands for."""
        stated, at = values.get(name), origin
        if stated is not None:
            for child in stated.iterchildren(c("float"), c("int")):
                return _number(child.text)
            name = next((child.text or "" for child in stated.iterchildren(c("SIDREF"))), "")
            outer = stated.getparent()
            at = origins.get(outer, origin) if outer is not None else origin
        found = references.resolve(name, at) if name.strip() else None
        if found is None or found.place is None:
            return None if found is None else found.number
        return references.axis_of(found.place)

    target = holder.find(f"{c('target')}/{c('param')}")
    meant = None if target is None else meaning((target.text or "").strip())
    summed = next((made for made in map(_linear, _maths(holder)) if made is not None), None)
    if not isinstance(meant, tuple) or summed is None:
        return None
    following = Following(meant, summed.constant)
    constant = summed.constant
    for name, slope in summed.slopes.items():
        value = meaning(name)
        if value is None:
            return None
        if isinstance(value, float):
            constant += slope * value
        else:
            following.slopes[value] = following.slopes.get(value, 0.0) + slope
    return Following(meant, constant, following.slopes)


def _maths(holder: etree._Element) -> Iterator[etree._Element]:
    """The common formula, then OpenRAVE's equation of the position."""
    for part in holder.iterchildren(c("technique_common")):
        yield from (child for child in part.iterchildren(tag=etree.Element))
    for part in holder.iterchildren(c("technique")):
        for equation in part.iterchildren(tag=etree.Element):
            if local_name(equation.tag) == "equation" and equation.get("type") == "position":
                yield from equation.iterchildren(tag=etree.Element)


def _number(text: str | None) -> float | None:
    try:
        return float(text or "")
    except ValueError:
        return None


def _linear(element: etree._Element, left: int = _DEPTH) -> _Sum | None:
    """A term of MathML as a sum; None where it is none."""
    kind, inner = local_name(element.tag), list(element.iterchildren(tag=etree.Element))
    if left == 0:
        return None
    if kind == "cn":
        value = _number("".join(map(str, element.itertext())))
        return None if value is None or inner else _Sum(value)
    if kind in ("ci", "csymbol"):
        name = (element.text or "").strip()
        return _Sum(0.0, {name: 1.0}) if name and not inner else None
    if kind in ("math", "semantics", "mrow"):
        return _linear(inner[0], left - 1) if inner else None
    if kind != "apply" or not inner:
        return None
    terms = [_linear(term, left - 1) for term in inner[1:]]
    known = [term for term in terms if term is not None]
    if not known or len(known) < len(terms):
        return None
    return _applied(local_name(inner[0].tag), known)


def _applied(operator: str, terms: list[_Sum]) -> _Sum | None:
    first, *rest = terms
    if operator == "plus":
        for term in rest:
            first = first.plus(term, 1.0)
        return first
    if operator == "minus" and len(terms) <= 2:
        return first.plus(rest[0], -1.0) if rest else first.times(-1.0)
    if operator == "times":
        for term in rest:
            if first.slopes and term.slopes:
                return None
            one, factor = (first, term) if first.slopes else (term, first)
            first = one.times(factor.constant)
        return first
    if operator == "divide" and len(terms) == 2 and not rest[0].slopes and rest[0].constant:
        return first.times(1.0 / rest[0].constant)
    return None
