"""Which repairs are about what: the version, the children of elements, the form as a whole."""

from __future__ import annotations

from colladaphy.conform import (
    body_rules,
    effect_rules,
    form_rules,
    name_rules,
    reference_rules,
    shape_rules,
    structure_rules,
    version_rules,
)

__all__ = ["FORM", "STRUCTURE", "UPGRADE"]

UPGRADE = frozenset(
    rule.code
    for rule in (*version_rules.RULES, *effect_rules.RULES, *shape_rules.RULES)
    if rule.stage == "upgrade"
    or rule in (version_rules.NAMESPACE_FIXED, version_rules.VERSION_ATTRIBUTE)
)
"""What makes another version's elements those of 1.5."""

STRUCTURE = frozenset(
    rule.code
    for rule in (
        form_rules.CHILD_ORDER,
        form_rules.UNEXPECTED_ELEMENT,
        form_rules.MISSING_ELEMENT,
        form_rules.INCOMPLETE_ELEMENT,
        structure_rules.MISSPELT,
        structure_rules.WRAPPED,
        structure_rules.STRAY,
        structure_rules.EMPTY_LIBRARY,
        structure_rules.EMPTY_BINDING,
        structure_rules.EMPTY_GEOMETRY,
        shape_rules.INLINE_MESH,
        shape_rules.SHAPE_SPLIT,
        shape_rules.EMPTY_SHAPE,
        shape_rules.MISSING_SHAPE,
        body_rules.BARE_INSTANCE,
        body_rules.MISSING_ATTACHMENT,
        body_rules.EMPTY_MASS_FRAME,
        body_rules.MATRIX,
    )
)
"""What puts children where the schema has them."""

FORM = STRUCTURE | frozenset(
    rule.code
    for rule in (
        form_rules.UNEXPECTED_TEXT,
        form_rules.UNKNOWN_ATTRIBUTE,
        form_rules.MISSING_ATTRIBUTE,
        form_rules.LEXICAL_FORM,
        form_rules.DECIMAL_COMMA,
        form_rules.SURPLUS_VALUES,
        form_rules.FAULTY_PROFILE,
        form_rules.UNREADABLE_VALUE,
        version_rules.VERSION_ATTRIBUTE,
        version_rules.NAMESPACE_FIXED,
        name_rules.ID_FORM,
        name_rules.ID_DUPLICATE,
        name_rules.SID_FORM,
        name_rules.SID_EMPTY,
        body_rules.MISSING_SID,
        shape_rules.CAPSULE_RADIUS,
        shape_rules.SHAPE_SIZE,
        shape_rules.SPHERE_RADII,
        body_rules.INERTIA,
        reference_rules.MISSING_BODY,
        reference_rules.MISSING_TARGET,
        reference_rules.BODY_REFERENCE,
    )
)
"""What makes a document valid, and changes nothing where it is."""
