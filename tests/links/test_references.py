"""References: ids, sids, relative addresses, bases, other files."""

from __future__ import annotations

from pathlib import Path

import pytest
from lxml import etree
from tests.mapper.documents import body, collada, instance, model, scene

import colladaphy

DATA = collada(
    model(body("b"), body("deep"), id="m") + model(body("b"), id="other"),
    scene(instance("b")),
    '<node id="n" sid="sn"><translate sid="place">1 2 3</translate><node sid="inner"/></node>',
)


@pytest.fixture
def document() -> colladaphy.Document:
    return colladaphy.read(DATA)


def at(document: colladaphy.Document, name: str) -> etree._Element:
    found = document.tree.getroot().find(f".//{{*}}{name}")
    assert found is not None
    return found


@pytest.mark.parametrize(
    ("reference", "tag"),
    [
        ("#m", "physics_model"),
        ("m/b", "rigid_body"),
        ("#m/deep", "rigid_body"),
        ("n/place", "translate"),
        ("n/inner", "node"),
        (" #n ", "node"),
    ],
)
def test_references_lead_to_elements(
    document: colladaphy.Document, reference: str, tag: str
) -> None:
    target = document.resolve(reference, at(document, "instance_rigid_body"))
    assert etree.QName(target.element).localname == tag
    assert target.document is document


def test_a_bare_sid_is_looked_for_outwards(document: colladaphy.Document) -> None:
    origin = at(document, "rigid_body")
    found = document.resolve("deep", origin).element
    assert found.get("sid") == "deep"


def test_a_dot_is_the_parent(document: colladaphy.Document) -> None:
    second = list(document.tree.getroot().iter("{*}physics_model"))[1]
    inner = second.find("{*}rigid_body")
    assert inner is not None
    assert document.resolve("./b", inner).element is inner


@pytest.mark.parametrize("reference", ["#nowhere", "m/nowhere", "#", "nowhere/b", "#m/b/c"])
def test_references_that_lead_nowhere(document: colladaphy.Document, reference: str) -> None:
    with pytest.raises(colladaphy.DocumentError) as caught:
        document.resolve(reference, at(document, "instance_rigid_body"))
    (finding,) = caught.value.findings
    assert finding.code == "link-missing"
    assert finding.path
    assert reference in finding.message


def test_the_type_is_checked(document: colladaphy.Document) -> None:
    with pytest.raises(colladaphy.DocumentError) as caught:
        document.resolve("#m", at(document, "instance_rigid_body"), ("node", "rigid_body"))
    assert caught.value.findings[0].code == "link-wrong-type"
    assert "<node> or <rigid_body>" in caught.value.findings[0].message


def test_other_files_are_read_once(tmp_path: Path) -> None:
    main = collada(model(body("a"), id="m"), scene(instance("a", "sub/two.dae#n")), nodes="")
    (tmp_path / "sub").mkdir()
    (tmp_path / "main.dae").write_bytes(main)
    (tmp_path / "sub" / "two.dae").write_bytes(DATA)
    document = colladaphy.read(tmp_path / "main.dae")
    origin = at(document, "instance_rigid_body")
    one = document.resolve("sub/two.dae#n", origin)
    two = document.resolve("sub/two.dae#m", origin)
    assert one.document is two.document
    assert one.document is not document
    with pytest.raises(colladaphy.DocumentError):
        document.resolve("../two.dae#n", origin)


def test_xml_base_moves_relative_references(tmp_path: Path) -> None:
    main = collada(model(body("a"), id="m"), scene(instance("a", "two.dae#n")), nodes="").replace(
        b"<COLLADA ", b'<COLLADA xml:base="sub/" '
    )
    (tmp_path / "sub").mkdir()
    (tmp_path / "main.dae").write_bytes(main)
    (tmp_path / "sub" / "two.dae").write_bytes(DATA)
    document = colladaphy.read(tmp_path / "main.dae")
    target = document.resolve("two.dae#n", at(document, "instance_rigid_body"))
    assert target.element.get("id") == "n"


def test_unit_and_axis() -> None:
    document = colladaphy.read(DATA)
    assert document.unit == ("meter", 1.0)
    assert document.up_axis == "Z_UP"
    inches = DATA.replace(b"<up_axis>", b'<unit name="inch" meter="0.0254"/><up_axis>')
    assert colladaphy.read(inches).unit == ("inch", 0.0254)


def test_repr_names_the_file(tmp_path: Path) -> None:
    (tmp_path / "a.dae").write_bytes(DATA)
    assert "a.dae" in repr(colladaphy.read(tmp_path / "a.dae"))
    document = colladaphy.read(DATA)
    assert "memory" in repr(document)
    assert repr(document.scenes[0]).startswith("<Scene 's': ")
    assert repr(document.scenes[0].models[0]).startswith("<Model 'm' of scene 's': ")
