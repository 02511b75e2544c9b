"""Rules of conform: generic repairs, driven by the schema."""

from __future__ import annotations

from colladaphy.findings import Rule, Severity

__all__ = ["RULES"]

_INFO, _WARNING = Severity.INFO, Severity.WARNING

CHILD_ORDER = Rule(
    "repair-child-order",
    _INFO,
    "children were not in the order of the content model",
    "the standard fixes the order of these elements; their values are unchanged",
    section="COLLADA 1.5 §Schema concepts",
    why="strict readers stop at the first child that is out of order",
)
UNEXPECTED_ELEMENT = Rule(
    "repair-unexpected-element",
    _WARNING,
    "an element stood where the standard has no place for it",
    "it is kept in an extra nearby",
    section="COLLADA 1.5 §extra",
    why="strict readers refuse the document, and others guess what it means",
)
UNEXPECTED_TEXT = Rule(
    "repair-unexpected-text",
    _WARNING,
    "text stood where only elements may stand",
    "it is kept in an extra nearby",
    section="COLLADA 1.5 §extra",
    why="strict readers refuse the document",
)
UNKNOWN_ATTRIBUTE = Rule(
    "repair-unknown-attribute",
    _WARNING,
    "the standard has no such attribute here",
    "it is kept in an extra nearby",
    section="COLLADA 1.5 §extra",
    why="strict readers refuse the document, and others pass over what it says",
)
MISSING_ELEMENT = Rule(
    "repair-missing-element",
    _INFO,
    "a required element was missing",
    "it was added with no content of its own",
    section="COLLADA 1.5 §Schema concepts",
    why="readers rely on it being there",
)
MISSING_ATTRIBUTE = Rule(
    "repair-missing-attribute",
    _WARNING,
    "a required attribute was missing",
    "check the assumed value",
    section="COLLADA 1.5 §Schema concepts",
    why="readers rely on it being there, and assume different values",
)
LEXICAL_FORM = Rule(
    "repair-lexical-form",
    _INFO,
    "a value was not in its lexical form",
    "write values as XML Schema spells them",
    section="XML Schema 1.0 §Datatypes",
    why="programs read such a value differently, or not at all",
)
DECIMAL_COMMA = Rule(
    "repair-decimal-comma",
    _WARNING,
    "a comma was a decimal mark",
    "check the numbers; write them with a point, and separate them with blanks",
    section="XML Schema 1.0 §float",
    why="most programs stop reading the number at the comma",
)
SURPLUS_VALUES = Rule(
    "repair-surplus-values",
    _WARNING,
    "a list of fixed length was longer",
    "the first values count; the whole list is kept in an extra nearby",
    section="COLLADA 1.5 §Schema concepts",
    why="programs differ in which of the values they take",
)
FAULTY_PROFILE = Rule(
    "repair-faulty-profile",
    _WARNING,
    "an element of the pe profile was not valid",
    "it is kept as text in an extra nearby; the common profile counts",
    section="colladaphy docs/pe-profile.md",
    why="a profile that is half understood is worse than none",
)
UNREADABLE_VALUE = Rule(
    "repair-unreadable-value",
    _WARNING,
    "a value could not be read as what it must be",
    "it is kept in an extra nearby; correct it at its source",
    section="XML Schema 1.0 §Datatypes",
    why="programs take zero, or garbage, or stop",
)
INCOMPLETE_ELEMENT = Rule(
    "repair-incomplete-element",
    _WARNING,
    "an element lacked something that nobody can make up",
    "it is kept in an extra nearby; complete it at its source",
    section="COLLADA 1.5 §Schema concepts",
    why="nobody can tell what it was to be",
)

RULES = (
    CHILD_ORDER,
    UNEXPECTED_ELEMENT,
    UNEXPECTED_TEXT,
    UNKNOWN_ATTRIBUTE,
    MISSING_ELEMENT,
    MISSING_ATTRIBUTE,
    LEXICAL_FORM,
    DECIMAL_COMMA,
    SURPLUS_VALUES,
    FAULTY_PROFILE,
    UNREADABLE_VALUE,
    INCOMPLETE_ELEMENT,
)
