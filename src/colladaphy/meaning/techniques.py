"""Parameters of effects by their types, and techniques by their names (COLLADA 1.5 §effect)."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.distinct import are_among
from colladaphy.findings import Severity
from colladaphy.links.rules import MISSING
from colladaphy.meaning import link_rules, scene_rules
from colladaphy.meaning.context import Context, FloatRows, NamedRows
from colladaphy.meaning.effects import RANGES, inside
from colladaphy.meaning.hits import Hit, listed
from colladaphy_schema.rows import Rows

__all__ = ["CHECKS"]

Array = NDArray[Any]

_ABOUT = frozenset({"annotate", "semantic", "modifier"})
"""What a parameter has beside its value."""
_COLOURS = ("emission", "ambient", "diffuse", "specular", "reflective", "transparent")
_NEEDED = {
    **dict.fromkeys(RANGES, ("float",)),
    **dict.fromkeys(_COLOURS, ("float4", "float3")),
}
"""The types of parameters that colours and numbers of a shading may be taken from."""


class _Parameters:
    """The parameters of effects, with their values."""

    def __init__(self, context: Context) -> None:
        elements = context.every("newparam")
        effects = context.ancestor(elements, "effect").tolist()
        sids = context.at(NamedRows, elements).sid
        values = _values(context, elements)
        self.by_effect: dict[int, dict[str, list[int]]] = defaultdict(dict)
        """The values of the parameters of each effect by sid; several profiles have one each."""
        for element, effect, sid in zip(elements.tolist(), effects, sids, strict=True):
            if effect >= 0 and sid and element in values:
                self.by_effect[effect].setdefault(sid, []).append(values[element])


def _values(context: Context, parameters: Array) -> dict[int, int]:
    """The value of each parameter."""
    found: dict[int, int] = {}
    for element in np.flatnonzero(are_among(context.parent, parameters)).tolist():
        if context.name(element) not in _ABOUT:
            found.setdefault(int(context.parent[element]), element)
    return found


def _users(context: Context) -> Iterator[tuple[int, int, list[int]]]:
    """Where shadings take a value from a parameter: the param, and the values it may have."""
    elements = inside(context, "param")
    elements = elements[context.is_within(elements, *_NEEDED)]
    known = context.shared(_Parameters).by_effect
    effects = context.ancestor(elements, "effect").tolist()
    texts = context.texts(context.at(Rows, elements), "ref")
    for element, effect, ref in zip(elements.tolist(), effects, texts, strict=True):
        if values := known.get(effect, {}).get(ref or "", []):
            yield element, effect, values


def _settings(context: Context) -> Iterator[tuple[int, int, str]]:
    """The setparam of instances of effects: element, effect and sid of the parameter."""
    for reference in context.references("ref", "setparam"):
        instance = int(context.parent[reference.element])
        if context.name(instance) == "instance_effect":
            effect = context.target(context.columns.attribute_of(instance, "url"))
            yield reference.element, effect, reference.text.rpartition("/")[2]


def types(context: Context) -> Iterator[Hit]:
    """Parameters that are used, or set, as another type than they have."""
    for element, _, values in _users(context):
        needed = _NEEDED[context.name(int(context.parent[element]))]
        there = [context.name(value) for value in values]
        if not set(there) & set(needed):
            message = f"The parameter is a <{there[0]}>, but a <{needed[0]}> is needed."
            yield Hit(link_rules.PARAMETER_TYPE, element, message, (values[0],), "ref")
    known = context.shared(_Parameters).by_effect
    settings = list(_settings(context))
    set_values = _values(context, np.array([element for element, _, _ in settings], np.int64))
    for element, effect, sid in settings:
        values = known.get(effect, {}).get(sid, [])
        given = context.name(set_values[element]) if element in set_values else ""
        there = [context.name(value) for value in values]
        # Of a sampler its image or its states are set.
        if not there or not given or given in there or given.startswith("sampler_"):
            continue
        message = f"The value is a <{given}>, but the parameter is a <{there[0]}>."
        yield Hit(link_rules.PARAMETER_TYPE, element, message, (values[0],), "ref")


def numbers(context: Context) -> Iterator[Hit]:
    """Numbers of shadings that are out of range where a parameter has them."""
    told: set[int] = set()
    used: dict[tuple[int, str], str] = {}
    for element, effect, values in _users(context):
        name = context.name(int(context.parent[element]))
        used[effect, context.columns.attribute_of(element, "ref") or ""] = name
        yield from _ranges(context, name, values, told)
    settings = list(_settings(context))
    set_values = _values(context, np.array([element for element, _, _ in settings], np.int64))
    for element, effect, sid in settings:
        if (effect, sid) in used and element in set_values:
            yield from _ranges(context, used[effect, sid], [set_values[element]], told)


def _ranges(context: Context, name: str, values: Iterable[int], told: set[int]) -> Iterator[Hit]:
    least, most = RANGES.get(name, (-np.inf, np.inf))
    for element in values:
        if name not in RANGES or element in told or context.name(element) != "float":
            continue
        number = context.at(FloatRows, np.array([element])).value[0]
        if len(number) == 1 and not least <= float(number[0]) <= most:
            told.add(element)
            message = f"The {name.replace('_', ' ')} is {float(number[0]):g}."
            yield Hit(scene_rules.EFFECT_VALUE, element, message)


def names(context: Context) -> Iterator[Hit]:
    """Hints at techniques, and choices of them, that the effect does not have."""
    for name in ("technique_hint", "technique_override"):
        for reference in context.references("ref", name):
            instance = int(context.parent[reference.element])
            effect = context.target(context.columns.attribute_of(instance, "url"))
            if effect >= 0 and context.name(effect) == "material":
                inner = context.first_children("instance_effect").get(effect, -1)
                url = context.columns.attribute_of(inner, "url") if inner >= 0 else None
                effect = context.target(url)
            if effect < 0 or context.name(effect) != "effect":
                continue
            known = context.shared(_techniques).get(effect, [])
            if reference.text not in known:
                message = f"{context.label(effect)} has no technique {reference.text!r}."
                if known:
                    message += f" There are: {listed(known)}."
                yield Hit(MISSING, reference.element, message, (effect,), "ref", Severity.WARNING)


def _techniques(context: Context) -> dict[int, list[str]]:
    """The sids of the techniques of each effect."""
    elements = context.every("technique")
    profiles = ("profile_COMMON", "profile_GLES", "profile_GLES2", "profile_GLSL", "profile_CG",
                "profile_BRIDGE")  # fmt: skip
    elements = elements[context.is_within(elements, *profiles)]
    effects = context.ancestor(elements, "effect").tolist()
    found: defaultdict[int, list[str]] = defaultdict(list)
    for effect, sid in zip(effects, context.at(NamedRows, elements).sid, strict=True):
        if sid:
            found[effect].append(sid)
    return dict(found)


CHECKS = (types, numbers, names)
