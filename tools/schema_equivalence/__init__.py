"""Decides whether two XML Schemas accept the same documents and give them the same meaning.

Both schemas are walked together from their global elements, over pairs of types. Content models are
compared as automata, simple types by their effective facets, defaults in value space. So any
regrouping is accepted, and anything that a document or its reader could see is found.

Not decided: whether two differently written regular expressions are equal (their text is
compared), and whether different facets admit the same values (``minExclusive 0`` for integers
against ``minInclusive 1``). Such pairs are reported as different.
"""

from tools.schema_equivalence.loading import SchemaError, load
from tools.schema_equivalence.report import Comparison, Difference
from tools.schema_equivalence.walk import compare

__all__ = ["Comparison", "Difference", "SchemaError", "compare", "load"]
