"""Whole documents of physics, put together from their parts."""

from __future__ import annotations

from hypothesis import strategies as st

from colladaphy.testing.composing.models import Models
from colladaphy.testing.composing.places import Nodes, coordinates
from colladaphy.testing.composing.shapes import Geometries, Materials
from colladaphy.testing.making.scalars import several
from colladaphy.testing.markup import collada, dates, library, numbers, tag

__all__ = ["compose"]

_steps = st.sampled_from([0.01, 1 / 240, 0.125])
_units = st.sampled_from([None, ("meter", 1.0), ("centimeter", 0.01), ("inch", 0.0254)])


def compose(draw: st.DrawFn, features: set[str]) -> bytes:
    """A document whose scenes in effect have one body or more; `features` gets what occurs."""
    mark = draw(st.sampled_from(["", "x", "_", "Kö-", "λ"]))
    nodes, geometries, materials = Nodes(mark), Geometries(mark), Materials(mark)
    models = Models(mark, nodes, geometries, materials, features)
    several(draw, 1, 3, models.new)
    scenes = several(draw, 1, 2, lambda draw: _scene(draw, models, features))
    in_effect = draw(st.sampled_from([[0], list(range(len(scenes)))]))
    if len(scenes) > 1:
        features.add("several-scenes")
    if len(in_effect) > 1:
        features.add("several-scenes-in-effect")
    lent, shown = nodes.texts()
    features |= nodes.features
    started = [tag("instance_physics_scene", url=f"#{mark}s{number}") for number in in_effect]
    if shown:
        started.append(tag("instance_visual_scene", url=f"#{mark}visual"))
    physics = [
        tag("physics_scene", text, id=f"{mark}s{number}") for number, text in enumerate(scenes)
    ]
    return collada(
        "1.5.0",
        _asset(draw),
        geometries.text(),
        lent,
        materials.text(),
        library("physics_models", *(model.text for model in models.all)),
        library("physics_scenes", *physics),
        shown,
        tag("scene", *started),
    )


def _asset(draw: st.DrawFn) -> str:
    unit = draw(_units)
    size = "" if unit is None else tag("unit", name=unit[0], meter=numbers([unit[1]]))
    axis = draw(st.sampled_from(["", "Z_UP", "Y_UP", "X_UP"]))
    return tag("asset", dates(), size, tag("up_axis", axis) if axis else "")


def _scene(draw: st.DrawFn, models: Models, features: set[str]) -> str:
    used: list[int] = []

    def instance(draw: st.DrawFn) -> str:
        number = draw(st.integers(0, len(models.all) - 1))
        if number in used:
            features.add("repeated-models")
        used.append(number)
        return models.instance(draw, models.all[number])

    instances = several(draw, 1, 3, instance)
    values = ""
    if draw(st.booleans()):
        values = tag("gravity", numbers((0.0, draw(coordinates), -9.75)))
    if draw(st.booleans()):
        values += tag("time_step", numbers([draw(_steps)]))
    return "".join(instances) + tag("technique_common", values)
