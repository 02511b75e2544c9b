"""Effects: parameters, colours and numbers (COLLADA 1.5 §profile_COMMON, §instance_effect)."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.distinct import distinct
from colladaphy.findings import Severity
from colladaphy.links.rules import MISSING
from colladaphy.meaning import scene_rules
from colladaphy.meaning.context import Context, FloatRows, NamedRows
from colladaphy.meaning.hits import Hit, listed
from colladaphy_schema.rows import Rows

__all__ = ["CHECKS", "RANGES", "inside"]

Array = NDArray[Any]

_MOST = 100.0
"""Above it a colour of a surface is meant from 0 to 255."""
RANGES = {
    "transparency": (0.0, 1.0),
    "reflectivity": (0.0, 1.0),
    "shininess": (0.0, np.inf),
    "index_of_refraction": (0.0, np.inf),
}


def inside(context: Context, name: str) -> Array:
    """The elements of a name in the techniques of effects."""
    found = context.every(name)
    techniques = context.ancestor(found, "technique")
    profiles = context.is_within(np.maximum(techniques, 0), "profile_COMMON", "profile_GLES")
    return found[(techniques >= 0) & profiles]


def parameters(context: Context) -> Iterator[Hit]:
    """References to parameters that the effect does not have."""
    elements = inside(context, "param")
    known = context.shared(_parameters)
    effects = context.ancestor(elements, "effect").tolist()
    texts = context.texts(context.at(Rows, elements), "ref")
    for element, effect, ref in zip(elements.tolist(), effects, texts, strict=True):
        if ref is not None and ref not in known.get(effect, ()):
            yield _missing(context, element, effect, ref, known)
    for reference in context.references("ref", "setparam"):
        instance = int(context.parent[reference.element])
        if context.name(instance) != "instance_effect":
            continue
        effect = context.target(context.columns.attribute_of(instance, "url"))
        last = reference.text.rpartition("/")[2]
        if effect >= 0 and context.name(effect) == "effect" and last not in known.get(effect, ()):
            yield _missing(context, reference.element, effect, reference.text, known)


def _missing(
    context: Context, element: int, effect: int, ref: str, known: dict[int, set[str]]
) -> Hit:
    message = f"{ref!r} is no parameter of {context.label(effect)}."
    if known.get(effect):
        message += f" There are: {listed(sorted(known[effect]))}."
    return Hit(MISSING, element, message, (effect,), "ref", Severity.WARNING)


def _parameters(context: Context) -> dict[int, set[str]]:
    """The sids of the parameters of each effect."""
    found: defaultdict[int, set[str]] = defaultdict(set)
    elements = context.every("newparam")
    rows = context.at(NamedRows, elements)
    effects = context.ancestor(elements, "effect").tolist()
    for effect, sid in zip(effects, rows.sid, strict=True):
        if sid:
            found[effect].add(sid)
    return dict(found)


def colours(context: Context) -> Iterator[Hit]:
    """Colours of effects and lights that are none."""
    lights = context.ordinals("color")
    lights = lights[context.ancestor(lights, "light") >= 0]
    # The colours of lights hold their strength, too: some write 1000 for a lamp.
    for elements, most in ((inside(context, "color"), _MOST), (lights, np.finfo(np.float64).max)):
        lists = context.at(FloatRows, elements).value
        bad = ~((lists.values >= 0.0) & (lists.values <= most))
        owner = np.searchsorted(lists.offsets, np.flatnonzero(bad), side="right") - 1
        for row in distinct(owner).tolist():
            shown = " ".join(f"{value:g}" for value in lists[row].tolist())
            yield Hit(scene_rules.COLOR, int(elements[row]), f"The colour is {shown}.")


def numbers(context: Context) -> Iterator[Hit]:
    """Numbers of effects that are out of range."""
    floats = inside(context, "float")
    for name, (least, most) in RANGES.items():
        mine = floats[context.is_within(floats, name)]
        if not len(mine):
            continue
        lists = context.at(FloatRows, mine).value
        for row in np.flatnonzero(np.diff(lists.offsets) == 1).tolist():
            value = float(lists[row][0])
            if not least <= value <= most:
                message = f"The {name.replace('_', ' ')} is {value:g}."
                yield Hit(scene_rules.EFFECT_VALUE, int(mine[row]), message)


CHECKS = (parameters, colours, numbers)
