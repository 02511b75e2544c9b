"""Faults of form of very large documents, without a tree of what repeats in them.

What is left out of such a document is valid wherever what is left is (`columns.thinning`). Where it
is not, the faults of values are all in what is left; those of structure are, if nothing of their
paths was left out.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from colladaphy.columns.reading import Document as Columns
from colladaphy.columns.thinning import Thinned
from colladaphy.conform.kinds import FORM
from colladaphy.errors import XmlError
from colladaphy.findings import Finding
from colladaphy.gate import rules
from colladaphy.gate.faults import violations
from colladaphy.gate.numerals import incomplete_violations
from colladaphy.meaning.hits import Hit, findings_of
from colladaphy.source import COLLADA_1_5, Limits, Loaded
from colladaphy.source.xml import parse_bytes
from colladaphy.validation.copies import Copy
from colladaphy.validation.options import NOTHING_BEHIND
from colladaphy.validation.schema_stage import schema_hits, with_schema_repairs

__all__ = ["check_rest"]

_OF_VALUES: Final = (rules.INVALID_VALUE, rules.WRONG_LENGTH)


def check_rest(thinned: Thinned, loaded: Loaded, limits: Limits) -> list[Finding]:
    """Findings about the whole document; none where these need not be all."""
    try:
        tree = parse_bytes(thinned.rest, None, limits)
    except XmlError:
        return []
    if not tree.getroot().tag.startswith(f"{{{COLLADA_1_5}}}"):
        return []
    first = violations(tree, fresh=True) + incomplete_violations(tree, thinned.rest)
    rest = Copy(tree, thinned.rows().tolist())
    hits = schema_hits(rest, first)
    structure = np.array([hit.element for hit in hits if hit.rule not in _OF_VALUES], np.int64)
    if not hits or not thinned.are_alone(structure).all():
        return []
    told = with_schema_repairs(hits, rest, rest.mended(FORM))
    told.append(Hit(rules.LARGE, 0, NOTHING_BEHIND))
    columns = Columns.of_index(thinned.index, thinned.tags, loaded.data)
    return findings_of(columns, loaded.file, told)
