"""Physics scenes: gravity and time (COLLADA 1.5 §physics_scene; thesis 4.1)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.meaning import link_rules, physics_rules
from colladaphy.meaning.asset import is_unit_doubtful
from colladaphy.meaning.context import Context
from colladaphy.meaning.hits import Hit
from colladaphy_schema.rows import Rows

__all__ = ["CHECKS"]

Array = NDArray[Any]


_EARTH = 9.81


def scenes(context: Context) -> Iterator[Hit]:
    """Gravities and time steps that are none, or in another unit or direction."""
    rows = context.children(context.rows(Rows, "physics_scene"), "technique_common", Rows)
    if not len(rows):
        return
    gravity, elements = context.vectors(rows, "gravity", 3)
    up = "XYZ".index(context.resource.up_axis[0])
    size = context.resource.unit[1]
    for row, element in enumerate(elements.tolist()):
        if element < 0:
            continue
        vector = gravity[row]
        shown = " ".join(f"{value:g}" for value in vector.tolist())
        if not np.isfinite(vector).all():
            yield Hit(physics_rules.GRAVITY_NUMBER, element, f"The gravity is {shown}.")
            continue
        strength = float(np.linalg.norm(vector))
        along = np.flatnonzero(np.abs(vector) > 1e-6 * strength)
        if len(along) == 1 and int(along[0]) != up and abs(strength * size - _EARTH) < 0.1:
            message = f"The gravity is {shown}, but {context.resource.up_axis} is up."
            yield Hit(physics_rules.GRAVITY_AXIS, element, message)
        elif len(along) == 1 and vector[up] > 0.0 and abs(strength * size - _EARTH) < 0.1:
            message = f"The gravity is {shown}, and {context.resource.up_axis} is up."
            yield Hit(physics_rules.GRAVITY_UP, element, message)
        elif is_unit_doubtful(context):
            continue
        elif (other := _other_unit(strength, size)) is not None:
            message = (
                f"The gravity is {shown}, as where the unit is {other}, but it is {size:g} "
                f"metres: 9.81 m/s² are {_EARTH / size:g} here."
            )
            yield Hit(physics_rules.GRAVITY_UNIT, element, message)
        elif abs(strength - _EARTH) < 0.05 and 0.0 < size < np.inf and not 0.5 < size < 2.0:
            message = (
                f"The gravity is {shown}, but the unit is {size:g} metres: 9.81 m/s² are "
                f"{_EARTH / size:g} here."
            )
            yield Hit(physics_rules.GRAVITY_UNIT, element, message)
    steps, elements = context.scalars(rows, "time_step")
    for step, element in zip(steps.tolist(), elements.tolist(), strict=True):
        if element < 0:
            continue
        if not 0.0 < step < np.inf:
            yield Hit(physics_rules.TIME_STEP, element, f"The time step is {step:g} seconds.")
        elif step > 1.0:
            yield Hit(physics_rules.TIME_STEP_LONG, element, f"The time step is {step:g} seconds.")


def _other_unit(strength: float, size: float) -> str | None:
    """The unit in which a gravity is that of the Earth, where it is far from that in this one."""
    if not 0.0 < size < np.inf or 0.1 < strength * size / _EARTH < 10.0:
        return None
    for name, metres in (("centimetre", 0.01), ("millimetre", 0.001), ("inch", 0.0254)):
        if abs(strength * metres / _EARTH - 1.0) < 2e-3:
            return f"a {name}" if name != "inch" else "an inch"
    return None


def together(context: Context) -> Iterator[Hit]:
    """Scenes in effect that differ."""
    instances = context.ordinals("instance_physics_scene").tolist()
    targets = context.led("instance_physics_scene", "url").tolist()
    seen: dict[int, int] = {}
    for element, target in zip(instances, targets, strict=True):
        before = seen.setdefault(target, element)
        if target >= 0 and before != element:
            message = f"{context.label(target)} is instanced already."
            yield Hit(link_rules.SCENE_TWICE, element, message, (before,), "url")
    known = list(dict.fromkeys(target for target in targets if target >= 0))
    if len(known) < 2:
        return
    rows = context.rows(Rows, "physics_scene")
    assert rows.ordinals is not None
    common = context.children(rows, "technique_common", Rows)
    gravity, places = context.vectors(common, "gravity", 3)
    steps, step_places = context.scalars(common, "time_step")
    at = {int(rows.ordinals[owner]): row for row, owner in enumerate(common.owner.tolist())}
    first = at.get(known[0])
    if first is None:
        return
    for scene in known[1:]:
        row = at.get(scene)
        if row is None:
            continue
        if not np.array_equal(np.nan_to_num(gravity[row]), np.nan_to_num(gravity[first])):
            element = int(places[row]) if places[row] >= 0 else scene
            message = f"{context.label(scene)} has another gravity than {context.label(known[0])}."
            yield Hit(physics_rules.SEVERAL_GRAVITIES, element, message, (known[0],))
        elif not np.array_equal(steps[row], steps[first], equal_nan=True):
            element = int(step_places[row]) if step_places[row] >= 0 else scene
            message = (
                f"{context.label(scene)} has another time step than {context.label(known[0])}."
            )
            yield Hit(physics_rules.SEVERAL_GRAVITIES, element, message, (known[0],))


CHECKS = (scenes, together)
