"""The strategies of colladaphy.testing: valid where they say so, and all over the schema."""

import re
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest
from hypothesis import HealthCheck, Phase, find, given, settings
from lxml import etree
from tools.schema_equivalence.loading import STUBS

from colladaphy.conform.grammar import NAMESPACE
from colladaphy.gate import gate, schema_folder
from colladaphy.testing import (
    AREAS,
    MUTATIONS,
    Component,
    Coverage,
    covering_documents,
    documents,
    mutants,
)

XS = "{http://www.w3.org/2001/XMLSchema}"
XSI = "{http://www.w3.org/2001/XMLSchema-instance}"

EXAMPLES = max(150, settings().max_examples)
"""Of valid documents and of mutants each; the nightly profile has 2,000 of both."""
many = settings(max_examples=EXAMPLES, suppress_health_check=list(HealthCheck))


@pytest.fixture(scope="module")
def ours() -> etree.XMLSchema:
    return etree.XMLSchema(etree.parse(schema_folder() / "collada-1.5" / "collada.xsd"))


@pytest.fixture(scope="module")
def official(official_schema: Path) -> etree.XMLSchema:
    tree = etree.parse(official_schema)
    for node in tree.getroot().iter(f"{XS}import"):
        node.set("schemaLocation", STUBS[node.get("schemaLocation", "")].as_uri())
    return etree.XMLSchema(tree)


def objections(schema: etree.XMLSchema, document: bytes) -> list[tuple[int, str, str]]:
    """What a schema objects to: line, path and wording, but for the facet of a wrong length."""
    schema.validate(etree.fromstring(document))
    wrong_length = re.compile(r"\[facet '\w*[lL]ength'\](.*); .*")
    return sorted(
        (entry.line, entry.path or "", wrong_length.sub(r"wrong length: \1", entry.message))
        for entry in schema.error_log
    )


@many
@given(document=documents())
def test_documents_are_valid_for_both_schemas(
    document: bytes, ours: etree.XMLSchema, official: etree.XMLSchema
) -> None:
    assert objections(ours, document) == []
    assert objections(official, document) == []


@many
@given(document=documents(xsi_types=True))
def test_derived_types_are_valid_for_both_schemas(
    document: bytes, ours: etree.XMLSchema, official: etree.XMLSchema
) -> None:
    assert objections(ours, document) == []
    assert objections(official, document) == []


@many
@given(document=mutants())
def test_both_schemas_object_to_the_same_in_mutants(
    document: bytes, ours: etree.XMLSchema, official: etree.XMLSchema
) -> None:
    assert objections(ours, document) == objections(official, document)


def test_covering_documents_hold_every_component(
    ours: etree.XMLSchema, official: etree.XMLSchema
) -> None:
    coverage = Coverage()
    for document in covering_documents():
        assert objections(ours, document) == []
        assert objections(official, document) == []
        coverage.record(document)
    assert coverage.missed == []


def declared() -> Counter[str]:
    """How many elements and attributes the schema files declare, by their global component."""
    return Counter(
        top.get("name", "")
        for area in AREAS
        for top in etree.parse(schema_folder() / "collada-1.5" / f"{area}.xsd").getroot()
        for _ in top.iter(f"{XS}element", f"{XS}attribute")
    )


UNREACHABLE = {
    "ellipsoid_type": 1,
    "fx_sampler_type": 1,  # of an element are only its restrictions, and these are empty
    "input_global_type": 2,
    "limits_sub_type": 1,
}
"""Declarations in types that no element has: how many there are of each."""


def test_components_are_all_that_the_schema_files_declare() -> None:
    """Counted in the files themselves, so that no declaration is lost on the way to the grammar."""
    root_itself = 1
    reachable = declared().total() - sum(UNREACHABLE.values()) - root_itself
    assert len(Coverage().reachable) == reachable
    assert {name: declared()[name] for name in UNREACHABLE} == UNREACHABLE
    assert not any(component.owner in UNREACHABLE for component in Coverage().reachable)


