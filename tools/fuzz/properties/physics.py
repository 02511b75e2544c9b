"""What must hold of every document of physics that means something."""

from __future__ import annotations

import re
from collections.abc import Callable
from random import Random

import numpy as np
from hypothesis import strategies as st
from lxml import etree
from tests.columns.test_bindings import assert_same

import colladaphy
from colladaphy import Document, World, compare
from colladaphy.conform import conform
from colladaphy.conform.exporting import export
from colladaphy.findings import Severity
from colladaphy.source import pack
from colladaphy.testing import edits, equivalents, physics_documents
from colladaphy_schema.codec import encode_document
from tools.fuzz.properties.documents import saved
from tools.fuzz.registry import note, of

__all__: list[str] = []

NS = "{http://www.collada.org/2008/03/COLLADASchema}"


def _changed(change: Callable[[bytes], st.SearchStrategy[bytes]]) -> st.SearchStrategy[object]:
    """A document, and what a change makes of it."""
    return physics_documents().flatmap(lambda data: st.tuples(st.just(data), change(data)))


def _alike() -> st.SearchStrategy[object]:
    return _changed(equivalents)


def _edited() -> st.SearchStrategy[object]:
    return _changed(edits)


def _seeds() -> st.SearchStrategy[int]:
    return st.integers(0, 2**32)


def loaded(data: bytes) -> World:
    """The World of a document."""
    return colladaphy.read(note(data)).load()


@of(physics_documents, weight=2)
def physics_loads(data: bytes) -> None:
    """Documents of physics are valid and load, from objects and columns alike."""
    report = colladaphy.validate(data)
    assert [str(error) for error in report.errors] == []
    document = colladaphy.read(note(data))
    world = document.load()
    assert [str(each) for each in document.report if each.severity is Severity.ERROR] == []
    rebuilt = Document(colladaphy.read(data).root)
    assert compare(world, rebuilt.load()) == []
    assert compare(world, loaded(encode_document(rebuilt.root).encode())) == []


@of(physics_documents)
def physics_columns(data: bytes) -> None:
    """Document → objects → columns → document say the same."""
    text = etree.tostring(etree.fromstring(data), encoding="UTF-8", xml_declaration=True)
    assert_same(note(text))


@of(_alike, weight=2)
def physics_alike(pair: tuple[bytes, bytes]) -> None:
    """Order of libraries, ids, spellings, comments and encodings mean nothing."""
    one, other = (loaded(data) for data in pair)
    for world in (one, other):  # the names of models and nodes may have changed
        world.name = None
    # A material without a name is called by its id.
    assert [each for each in compare(one, other) if not _MATERIAL_NAME.match(each)] == []


_MATERIAL_NAME = re.compile(r"material \d+, name: |name of material \d+: ")


@of(_edited, _seeds, weight=2)
def physics_edited(pair: tuple[bytes, bytes], seed: int) -> None:
    """What editors make of a document loads, and a World is written back into it."""
    document = colladaphy.read(note(pair[1]))
    world, chance = document.load(), np.random.default_rng(seed)
    for body in world.bodies:
        if not body.fixed and chance.random() < 0.7:
            body.position = np.asarray(body.position) + chance.normal(size=3)
            body.rotate(*chance.normal(size=3))
            body.linear_velocity, body.angular_velocity = chance.normal(size=(2, 3))
    if len(world.bodies) > 1 and not len(world.joints) and chance.random() < 0.3:
        world.destroy(world.bodies[0])
    world.time = 1.5
    document.update(world)
    again = colladaphy.read(note(saved(document))).load()
    told = any(finding.code == "store-inexact" for finding in document.report)
    assert told or compare(again, world) == []


@of(physics_documents)
def physics_repaired(data: bytes) -> None:
    """To repair what is valid only spells out what it means, and changes nothing of that."""
    tree = etree.ElementTree(etree.fromstring(note(data)))
    mended, changes = conform(tree)
    assert {change.code for change in changes} <= _SPELLED_OUT
    if not changes:
        assert etree.tostring(mended, method="c14n2") == etree.tostring(tree, method="c14n2")
    assert conform(mended)[1] == []
    strict, tolerant = colladaphy.read(data).load(), colladaphy.read(data, repair=True).load()
    assert compare(strict, tolerant, rtol=0.0 if not changes else 1e-12) == []


