"""Which names, as they are written, are which qualified names."""

from __future__ import annotations

from collections import defaultdict
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.distinct import distinct
from colladaphy.columns.factors import factors_of
from colladaphy.columns.index import Index
from colladaphy.columns.names import NotPlain
from colladaphy.columns.tags import Tags
from colladaphy.columns.texts import Ranges

__all__ = ["codes_by_name"]

Array = NDArray[Any]

_XMLNS = int.from_bytes(b"xmlns", "little")
_FIVE = (1 << 40) - 1
_COLON, _EQUALS = 58, 61


class _Declarations(NamedTuple):
    """Attributes that declare namespaces, in the order of the document."""

    rows: Array
    """(n,) the elements."""
    kinds: Array
    """(n,) which of the different declarations it is."""
    prefixes: list[bytes]
    """(k,) of each different one; empty for the default namespace."""
    uris: list[bytes]


def codes_by_name(index: Index, tags: Tags | None = None) -> dict[str, tuple[int, ...]]:
    """The codes of the names of elements, by qualified name.

    `tags` are those of the index, if they are known.

    Where a prefix stands for different namespaces in different places, the elements of it get
    codes of their own first.
    """
    declared = _declarations(index) if tags is None else _declared(tags)
    names: defaultdict[bytes, list[int]] = defaultdict(list)
    for code, name in enumerate(index.names.texts):
        names[name.rpartition(b":")[0]].append(code)
    found: defaultdict[str, list[int]] = defaultdict(list)
    by_prefix = _by_prefix(declared)
    uris: dict[bytes, int] = {b"": 0}
    uri_of = np.array([uris.setdefault(uri, len(uris)) for uri in declared.uris], np.int64)
    texts = list(uris)
    for prefix, codes in names.items():
        here = by_prefix.get(prefix)
        kinds = [] if here is None else distinct(declared.kinds[here]).tolist()
        # An undeclared prefix is not well-formed, but without a default there is no namespace.
        everywhere = prefix or here is None or int(declared.rows[here[0]]) == 0
        if here is None or (len(kinds) < 2 and everywhere):
            uri = declared.uris[kinds[0]] if kinds else b""
            for code in codes:
                found[_qualified(uri, index.names.texts[code])].append(code)
        else:
            _separate(index, codes, here, declared, uri_of, texts, found)
    return {name: tuple(codes) for name, codes in found.items()}


def _by_prefix(declared: _Declarations) -> dict[bytes, Array]:
    """The declarations of each prefix, in the order of the document."""
    if not len(declared.kinds):
        return {}
    numbers: dict[bytes, int] = {}
    prefix = np.array([numbers.setdefault(p, len(numbers)) for p in declared.prefixes])
    mine = prefix[declared.kinds]
    sorting = np.argsort(mine, kind="stable")
    cuts = np.searchsorted(mine[sorting], np.arange(1, len(numbers)))
    return dict(zip(numbers, np.split(sorting, cuts), strict=True))


def _qualified(uri: bytes, name: bytes) -> str:
    local = name.rpartition(b":")[2].decode()
    return f"{{{uri.decode()}}}{local}" if uri else local


def _declarations(index: Index) -> _Declarations:
    """All declarations; there may be one in every other element, but hardly any different ones."""
    names, values, rows = _attributes(index)
    if not len(rows):
        return _Declarations(rows, rows, [], [])
    kinds, texts = _different(Ranges(index.words, names.starts, values.stops))
    return _parted(rows, kinds, texts)


def _declared(tags: Tags) -> _Declarations:
    """The same from the tags."""
    different, kinds = np.unique(tags.declared, return_inverse=True)
    texts = [tags.declarations[code].strip()[:-1] for code in different.tolist()]
    return _parted(tags.declaring, kinds, texts)


def _parted(rows: Array, kinds: Array, texts: list[bytes]) -> _Declarations:
    prefixes, uris = [], []
    for text in texts:
        name, _, uri = text.partition(b'="')
        if b"&" in uri:
            raise NotPlain("a reference in the name of a namespace")
        prefixes.append(name.partition(b":")[2])
        uris.append(uri)
    return _Declarations(rows, kinds, prefixes, uris)


def _different(ranges: Ranges) -> tuple[Array, list[bytes]]:
    """Which of the different texts each one is, and those."""
    numbers, first = factors_of(ranges)
    return numbers, ranges.take(first).texts()


def _attributes(index: Index) -> tuple[Ranges, Ranges, Array]:
    """The names and values of attributes that declare namespaces, and their elements."""
    opens = index.quote_places[::2]
    closes = index.quote_places[1::2]
    data = index.bytes
    # The name is behind the end of the value before it, or of the element's name.
    starts = np.empty(len(opens), opens.dtype)
    starts[1:] = closes[:-1] + 1
    starts[index.first_quote // 2] = index.name_end
    candidates = np.flatnonzero(opens - starts >= 7)
    start = starts[candidates].astype(np.intp)
    while True:  # there is one blank, mostly
        more = np.flatnonzero(np.isin(data[start], (9, 10, 13, 32)))
        if not len(more):
            break
        start[more] += 1
    same = (index.words.at(start) & np.uint64(_FIVE)) == np.uint64(_XMLNS)
    after = data[start + 5]
    same &= (after == _COLON) | (after == _EQUALS)
    places, start = candidates[same], start[same]
    rows = index.attributed[np.searchsorted(index.first_quote, places * 2, side="right") - 1]
    return (
        Ranges(index.words, start, opens[places] - 1),
        Ranges(index.words, opens[places] + 1, closes[places]),
        rows,
    )


def _separate(
    index: Index,
    codes: list[int],
    here: Array,
    declared: _Declarations,
    uri_of: Array,
    texts: list[bytes],
    found: defaultdict[str, list[int]],
) -> None:
    """Give elements whose prefix means different things codes by what it means where they are.

    `here` are the declarations of that prefix, `uri_of` the numbers of the URIs of the different
    ones in `texts`.
    """
    rows = np.sort(np.concatenate([index.rows(code) for code in codes]))
    begins = declared.rows[here]
    spans = zip(
        np.searchsorted(rows, begins).tolist(),
        np.searchsorted(rows, index.last_within(begins), side="right").tolist(),
        uri_of[declared.kinds[here]].tolist(),
        strict=True,
    )
    meaning = np.zeros(len(rows), np.int64)
    for begin, end, uri in spans:  # in the order of the document: the inner ones come later
        meaning[begin:end] = uri
    for code in codes:
        name = index.names.texts[code]
        mine = index.rows(code)
        means = meaning[np.searchsorted(rows, mine)]
        sorting = np.argsort(means, kind="stable")
        means = means[sorting]
        cuts = np.flatnonzero(means[1:] != means[:-1]) + 1
        parts = np.split(mine[sorting], cuts)
        for fresh, place in zip(index.parted(code, parts), [0, *cuts.tolist()], strict=True):
            found[_qualified(texts[means[place]], name)].append(fresh)
