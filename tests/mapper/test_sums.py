"""Exact poses beside nodes that add up: rounding is no edit, and an edit is one."""

from __future__ import annotations

import numpy as np
import pytest
from tests.document.test_updating import body, instance, reread, scene

from colladaphy.document import Document
from colladaphy.world import World

NS = {"c": "http://www.collada.org/2008/03/COLLADASchema"}


def far_away() -> tuple[Document, World]:
    """A body next to the origin, in nodes that are far from it and turned."""
    nodes = (
        '<node id="o"><translate>12345.678 -2345.6789 345.67891</translate>'
        "<rotate>1 2 3 40</rotate>"
        '<node id="m"><rotate>3 1 2 77</rotate><translate>1 2 3</translate>'
        '<node id="a"/></node></node>'
    )
    document = scene(nodes, body("one"), instance("one", "a"))
    world = document.load()
    world.bodies[0].position = (1e-9, 0.1, 1 / 3)
    world.bodies[0].rotate(0.1, 0.2, 0.3)
    document.update(world)
    return reread(document), world


def codes(document: Document) -> list[str]:
    return [finding.code for finding in document.report if finding.code != "load-material-assumed"]


def test_rounding_of_sums_is_no_edit() -> None:
    document, world = far_away()
    (target,) = document.tree.getroot().xpath("//c:instance_rigid_body/@target", namespaces=NS)
    assert target == "#a"
    common = document.load(prefer="common")
    assert common.positions[0, 0] != world.positions[0, 0]
    assert np.array_equal(document.load().positions, world.positions)
    assert np.array_equal(document.load().orientations, world.orientations)
    assert codes(document) == []


@pytest.mark.parametrize("place", range(3))
def test_an_edit_of_a_sum_is_one(place: int) -> None:
    """It is told from rounding to the size of what is added up, not of the sum."""
    document, world = far_away()
    node = document.tree.getroot().xpath("//c:node[@id='o']/c:translate", namespaces=NS)[0]
    values = [float(value) for value in node.text.split()]
    values[place] += 1e-7
    node.text = " ".join(map(repr, values))
    edited = document.load().positions[0]
    assert np.abs(edited - world.positions[0]).max() == pytest.approx(1e-7, rel=1e-3)
    assert codes(document) == ["profile-old-value"]


def test_an_edit_of_a_turn_is_one() -> None:
    document, world = far_away()
    node = document.tree.getroot().xpath("//c:node[@id='m']/c:rotate", namespaces=NS)[0]
    node.text = "3 1 2 77.0001"
    assert not np.array_equal(document.load().orientations, world.orientations)
    assert "profile-old-value" in codes(document)


def test_what_stands_in_no_other_frame_is_compared_number_by_number() -> None:
    document = scene('<node id="a"><translate>1000 0.001 0</translate></node>', body("one"),
                     instance("one", "a"))  # fmt: skip
    world = document.load()
    world.bodies[0].rotate(0.1, 0.2, 0.3)
    world.bodies[0].position = (1000.0, 0.001, 0.0)
    document.update(world)
    motion = document.tree.getroot().xpath("//*[local-name()='motion']")[0]
    exact = motion.makeelement("{urn:colladaphy:pe:1}position")
    exact.text = "1000 0.0010000000000001 0"
    motion.insert(0, exact)
    edited = document.load()
    assert edited.positions[0, 1] == 0.001
    assert codes(document) == ["profile-old-value"]
