"""Mending takes time that grows with the document, whatever is in it, or says why it does not."""

from __future__ import annotations

import time
from collections.abc import Callable

import pytest
from lxml import etree
from tests.conform.documents import ASSET, BOX, C, codes, document, kept, mended, parse, physics
from tests.mapper.documents import body, collada, instance, model, scene

from colladaphy.conform import conform
from colladaphy.conform.grammar import SimpleType
from colladaphy.conform.lexical import is_valid, mend
from colladaphy.gate import gate

MANY = 3000


def seconds(tree: etree._ElementTree) -> float:
    start = time.process_time()
    conform(tree)
    return time.process_time() - start


@pytest.mark.parametrize("text", ["1T11" * 225_000, "1 " * 450_000, "-" * 900_000, "x" * 900_000])
def test_dates_of_any_length(text: str) -> None:
    assert mend(text, SimpleType("dateTime", primitive="dateTime")) == (None, False)
    tree = document("", asset=ASSET.replace("2020-01-02T03:04:05Z</created>", text + "</created>"))
    assert seconds(tree) < 5


@pytest.mark.parametrize(
    ("primitive", "text"),
    [
        ("double", "1" * 500_000 + "x"),
        ("double", "1," * 250_000),
        ("double", "1.5e" * 100_000),
        ("boolean", "t" * 500_000),
        ("anyURI", "%" * 500_000),
        ("NCName", "a b" * 200_000),
        ("unsignedInt", "9" * 100_000),
        ("integer", "-" + "9" * 100_000),
    ],
)
def test_texts_of_any_length(primitive: str, text: str) -> None:
    kind = SimpleType(primitive, primitive=primitive)
    start = time.process_time()
    for one in (kind, SimpleType("list", item=kind)):
        if not is_valid(text, one):
            mend(text, one)
    assert time.process_time() - start < 5


@pytest.mark.parametrize(
    ("text", "valid"),
    [("0" * 60 + "7", True), ("+" + "0" * 60, True), ("9" * 60, False), ("-" + "9" * 60, False)],
)
def test_whole_numbers_of_many_digits(text: str, valid: bool) -> None:
    assert is_valid(text, SimpleType("unsignedInt", primitive="unsignedInt")) == valid
    assert is_valid("-" + "9" * 60, SimpleType("integer", primitive="integer"))


def wide(where: str, count: int) -> etree._ElementTree:
    names = " ".join(f'a{i}="1"' for i in range(count))
    if where == "root":
        return parse(f'<COLLADA xmlns="{C[1:-1]}" version="1.5.0" {names}>{ASSET}</COLLADA>')
    if where == "node":
        return physics(BOX, nodes=f'<node id="n1" {names}/>')
    if where == "namespaces":
        names = " ".join(f'xmlns:a{i}="urn:{i}"' for i in range(count))
        return parse(f'<COLLADA xmlns="{C[1:-1]}" version="1.5.0" {names}>{ASSET}</COLLADA>')
    return document(f'<extra><technique profile="x"><f {names}/></technique></extra>')


@pytest.mark.parametrize("where", ["root", "node", "foreign", "namespaces"])
def test_many_attributes_are_kept(where: str) -> None:
    tree = wide(where, MANY)
    assert seconds(tree) < 5
    root, findings = mended(tree)
    if where in ("root", "node"):
        assert len(findings) == MANY
        assert kept(root).count("<conform:attribute") == MANY


@pytest.mark.parametrize("where", ["root", "node", "foreign", "namespaces"])
def test_too_many_are_refused_at_once_by_a_limit_that_names_itself(where: str) -> None:
    tree = wide(where, 100_000)
    start = time.process_time()
    same, findings = conform(tree)
    gate(same)
    assert time.process_time() - start < 30
    assert same is tree
    assert codes(findings) == {"repair-too-many-attributes"}
    assert findings[0].severity == "error"
    assert "4096" in findings[0].message


def dangling(count: int) -> bytes:
    """References to nodes and bodies that are not there, among many that are."""
    nodes = "".join(f'<node id="n{at}"/>' for at in range(5 * count))
    lost = (instance("b", f"#gone{at}") for at in range(count))
    bodiless = (instance(f"none{at}", "#n0") for at in range(count))
    return collada(model(body()), scene(*lost, *bodiless), nodes)


def repeated(count: int) -> bytes:
    """One id a thousand times, and references to it."""
    same = '<node id="n"/>' * 1000
    nodes = "".join(f'<node id="n{at}"/>' for at in range(5 * count))
    return collada(model(body()), scene(*(instance() for _ in range(count))), same + nodes)


@pytest.mark.parametrize("make", [dangling, repeated])
def test_references_of_any_number_take_time_in_proportion(make: Callable[[int], bytes]) -> None:
    spent = []
    for count in (500, 4000):
        tree = etree.ElementTree(etree.fromstring(make(count)))
        spent.append(min(seconds(tree) for _ in range(2)))
    assert spent[1] < 24 * spent[0] + 0.2  # eight times as much, and room for the machine
