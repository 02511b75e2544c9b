"""Documents with one fault each, by the rule that it breaks."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from hypothesis import strategies as st
from lxml import etree

from colladaphy.testing.breaking.archives import ARCHIVES
from colladaphy.testing.breaking.cases import cases
from colladaphy.testing.breaking.form import FORM
from colladaphy.testing.breaking.graphs import GRAPHS
from colladaphy.testing.changes import apply
from colladaphy.testing.changing.rewriting import REWRITES
from colladaphy.testing.making.scalars import several
from colladaphy.testing.physics import physics_documents
from colladaphy.validation.catalogue import find_rule

__all__ = ["BROKEN_RULES", "BrokenDocument", "broken_documents"]

_MADE = {**FORM, **ARCHIVES, **GRAPHS}
# What only the files beside a document tell.
_OF_FILES = {"io-reference-missing", "io-reference-refused", "link-image-missing"}

BROKEN_RULES: tuple[str, ...] = tuple(
    sorted({*_MADE, *(case.rule for case in cases())} - _OF_FILES)
)
"""The codes of the rules that `broken_documents` breaks: all errors that a document can have, and
what is worth a warning in a document that is valid otherwise."""

# What stays as it is does not hide a fault, nor bring in another. (A copy of a model that is not
# instanced lacks what its instances say.)
_AROUND = {kind: REWRITES[kind] for kind in ("comments", "extras")}


@dataclass(frozen=True, slots=True)
class BrokenDocument:
    """A document, or an archive of one, and what is wrong with it."""

    data: bytes
    rule: str
    """The code of the rule that it breaks; in a near miss, that it nearly breaks."""
    is_broken: bool
    """Whether it breaks the rule; a near miss does not."""
    about: str
    """What was done to it."""


def broken_documents(
    rules: str | Iterable[str] | None = None, *, near: bool = False, errors: bool = False
) -> st.SearchStrategy[BrokenDocument]:
    """Documents with one fault each, which `colladaphy.validate` finds, by its rule.

    `rules` names some of BROKEN_RULES; None is all, or with `errors` those that make a document
    invalid. With `near` they are near misses instead, in which that rule is kept: an importer
    that refuses the first and not these knows the rule.

    Raises ValueError for a rule that no document breaks.
    """
    names = BROKEN_RULES if rules is None else [rules] if isinstance(rules, str) else [*rules]
    for name in names:
        if name not in BROKEN_RULES:
            raise ValueError(f"no document breaks {name!r}; see BROKEN_RULES")
    chosen = [name for name in names if not errors or _is_error(name)]

    @st.composite
    def document(draw: st.DrawFn) -> BrokenDocument:
        name = draw(st.sampled_from(chosen))
        if name in _MADE:
            data = draw(physics_documents(oddities=False))
            made = _MADE[name][near](draw, data)
            return BrokenDocument(made, name, not near, "near miss" if near else "fault")
        found = [case for case in cases() if case.rule == name and case.is_fault != near]
        case = draw(st.sampled_from(found))
        return BrokenDocument(draw(_surrounded(case.data)), name, not near, case.name)

    return document()


def _is_error(code: str) -> bool:
    rule = find_rule(code)
    return rule is not None and str(rule.severity) == "error"


@st.composite
def _surrounded(draw: st.DrawFn, data: bytes) -> bytes:
    root = etree.fromstring(data)
    several(draw, 0, 2, lambda draw: apply(draw, root, _AROUND))
    return etree.tostring(root, encoding="UTF-8", xml_declaration=True)
