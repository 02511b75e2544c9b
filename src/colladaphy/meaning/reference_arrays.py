"""Arrays of references that lead nowhere (COLLADA 1.5 §IDREF_array, §SIDREF_array)."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from colladaphy.findings import Severity
from colladaphy.links.rules import MISSING
from colladaphy.meaning.addresses import lost_in
from colladaphy.meaning.array_table import WordRows
from colladaphy.meaning.context import Context
from colladaphy.meaning.hits import Hit, listed
from colladaphy.meaning.inputs import inputs_of
from colladaphy.meaning.source_table import sources_of

__all__ = ["CHECKS"]


def ids(context: Context) -> Iterator[Hit]:
    """Arrays of ids, but for those of joints and targets of morphs, which are told there."""
    rows = context.rows(WordRows, "IDREF_array")
    if not len(rows):
        return
    assert rows.ordinals is not None
    inputs, table = inputs_of(context), sources_of(context)
    told = np.flatnonzero(inputs.are("JOINT", "MORPH_TARGET") & (inputs.sources >= 0))
    known = set(table.arrays[inputs.sources[told]].tolist())
    for array, words in zip(rows.ordinals.tolist(), rows.value, strict=True):
        if array in known:
            continue
        lost = [word for word in words if context.target(word) < 0]
        if lost:
            message = f"There is no element of the id {listed(lost)}."
            yield Hit(MISSING, array, message, severity=Severity.WARNING)


def addresses(context: Context) -> Iterator[Hit]:
    """Arrays of addresses with names that are there nowhere."""
    rows = context.rows(WordRows, "SIDREF_array")
    assert rows.ordinals is not None
    for array, words in zip(rows.ordinals.tolist(), rows.value, strict=True):
        lost = [word for word in words if lost_in(context, word) is not None]
        if lost:
            message = f"The address {listed(lost)} leads nowhere."
            yield Hit(MISSING, array, message, severity=Severity.WARNING)


CHECKS = (ids, addresses)
