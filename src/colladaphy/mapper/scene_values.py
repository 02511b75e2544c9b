"""What a physics scene says of the World: gravity, time step, and the pe profile's world.

Global values are on the level of the scene, of which COLLADA allows several and pe one (thesis
4.1): several scenes go into one World with the first one's values.
"""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Sequence
from typing import TYPE_CHECKING

from lxml import etree

from colladaphy.document.names import c, local_name, p
from colladaphy.document.poses import Vector
from colladaphy.mapper import rules
from colladaphy.mapper.bodies import same_token
from colladaphy.mapper.profile import numbers, techniques, vector
from colladaphy.mapper.staleness import Precision

if TYPE_CHECKING:
    from colladaphy.document import Document, Prefer, Scene
    from colladaphy.mapper.materials import MaterialTable
    from colladaphy.world import World

__all__ = ["apply_pairs", "apply_scenes", "world_profile"]


def world_profile(scene: etree._Element) -> etree._Element | None:
    """The pe:world of a physics_scene."""
    for technique in techniques(scene):
        found = technique.find(p("world"))
        if found is not None:
            return found
    return None


def apply_scenes(world: World, scenes: Sequence[Scene], document: Document, prefer: Prefer) -> None:
    """Give the World the values of the scenes that are loaded into it."""
    first: tuple[Vector, float | None] | None = None
    for scene in scenes:
        gravity, step = _stated(scene.element)
        if first is None:
            first = gravity, step
            world.gravity = gravity
            world.time_step = step
            world.name = scene.name
            kept = world_profile(scene.element)
            if kept is not None and prefer != "common":
                _apply_profile(world, scene, kept, prefer)
        elif first != (gravity, step):
            document.note(rules.SEVERAL_GRAVITIES, scene.element, file=scene.document.file)


def _stated(scene: etree._Element) -> tuple[Vector, float | None]:
    gravity: Vector = (0.0, 0.0, 0.0)
    step = None
    common = scene.find(c("technique_common"))
    for child in () if common is None else common:
        if local_name(child.tag) == "gravity":
            gravity = vector(child)
        elif local_name(child.tag) == "time_step":
            step = numbers(child)[0]
    return gravity, step


def _apply_profile(world: World, scene: Scene, kept: etree._Element, prefer: Prefer) -> None:
    from colladaphy.world import EngineState

    name = kept.get("name")
    if name is not None and same_token(name, world.name):
        world.name = name
    if kept.get("unit") is not None and world.unit_name == "unit":
        world.unit_name = kept.get("unit", "unit")
    world.time = float(kept.get("time", "0"))
    world.step_count = int(kept.get("step_count", "0"))
    precision = Precision(scene.element.iterchildren(c("technique_common")))
    for child in kept:
        match local_name(child.tag):
            case "gravity":
                gravity = vector(child)
                if prefer == "profile" or precision.same_each(
                    tuple(world.gravity.tolist()), gravity
                ):
                    world.gravity = gravity
                else:
                    scene.document.note(rules.STALE, scene.element, "The gravity was edited.")
            case "time_step":
                step = numbers(child)[0]
                if prefer == "profile" or (
                    world.time_step is not None and precision.same(world.time_step, step)
                ):
                    world.time_step = step
                else:
                    scene.document.note(rules.STALE, scene.element, "The time step was edited.")
            case "engine_state":
                data = _checked(child)
                if data is None:
                    scene.document.note(rules.CHECKSUM, child, file=scene.document.file)
                else:
                    world.engine_state = EngineState(
                        child.get("engine", ""), child.get("version", ""), data
                    )


def _checked(element: etree._Element) -> bytes | None:
    try:
        data = base64.b64decode("".join((element.text or "").split()), validate=True)
    except ValueError:  # not Base64, or not even ASCII
        return None
    return data if hashlib.sha256(data).hexdigest() == element.get("sha256", "").lower() else None


def apply_pairs(world: World, scenes: Sequence[Scene], materials: MaterialTable) -> None:
    """Set what the scenes override for pairs of materials that are in use."""
    for scene in scenes:
        kept = world_profile(scene.element)
        for pair in () if kept is None else kept.iterchildren(p("pair")):
            found = []
            for end in ("first", "second"):
                target = scene.document.resolve(pair.get(end, ""), pair, "physics_material")
                found.append(materials.known_id(target.element))
            values = {
                name: float(pair.get(name, "0"))
                for name in ("restitution", "static_friction", "dynamic_friction")
                if pair.get(name) is not None
            }
            if found[0] is not None and found[1] is not None:
                world.set_pair(found[0], found[1], **values)
