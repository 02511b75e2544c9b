"""Strategies for Worlds."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from hypothesis import currently_in_test_context, note
from hypothesis import strategies as st

from colladaphy.testing.making.bodies import SHAPES, draw_body, draw_state, draw_union
from colladaphy.testing.making.crowds import CROWD_SHAPES, crowd
from colladaphy.testing.making.joints import JOINTS, draw_joint
from colladaphy.testing.making.materials import draw_materials
from colladaphy.testing.making.planar import PLANAR_JOINTS, PLANAR_SHAPES, draw_planar
from colladaphy.testing.making.scalars import (
    Scale,
    maybe,
    names,
    numbers,
    positives,
    several,
    triples,
)
from colladaphy.testing.making.script import Script
from colladaphy.world import Body, EngineState, World

__all__ = ["JOINTS", "SHAPES", "worlds"]

ONE_BY_ONE = 6
"""How many bodies are chosen each by itself; more come as a crowd."""


def worlds(
    *,
    shapes: Iterable[str] | None = None,
    joints: bool | Iterable[str] = True,
    unions: bool = True,
    materials: bool = True,
    moving: bool = True,
    min_bodies: int = 1,
    max_bodies: int = 300,
    extreme: bool | None = None,
    physical: bool = False,
    planar: bool = False,
    engine_states: bool = True,
) -> st.SearchStrategy[World]:
    """Worlds: from one body to hundreds, of every shape, joined, moving, of odd units and names.

    All that a World can hold occurs: unions in unions, planes, shared meshes, bodies without a
    shape, joints of every kind with limits and springs, new materials and pairs of them, ids with
    gaps, any Unicode that XML can hold. When an example fails, hypothesis prints the Python that
    makes it. What may be narrowed:

    - `shapes`: which of SHAPES bodies have; None is all of them;
    - `joints`: whether there are joints, or which of JOINTS there are;
    - `unions`, `materials` (beyond those that every World has), `moving` (velocities, forces),
      `engine_states` (what a checkpoint keeps of an engine): whether there are any;
    - `min_bodies`, `max_bodies`: how many bodies there are at the top level, where a union counts
      as one;
    - `extreme`: with True numbers are any finite floats, from denormal ones to the largest; with
      False they are of everyday size; None draws which;
    - `physical`: with True inertias are such as bodies can have, which an importer may insist on;
      a World takes any numbers;
    - `planar`: everything stays in a plane, as `PymunkEngine` needs it, and is of everyday size.

    Raises ValueError for an unknown shape or joint, or one that cannot be planar, and for fewer
    than no bodies.
    """
    known_shapes, known_joints = (PLANAR_SHAPES, PLANAR_JOINTS) if planar else (SHAPES, JOINTS)
    some_shapes = _chosen("shape", shapes, known_shapes)
    some_joints = _chosen("joint", None if joints is True else (joints or ()), known_joints)
    if not 0 <= min_bodies <= max_bodies:
        raise ValueError(f"no World has {min_bodies} to {max_bodies} bodies")
    if planar and extreme:
        raise ValueError("planar Worlds are of everyday size: leave out extreme or planar")
    if not some_shapes and max_bodies:
        raise ValueError("bodies need a shape: name at least one of SHAPES, or 'empty'")
    plan = _Plan(
        some_shapes, some_joints, unions, materials, moving, min_bodies, max_bodies, engine_states,
        physical,
    )  # fmt: skip

    @st.composite
    def world(draw: st.DrawFn) -> World:
        wild = draw(st.booleans()) if extreme is None and not planar else bool(extreme)
        script = _planar(draw, plan) if planar else _any(draw, plan, wild)
        if currently_in_test_context():
            note(script)
        return script.world

    return world()


def _chosen(what: str, names: Any, known: tuple[str, ...]) -> list[str]:
    if names is None:
        return list(known)
    chosen = [names] if isinstance(names, str) else list(names)
    for name in chosen:
        if name not in known:
            raise ValueError(f"no {what} {name!r} here; there are {', '.join(known)}")
    return [name for name in known if name in chosen]


class _Plan:
    """What a World may hold."""

    def __init__(
        self, shapes: list[str], joints: list[str], unions: bool, materials: bool, moving: bool,
        fewest: int, most: int, engine_states: bool, physical: bool,
    ) -> None:  # fmt: skip
        self.shapes = shapes
        self.joints = joints
        self.unions = unions
        self.materials = materials
        self.moving = moving
        self.fewest = fewest
        self.most = most
        self.engine_states = engine_states
        self.physical = physical
        self.crowd = [name for name in CROWD_SHAPES if name in shapes]


def _planar(draw: st.DrawFn, plan: _Plan) -> Script:
    options: dict[str, Any] = {"gravity": (0.0, 0.0, draw(st.floats(-10, 0)))}
    maybe(draw, options, "time_step", st.just(1 / 120))
    script = Script(**options)
    most = min(plan.most, max(plan.fewest, ONE_BY_ONE))
    draw_planar(draw, script, plan.shapes, plan.joints, plan.unions, most, plan.fewest)
    return script


def _any(draw: st.DrawFn, plan: _Plan, extreme: bool) -> Script:
    script = _empty(draw, extreme)
    scale = Scale(extreme, plan.physical)
    world = script.world
    materials = list(world.materials)[:2]
    if plan.materials:
        materials = draw_materials(draw, script, extreme)

    def body(draw: st.DrawFn) -> Body:
        shape = draw(st.sampled_from(plan.shapes))
        made = draw_body(draw, script, shape, materials, scale)
        if made is None:  # a plane too far away
            made = script.call(world.create_plane, 0, (0, 0, 1), 0, "iron")
        return made

    few = min(plan.fewest, ONE_BY_ONE) if plan.crowd else plan.fewest
    top = several(draw, few, max(few, min(plan.most, ONE_BY_ONE)), body)
    _join(draw, script, plan, top, scale)
    if len(top) > plan.fewest and draw(st.integers(0, 2)) == 2:
        script.call(world.destroy, top.pop(draw(st.integers(0, len(top) - 1))))
    if plan.moving:
        for each in top:
            draw_state(draw, script, each, scale)
    if top and plan.joints:
        several(draw, 0, 3, lambda draw: draw_joint(draw, script, top, plan.joints, extreme))
        if len(world.joints) and draw(st.integers(0, 4)) == 4:
            script.call(world.destroy_joint, world.joints[0])
    _crowd(draw, script, plan, len(top))
    if plan.engine_states and draw(st.integers(0, 3)) == 3:
        state = EngineState(draw(names), draw(names), draw(st.binary(max_size=40)))
        script.set(world, engine_state=state)
    return script


def _empty(draw: st.DrawFn, extreme: bool) -> Script:
    options: dict[str, Any] = {}
    maybe(draw, options, "gravity", triples(numbers(extreme)))
    maybe(draw, options, "unit", st.tuples(names, positives(extreme)))
    maybe(draw, options, "up_axis", st.sampled_from(["Z_UP", "Y_UP", "X_UP"]))
    maybe(draw, options, "time_step", positives(extreme))
    maybe(draw, options, "name", names)
    script = Script(**options)
    clock: dict[str, Any] = {}
    maybe(draw, clock, "time", numbers(extreme))
    maybe(draw, clock, "step_count", st.integers(0, 2**40))
    script.set(script.world, **clock)
    return script


def _join(draw: st.DrawFn, script: Script, plan: _Plan, top: list[Body], scale: Scale) -> None:
    """Unions, later ones of earlier ones, as long as enough bodies are left at the top."""

    def union(draw: st.DrawFn) -> None:
        most = min(3, len(top) - plan.fewest + 1)
        if top and most > 0:
            draw_union(draw, script, top, most, scale)

    several(draw, 0, 3 if plan.unions else 0, union)


def _crowd(draw: st.DrawFn, script: Script, plan: _Plan, count: int) -> None:
    most, fewest = plan.most - count, max(0, plan.fewest - count)
    if plan.crowd and most > 0 and (fewest or (most > ONE_BY_ONE and draw(st.integers(0, 7)) == 7)):
        seed = draw(st.integers(0, 2**32 - 1))
        shapes = tuple(plan.crowd)
        script.call(crowd, script.world, draw(st.integers(fewest, most)), seed, shapes=shapes)
