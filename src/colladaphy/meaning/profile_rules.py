"""What can be wrong with the pe profile in a document that is schema-valid."""

from __future__ import annotations

from colladaphy.findings import Rule, Severity

__all__ = ["RULES"]

PE = "urn:colladaphy:pe:1"

PLACE = Rule(
    "profile-place",
    Severity.WARNING,
    "An element of the pe profile stands where nobody looks for it.",
    "pe:world belongs in a physics_scene, pe:body in a rigid_body, pe:motion in an "
    "instance_rigid_body, pe:joint in a rigid_constraint, pe:material in a physics_material.",
    "docs/pe-profile.md",
    "It is not read.",
)
TECHNIQUE = Rule(
    "profile-technique",
    Severity.WARNING,
    "An element of the pe profile stands in the technique of another profile.",
    'Write <technique profile="pe">.',
    "docs/pe-profile.md",
    "It is not read.",
)
NAMESPACE = Rule(
    "profile-namespace",
    Severity.WARNING,
    "A technique of the pe profile holds an element of another namespace.",
    f'The namespace is xmlns:pe="{PE}".',
    "docs/pe-profile.md",
    "It is not read.",
)
NUMBER = Rule(
    "profile-number",
    Severity.ERROR,
    "A value of the pe profile is no number.",
    "Replace NaN and INF by numbers.",
    "docs/pe-profile.md",
    "After one step the body is nowhere.",
)
QUATERNION = Rule(
    "profile-quaternion",
    Severity.WARNING,
    "An orientation of the pe profile is 0 0 0 0.",
    "Write it in the order w x y z; 1 0 0 0 is not turned.",
    "docs/pe-profile.md",
    "It is no rotation, and is taken for none.",
)
SYSTEM_ID = Rule(
    "profile-system-id",
    Severity.WARNING,
    "Two bodies, or two joints, of a model have the same system id, or one has none.",
    "Give each its own, from 1 on, or leave the ids out.",
    "thesis 6.1",
    "The second one gets the next free id.",
)
UNION = Rule(
    "profile-union",
    Severity.WARNING,
    "The pe profile tells of another number of shapes than the body has.",
    "Write the document again with colladaphy, or remove the profile of the body.",
    "thesis 4.3",
    "Which shape is which cannot be told, and the profile is not used.",
)
OLD_VALUE = Rule(
    "profile-old-value",
    Severity.WARNING,
    "A value of the pe profile is not that of the common profile.",
    "Correct the one that is wrong, remove the value from the profile, or load with "
    'prefer="profile".',
    "thesis 6.2.1",
    "Programs that know the profile and those that do not see different scenes; loading takes the "
    "common value, as the newer one.",
)

VALUE = Rule(
    "profile-value",
    Severity.ERROR,
    "A value of the pe profile is out of its range.",
    "Masses are not negative, densities and sizes are positive, an inertia is symmetric and that "
    "of a body, and no lower limit is above the upper one.",
    "docs/pe-profile.md",
    "No World can hold it.",
)
ENGINE_STATE = Rule(
    "profile-engine-state",
    Severity.WARNING,
    "The state of an engine does not fit its checksum.",
    "Write the checkpoint again.",
    "thesis 6.1",
    "It is left out: the simulation goes on from the bodies' state alone, not exactly as it would.",
)

TWICE = Rule(
    "profile-twice",
    Severity.WARNING,
    "The pe profile of an element, or a pair of materials, is there twice.",
    "Remove one of them.",
    "docs/pe-profile.md",
    "Only one of them counts.",
)

RULES = (
    TWICE,
    VALUE,
    ENGINE_STATE,
    PLACE,
    TECHNIQUE,
    NAMESPACE,
    NUMBER,
    QUATERNION,
    SYSTEM_ID,
    UNION,
    OLD_VALUE,
)
