"""Joints of a World: every kind, between bodies or a body and the world."""

from __future__ import annotations

from typing import Any

from hypothesis import strategies as st

from colladaphy.testing.making.scalars import (
    directions,
    identifiers,
    maybe,
    names,
    numbers,
    quaternions,
    ranges,
    triples,
)
from colladaphy.testing.making.script import Script
from colladaphy.world import Body

__all__ = ["JOINTS", "draw_joint"]

JOINTS: tuple[str, ...] = ("fixed", "hinge", "slider", "ball", "general")
"""The kinds of joints; "general" has any limits about and along all three axes."""

_near = triples(numbers(False))


def draw_joint(
    draw: st.DrawFn, script: Script, bodies: list[Body], kinds: list[str], extreme: bool
) -> None:
    """A joint of one of the kinds between two of the bodies, or one of them and the world."""
    world = script.world
    first = draw(st.sampled_from([*bodies, None]))
    second = draw(st.sampled_from([body for body in (*bodies, None) if body != first]))
    options: dict[str, Any] = {}
    maybe(draw, options, "uid", identifiers)
    maybe(draw, options, "name", names)
    maybe(draw, options, "enabled", st.booleans())
    maybe(draw, options, "interpenetrate", st.booleans())
    maybe(draw, options, "linear_spring", triples(numbers(extreme)))
    maybe(draw, options, "angular_spring", triples(numbers(extreme)))
    maybe(draw, options, "motor", st.tuples(numbers(extreme), numbers(extreme).map(abs)))
    kind = draw(st.sampled_from(kinds))
    if extreme or kind == "general":
        _general(draw, script, first, second, kind, extreme, options)
    elif kind in ("hinge", "slider"):
        options["axis"] = draw(directions)
        maybe(draw, options, "limits", ranges)
        maybe(draw, options, "anchor1", _near)
        attach = world.attach_hinge_joint if kind == "hinge" else world.attach_slider_joint
        script.call(attach, first, second, **options)
    elif kind == "ball":
        maybe(draw, options, "anchor1", _near)
        maybe(draw, options, "anchor2", _near)
        script.call(world.attach_ball_joint, first, second, **options)
    else:
        maybe(draw, options, "anchor1", _near)
        script.call(world.attach_fixed_joint, first, second, **options)


def _general(
    draw: st.DrawFn, script: Script, first: Body | None, second: Body | None, kind: str,
    extreme: bool, options: dict[str, Any],
) -> None:  # fmt: skip
    """Frames and limits one by one: those of extreme poses cannot be computed from the poses."""
    vectors = triples(numbers(extreme))
    for key in ("frame1", "frame2"):
        maybe(draw, options, key, st.tuples(vectors, quaternions))
    locked, free, any_range = st.just((0.0, 0.0)), ranges, ranges
    third = free if kind in ("hinge", "slider", "general") else locked
    if kind == "ball":
        linear, angular = [locked] * 3, [st.just((-float("inf"), float("inf")))] * 3
    elif kind == "general":
        linear, angular = [any_range] * 3, [any_range] * 3
    else:
        linear = [locked, locked, third if kind == "slider" else locked]
        angular = [locked, locked, third if kind == "hinge" else locked]
    for name, axes in (("linear", linear), ("angular", angular)):
        drawn = [draw(axis) for axis in axes]
        if any(low or high for low, high in drawn):
            options[f"{name}_min"] = tuple(low for low, _ in drawn)
            options[f"{name}_max"] = tuple(high for _, high in drawn)
    script.call(script.world.attach_joint, first, second, **options)
