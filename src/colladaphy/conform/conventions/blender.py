"""Blender's exporters: upright means along z, and heights may be halved. The numbers decide."""

from __future__ import annotations

from collections import Counter

import numpy as np
from lxml import etree

from colladaphy.conform import convention_rules
from colladaphy.conform.bodies import body_targets
from colladaphy.conform.context import NS, Context, insert, local
from colladaphy.conform.conventions.clues import Clues, extents
from colladaphy.conform.solids import numbers_of

__all__ = ["apply", "recognise"]

_UPRIGHT = ("cylinder", "tapered_cylinder")
# Blender's cones have their first radius at the -z end; COLLADA's have it at the +y end.
_TURN = "1 0 0 -90"
_Reading = tuple[str, float]
_STANDARD: _Reading = ("y", 1.0)


def recognise(clues: Clues) -> str | None:
    """Illusoft's and Chimera's exporters name Blender."""
    return clues.tool("blender", "illusoft", "chimera")


def apply(context: Context) -> None:
    """Read cylinders and cones as most of them fit the geometry that their bodies show."""
    solids = []
    votes: Counter[_Reading] = Counter()
    for body, node in body_targets(context).items():
        shapes = list(body.iterfind(f"{NS}technique_common/{NS}shape"))
        if len(shapes) != 1:
            continue
        for solid in shapes[0].iterchildren(*(NS + name for name in _UPRIGHT)):
            height = numbers_of(solid.find(NS + "height"))
            shown = [
                box
                for instance in node.iterchildren(NS + "instance_geometry")
                if (box := extents(context, context.by_url(instance.get("url")))) is not None
            ]
            if len(height) == 1:
                solids.append(solid)
                if len(shown) == 1:
                    votes.update(_fitting(height[0], shown[0][1] - shown[0][0]))
    if not votes:
        return
    best = max(votes, key=lambda reading: (votes[reading], reading == _STANDARD))
    evidence = f"{votes[best]} of {len(solids)} are as high as the geometry shown, {_words(best)}"
    for solid in solids:
        _read(context, solid, best, evidence)


def _fitting(height: float, sides: np.ndarray) -> list[_Reading]:
    return [
        (axis, factor)
        for axis, side in (("y", sides[1]), ("z", sides[2]))
        for factor in (1.0, 2.0)
        if height > 0 and abs(side - factor * height) < 0.01 * height
    ]


def _words(reading: _Reading) -> str:
    halved = "with halved heights " if reading[1] == 2.0 else ""
    return f"read {halved}along {reading[0]}"


def _read(context: Context, solid: etree._Element, reading: _Reading, evidence: str) -> None:
    axis, factor = reading
    height, shape = solid.find(NS + "height"), solid.getparent()
    assert height is not None and shape is not None
    if factor != 1.0 and context.wants(convention_rules.HALF_HEIGHT):
        before = context.write(height, [factor * numbers_of(height)[0]])
        message = f"<height> of a {local(solid)} was {before}, is now {height.text}: {evidence}"
        context.note(convention_rules.HALF_HEIGHT, height, message)
    if axis == "z" and context.wants(convention_rules.AXIS):
        last = max(
            i for i, c in enumerate(shape) if c is solid or local(c) in ("translate", "rotate")
        )
        insert(shape, last + 1, context.make("rotate", _TURN))
        message = f"a {local(solid)} along z was turned by <rotate>{_TURN}: {evidence}"
        context.note(convention_rules.AXIS, shape, message)
