"""Ids and references are matched as a table of texts would match them."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from colladaphy.columns.reading import Document
from colladaphy_schema.rows import Rows

HEAD = '<COLLADA xmlns="http://www.collada.org/2008/03/COLLADASchema" version="1.5.0">'
NAMES = st.sampled_from(["a", "b", "ab", "a" * 8, "b" * 9, "a" * 16, "\u00e9", "a.b", "a/b", ""])
LOOSE = st.sampled_from([" a", "a ", "a&amp;b", "&#97;", "a\tb"])
SCOPES = st.lists(st.lists(NAMES, max_size=6), max_size=5)


def document(scopes: list[list[str]]) -> Document:
    nodes = ["".join(f'<node sid="{sid}" id="{sid}"/>' for sid in sids) for sids in scopes]
    inner = "".join(f"<node>{each}</node>" for each in nodes)
    foreign = '<extra><technique profile="x"><node sid="a" id="a"/></technique></extra>'
    return Document(f"{HEAD}{foreign}{inner}</COLLADA>".encode())


def tables(found: Document) -> tuple[dict[str, int], dict[tuple[int, str], int]]:
    """The first element of each id, and of each sid in each scope."""
    elements, texts = found.with_attribute("sid")
    ids: dict[str, int] = {}
    sids: dict[tuple[int, str], int] = {}
    for element, text in zip(elements.tolist(), texts, strict=True):
        ids.setdefault(text, element)
        sids.setdefault((int(found.index.parent[element]), text), element)
    return ids, sids


@given(SCOPES, st.lists(st.tuples(NAMES, st.integers(0, 60)), max_size=8))
def test_they_are_matched(scopes: list[list[str]], wanted: list[tuple[str, int]]) -> None:
    found = document(scopes)
    ids, sids = tables(found)
    asked = "".join(f'<b c="{name}" d="#{name}"/>' for name, _ in wanted)
    other = Document(f"{HEAD}{asked}</COLLADA>".encode())
    rows = Rows(len(wanted), origin=other, ordinals=np.arange(1, len(wanted) + 1))
    _, names = other.ranges(rows, "c")
    _, references = other.ranges(rows, "d")
    assert found.identifiers.matched(names).tolist() == [
        ids.get(name, -1) if name else -1 for name, _ in wanted
    ]
    assert found.identifiers.referred(references).tolist() == [
        ids.get(name, -1) if name else -1 for name, _ in wanted
    ]
    assert found.identifiers.referred(names).tolist() == [-1] * len(wanted)
    within = np.array([scope for _, scope in wanted], np.int64)
    assert found.scoped_identifiers.matched(names, within).tolist() == [
        sids.get((scope, name), -1) if name else -1 for name, scope in wanted
    ]


@given(st.lists(st.lists(NAMES | LOOSE, max_size=6), max_size=5))
def test_that_all_differ_is_not_said_wrongly(scopes: list[list[str]]) -> None:
    found = document(scopes)
    elements, texts = found.with_attribute("sid")
    scoped = set(zip(found.index.parent[elements].tolist(), texts, strict=True))
    if found.scoped_identifiers.all_differ():
        assert len(scoped) == len(texts)
    elif not any(text in sid for sids in scopes for sid in sids for text in (" ", "&", "\t")):
        assert len(scoped) < len(texts)
