"""The kinds of deviations from the schema that the gate tells apart."""

from __future__ import annotations

from colladaphy.findings import Rule, Severity

__all__ = ["RULES"]

_ERROR = Severity.ERROR
_REPAIR = "'colladaphy repair IN OUT' mends the usual deviations of exporters."

VERSION_1_4 = Rule(
    "schema-version-1-4",
    _ERROR,
    "The document is COLLADA 1.4, not 1.5.",
    "'colladaphy convert IN OUT' writes it as valid COLLADA 1.5.",
    "COLLADA 1.5 §COLLADA",
    why="Readers of 1.5 refuse it: names, images and kinematics differ.",
)
WRONG_NAMESPACE = Rule(
    "schema-wrong-namespace",
    _ERROR,
    "The root element is not in the namespace of COLLADA 1.5.",
    'COLLADA 1.5 has xmlns="http://www.collada.org/2008/03/COLLADASchema".',
    "COLLADA 1.5 §COLLADA",
    why="Programs tell by the namespace what they can read.",
)
UNEXPECTED_ELEMENT = Rule(
    "schema-unexpected-element",
    _ERROR,
    "An element stands where it may not: unknown here, out of order, or once too often.",
    "Move, rename or remove it. " + _REPAIR,
    section="COLLADA 1.5 §Schema concepts",
    why="Strict readers refuse the document, and others pass the element over.",
)
MISSING_ELEMENT = Rule(
    "schema-missing-element",
    _ERROR,
    "A required child element is missing.",
    "Add it. " + _REPAIR,
    section="COLLADA 1.5 §Schema concepts",
    why="Readers rely on it being there.",
)
UNKNOWN_ELEMENT = Rule(
    "schema-unknown-element",
    _ERROR,
    "The schema does not know this element.",
    "Check its spelling and its namespace.",
    section="COLLADA 1.5 §Schema concepts",
    why="Programs pass over what they do not know.",
)
UNEXPECTED_CONTENT = Rule(
    "schema-unexpected-content",
    _ERROR,
    "An element has text or children that it may not have.",
    "Remove them. " + _REPAIR,
    section="COLLADA 1.5 §Schema concepts",
    why="Strict readers refuse the document, and others pass the content over.",
)
INVALID_VALUE = Rule(
    "schema-invalid-value",
    _ERROR,
    "A text or an attribute has a value that its type does not allow.",
    "Correct the value. " + _REPAIR,
    section="COLLADA 1.5 §Schema concepts",
    why="Programs take zero, or garbage, or stop.",
)
WRONG_LENGTH = Rule(
    "schema-wrong-length",
    _ERROR,
    "A list has too many or too few values.",
    "Correct the list. " + _REPAIR,
    section="COLLADA 1.5 §Schema concepts",
    why="Programs read too few values, or beyond the last.",
)
MISSING_ATTRIBUTE = Rule(
    "schema-missing-attribute",
    _ERROR,
    "A required attribute is missing.",
    "Add it. " + _REPAIR,
    section="COLLADA 1.5 §Schema concepts",
    why="Readers rely on it being there, and assume different values.",
)
UNKNOWN_ATTRIBUTE = Rule(
    "schema-unknown-attribute",
    _ERROR,
    "An element has an attribute that it may not have.",
    "Remove or rename it. " + _REPAIR,
    section="COLLADA 1.5 §Schema concepts",
    why="Strict readers refuse the document, and others pass over what it says.",
)
DUPLICATE_ID = Rule(
    "schema-duplicate-id",
    _ERROR,
    "Two elements have the same id.",
    "Rename one of them, and what refers to it. " + _REPAIR,
    "COLLADA 1.5 §Address syntax",
    why="Programs differ in which of the two a reference means.",
)
BROKEN_KEY = Rule(
    "schema-broken-key",
    _ERROR,
    "A key is not unique, or refers to nothing.",
    "Give every element its own key.",
    section="XML Schema 1.0 §Identity-constraint definitions",
    why="What refers by the key means several elements, or none.",
)
OTHER = Rule(
    "schema-violation",
    _ERROR,
    "The document deviates from the schema.",
    _REPAIR,
    section="COLLADA 1.5 §Schema concepts",
    why="Strict readers refuse the document.",
)
LARGE = Rule(
    "schema-large",
    Severity.INFO,
    "The document is large: what its faulty records themselves mean was not looked at.",
    "Mend them ('colladaphy repair IN OUT'), and check the result.",
    "colladaphy docs/validate.md",
    "A copy of it would have to be mended first, which takes minutes.",
)

RULES = (
    VERSION_1_4,
    WRONG_NAMESPACE,
    UNEXPECTED_ELEMENT,
    MISSING_ELEMENT,
    UNKNOWN_ELEMENT,
    UNEXPECTED_CONTENT,
    INVALID_VALUE,
    WRONG_LENGTH,
    MISSING_ATTRIBUTE,
    UNKNOWN_ATTRIBUTE,
    DUPLICATE_ID,
    BROKEN_KEY,
    OTHER,
    LARGE,
)
