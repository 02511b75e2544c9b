"""Scenes and models are chosen as users expect it, and everything says what it is."""

from __future__ import annotations

import pytest
from tests.mapper.documents import body, collada, instance, model, scene

import colladaphy
from colladaphy.findings import Report
from colladaphy.source import pack
from colladaphy.world import World, compare

DATA = collada(
    model(body(), id="m") + model(body(), id="k"),
    scene(instance(), id="first") + scene(instance(), id="second", url="#k"),
    effects=("first",),
)


def test_choosing() -> None:
    document = colladaphy.read(DATA)
    scenes = document.scenes
    assert len(scenes) == 2
    assert [found.id for found in scenes] == ["first", "second"]
    assert "first" in scenes and "third" not in scenes
    assert [found.is_instantiated for found in scenes] == [True, False]
    models = scenes["second"].models
    assert len(models) == 1 and "k" in models and "m" not in models
    assert models["k"].id == models[0].id == "k"
    assert models[0] in models


def test_what_is_not_there_lists_what_is() -> None:
    scenes = colladaphy.read(DATA).scenes
    with pytest.raises(colladaphy.DocumentError, match="'third'; it has 'first', 'second'"):
        scenes["third"]
    with pytest.raises(colladaphy.DocumentError, match="'x'; it has 'm'"):
        scenes["first"].models["x"]
    with pytest.raises(IndexError):
        scenes[2]


def test_texts() -> None:
    document = colladaphy.read(DATA)
    assert repr(document) == "<Document in memory: physics scenes first, second; 0 findings>"
    assert repr(document.scenes) == "<Scenes 'first', 'second'>"
    assert repr(document.scenes["second"]) == "<Scene 'second': 1 models, not instantiated>"
    assert repr(document.scenes["first"].models) == "<Models 'm'>"
    assert repr(document.scenes["first"].models[0]) == (
        "<Model 'm' of scene 'first': 1 instanced bodies>"
    )
    assert repr(document.report) == "<Report: no findings>"
    world = World()
    assert repr(world.bodies) == "<0 bodies: none>"
    for number in range(7):
        world.create_sphere(number, (0, 0, number), 1.0, "iron")
    assert repr(world) == "<World of 7 bodies, 0 joints>"
    assert repr(world.bodies[0]) == "<sphere 1>"
    assert repr(world.bodies).startswith("<7 bodies: <sphere 1>, <sphere 2>, ")
    assert repr(world.bodies).endswith(", …>")


def test_text_of_a_report() -> None:
    with pytest.raises(colladaphy.SchemaError) as caught:
        colladaphy.read(DATA.replace(b"<radius>1</radius>", b"<radius>x</radius>"))
    report = Report("a.dae", list(caught.value.findings))
    assert repr(report) == "<Report of a.dae: 2 errors>"


def test_scenes_are_in_effect_in_the_order_of_their_instances() -> None:
    """Not in that of the libraries, nor by the files that they stand in (COLLADA 1.5 §scene)."""

    def only(name: str, gravity: int) -> str:
        values = f"<gravity>0 0 {gravity}</gravity>"
        return scene(instance(name), id=f"s-{name}", url=f"#m-{name}", values=values)

    near = collada(
        model(body("first"), id="m-first") + model(body("last"), id="m-last"),
        only("last", -1) + only("first", -2),
        effects=("far", "s-first", "s-last"),
    ).replace(b"#far", b"other.dae#s-far")
    far = collada(model(body("far"), id="m-far"), only("far", -3), '<node id="n"/>', effects=())
    document = colladaphy.read(pack(near, name="main.dae", others={"other.dae": far}))
    assert [each.id for each in document.scenes.instantiated] == ["s-far", "s-first", "s-last"]
    world = document.load()
    assert world.gravity.tolist() == [0, 0, -3]
    world.positions += ((1, 0, 0), (2, 0, 0), (3, 0, 0))
    document.update(world)
    assert compare(world, document.load()) == []
    chosen = ["s-last", "s-first"]
    some = document.load(scenes=chosen)
    assert some.positions[:, 0].tolist() == [3, 2]
    some.positions *= 2
    document.update(some, scenes=chosen)
    assert compare(some, document.load(scenes=chosen)) == []
