"""Documents that mean the same load the same, and edited ones are valid."""

from __future__ import annotations

import io
from collections import Counter
from collections.abc import Callable
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lxml import etree
from tests.testing.collecting import any_one, drawn, smallest

import colladaphy
from colladaphy.testing import EDITS, MUTATIONS, REWRITES, edits, equivalents, physics_documents
from colladaphy.testing.changing.editing import EDITS as EDIT_CHANGES
from colladaphy.testing.changing.rewriting import REWRITES as REWRITE_CHANGES
from colladaphy.testing.changing.spelling import respelled
from colladaphy.world import World, compare
from colladaphy.world.materials import VALUES

EXACT = ("comments", "comments-within", "instructions", "extras", "techniques", "numbers", "flags",
         "libraries-reordered", "libraries-split", "names", "models-unused")  # fmt: skip
"""Changes after which not a bit of any pose differs."""

FEW = max(8, settings().max_examples // 3)
"""Documents that each kind of change is tried on."""
TO_DROP: dict[str, Callable[[etree._Element], object]] = {
    "comments-dropped": lambda root: list(root.iter(etree.Comment)),
    "extras-dropped": lambda root: list(root.iter("{*}extra")),
}


def load(data: bytes) -> World:
    return colladaphy.read(data).load()


def nameless(world: World) -> World:
    """Without the names, which ids and names of a document may become."""
    for body in world.bodies:
        body.name = None
        for member in body.members:
            member.name = None
    for joint in world.joints:
        joint.name = None
    world.name = None
    return world


def differences(first: World, second: World) -> list[str]:
    """What differs but for names; materials are named by their ids."""
    found = compare(nameless(first), nameless(second))
    return [line for line in found if "material" not in line and "name" not in line]


def assert_near(first: World, second: World) -> None:
    """The same bodies and joints, but for the rounding of a transform more."""
    assert first.kinds.tolist() == second.kinds.tolist()
    assert first.fixed.tolist() == second.fixed.tolist()
    size = 1 + np.abs(first.positions).max(initial=0)
    assert np.allclose(first.positions, second.positions, rtol=0, atol=1e-9 * size)
    assert np.allclose(first.masses, second.masses, rtol=1e-12)
    turned = np.abs(np.sum(first.orientations * second.orientations, axis=1))
    assert np.allclose(turned, 1, atol=1e-9)
    assert np.allclose(first.linear_velocities, second.linear_velocities)
    assert np.allclose(first.angular_velocities, second.angular_velocities)
    assert len(first.joints) == len(second.joints)


@settings(max_examples=30)
@given(st.data(), physics_documents(oddities=False))
def test_other_spellings_load_the_same_bits(data: st.DataObject, document: bytes) -> None:
    again = data.draw(equivalents(document, kinds=EXACT))
    assert colladaphy.validate(again).valid
    assert differences(load(document), load(again)) == []


@settings(max_examples=30)
@given(st.data(), physics_documents(oddities=False, profiles=False))
def test_equivalent_documents_load_the_same(data: st.DataObject, document: bytes) -> None:
    again = data.draw(equivalents(document))
    assert colladaphy.validate(again).valid
    assert_near(load(document), load(again))


@settings(max_examples=40)
@given(st.data(), physics_documents(oddities=False))
def test_edited_documents_are_valid(data: st.DataObject, document: bytes) -> None:
    edited = data.draw(edits(document))
    report = colladaphy.validate(edited)
    assert report.valid, [str(finding) for finding in report]
    load(edited)


@cache
def many() -> list[bytes]:
    """Documents to change, the same each time."""
    return drawn(physics_documents(oddities=False), 30)


def where(applies: Callable[[etree._Element], object]) -> list[bytes]:
    """Those of them that a kind of change has a place in, or another document that has."""

    def holds(document: bytes) -> bool:
        return bool(applies(etree.fromstring(document)))

    return list(filter(holds, many()))[:FEW] or [any_one(physics_documents(), holds)]


@pytest.mark.parametrize("kind", REWRITES)
def test_each_rewrite_changes_the_file_and_not_the_bodies(kind: str) -> None:
    changed = 0
    for document in where(REWRITE_CHANGES[kind][0]):
        for again in drawn(equivalents(document, kinds=[kind], most=1, serializations=False), 3):
            if canonical(again) != canonical(document):
                changed += 1
                assert_near(load(document), load(again))
                break
    assert changed >= 1


@pytest.mark.parametrize("kind", EDITS)
def test_each_edit_changes_the_file(kind: str) -> None:
    changed = 0
    for document in where(TO_DROP.get(kind, EDIT_CHANGES[kind][0])):
        for again in drawn(edits(document, kinds=[kind], most=1), 3):
            if canonical(again) != canonical(document):
                changed += 1
                assert colladaphy.validate(again).valid
                break
    assert changed >= 1


def test_other_ids_are_followed_by_kinematics() -> None:
    world = World()
    one = world.create_sphere(1, (0, 0, 0), 1, "iron")
    two = world.create_box(2, (3, 0, 0), (1, 1, 1), "iron")
    world.attach_hinge_joint(one, two, axis=(0, 0, 1))
    target = io.BytesIO()
    colladaphy.write(world, target, options=colladaphy.WriteOptions(kinematics=True))
    assert b"<SIDREF>" in target.getvalue()
    for again in drawn(equivalents(target.getvalue(), kinds=["ids"], most=1), 3):
        assert list(colladaphy.validate(again)) == []
        assert differences(load(target.getvalue()), load(again)) == []


def test_other_ids_leave_the_numbers_of_materials() -> None:
    world = World()
    values = dict.fromkeys(VALUES, 1.0) | {"poisson_ratio": 0.3}
    for name in ("one", "two"):
        world.materials.create(name, **values)
    world.create_sphere(1, (0, 0, 0), 1.0, "two")
    stream = io.BytesIO()
    colladaphy.write(world, stream)
    data = stream.getvalue()
    only = data.replace(b'id="Material5"', b'id="else"')
    for again in drawn(equivalents(only, kinds=["ids"], most=1), 5):
        assert b'id="Material6"' in again
        assert [body.material.id for body in load(again).bodies] == [6]


@pytest.mark.parametrize("kind", MUTATIONS)
@given(data=st.data())
def test_every_mutation_takes_documents_without_anything(kind: str, data: st.DataObject) -> None:
    MUTATIONS[kind](data.draw, etree.fromstring("<COLLADA/>"))


def canonical(document: bytes) -> bytes:
    return bytes(etree.tostring(etree.fromstring(document), method="c14n"))


def test_documents_and_text_can_be_changed_too() -> None:
    data = many()[0]
    (first,) = drawn(edits(colladaphy.read(data), kinds=["saved"], most=1), 1)
    (second,) = drawn(edits(etree.tostring(etree.fromstring(data), encoding="unicode"),
                            kinds=["saved"], most=1), 1)  # fmt: skip
    assert b"2024-02-29T12:00:00Z" in first
    assert b"2024-02-29T12:00:00Z" in second


@pytest.mark.parametrize("strategy", [edits, equivalents])
def test_unknown_kinds_are_refused(strategy: object) -> None:
    with pytest.raises(ValueError, match=r"no kind of change 'magic'; there are .*, "):
        strategy(b"", kinds=["magic"])  # type: ignore[operator]


def test_nothing_changed_is_simplest() -> None:
    assert canonical(smallest(equivalents(many()[0]), lambda data: True)) == canonical(many()[0])


def test_names_of_changes_are_those_that_there_are() -> None:
    assert tuple(EDIT_CHANGES) == EDITS
    assert tuple(REWRITE_CHANGES) == REWRITES
    assert set(EXACT) < set(REWRITES)


@given(
    st.lists(st.floats(allow_nan=False), max_size=4),
    st.sampled_from(["plus", "short", "zeros", "bare", "exponent", "shifted", "capital", "mixed"]),
)
def test_other_spellings_are_the_same_numbers(numbers: list[float], style: str) -> None:
    spelled = respelled(" ".join(map(xml, numbers)), style)
    assert [from_xml(word) for word in spelled.split()] == numbers
    signs = [str(from_xml(word)) for word in spelled.split()]
    assert signs == [str(number) for number in numbers]


def xml(number: float) -> str:
    return repr(number).replace("inf", "INF")


def from_xml(word: str) -> float:
    return float(word.replace("INF", "inf"))


def test_every_style_spells_otherwise() -> None:
    styles = ["plus", "short", "zeros", "bare", "exponent", "shifted", "capital", "mixed"]
    found = Counter(respelled("0.5 12.0 100.0", style) for style in styles)
    assert len(found) == len(styles)


def test_documents_of_others_can_be_edited() -> None:
    """What an editor makes of what was written by this library is valid, with its profile."""
    world = World()
    world.create_sphere(1, (0, 0, 0), 1, "iron")
    stream = io.BytesIO()
    colladaphy.write(world, stream)
    for again in drawn(edits(stream.getvalue()), 40):
        assert colladaphy.validate(again).valid
