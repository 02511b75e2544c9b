"""Strategies that change a document: into one that means the same, or as an editor would."""

from __future__ import annotations

import io
from collections.abc import Iterable, Mapping

from hypothesis import strategies as st
from lxml import etree

from colladaphy.document import Document
from colladaphy.testing.changing.editing import EDITS as _EDITS
from colladaphy.testing.changing.rewriting import REWRITES as _REWRITES
from colladaphy.testing.changing.rewriting import Change
from colladaphy.testing.changing.spelling import SERIALIZATIONS, serialized
from colladaphy.testing.making.scalars import several

__all__ = ["EDITS", "REWRITES", "edits", "equivalents"]

REWRITES: tuple[str, ...] = tuple(_REWRITES)
"""The names of changes that leave a document's meaning as it is."""

EDITS: tuple[str, ...] = tuple(_EDITS)
"""The names of edits."""


def equivalents(
    document: bytes | str | Document,
    *,
    kinds: Iterable[str] | None = None,
    most: int = 4,
    serializations: bool = True,
) -> st.SearchStrategy[bytes]:
    """Documents that mean the same as a valid one: whoever loads both should have the same bodies.

    Up to `most` changes of the `kinds` (of REWRITES; None is all of them) are made, where there
    is anything to change: comments and extras come in, numbers and ids are spelled otherwise,
    libraries stand in another order, nodes within nodes that move nothing. With `serializations`
    the file may be in another encoding, with prefixes, indented and so on. Order of bodies and
    their values stay; names of nodes and models need not.

    Raises ValueError for an unknown kind.
    """
    chosen = _chosen(kinds, _REWRITES)
    data = _bytes_of(document)

    @st.composite
    def changed(draw: st.DrawFn) -> bytes:
        root = etree.fromstring(data)
        several(draw, 0, most, lambda draw: apply(draw, root, chosen))
        form = draw(st.sampled_from(SERIALIZATIONS)) if serializations else "plain"
        return serialized(root, form)

    return changed()


def edits(
    document: bytes | str | Document, *, kinds: Iterable[str] | None = None, most: int = 3
) -> st.SearchStrategy[bytes]:
    """Documents that an editor program could have made of a valid one, and that are valid.

    One to `most` edits of the `kinds` (of EDITS; None is all of them) are made: bodies are moved,
    weighed, removed, copied and added, numbers are rounded, comments and what the program does
    not understand are dropped. The pe profile is left as it is, or is dropped as a whole: it may
    not fit the common profile any more, and the common profile counts then.

    Raises ValueError for an unknown kind.
    """
    chosen = _chosen(kinds, _EDITS)
    data = _bytes_of(document)

    @st.composite
    def edited(draw: st.DrawFn) -> bytes:
        root = etree.fromstring(data)
        several(draw, 1, most, lambda draw: apply(draw, root, chosen))
        return serialized(root, "plain")

    return edited()


def apply(draw: st.DrawFn, root: etree._Element, changes: Mapping[str, Change]) -> str | None:
    """Makes one of the changes that can be made; gives its name."""
    places = {name: change[0](root) for name, change in changes.items()}
    names = [name for name, found in places.items() if found]
    if not names:
        return None
    name = draw(st.sampled_from(names))
    changes[name][1](draw, draw(st.sampled_from(places[name])))
    return name


def _chosen(kinds: Iterable[str] | None, known: Mapping[str, Change]) -> dict[str, Change]:
    if kinds is None:
        return dict(known)
    names = [kinds] if isinstance(kinds, str) else list(kinds)
    for name in names:
        if name not in known:
            raise ValueError(f"no kind of change {name!r}; there are {', '.join(known)}")
    return {name: known[name] for name in names}


def _bytes_of(document: bytes | str | Document) -> bytes:
    if isinstance(document, bytes):
        return document
    if isinstance(document, str):
        return document.encode()
    stream = io.BytesIO()
    document.write(stream)
    return stream.getvalue()
