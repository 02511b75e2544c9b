"""The COLLADA 1.5 schema in this project: complete, well built, and equal to the official one."""

from graphlib import TopologicalSorter
from pathlib import Path

import pytest
from lxml import etree
from tools.schema_equivalence import compare, load
from tools.schema_equivalence.loading import OURS

XS = "{http://www.w3.org/2001/XMLSchema}"
FOLDER = OURS.parent
AREAS = sorted(path.stem for path in FOLDER.glob("*.xsd"))
NAMESPACE = "http://www.collada.org/2008/03/COLLADASchema"


def root(area: str) -> etree._Element:
    return etree.parse(FOLDER / f"{area}.xsd").getroot()


def includes(area: str) -> list[str]:
    return [Path(node.get("schemaLocation", "")).stem for node in root(area).iter(f"{XS}include")]


def everything_read_with(area: str) -> set[str]:
    found: set[str] = set()
    waiting = [area]
    while waiting:
        for included in includes(waiting.pop()):
            if included not in found:
                found.add(included)
                waiting.append(included)
    return found


def test_equal_to_the_official_schema(official_schema: Path) -> None:
    found = compare(load(OURS), load(official_schema), names=True)
    assert found.differences == []
    assert found.counts["types"] >= 700
    assert found.counts["elements"] >= 1900
    assert found.counts["attributes"] >= 990


def test_counts_of_global_components() -> None:
    found = [node.tag for area in AREAS for node in root(area) if node.get("name") is not None]
    assert found.count(f"{XS}simpleType") == 109
    assert found.count(f"{XS}complexType") == 221
    assert found.count(f"{XS}group") == 13
    assert found.count(f"{XS}element") == 1
    assert len(found) == 109 + 221 + 13 + 1


def test_every_global_name_is_given_once() -> None:
    found = [node.get("name") for area in AREAS for node in root(area) if node.get("name")]
    assert len(found) == len(set(found))


def test_includes_are_acyclic_and_complete() -> None:
    order = list(TopologicalSorter({area: includes(area) for area in AREAS}).static_order())
    assert sorted(order) == AREAS
    assert everything_read_with("collada") == {*AREAS} - {"collada"}


@pytest.mark.parametrize("area", AREAS)
def test_every_area_stands_by_itself(area: str) -> None:
    etree.XMLSchema(etree.parse(FOLDER / f"{area}.xsd"))


@pytest.mark.parametrize("area", AREAS)
def test_includes_are_those_that_are_used(area: str) -> None:
    """Each file includes exactly the files whose names it mentions, and only files beside it."""
    declared = {node.get("name"): other for other in AREAS for node in root(other)}
    mentioned = {
        declared[name]
        for node in root(area).iter(f"{XS}*")
        for attribute in ("type", "base", "ref", "itemType", "memberTypes")
        for name in node.get(attribute, "").split()
        if name in declared
    }
    if area == "collada":  # includes all, to be the one entry
        mentioned = {*AREAS}
    assert {*includes(area)} == mentioned - {area}
    locations = [
        node.get("schemaLocation", "") for node in root(area) if node.get("schemaLocation")
    ]
    assert all(":" not in location for location in locations), "nothing is fetched"


@pytest.mark.parametrize("area", AREAS)
def test_every_area_declares_the_same_namespace(area: str) -> None:
    schema = root(area)
    assert schema.get("targetNamespace") == NAMESPACE
    assert schema.get("elementFormDefault") == "qualified"
    assert schema.nsmap[None] == NAMESPACE


def test_physics_needs_neither_effects_nor_scenes() -> None:
    assert everything_read_with("physics") == {"values", "core", "geometry"}


@pytest.mark.parametrize("area", AREAS)
def test_no_documentation_is_taken_over(area: str) -> None:
    assert list(root(area).iter(f"{XS}annotation")) == []
