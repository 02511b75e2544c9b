"""Whatever is near COLLADA becomes COLLADA: random documents with random deviations."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st
from lxml import etree
from tests.conform.documents import NS_1_4, NS_1_5, codes

from colladaphy.conform import conform
from colladaphy.conform.context import standard_elements, standard_elements_with
from colladaphy.gate import gate
from colladaphy.testing import documents, mutants


def check(text: bytes) -> None:
    tree = etree.ElementTree(etree.fromstring(text))
    before = etree.tostring(tree)
    result, findings = conform(tree)
    assert etree.tostring(tree) == before
    if codes(findings) == {"repair-not-collada"}:
        return
    assert gate(result) == []
    assert bool(findings) == (etree.tostring(result) != before)
    again, more = conform(result)
    assert more == []
    assert etree.tostring(again) == etree.tostring(result)
    assert [str(finding) for finding in conform(tree)[1]] == [str(f) for f in findings]


@given(mutants(size=30), st.sampled_from(["id", "sid"]))
@settings(max_examples=20)
def test_the_search_for_an_attribute_finds_what_a_walk_finds(text: bytes, name: str) -> None:
    root = etree.fromstring(text)
    walked = [element for element in standard_elements(root) if element.get(name) is not None]
    assert standard_elements_with(root, name) == walked


@given(documents(size=30))
@settings(max_examples=20)
def test_valid_documents_stay_valid(text: bytes) -> None:
    check(text)


@given(mutants(size=30))
@settings(max_examples=25)
def test_mutants_become_valid(text: bytes) -> None:
    check(text)


@given(mutants(areas=["physics"], size=40, changes=6))
@settings(max_examples=25)
def test_mutants_of_physics_become_valid(text: bytes) -> None:
    check(text)


@given(mutants(size=30, changes=2), st.sampled_from(["1.4.0", "1.4.1"]))
@settings(max_examples=20)
def test_documents_that_say_they_are_1_4_become_valid(text: bytes, version: str) -> None:
    old = text.replace(NS_1_5.encode(), NS_1_4.encode())
    check(old.replace(b'version="1.5.0"', f'version="{version}"'.encode()))