_SPELLED_OUT = {"repair-attachment-reference", "repair-mass-frame-origin"}


@of(physics_documents, lambda: st.sampled_from(["X_UP", "Y_UP", "Z_UP"]), st.booleans)
def physics_converted(data: bytes, axis: str, si: bool) -> None:
    """Units and axes change commute with loading: lengths scale, and vectors turn."""
    plain, other = loaded(data), colladaphy.read(data).load(si=si, up_axis=axis)
    scale = plain.unit_meter if si else 1.0
    turn = _AXES[axis].T @ _AXES[plain.up_axis]
    assert (other.up_axis, other.unit_meter) == (axis, 1.0 if si else plain.unit_meter)
    assert np.array_equal(plain.masses, other.masses)
    for name in ("positions", "linear_velocities", "forces"):
        _near(getattr(plain, name) @ turn.T * scale, getattr(other, name), name)
    _near(plain.angular_velocities @ turn.T, other.angular_velocities, "angular velocities")
    _near(plain.gravity @ turn.T * scale, other.gravity, "gravity")
    _near(plain.inertias * scale**2, other.inertias, "inertias")
    assert len(plain.joints) == len(other.joints)


_AXES = {  # what turns each of them to Z_UP (COLLADA 1.5 §up_axis)
    "X_UP": np.array([[0.0, -1, 0], [0, 0, -1], [1, 0, 0]]),
    "Y_UP": np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]]),
    "Z_UP": np.eye(3),
}


def _near(wanted: np.ndarray, found: np.ndarray, what: str) -> None:
    size = float(np.abs(wanted).max(initial=0.0))
    assert np.allclose(wanted, found, rtol=1e-9, atol=1e-12 * size), what


@of(physics_documents, _seeds)
def physics_parts(data: bytes, seed: int) -> None:
    """It is all the same in which files of an archive libraries stand."""
    document = colladaphy.read(note(data))
    files = _parts(etree.fromstring(data), Random(seed))
    other = colladaphy.read(pack(files.pop("main.dae"), name="main.dae", others=files)).load()
    assert compare(document.load(), other) == []


def _parts(root: etree._Element, chance: Random) -> dict[str, bytes]:
    """The document with some of its libraries in other files."""
    kinds = ("physics_materials", "physics_models", "geometries", "nodes")
    roots, homes = {"main.dae": root}, {}
    for library in [child for child in root if child.tag in {f"{NS}library_{k}" for k in kinds}]:
        if chance.random() < 0.5:
            name = chance.choice(("one.dae", "deep/two.dae"))
            if name not in roots:
                roots[name] = etree.Element(root.tag, root.attrib, root.nsmap)
                asset = root.find(f"{NS}asset")
                assert asset is not None
                roots[name].append(etree.fromstring(etree.tostring(asset)))
            roots[name].append(library)
    for name, part in roots.items():
        homes.update({each.get("id"): name for each in part.iter(etree.Element) if each.get("id")})
    for name, part in roots.items():
        for element in part.iter(etree.Element):
            for key, value in element.attrib.items():
                place, _, own = value.partition("#")
                if not place and own in homes and homes[own] != name:
                    element.set(key, ("../" if "/" in name else "") + homes[own] + "#" + own)
    return {name: etree.tostring(part, encoding="UTF-8") for name, part in roots.items()}


@of(physics_documents)
def physics_for_bullet(data: bytes) -> None:
    """What is written for Bullet comes back with all that moves, unless it says what is lost.

    Held are number, masses and centres of the bodies that move, to Bullet's single precision.
    """
    before = loaded(data)
    text, findings = export(etree.ElementTree(etree.fromstring(data)), "bullet")
    after = colladaphy.read(text, repair=True).load()
    if {finding.code for finding in findings} & _LOST:
        return
    one, other = (world.masses[~world.fixed] for world in (before, after))
    assert len(one) == len(other)
    assert np.allclose(np.sort(one), np.sort(other), rtol=1e-4)
    places = after.positions[~after.fixed]
    for place in before.positions[~before.fixed]:
        size = 1.0 + float(np.abs(place).max())
        assert float(np.abs(places - place).max(axis=1).min()) < 1e-4 * size


_LOST = {"downgrade-bullet-scene-removed", "downgrade-bullet-no-shape"}
