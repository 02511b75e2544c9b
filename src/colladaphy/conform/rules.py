"""The rules of conform: every kind of change that a document may get at the door."""

from __future__ import annotations

from colladaphy.findings import Rule, Severity

_INFO, _WARNING, _ERROR = Severity.INFO, Severity.WARNING, Severity.ERROR

# Generic repairs, driven by the schema.
CHILD_ORDER = Rule(
    "repair-child-order",
    _INFO,
    "children were not in the order of the content model",
    "the standard fixes the order of these elements; their values are unchanged",
)
UNEXPECTED_ELEMENT = Rule(
    "repair-unexpected-element",
    _WARNING,
    "an element stood where the standard has no place for it",
    "it is kept in an extra nearby",
)
UNEXPECTED_TEXT = Rule(
    "repair-unexpected-text",
    _WARNING,
    "text stood where only elements may stand",
    "it is kept in an extra nearby",
)
UNKNOWN_ATTRIBUTE = Rule(
    "repair-unknown-attribute",
    _WARNING,
    "the standard has no such attribute here",
    "it is kept in an extra nearby",
)
MISSING_ELEMENT = Rule(
    "repair-missing-element",
    _INFO,
    "a required element was missing",
    "it was added with no content of its own",
)
MISSING_ATTRIBUTE = Rule(
    "repair-missing-attribute",
    _WARNING,
    "a required attribute was missing",
    "check the assumed value",
)
LEXICAL_FORM = Rule(
    "repair-lexical-form",
    _INFO,
    "a value was not in its lexical form",
    "write values as XML Schema spells them",
)
UNREADABLE_VALUE = Rule(
    "repair-unreadable-value",
    _WARNING,
    "a value could not be read as what it must be",
    "it is kept in an extra nearby; correct it at its source",
)
INCOMPLETE_ELEMENT = Rule(
    "repair-incomplete-element",
    _WARNING,
    "an element lacked something that nobody can make up",
    "it is kept in an extra nearby; complete it at its source",
)

# The way from 1.4 to 1.5.
VERSION = Rule(
    "upgrade-version",
    _INFO,
    "the document was COLLADA 1.4",
    "it is read as the same document in COLLADA 1.5",
)
SCHEMA_LOCATION = Rule(
    "upgrade-schema-location",
    _INFO,
    "the schema location named another version's schema",
    "it is only a hint and was removed",
)
NAMESPACE_FIXED = Rule(
    "repair-namespace",
    _WARNING,
    "the COLLADA namespace was missing or unknown",
    "write the namespace of the version you mean",
)
VERSION_ATTRIBUTE = Rule(
    "repair-version",
    _INFO,
    "the version attribute did not fit the namespace",
    "the namespace decides",
)
NOT_COLLADA = Rule(
    "repair-not-collada",
    _ERROR,
    "the document is not COLLADA",
    "its root must be <COLLADA>; nothing was changed",
)
# Identifiers and references.
ID_FORM = Rule(
    "repair-id-form", _WARNING, "an id was not an NCName", "references to it were rewritten"
)
ID_DUPLICATE = Rule(
    "repair-duplicate-id",
    _WARNING,
    "an id was used more than once",
    "later ones were renamed; references go to the nearest definition",
)
SID_FORM = Rule(
    "repair-sid-form", _WARNING, "a sid was not an NCName", "references by it were rewritten"
)
SID_EMPTY = Rule(
    "repair-empty-sid", _INFO, "a sid was empty", "it was removed, or made up where one is required"
)
SID_DUPLICATE = Rule(
    "repair-duplicate-sid", _WARNING, "a sid was used twice in one scope", "later ones were renamed"
)
RULES: tuple[Rule, ...] = tuple(
    value for value in list(globals().values()) if isinstance(value, Rule)
)