def test_coverage_tells_declarations_of_one_name_apart() -> None:
    both = b"<orthographic><xmag>1</xmag><ymag>1</ymag>"
    document = next(found for found in covering_documents() if both in found)
    reached = []
    for text in (document, document.replace(b"<xmag>1</xmag>", b"")):
        coverage = Coverage()
        coverage.record(text)
        reached.append({part.number for part in coverage.reached if part.name == "ymag"})
    assert reached == [{0}, {1}]


def test_coverage_of_one_document_is_what_it_holds() -> None:
    document = (
        f'<COLLADA xmlns="{NAMESPACE}" version="1.5.0"><asset><created>2001-01-01T00:00:00'
        "</created><modified>2001-01-01T00:00:00</modified></asset></COLLADA>"
    ).encode()
    coverage = Coverage()
    coverage.record(document)
    assert coverage.reached == {
        Component("COLLADA", "@version"),
        Component("COLLADA", "asset"),
        Component("asset_type", "created"),
        Component("asset_type", "modified"),
    }
    assert len(coverage.missed) == len(coverage.reachable) - 4


@many
@given(document=documents(areas=["physics"]))
def test_an_area_keeps_to_what_it_builds_on(document: bytes) -> None:
    libraries = {
        etree.QName(child).localname
        for child in etree.fromstring(document).iterchildren(etree.Element)
    } - {"asset", "scene", "extra"}
    assert libraries <= {
        "library_force_fields",
        "library_physics_materials",
        "library_physics_models",
        "library_physics_scenes",
    }


def test_unknown_area_is_refused() -> None:
    with pytest.raises(ValueError, match=r"no area 'fizzics' in the schema; there are .*physics"):
        documents(areas=["fizzics"])


@many
@given(document=documents())
def test_ids_are_unique_and_references_resolve(document: bytes) -> None:
    root = etree.fromstring(document)
    ids = [node.get("id") for node in root.iter(f"{{{NAMESPACE}}}*") if node.get("id") is not None]
    assert len(ids) == len(set(ids))
    for array in root.iter(f"{{{NAMESPACE}}}IDREF_array"):
        if array.get(f"{XSI}type") is None:
            assert set((array.text or "").split()) <= set(ids)


@settings(many, max_examples=30)
@given(document=documents(xsi_types=True))
def test_documents_pass_the_gate(document: bytes) -> None:
    assert gate(etree.ElementTree(etree.fromstring(document))) == []


def test_the_simplest_document_is_minimal() -> None:
    smallest = find(
        documents(), lambda _: True, settings=settings(database=None, phases=[Phase.generate])
    )
    assert len(list(etree.fromstring(smallest).iter())) < 10


@pytest.mark.parametrize("wanted", ["physics_scene", "profile_CG", "articulated_system", "nurbs"])
def test_documents_reach_deep_places(wanted: str) -> None:
    tag = f"{{{NAMESPACE}}}{wanted}"
    quick = settings(max_examples=2000, database=None, derandomize=True, phases=[Phase.generate])
    find(documents(), lambda d: etree.fromstring(d).find(f".//{tag}") is not None, settings=quick)


def test_most_mutants_are_invalid_and_each_kind_can_be(ours: etree.XMLSchema) -> None:
    verdicts: list[bool] = []

    @settings(many, max_examples=150, derandomize=True, database=None)
    @given(document=mutants(changes=1))
    def collect(document: bytes) -> None:
        verdicts.append(ours.validate(etree.fromstring(document)))

    collect()
    assert len(MUTATIONS) >= 14
    assert verdicts.count(False) > len(verdicts) / 2


def test_missing_hypothesis_is_explained() -> None:
    code = "import sys; sys.modules['hypothesis'] = None; import colladaphy.testing"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert "ImportError: colladaphy.testing needs hypothesis: pip install" in done.stderr


@settings(many, max_examples=50)
@given(document=mutants())
def test_coverage_takes_note_of_invalid_documents_too(document: bytes) -> None:
    coverage = Coverage()
    coverage.record(document)
    assert coverage.reached <= coverage.reachable
