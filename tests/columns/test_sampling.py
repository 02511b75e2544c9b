"""Columns without what is alike: valid if, and only if, the whole is."""

from __future__ import annotations

import random
from collections.abc import Iterator
from functools import cache
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lxml import etree
from tools.bench.kinds import KINDS

from colladaphy.columns.sampling import sampled
from colladaphy.columns.writing import document_bytes
from colladaphy.errors import SchemaError
from colladaphy.gate import is_valid_text
from colladaphy.mapper.storing import columns_of
from colladaphy.testing import worlds
from colladaphy.world import World
from colladaphy_schema.rows import Child, Column, Rows

NAMES = [name for name, kind in KINDS.items() if kind.edit is None]


def valid(root: Rows) -> bool:
    return is_valid_text(document_bytes(root))


@pytest.mark.parametrize("name", NAMES)
def test_samples_of_many_alike_are_small_and_valid(name: str) -> None:
    kind = KINDS[name]
    columns = columns_of(kind.world(400), kind.write_options)
    sample = document_bytes(sampled(columns))
    assert is_valid_text(sample)
    assert len(sample) < 0.1 * len(document_bytes(columns))


@given(worlds())
def test_samples_of_any_world_are_valid(world: World) -> None:
    columns = columns_of(world)
    before = document_bytes(columns)
    assert valid(sampled(columns))
    assert document_bytes(columns) == before


@given(worlds())
def test_samples_have_every_kind_of_element_with_every_attribute(world: World) -> None:
    columns = columns_of(world)
    assert _kinds(document_bytes(sampled(columns))) == _kinds(document_bytes(columns))


def _kinds(data: bytes) -> set[tuple[str, ...]]:
    root = etree.fromstring(data)
    found = set()
    for element in root.iter(etree.Element):
        path = [str(each.tag) for each in (*element.iterancestors(), element)]
        found |= {(*path, str(name)) for name in element.attrib} | {(*path,)}
    return found


def tables(rows: Rows) -> Iterator[Rows]:
    """All tables with values."""
    yield rows
    for field in type(rows).FIELDS:
        value = rows.known.get(field.name)
        if isinstance(field, Child) and value is not None and len(value):
            yield from tables(value)


@cache
def sources() -> tuple[tuple[str, int], ...]:
    return tuple((name, count) for name in NAMES for count in (3, 6, 9))


def spoilt(number: int) -> Rows | None:
    """Columns of which one thing was changed, mostly for the worse; None where nothing can be."""
    draw = random.Random(number)
    name, count = draw.choice(sources())
    root = columns_of(KINDS[name].world(count), KINDS[name].write_options)
    table = draw.choice(list(tables(root)))
    row = draw.randrange(len(table))
    fields = [field for field in type(table).FIELDS if table.known.get(field.name) is not None]
    if not fields:
        return None
    field = draw.choice(fields)
    value = table.known[field.name]
    if isinstance(field, Child) and not len(value):
        return None
    if isinstance(field, Child):
        _drop(value, draw.randrange(len(value)))
    elif isinstance(value, list):
        if value[row] is None or isinstance(value[row], list):
            return None
        value[row] = draw.choice(["a b", "", "1a", "#", "a", "#a", "-", "%zz", "ä", "#a#b", "3"])
    elif isinstance(value, np.ndarray) and value.dtype.kind == "i":
        value.flat[draw.randrange(value.size)] = draw.choice([-5, 0, 7, 2**40, -(2**40)])
    else:
        return None
    return root


def _drop(rows: Rows, row: int) -> None:
    """Leave out one row of a table, as if its parent had none."""
    kept = np.delete(np.arange(len(rows)), row)
    owner = rows.owner[kept]
    for field in type(rows).FIELDS:
        value: Any = rows.known.get(field.name)
        if value is None:
            continue
        if isinstance(field, Column):
            if isinstance(value, np.ndarray):
                rows.known[field.name] = value[kept]
            elif isinstance(value, list):
                rows.known[field.name] = [value[each] for each in kept.tolist()]
        else:
            value._owner = value.owner - (value.owner > row)
            value.owners = len(kept)
    rows._size, rows._owner = len(kept), owner
    if rows.order is not None:
        rows.order = rows.order[kept]


def verdict(root: Rows) -> bool | None:
    try:
        return valid(root)
    except (SchemaError, ValueError, IndexError):
        return None


@settings(max_examples=20 * settings().max_examples)
@given(st.integers(0, 10**9))
def test_what_is_wrong_with_the_whole_is_wrong_with_the_sample(number: int) -> None:
    root = spoilt(number)
    whole = None if root is None else verdict(root)
    if root is not None and whole is not None:
        assert verdict(sampled(root)) is whole


def test_the_search_spoils_enough() -> None:
    verdicts = [verdict(root) for root in map(spoilt, range(400)) if root is not None]
    assert verdicts.count(False) > 20
    assert verdicts.count(True) > 100


def test_a_search_with_a_fault_in_sampling_finds_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("colladaphy.columns.sampling.unsure_texts", lambda *_: [])
    roots = (root for root in map(spoilt, range(5000)) if root is not None)
    assert any(verdict(root) is False and verdict(sampled(root)) for root in roots)
