"""Bodies of a World: every shape, unions of them, and what can be said of a body later."""

from __future__ import annotations

from typing import Any

import numpy as np
from hypothesis import strategies as st

from colladaphy.errors import WorldError
from colladaphy.testing.making.scalars import (
    Scale,
    directions,
    identifiers,
    maybe,
    names,
    numbers,
    positives,
    quaternions,
    triples,
)
from colladaphy.testing.making.script import Script
from colladaphy.world import Body, Material

__all__ = ["SHAPES", "draw_body", "draw_state", "draw_union"]

SHAPES: tuple[str, ...] = (
    "sphere",
    "box",
    "capsule",
    "cylinder",
    "plane",
    "ellipsoid",
    "mesh",
    "empty",
)
"""What a body can be made of; "empty" is mass and inertia without any shape."""

_TETRAHEDRON = ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2))
_angles = st.floats(-7, 7)


def _mass_options(draw: st.DrawFn, scale: Scale) -> dict[str, Any]:
    """Extreme dimensions lead to masses out of range: then both are given."""
    options: dict[str, Any] = {}
    if scale.extreme or draw(st.integers(0, 3)) == 3:
        options["mass"] = draw(positives(scale.extreme))
        if scale.physical:
            x, y, z = draw(triples(positives(False)))
            options["inertia"] = (y + z, x + z, x + y)
        else:
            options["inertia"] = draw(triples(triples(numbers(scale.extreme))))
    return options


def _options(draw: st.DrawFn, script: Script, scale: Scale) -> dict[str, Any]:
    options: dict[str, Any] = {}
    maybe(draw, options, "orientation", quaternions)
    maybe(draw, options, "fixed", st.booleans())
    maybe(draw, options, "name", names)
    options.update(_mass_options(draw, scale))
    if draw(st.integers(0, 4)) == 4:
        world = script.world
        options["sid"] = draw(
            st.integers(1, 50).filter(lambda sid: sid not in world)
            | st.integers(world.next_body_sid, world.next_body_sid + 2**20)
        )
    return options


def draw_body(
    draw: st.DrawFn, script: Script, shape: str, materials: list[Material], scale: Scale
) -> Body | None:
    """A body of a shape; None where its numbers are of no use, which extreme ones may be."""
    world = script.world
    options = _options(draw, script, scale)
    uid, position = draw(identifiers), draw(triples(numbers(scale.extreme)))
    positive = positives(scale.extreme)
    if shape == "empty":
        mass = options.pop("mass", None)
        mass = draw(st.just(0.0) | positive) if mass is None else mass
        return script.call(world.create_body, uid, position, mass, **options)
    material = draw(st.sampled_from(materials)).name
    if shape == "plane":
        return _plane(draw, script, uid, position, material, scale, options)
    maybe(draw, options, "hollow", st.booleans())
    if shape == "mesh":
        return _mesh(draw, script, uid, position, material, options)
    three = triples(positive)
    match shape:
        case "sphere":
            sizes: tuple[Any, ...] = (draw(positive),)
        case "box" | "ellipsoid":
            sizes = (draw(three),)
        case "capsule":
            sizes = (draw(positive | three), draw(positive))
        case _:
            sizes = (draw(positive | st.tuples(positive, positive)), draw(positive))
    create = getattr(world, f"create_{shape}")
    made: Body = script.call(create, uid, position, *sizes, material, **options)
    return made


def _plane(
    draw: st.DrawFn, script: Script, uid: int, position: Any, material: str, scale: Scale,
    options: dict[str, Any],
) -> Body | None:  # fmt: skip
    for key in ("fixed", "mass", "inertia"):
        options.pop(key, None)
    normal, create = draw(directions), script.world.create_plane
    if draw(st.booleans()):
        return script.call(create, uid, normal, draw(numbers(scale.extreme)), material, **options)
    with np.errstate(all="ignore"):
        try:
            return script.call(create, uid, normal, None, material, position=position, **options)
        except WorldError:  # the displacement of a point far away can overflow
            return None


def _mesh(
    draw: st.DrawFn, script: Script, uid: int, position: Any, material: str,
    options: dict[str, Any],
) -> Body:  # fmt: skip
    """A tetrahedron, or a mesh that the World has already."""
    create = script.world.create_mesh
    mesh = draw(st.sampled_from([None, *script.world.meshes.values()]))
    if mesh is not None:
        return script.call(create, uid, position, mesh, None, material, **options)
    x, y, z, shift = (draw(st.floats(0.01, 10)) for _ in range(4))
    corners = np.array([(0, 0, 0), (x, 0, 0), (0, y, 0), (shift, shift, z)])
    points = (corners + draw(triples(numbers(False)))).tolist()
    maybe(draw, options, "convex", st.booleans())
    return script.call(create, uid, position, points, _TETRAHEDRON, material, **options)


def draw_union(draw: st.DrawFn, script: Script, top: list[Body], most: int, scale: Scale) -> None:
    """Joins up to `most` bodies of `top`, unions among them, to one that takes their place."""
    members = draw(st.lists(st.sampled_from(top), min_size=1, max_size=most, unique=True))
    options: dict[str, Any] = {}
    maybe(draw, options, "name", names)
    if scale.extreme:
        options.update(_mass_options(draw, scale))
        options["position"] = draw(triples(numbers(scale.extreme)))
        options["orientation"] = draw(quaternions)
        options["members_are_local"] = True
    else:
        maybe(draw, options, "orientation", quaternions)
    union = script.call(script.world.create_union, draw(identifiers), members, **options)
    for member in members:
        top.remove(member)
    top.append(union)


def draw_state(draw: st.DrawFn, script: Script, body: Body, scale: Scale) -> None:
    """What can be set on any body after its creation."""
    state: dict[str, Any] = {}
    vectors = triples(numbers(scale.extreme))
    maybe(draw, state, "linear_velocity", vectors)
    maybe(draw, state, "angular_velocity", vectors)
    if draw(st.integers(0, 3)) == 3:
        state["force"], state["torque"] = draw(vectors), draw(vectors)
    maybe(draw, state, "sleeping", st.booleans())
    maybe(draw, state, "fixed", st.booleans())
    script.set(body, **state)
    if draw(st.integers(0, 3)) == 3:
        script.call(body.rotate, *(draw(_angles) for _ in range(3)))
