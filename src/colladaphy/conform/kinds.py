"""Which repairs are about what: the version, the children of elements, the form as a whole."""

from __future__ import annotations

from colladaphy.conform import rules

__all__ = ["FORM", "STRUCTURE", "UPGRADE"]

UPGRADE = frozenset(
    rule.code
    for rule in rules.RULES
    if rule.stage == "upgrade" or rule in (rules.NAMESPACE_FIXED, rules.VERSION_ATTRIBUTE)
)
"""What makes another version's elements those of 1.5."""

STRUCTURE = frozenset(
    rule.code
    for rule in (
        rules.CHILD_ORDER,
        rules.UNEXPECTED_ELEMENT,
        rules.MISSING_ELEMENT,
        rules.INCOMPLETE_ELEMENT,
        rules.MISSPELT,
        rules.WRAPPED,
        rules.STRAY,
        rules.EMPTY_LIBRARY,
        rules.EMPTY_BINDING,
        rules.EMPTY_GEOMETRY,
        rules.INLINE_MESH,
        rules.SHAPE_SPLIT,
        rules.EMPTY_SHAPE,
        rules.MISSING_SHAPE,
        rules.BARE_INSTANCE,
        rules.MISSING_ATTACHMENT,
        rules.EMPTY_MASS_FRAME,
        rules.MATRIX,
    )
)
"""What puts children where the schema has them."""

FORM = STRUCTURE | frozenset(
    rule.code
    for rule in (
        rules.UNEXPECTED_TEXT,
        rules.UNKNOWN_ATTRIBUTE,
        rules.MISSING_ATTRIBUTE,
        rules.LEXICAL_FORM,
        rules.DECIMAL_COMMA,
        rules.SURPLUS_VALUES,
        rules.FAULTY_PROFILE,
        rules.UNREADABLE_VALUE,
        rules.VERSION_ATTRIBUTE,
        rules.NAMESPACE_FIXED,
        rules.ID_FORM,
        rules.ID_DUPLICATE,
        rules.SID_FORM,
        rules.SID_EMPTY,
        rules.MISSING_SID,
        rules.CAPSULE_RADIUS,
        rules.SHAPE_SIZE,
        rules.SPHERE_RADII,
        rules.INERTIA,
        rules.MISSING_BODY,
        rules.MISSING_TARGET,
        rules.BODY_REFERENCE,
    )
)
"""What makes a document valid, and changes nothing where it is."""
