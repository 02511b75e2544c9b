"""Materials of a World, and what holds between two of them."""

from __future__ import annotations

from typing import Any

from hypothesis import strategies as st

from colladaphy.testing.making.scalars import maybe, names, positives, several
from colladaphy.testing.making.script import Script
from colladaphy.world import Material

__all__ = ["draw_materials"]

_share = st.floats(0, 1)


def draw_materials(draw: st.DrawFn, script: Script, extreme: bool) -> list[Material]:
    """Materials for bodies: two that every World has, and up to two new ones, some in pairs."""
    world = script.world
    positive = positives(extreme)
    not_negative = st.just(0.0) | positive
    ids = st.integers(10, 2**31)

    def material(draw: st.DrawFn) -> Material:
        options: dict[str, Any] = {}
        maybe(draw, options, "id", ids.filter(lambda id: id not in world.materials))
        return script.call(
            world.create_material,
            draw(names.filter(lambda name: name not in world.materials)),
            density=draw(positive),
            restitution=draw(_share),
            static_friction=draw(not_negative),
            dynamic_friction=draw(not_negative),
            poisson_ratio=draw(st.floats(-1, 0.5)),
            young_modulus=draw(positive),
            stiffness=draw(positive),
            damping_normal=draw(not_negative),
            damping_tangential=draw(not_negative),
            **options,
        )

    def pair(draw: st.DrawFn) -> None:
        everything = [each.name for each in world.materials]
        values = [draw(st.none() | of) for of in (_share, not_negative, not_negative)]
        two = draw(st.sampled_from(everything)), draw(st.sampled_from(everything))
        script.call(world.set_pair, *two, *values)

    made = several(draw, 0, 2, material)
    several(draw, 0, 2, pair)
    return list(world.materials)[:2] + made
