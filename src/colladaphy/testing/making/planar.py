"""Worlds that stay in a plane: everything moves along it and turns about its normal."""

from __future__ import annotations

import math
from typing import Any

from hypothesis import strategies as st

from colladaphy.testing.making.scalars import maybe, several
from colladaphy.testing.making.script import Script
from colladaphy.world import Body, rotations

__all__ = ["PLANAR_JOINTS", "PLANAR_SHAPES", "draw_planar"]

PLANAR_SHAPES = ("sphere", "box", "capsule", "cylinder", "plane")
PLANAR_JOINTS = ("fixed", "hinge", "slider", "ball")

_across = st.floats(-3, 3)
_sizes = st.floats(0.25, 1.5)
_limits = st.sampled_from([(-math.inf, math.inf), (-0.5, 0.5), (0.0, math.inf), (-0.125, 1.0)])
_spring = st.tuples(st.floats(0, 5e3), st.floats(0, 1e2), st.floats(-1, 1))
_motor = st.tuples(st.floats(-5, 5), st.floats(0, 1e3))
_materials = st.sampled_from(["iron", "oak", "fir"])


def draw_planar(
    draw: st.DrawFn, script: Script, shapes: list[str], joints: list[str], unions: bool,
    most: int, fewest: int,
) -> None:  # fmt: skip
    """Fills a World with bodies in a plane y = constant, some of them joined."""
    depth = draw(st.sampled_from([0.0, 2.0]))
    kinds = st.sampled_from(shapes)
    bodies = several(draw, fewest, most, lambda draw: _body(draw, script, draw(kinds), depth))
    movable = [body for body in bodies if body.kind.name != "PLANE"]
    if unions and len(bodies) > fewest and len(movable) > 1 and draw(st.booleans()):
        members = movable[:2]
        union = script.call(script.world.create_union, 0, members)
        movable = [union, *movable[2:]]
    for body in movable:
        state: dict[str, Any] = {}
        along = st.tuples(_across, st.just(0.0), _across)
        about = st.tuples(st.just(0.0), _across, st.just(0.0))
        for key, of in (("linear_velocity", along), ("angular_velocity", about)):
            maybe(draw, state, key, of)
        maybe(draw, state, "force", along)
        maybe(draw, state, "torque", about)
        maybe(draw, state, "sleeping", st.booleans())
        script.set(body, **state)
    if joints and movable:
        several(
            draw, 0, 3, lambda draw: _joint(draw, script, movable, draw(st.sampled_from(joints)))
        )


def _body(draw: st.DrawFn, script: Script, shape: str, depth: float) -> Body:
    world = script.world
    if shape == "plane":
        return script.call(world.create_plane, 0, (0, 0, 1), draw(st.floats(-6, -3)), "granite")
    position = (draw(_across), depth, draw(_across))
    options: dict[str, Any] = {}
    maybe(draw, options, "fixed", st.booleans())
    material = draw(_materials)
    angle = draw(_across)
    turned = False
    match shape:
        case "sphere":
            sizes: tuple[Any, ...] = (draw(_sizes),)
        case "box":
            sizes = ((draw(_sizes), draw(_sizes), draw(_sizes)),)
        case "capsule":
            sizes = (draw(_sizes), draw(_sizes))
        case _:
            turned = draw(st.booleans())  # a wheel, seen from its side
            radius = _sizes if turned else _sizes | st.tuples(_sizes, _sizes)
            sizes = (draw(radius), draw(_sizes))
    create = getattr(world, f"create_{shape}")
    body: Body = script.call(create, 0, position, *sizes, material, **options)
    if turned:
        script.call(body.rotate, 0, 0, math.pi / 2)
    if angle:
        script.call(body.rotate, 0, angle, 0)
    return body


def _joint(draw: st.DrawFn, script: Script, bodies: list[Body], kind: str) -> None:
    world = script.world
    first = draw(st.sampled_from([*bodies, None]))
    second = draw(st.sampled_from([body for body in (*bodies, None) if body != first]))
    options: dict[str, Any] = {}
    maybe(draw, options, "interpenetrate", st.booleans())
    if kind == "hinge":
        options["axis"] = _inside(first, draw(st.sampled_from([(0, 1, 0), (0, -1, 0)])))
        maybe(draw, options, "limits", _limits)
        maybe(draw, options, "angular_spring", _spring)
        maybe(draw, options, "motor", _motor)
    elif kind == "slider":
        angle = draw(_across)
        options["axis"] = _inside(first, (math.cos(angle), 0, math.sin(angle)))
        maybe(draw, options, "limits", _limits)
        maybe(draw, options, "linear_spring", _spring)
    script.call(getattr(world, f"attach_{kind}_joint"), first, second, **options)


def _inside(body: Body | None, axis: tuple[float, float, float]) -> tuple[float, ...]:
    """An axis of the World in the frame of a body."""
    if body is None:
        return axis
    return tuple(rotations.unrotate(body.orientation, axis).tolist())
