"""What says the same in the common profile as a value of the pe profile (docs/pe-profile.md)."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.distinct import distinct
from colladaphy.meaning.context import Context
from colladaphy.meaning.profile_shapes import pairs_of
from colladaphy.meaning.profile_table import profile_of
from colladaphy.meaning.shape_table import shapes_of

__all__ = ["counterparts"]

Array = NDArray[Any]

_OF_MATERIALS = ("restitution", "static_friction", "dynamic_friction")
_OF_SPRINGS = ("stiffness", "damping", "target_value")
_HELD: Final[dict[tuple[str, str], tuple[str, ...]]] = {
    ("body", "mass"): ("mass",),
    ("body", "inertia"): ("inertia",),
    ("world", "gravity"): ("gravity",),
    ("world", "time_step"): ("time_step",),
    ("motion", "linear_velocity"): ("velocity",),
    ("motion", "angular_velocity"): ("angular_velocity",),
    **{("material", name): (name,) for name in _OF_MATERIALS},
    **{
        (f"{kind}_spring", name): ("spring", kind, name)
        for kind in ("linear", "angular") for name in _OF_SPRINGS
    },
    **{
        (limits, name): ("limits", kind, name)
        for limits, kind in (
            ("linear_limits", "linear"), ("angular_limits", "swing_cone_and_twist"),
        )
        for name in ("min", "max")
    },
}  # fmt: skip
"""Where it is in the technique_common beside the technique, by what the value stands in."""
_SHAPED: Final[dict[tuple[str, str], tuple[str, ...]]] = {
    ("shape", "mass"): ("mass",),
    ("shape", "density"): ("density",),
    ("sphere", "radius"): ("sphere", "radius"),
    ("box", "lengths"): ("box", "half_extents"),
    ("plane", "normal"): ("plane", "equation"),
    **{(kind, name): (kind, "radius") for kind in ("capsule", "cylinder")
       for name in ("radii", "radius")},
    **{(kind, "length"): (kind, "height") for kind in ("capsule", "cylinder")},
}  # fmt: skip
"""The same in the shape that the shape of the profile stands for."""


def counterparts(context: Context, elements: Array) -> list[tuple[int, ...]]:
    """The element of the common profile for each of some values; nothing where there is none."""
    if not len(elements):
        return []
    around = context.parent[elements]
    holders = profile_of(context).holders(elements).tolist()
    shapes = _shapes(context, elements)
    found: list[tuple[int, ...]] = []
    for element, outer, holder in zip(elements.tolist(), around.tolist(), holders, strict=True):
        kind = context.name(outer), context.name(element)
        if kind in _HELD:
            at, path = holder, ("technique_common", *_HELD[kind])
        else:
            at, path = shapes.get(outer, shapes.get(int(context.parent[outer]), -1)), ()
            path = _SHAPED.get(kind, ())
            at = at if path else -1
        for name in path:
            at = context.first_children(name).get(at, -1)
        found.append((at,) if at >= 0 else ())
    return found


def _shapes(context: Context, elements: Array) -> dict[int, int]:
    """The shapes of bodies for the shapes of the profile around some values."""
    around = context.parent[elements]
    wanted = distinct(np.concatenate([around, context.parent[around]]))
    mine, rows = pairs_of(context).matched(wanted)
    stated = shapes_of(context).elements[rows]
    return dict(zip(wanted[mine].tolist(), stated.tolist(), strict=True))
