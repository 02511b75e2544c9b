"""Units and signs: what Bullet, NxuStream2 and ColladaMaya mean by their numbers."""

from __future__ import annotations

import math

from lxml import etree

from colladaphy.conform import rules
from colladaphy.conform.context import NS, Context, local
from colladaphy.conform.conventions.clues import Clues, write_numbers
from colladaphy.conform.solids import numbers_of

__all__ = [
    "apply_bullet",
    "apply_colladamaya",
    "apply_nxustream",
    "free_limits",
    "recognise_bullet",
    "recognise_colladamaya",
    "recognise_nxustream",
]

_FREE_LENGTH, _FREE_ANGLE = 999999.0, 180.0
_BULLET_MODEL = "Bullet-PhysicsModel"


def recognise_bullet(clues: Clues) -> str | None:
    """Bullet's converter names itself or its model; our own writer notes for whom it wrote."""
    if clues.written_for == "bullet":
        return "it was written for Bullet by colladaphy"
    found = clues.tool("bulletcolladaconverter", "bullet physics")
    named = f"it has the model {_BULLET_MODEL}" if _BULLET_MODEL in clues.models else None
    return found or named


def recognise_nxustream(clues: Clues) -> str | None:
    """NxuStream2, the PhysX SDK's own writer, names itself."""
    return clues.tool("nxustream", "nxu stream", "ageia")


def recognise_colladamaya(clues: Clues) -> str | None:
    """ColladaMaya names itself."""
    return clues.tool("colladamaya", "feeling")


def apply_bullet(context: Context, *, whole: bool) -> None:
    """Radians, planes n·x = D, halved cylinder heights, and free axes as min > max.

    What Bullet edits keeps its shapes: only its own model has Bullet's meaning, unless the
    `whole` file was written for Bullet.
    """
    for limits in context.all("swing_cone_and_twist"):
        _angles(context, limits)
    for velocity in context.all("angular_velocity"):
        _degrees(context, velocity)
    for plane in context.all("plane"):
        if whole or _in_bullet_model(plane):
            _plane(context, plane)
    for cylinder in context.all("cylinder"):
        if whole or _in_bullet_model(cylinder):
            _height(context, cylinder)


def _in_bullet_model(element: etree._Element) -> bool:
    return any(model.get("id") == _BULLET_MODEL for model in element.iterancestors())


def _angles(context: Context, limits: etree._Element) -> None:
    if not context.wants(rules.ANGLE_UNIT):
        return
    for end in limits.iterchildren(NS + "min", NS + "max"):
        values = numbers_of(end)
        if any(value and math.isfinite(value) for value in values):
            turned = [_angle_limit(value) for value in values]
            before = write_numbers(end, turned)
            message = (
                f"<{local(end)}> of an angular limit was {before} rad, is now {end.text} degrees"
            )
            context.note(rules.ANGLE_UNIT, end, message)


def _angle_limit(value: float) -> float:
    if math.isfinite(value) and abs(value) > _FREE_ANGLE:
        return math.copysign(math.inf, value)
    return math.degrees(value)


def _degrees(context: Context, velocity: etree._Element) -> None:
    values = numbers_of(velocity)
    if any(values) and context.wants(rules.ANGLE_UNIT):
        before = write_numbers(velocity, [math.degrees(value) for value in values])
        message = f"<angular_velocity> was {before} rad/s, is now {velocity.text} degrees/s"
        context.note(rules.ANGLE_UNIT, velocity, message)


def _plane(context: Context, plane: etree._Element) -> None:
    equation = plane.find(NS + "equation")
    values = numbers_of(equation)
    if equation is None or len(values) != 4 or not values[3] or not context.wants(rules.PLANE_SIGN):
        return
    length = math.sqrt(sum(value * value for value in values[:3]))
    # Bullet makes the normal a unit vector, but leaves the constant as it is.
    before = write_numbers(equation, [*values[:3], -values[3] * (length or 1.0)])
    message = f"plane {before} means n·x = D to Bullet; its equation is now {equation.text}"
    context.note(rules.PLANE_SIGN, equation, message)


def _height(context: Context, solid: etree._Element) -> None:
    height = solid.find(NS + "height")
    values = numbers_of(height)
    if height is not None and len(values) == 1 and context.wants(rules.HALF_HEIGHT):
        before = write_numbers(height, [2 * values[0]])
        message = f"<height> of a {local(solid)} was half of it, {before}; is now {height.text}"
        context.note(rules.HALF_HEIGHT, height, message)


def free_limits(context: Context) -> None:
    """Axes with min > max are free, whoever wrote them: -INF to INF."""
    for limits in context.all("swing_cone_and_twist", "linear"):
        low, high = limits.find(NS + "min"), limits.find(NS + "max")
        lows, highs = numbers_of(low), numbers_of(high)
        if low is None or high is None or len(lows) != 3 or len(highs) != 3:
            continue
        free = [a > b for a, b in zip(lows, highs, strict=True)]
        if not any(free) or not context.wants(rules.FREE_LIMITS):
            continue
        before = f"{' '.join((low.text or '').split())} to {' '.join((high.text or '').split())}"
        for end, word in ((low, "-INF"), (high, "INF")):
            words = (end.text or "").split()
            end.text = " ".join(word if f else w for f, w in zip(free, words, strict=True))
        message = f"limits {before} of <{local(limits)}> are now {low.text} to {high.text}"
        context.note(rules.FREE_LIMITS, limits, message)


def apply_nxustream(context: Context) -> None:
    """Angular velocities in radians a second; restitution as a spring's angular target."""
    for velocity in context.all("angular_velocity"):
        _degrees(context, velocity)
    for spring in context.all("angular"):
        target, stiffness = spring.find(NS + "target_value"), spring.find(NS + "stiffness")
        if target is None or not any(numbers_of(target)) or any(numbers_of(stiffness)):
            continue
        if context.wants(rules.RESTITUTION):
            message = f"target_value {target.text} of a spring without stiffness is a restitution"
            context.note(rules.RESTITUTION, target, message)
            context.stash(target)


def apply_colladamaya(context: Context) -> None:
    """Gravity in metres whatever the unit, and hollow shapes that are solid."""
    meter = _meter(context)
    for gravity in context.all("gravity"):
        values = numbers_of(gravity)
        size = math.sqrt(sum(value * value for value in values))
        if 9.7 <= size <= 10.1 and 0 < meter < 0.5 and context.wants(rules.GRAVITY_UNIT):
            before = write_numbers(gravity, [_tidy(value / meter) for value in values])
            message = (
                f"gravity was {before} in a document whose unit is {meter:g} m: as large as the "
                f"earth's in metres; is now {gravity.text}"
            )
            context.note(rules.GRAVITY_UNIT, gravity, message)
    for hollow in context.all("hollow"):
        shape = hollow.getparent()
        bare = shape is not None and shape.find(NS + "mass") is None
        bare = bare and shape is not None and shape.find(NS + "density") is None
        if bare and (hollow.text or "").strip() in ("true", "1") and context.wants(rules.HOLLOW):
            hollow.text = "false"
            context.note(rules.HOLLOW, hollow, "<hollow> was true, is now false: no mass is given")


def _tidy(value: float) -> float:
    return float(f"{value:.15g}")


def _meter(context: Context) -> float:
    unit = context.root.find(f"{NS}asset/{NS}unit")
    try:
        return float(unit.get("meter", "1") if unit is not None else "1")
    except ValueError:
        return 1.0
