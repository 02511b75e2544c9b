"""Masses and inertias that no body can have: told on loading as they are in `validate`."""

from __future__ import annotations

import pytest
from tests.mapper.documents import body, collada, instance, model, scene, simple

import colladaphy
from colladaphy.findings import Severity

BOX = "<shape><box><half_extents>1 1 1</half_extents></box></shape>"


def told(data: bytes, *, repair: bool) -> tuple[colladaphy.World, list[str]]:
    document = colladaphy.read(data, repair=repair)
    world = document.load()
    found = [finding for finding in document.report if finding.code.startswith("physics-")]
    assert all(finding.line and finding.severity is Severity.WARNING for finding in found)
    return world, [finding.code for finding in found]


@pytest.mark.parametrize("repair", [False, True])
@pytest.mark.parametrize(
    ("values", "code"),
    [
        ("<mass>2</mass><inertia>0.001 0.002 0.009</inertia>", "physics-inertia-triangle"),
        ("<mass>2</mass><inertia>-0.001 0.002 0.002</inertia>", "physics-inertia-value"),
        ("<mass>2</mass><inertia>0 0 0</inertia>", "physics-inertia-zero"),
        ("<mass>2</mass><inertia>1 0 1</inertia>", "physics-inertia-zero"),
        ("<mass>0</mass>", "physics-mass-zero"),
        ("<dynamic>false</dynamic><mass>0</mass>", None),
        ("<dynamic>false</dynamic><mass>0</mass><inertia>0 0 0</inertia>", None),
        ("<mass>2</mass><inertia>1 1 2</inertia>", None),
    ],
)
def test_what_no_body_can_have_is_told_and_taken(
    values: str, code: str | None, repair: bool
) -> None:
    data = simple(BOX, values=values)
    world, codes = told(data, repair=repair)
    assert codes == ([] if code is None else [code])
    known = [found.code for found in colladaphy.validate(data) if found.code == code]
    assert known == codes
    if "<inertia>" in values:
        stated = [float(word) for word in values.split("<inertia>")[1].split("<")[0].split()]
        assert world.bodies[0].inertia.diagonal().tolist() == stated


def test_each_element_is_told_once_and_the_instance_counts() -> None:
    bad = "<mass>2</mass><inertia>1 1 9</inertia>"
    twice = collada(model(body("b", BOX, bad)), scene(instance("b") + instance("b", "#k")),
                    '<node id="n"/><node id="k"/>')  # fmt: skip
    assert told(twice, repair=False)[1] == ["physics-inertia-triangle"]
    better = "<mass>2</mass><inertia>1 1 1</inertia>"
    mended = collada(model(body("b", BOX, bad)), scene(instance("b", values=better)))
    assert told(mended, repair=False)[1] == []
    worse = collada(model(body("b", BOX, better)), scene(instance("b", values=bad)))
    assert told(worse, repair=False)[1] == ["physics-inertia-triangle"]
