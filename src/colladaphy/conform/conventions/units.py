"""Units and signs: what NxuStream2 and ColladaMaya mean by their numbers."""

from __future__ import annotations

import math

from lxml import etree

from colladaphy.conform import convention_rules
from colladaphy.conform.context import NS, Context, local
from colladaphy.conform.conventions.clues import Clues
from colladaphy.conform.solids import numbers_of

__all__ = [
    "apply_colladamaya",
    "apply_nxustream",
    "free_limits",
    "recognise_colladamaya",
    "recognise_nxustream",
    "still_springs",
    "to_degrees",
]


def recognise_nxustream(clues: Clues) -> str | None:
    """NxuStream2, the PhysX SDK's own writer, names itself: as the tool, or as the author.

    Where it does not, its profile and its springs tell: nobody else writes an infinite target for
    a spring without stiffness.
    """
    names = ("nxustream", "nxu stream", "ageia")
    found = clues.tool(*names) or clues.author(*names)
    if found is None and "PhysX" in clues.profiles:
        found = "it has the profile PhysX"
    if found is None and clues.inert_springs:
        found = f"{clues.inert_springs} springs without stiffness have a target that is no number"
    return found


def recognise_colladamaya(clues: Clues) -> str | None:
    """ColladaMaya names itself."""
    return clues.tool("colladamaya", "feeling")


def to_degrees(context: Context, velocity: etree._Element) -> None:
    """An angular velocity in radians a second, in degrees."""
    values = numbers_of(velocity)
    if any(values) and context.wants(convention_rules.ANGLE_UNIT):
        before = context.write(velocity, [math.degrees(value) for value in values])
        message = f"<angular_velocity> was {before} rad/s, is now {velocity.text} degrees/s"
        context.note(convention_rules.ANGLE_UNIT, velocity, message)


def free_limits(context: Context) -> None:
    """Axes with min > max are free, whoever wrote them: -INF to INF."""
    for limits in context.all("swing_cone_and_twist", "linear"):
        low, high = limits.find(NS + "min"), limits.find(NS + "max")
        lows, highs = numbers_of(low), numbers_of(high)
        if low is None or high is None or len(lows) != 3 or len(highs) != 3:
            continue
        free = [a > b for a, b in zip(lows, highs, strict=True)]
        if not any(free) or not context.wants(convention_rules.FREE_LIMITS):
            continue
        before = f"{' '.join((low.text or '').split())} to {' '.join((high.text or '').split())}"
        for end, word in ((low, "-INF"), (high, "INF")):
            words = (end.text or "").split()
            end.text = " ".join(word if f else w for f, w in zip(free, words, strict=True))
        message = f"limits {before} of <{local(limits)}> are now {low.text} to {high.text}"
        context.note(convention_rules.FREE_LIMITS, limits, message)


def still_springs(context: Context) -> None:
    """A spring without stiffness has no target, whatever number stands for none."""
    for spring in context.all("spring"):
        for part in spring.iterchildren(NS + "angular", NS + "linear"):
            stiffness, target = part.find(NS + "stiffness"), part.find(NS + "target_value")
            if numbers_of(stiffness) != [0.0] or target is None:
                continue
            finite = [math.isfinite(value) for value in numbers_of(target)]
            if not (finite and all(finite)) and context.wants(convention_rules.INERT_SPRING):
                message = (
                    f"the {local(part)} spring has no stiffness, and the target_value "
                    f"{(target.text or '').strip()}, which is none; it is set aside"
                )
                context.note(convention_rules.INERT_SPRING, target, message)
                context.stash(target)


def apply_nxustream(context: Context) -> None:
    """Angular velocities in radians a second; restitution as a spring's angular target."""
    for velocity in context.all("angular_velocity"):
        to_degrees(context, velocity)
    for spring in context.all("angular"):
        target, stiffness = spring.find(NS + "target_value"), spring.find(NS + "stiffness")
        if target is None or not any(numbers_of(target)) or any(numbers_of(stiffness)):
            continue
        if context.wants(convention_rules.RESTITUTION):
            message = f"target_value {target.text} of a spring without stiffness is a restitution"
            context.note(convention_rules.RESTITUTION, target, message)
            context.stash(target)


def apply_colladamaya(context: Context) -> None:
    """Gravity in metres whatever the unit, and hollow shapes that are solid."""
    meter = _meter(context)
    for gravity in context.all("gravity"):
        values = numbers_of(gravity)
        size = math.sqrt(sum(value * value for value in values))
        if 9.7 <= size <= 10.1 and 0 < meter < 0.5 and context.wants(convention_rules.GRAVITY_UNIT):
            before = context.write(gravity, [_tidy(value / meter) for value in values])
            message = (
                f"gravity was {before} in a document whose unit is {meter:g} m: as large as the "
                f"earth's in metres; is now {gravity.text}"
            )
            context.note(convention_rules.GRAVITY_UNIT, gravity, message)
    for hollow in context.all("hollow"):
        shape = hollow.getparent()
        bare = shape is not None and shape.find(NS + "mass") is None
        bare = bare and shape is not None and shape.find(NS + "density") is None
        if (
            bare
            and (hollow.text or "").strip() in ("true", "1")
            and context.wants(convention_rules.HOLLOW)
        ):
            hollow.text = "false"
            context.note(
                convention_rules.HOLLOW, hollow, "<hollow> was true, is now false: no mass is given"
            )


def _tidy(value: float) -> float:
    return float(f"{value:.15g}")


def _meter(context: Context) -> float:
    unit = context.root.find(f"{NS}asset/{NS}unit")
    try:
        return float(unit.get("meter", "1") if unit is not None else "1")
    except ValueError:
        return 1.0
