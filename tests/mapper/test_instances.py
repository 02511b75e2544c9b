"""Nested and repeated models, parents, other files, scenes: against a reference with matrices."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.strategies import DrawFn
from tests.mapper.documents import SPHERE, body, collada, instance, model, scene
from tests.mapper.reference import Reference

import colladaphy
from colladaphy.findings import Severity
from colladaphy.world import World, rotations

_small = st.integers(-4, 4).map(float)


@st.composite
def steps(draw: DrawFn, matrices: bool = True) -> str:
    text = ""
    for _ in range(draw(st.integers(0, 3))):
        kind = draw(st.sampled_from(["translate", "rotate", "matrix" if matrices else "rotate"]))
        x, y, z = draw(_small), draw(_small), draw(_small)
        if kind == "translate":
            text += f"<translate>{x} {y} {z}</translate>"
        elif kind == "rotate":
            if x == y == z == 0.0:
                x = 1.0
            text += f"<rotate>{x} {y} {z} {draw(st.integers(-360, 360))}</rotate>"
        else:
            angle = math.radians(draw(st.integers(-180, 180)))
            c, s = math.cos(angle), math.sin(angle)
            text += f"<matrix>{c!r} {-s!r} 0 {x} {s!r} {c!r} 0 {y} 0 0 1 {z} 0 0 0 1</matrix>"
    return text


@st.composite
def bodies(draw: DrawFn, sid: str) -> str:
    shapes = "".join(
        f"<shape><mass>{draw(st.integers(1, 5))}</mass>{SPHERE}"
        f"{draw(steps(matrices=False))}</shape>"
        for _ in range(draw(st.integers(1, 3)))
    )
    values = draw(st.sampled_from(["", "<dynamic>false</dynamic>", "<dynamic>true</dynamic>"]))
    if draw(st.booleans()):
        values += f"<mass>{draw(st.integers(1, 9))}</mass>"
    return body(sid, shapes, values)


@st.composite
def instances(draw: DrawFn, sid: str, node: str) -> str:
    values = ""
    if draw(st.booleans()):
        values += f"<angular_velocity>{draw(_small)} 90 {draw(_small)}</angular_velocity>"
    if draw(st.booleans()):
        values += f"<velocity>{draw(_small)} {draw(_small)} 1</velocity>"
    if draw(st.booleans()):
        values += f"<dynamic>{draw(st.sampled_from(['true', 'false']))}</dynamic>"
    if draw(st.booleans()):
        values += f"<mass>{draw(st.integers(1, 9))}</mass>"
    return instance(sid, node, values)


@st.composite
def documents(draw: DrawFn) -> bytes:
    """Two models, the second nested in the first; both instanced, some under parents."""
    count = draw(st.integers(1, 3))
    nodes, targets = _nodes(draw, 6)
    library, instanced = _library_nodes(draw)
    targets += instanced

    def model_instance(url: str, sids: list[str], sid: str) -> str:
        parent = draw(st.sampled_from(["", ' parent="#parent"']))
        inner = "".join(draw(instances(each, draw(st.sampled_from(targets)))) for each in sids)
        return (
            f'<instance_physics_model url="#{url}" sid="{sid}"{parent}>{inner}'
            "</instance_physics_model>"
        )

    inner_sids = [f"i{number}" for number in range(count)]
    outer_sids = [f"o{number}" for number in range(count)]
    inner = model(*(draw(bodies(sid)) for sid in inner_sids), id="inner")
    nested = [model_instance("inner", inner_sids, f"n{k}") for k in range(draw(st.integers(0, 2)))]
    outer = model(*(draw(bodies(sid)) for sid in outer_sids), *nested, id="outer")
    scenes = scene(
        *(model_instance("outer", outer_sids, f"t{k}") for k in range(draw(st.integers(1, 2)))),
        id="s",
    ) + scene(model_instance("inner", inner_sids, "u"), id="s2")
    parent = f'<node id="parent">{draw(steps())}</node>'
    return collada(
        inner + outer,
        scenes,
        parent + nodes,
        library_nodes=library,
        effects=draw(st.sampled_from([("s",), ("s", "s2"), ("s2",)])),
    )


def _nodes(draw: DrawFn, count: int) -> tuple[str, list[str]]:
    """A tree of nodes in the visual scene, and references to all of them."""
    text = ""
    targets = []
    depth = 0
    for number in range(count):
        if depth and draw(st.booleans()):
            text += "</node>"
            depth -= 1
        text += f'<node id="v{number}">{draw(steps())}'
        depth += 1
        targets.append(f"#v{number}")
    return text + "</node>" * depth, targets


def _library_nodes(draw: DrawFn) -> tuple[str, list[str]]:
    """Two nodes of the library, the first instanced by the second."""
    if not draw(st.booleans()):
        return "", []
    first = f'<node id="l1">{draw(steps())}</node>'
    second = f'<node id="l2">{draw(steps())}<instance_node url="#l1"/></node>'
    return first + second, ["#l1", "#l2"]


def check(world: World, reference: Reference) -> None:
    expected = reference.bodies()
    assert len(world.bodies) == len(expected)
    for found, wanted in zip(world.bodies, expected, strict=True):
        assert found.mass == pytest.approx(wanted["mass"])
        assert np.allclose(found.position, wanted["position"], atol=1e-9)
        assert found.fixed == wanted["fixed"]
        assert np.allclose(found.linear_velocity, wanted["velocity"])
        assert np.allclose(found.angular_velocity, wanted["turning"])
        members = found.members or (found,)
        for member, place in zip(members, wanted["members"], strict=True):
            assert np.allclose(member.position, place, atol=1e-9)
        if len(members) > 1:
            matrix = rotations.to_matrix(found.orientation)
            assert np.allclose(matrix, wanted["rotation"], atol=1e-9)


@settings(max_examples=60)
@given(documents())
def test_against_the_reference(data: bytes) -> None:
    check(colladaphy.read(data).load(), Reference(data))


def two_files() -> tuple[bytes, bytes]:
    material = (
        '<physics_material id="slick"><technique_common><dynamic_friction>0.01</dynamic_friction>'
        "</technique_common></physics_material>"
    )
    box = (
        '<shape><mass>2</mass><instance_physics_material url="#slick"/>'
        "<box><half_extents>1 1 1</half_extents></box></shape>"
    )
    other = collada(
        model(body("b", box), id="far"),
        scene(id="none", url="#far"),
        '<node id="there"><translate>1 2 3</translate></node>',
        materials=material,
        effects=(),
    )
    here = (
        '<shape><mass>1</mass><instance_physics_material url="sub/other.dae#slick"/>'
        f"{SPHERE}</shape>"
    )
    main = collada(
        model(
            body("a", here),
            '<instance_physics_model url="sub/other.dae#far" sid="inner">'
            + instance("b", "sub/other.dae#there")
            + "</instance_physics_model>",
        ),
        scene(instance("a", "#n")),
    )
    return main, other


def test_models_materials_and_nodes_in_other_files(tmp_path: Path) -> None:
    main, other = two_files()
    (tmp_path / "sub").mkdir()
    (tmp_path / "main.dae").write_bytes(main)
    (tmp_path / "sub" / "other.dae").write_bytes(other)
    world = colladaphy.read(tmp_path / "main.dae").load()
    check(world, Reference(main, {"sub/other.dae": other}))
    assert world.bodies[0].material is world.bodies[1].material
    assert world.bodies[1].position.tolist() == [1.0, 2.0, 3.0]


def test_other_files_in_an_archive() -> None:
    from colladaphy.source import pack

    main, other = two_files()
    data = pack(main, name="main.dae", others={"sub/other.dae": other})
    assert len(colladaphy.read(data).load().bodies) == 2


def test_other_files_need_a_folder() -> None:
    main, _ = two_files()
    document = colladaphy.read(main)
    document.load()
    (finding,) = [found for found in document.report if found.stage == "io"]
    assert finding.code == "io-reference-refused" and finding.line
    assert "Read the document from its path" in (finding.hint or "")


def test_choosing_scenes_and_models() -> None:
    data = collada(
        model(body("a"), id="m1") + model(body("b"), body("c"), id="m2"),
        scene(
            f'<instance_physics_model url="#m1">{instance("a")}</instance_physics_model>'
            '<instance_physics_model url="#m2" sid="second">'
            f"{instance('b')}{instance('c')}</instance_physics_model>",
            values="<gravity>0 0 -1</gravity><time_step>0.5</time_step>",
        )
        + scene(instance("b"), id="s2", url="#m2"),
    )
    document = colladaphy.read(data)
    assert [each.id for each in document.scenes] == ["s", "s2"]
    assert [each.is_instantiated for each in document.scenes] == [True, False]
    assert len(document.load().bodies) == 3
    assert len(document.load(scenes=["s2"]).bodies) == 1
    assert len(document.scenes["s"].models["m1"].load().bodies) == 1
    world = document.scenes["s"].models["second"].load()
    assert len(world.bodies) == 2
    assert world.gravity.tolist() == [0.0, 0.0, -1.0]
    assert world.time_step == 0.5
    assert document.scenes["s"].models["m1"].load(world) is world
    assert [each.sid for each in world.bodies] == [1, 2, 3]
    with pytest.raises(colladaphy.DocumentError):
        document.scenes["nowhere"]
    with pytest.raises(colladaphy.DocumentError):
        document.scenes["s"].models["nowhere"]


def test_no_scene_in_effect_is_reported() -> None:
    document = colladaphy.read(collada(model(body()), scene(instance()), effects=()))
    assert len(document.load().bodies) == 0
    assert [finding.code for finding in document.report] == ["load-no-scene"]


def test_parent_is_not_applied_twice() -> None:
    nodes = (
        '<node id="parent"><translate>5 0 0</translate>'
        '<node id="n"><translate>1 0 0</translate></node></node>'
    )
    instanced = (
        f'<instance_physics_model url="#m" parent="#parent">{instance()}</instance_physics_model>'
    )
    world = colladaphy.read(collada(model(body()), scene(instanced), nodes)).load()
    assert world.bodies[0].position.tolist() == [6.0, 0.0, 0.0]


@pytest.mark.parametrize(
    ("models", "scenes", "nodes", "code"),
    [
        (model(body()), scene(instance(target="#nowhere")), '<node id="n"/>', "link-missing"),
        (model(body()), scene(instance(sid="x")), '<node id="n"/>', "link-missing"),
        (model(body()), scene(instance(), url="#n"), '<node id="n"/>', "link-wrong-type"),
        (
            model(body(), '<instance_physics_model url="#m"/>'),
            scene(instance()),
            '<node id="n"/>',
            "link-cycle",
        ),
        (
            model(body()),
            scene(instance()),
            '<node id="o"/>',
            "link-missing",
        ),
    ],
)
def test_broken_references_are_errors(models: str, scenes: str, nodes: str, code: str) -> None:
    document = colladaphy.read(collada(models, scenes, nodes))
    with pytest.raises(colladaphy.DocumentError) as caught:
        document.load()
    assert code in [finding.code for finding in caught.value.findings]


def test_nodes_in_a_circle_are_refused() -> None:
    library = (
        '<node id="x"><instance_node url="#y"/></node><node id="y"><instance_node url="#x"/></node>'
    )
    data = collada(model(body()), scene(instance(target="#x")), library_nodes=library)
    with pytest.raises(colladaphy.DocumentError):
        colladaphy.read(data).load()


def test_exponential_nesting_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    from colladaphy.mapper.loading import instances as module

    monkeypatch.setattr(module, "MOST_INSTANCES", 1000)
    twice = "".join(
        model(*[f'<instance_physics_model url="#m{k + 1}"/>'] * 2, id=f"m{k}") for k in range(12)
    )
    data = collada(twice + model(body(), id="m12"), scene("", url="#m0"))
    with pytest.raises(colladaphy.DocumentError) as caught:
        colladaphy.read(data).load()
    assert caught.value.findings[0].code == "link-budget"


def test_scaled_nodes_are_reported() -> None:
    nodes = '<node id="n"><scale>2 2 2</scale><translate>1 0 0</translate></node>'
    document = colladaphy.read(collada(model(body()), scene(instance()), nodes))
    assert document.load().bodies[0].position.tolist() == [2.0, 0.0, 0.0]
    assert "link-not-rigid" in [finding.code for finding in document.report]


def test_a_file_is_one_by_whatever_way_it_is_found(tmp_path: Path) -> None:
    """The way there may lead out of a folder and in again."""
    nodes = '<node id="n"><translate>2 0 0</translate><instance_node url="../main.dae#l"/></node>'
    inner = collada(
        "", "", nodes, effects=(), library_nodes='<node id="k"><translate>0 0 1</translate></node>'
    )
    main = collada(
        model(body("a"), body("b")),
        scene(instance("a", "#l"), instance("b", "sub/inner.dae#k")),
        '<node id="top"><translate>1 0 0</translate><instance_node url="sub/../sub/inner.dae#k"/>'
        "</node>",
        library_nodes='<node id="l"><translate>0 3 0</translate></node>',
    )
    (tmp_path / "sub").mkdir()
    (tmp_path / "main.dae").write_bytes(main)
    (tmp_path / "sub" / "inner.dae").write_bytes(inner)
    document = colladaphy.read(tmp_path / "main.dae")
    assert document.load().positions.tolist() == [[2.0, 3.0, 0.0], [1.0, 0.0, 1.0]]
    assert len(document.related) == 1


def test_a_visual_scene_of_another_file_places_nodes(tmp_path: Path) -> None:
    """Though nothing of the physics leads there; where it is missing, that is only told."""
    main = collada(
        model(body("a")),
        scene(instance("a", "#lent")),
        "",
        library_nodes='<node id="lent"><translate>0 3 0</translate></node>',
    ).replace(b"</scene>", b'<instance_visual_scene url="look.dae#visual"/></scene>')
    look = collada(
        "",
        "",
        '<node id="host"><translate>1 0 0</translate><instance_node url="main.dae#lent"/></node>',
        effects=(),
    )
    (tmp_path / "main.dae").write_bytes(main)
    document = colladaphy.read(tmp_path / "main.dae")
    assert document.load().positions.tolist() == [[0.0, 3.0, 0.0]]
    told = [finding.severity for finding in document.report if finding.code.startswith("io-")]
    assert told == [Severity.WARNING]
    (tmp_path / "look.dae").write_bytes(look)
    document = colladaphy.read(tmp_path / "main.dae")
    assert document.load().positions.tolist() == [[1.0, 3.0, 0.0]]


def test_other_files_may_lead_back(tmp_path: Path) -> None:
    """What they lead back to is the document itself, not a second copy of it."""
    other = collada(
        model(body("b"), id="far"),
        scene(id="none", url="#far"),
        "",
        library_nodes='<node id="lent"><translate>0 0 7</translate>'
        '<instance_node url="main.dae#within"/></node>',
        effects=(),
    )
    main = collada(
        "",
        scene(instance("b", "#within"), url="other.dae#far"),
        '<node id="host"><translate>1 0 0</translate><instance_node url="other.dae#lent"/></node>',
        library_nodes='<node id="within"><translate>0 3 0</translate></node>',
    )
    (tmp_path / "main.dae").write_bytes(main)
    (tmp_path / "other.dae").write_bytes(other)
    from colladaphy.source import pack

    archive = pack(main, name="main.dae", others={"other.dae": other})
    for source in (tmp_path / "main.dae", archive):
        document = colladaphy.read(source)
        world = document.load()
        assert world.positions.tolist() == [[1.0, 3.0, 7.0]]
        assert {finding.code for finding in document.report} == {"load-material-assumed"}
        assert len(document.related) == 1
        world.positions += (0, 0, 1)  # and where the document is changed, they lead to the change
        document.update(world)
        assert document.load().positions.tolist() == [[1.0, 3.0, 8.0]]
        assert len(document.related) == 1
