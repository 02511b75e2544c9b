"""Telling that a document is valid while its columns are read, for less than validating it costs.

What repeats in it is not sent through the gate one by one (see `colladaphy.columns.thinning`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from colladaphy.columns.reading import Document
from colladaphy.columns.thinning import Thinned, thinned
from colladaphy.errors import XmlError
from colladaphy.gate import accepts, gate
from colladaphy.gate.numerals import incomplete_numbers
from colladaphy.source.limits import Limits
from colladaphy.source.plain import is_plain
from colladaphy.source.xml import parse_bytes

__all__ = ["Verdict", "judge"]

_LARGE: Final = 1 << 16
"""Bytes from which documents repeat enough to look for it."""
_REGULAR: Final = 0.5
"""The share of a document that may be left for it to be worth it."""
_DEFAULTS: Final = Limits()


@dataclass(frozen=True, slots=True)
class Verdict:
    """What is known of the bytes of a document."""

    accepted: bool
    """Whether parsing it within the limits is sure to raise nothing, and the gate to find nothing;
    where it is False, a tree has to tell."""
    columns: Document | None = None
    """Its columns, where they were read on the way."""
    thinned: Thinned | None = None
    """What is left of it without what repeats, where a fault has to be in that."""


def judge(data: bytes, limits: Limits = _DEFAULTS) -> Verdict:
    """Whether a document is sure to be read and valid (see `colladaphy.gate.accepts`)."""
    if len(data) < _LARGE or not is_plain(data, limits):
        return Verdict(accepts(data, limits))
    found = thinned(data)
    if found is None:
        return Verdict(accepts(data, limits))
    if len(found.rest) > _REGULAR * len(data):
        accepted, few = accepts(data, limits), False
    else:
        accepted, few = accepts(found.rest, limits) or _passes(found.rest, limits), True
    if accepted:
        return Verdict(True, Document.of_index(found.index, found.tags, data))
    return Verdict(False, None, found if few else None)


def _passes(data: bytes, limits: Limits) -> bool:
    """The same for a small document, with a tree."""
    try:
        tree = parse_bytes(data, None, limits)
    except XmlError:
        return False
    return not (gate(tree, fresh=True) or incomplete_numbers(tree, data))
