"""Rules of conform: names, places and wrappings of elements."""

from __future__ import annotations

from colladaphy.findings import Rule, Severity

__all__ = ["RULES"]

_INFO, _WARNING = Severity.INFO, Severity.WARNING

MISSPELT = Rule(
    "repair-misspelt-element",
    _WARNING,
    "an element's name was misspelt",
    "the standard's name is used",
    section="COLLADA 1.5 §Schema concepts",
    why="programs pass over an element that they do not know",
)
WRAPPED = Rule(
    "repair-wrapper",
    _INFO,
    "an element stood beside the wrapper it belongs in, or inside one it does not",
    "values are unchanged",
    section="COLLADA 1.5 §Schema concepts",
    why="programs look for it in its place only",
)
STRAY = Rule(
    "repair-outside-library",
    _WARNING,
    "an element that belongs in a library stood outside of one",
    "it was moved into its library",
    section="COLLADA 1.5 §COLLADA",
    why="programs look for it in its library only",
)
EMPTY_LIBRARY = Rule(
    "repair-empty-library",
    _INFO,
    "a library was empty",
    "the standard allows no empty libraries",
    section="COLLADA 1.5 §COLLADA",
    why="strict readers refuse the document",
)
EMPTY_BINDING = Rule(
    "repair-empty-bind-material",
    _INFO,
    "a material binding bound nothing",
    "the standard asks for at least one material",
    section="COLLADA 1.5 §bind_material",
    why="strict readers refuse the document",
)
EMPTY_GEOMETRY = Rule(
    "repair-empty-geometry",
    _WARNING,
    "a geometry had no content",
    "complete it at its source",
    section="COLLADA 1.5 §geometry",
    why="there is nothing to show or to collide with",
)

RULES = (
    MISSPELT,
    WRAPPED,
    STRAY,
    EMPTY_LIBRARY,
    EMPTY_BINDING,
    EMPTY_GEOMETRY,
)
