"""Rules of conform: ids and sids, well formed and unique."""

from __future__ import annotations

from colladaphy.findings import Rule, Severity

__all__ = ["RULES"]

_INFO, _WARNING = Severity.INFO, Severity.WARNING

ID_FORM = Rule(
    "repair-id-form",
    _WARNING,
    "an id was not an NCName",
    "references to it were rewritten",
    section="XML Schema 1.0 §ID",
    why="references cannot lead to it",
)
ID_DUPLICATE = Rule(
    "repair-duplicate-id",
    _WARNING,
    "an id was used more than once",
    "later ones were renamed; references go to the nearest definition of the kind they expect",
    section="COLLADA 1.5 §Address syntax",
    why="programs differ in which of the two a reference means",
)
SID_FORM = Rule(
    "repair-sid-form",
    _WARNING,
    "a sid was not an NCName",
    "references by it were rewritten",
    section="COLLADA 1.5 §Address syntax",
    why="paths of sids break at such a name",
)
SID_EMPTY = Rule(
    "repair-empty-sid",
    _INFO,
    "a sid was empty",
    "it was removed, or made up where one is required",
    section="COLLADA 1.5 §Address syntax",
    why="no path can lead to it",
)
SID_DUPLICATE = Rule(
    "repair-duplicate-sid",
    _WARNING,
    "a sid was used twice in one scope",
    "later ones were renamed",
    section="COLLADA 1.5 §Address syntax",
    why="programs differ in which of the two a path means",
)

RULES = (
    ID_FORM,
    ID_DUPLICATE,
    SID_FORM,
    SID_EMPTY,
    SID_DUPLICATE,
)
