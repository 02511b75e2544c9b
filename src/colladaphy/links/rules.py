"""What can be wrong with the references of a document."""

from __future__ import annotations

from colladaphy.findings import Rule, Severity

__all__ = ["RULES"]

_ERROR = Severity.ERROR
_WARNING = Severity.WARNING

MISSING = Rule(
    "link-missing",
    _ERROR,
    "A reference leads nowhere.",
    "Correct the id or the path, or add the element that it names.",
    "COLLADA 1.5 §Address syntax",
)
WRONG_TYPE = Rule(
    "link-wrong-type",
    _ERROR,
    "A reference leads to an element of another type.",
    "Refer to an element of the type that is expected here.",
    "COLLADA 1.5 §Address syntax",
)
CYCLE = Rule(
    "link-cycle",
    _ERROR,
    "An element is instanced within itself.",
    "Break the circle of instance elements.",
    "COLLADA 1.5 §Instantiation",
)
BUDGET = Rule(
    "link-budget",
    _ERROR,
    "Instances of instances expand to more elements than the limit.",
    "If the file is trusted, raise the limit: colladaphy.read(..., limits=Limits(elements=...)).",
)
SEVERAL_PLACES = Rule(
    "link-several-places",
    _WARNING,
    "A node is instanced several times, so it stands in several places; the first one is taken.",
    "Let each rigid body target a node of its own.",
    "COLLADA 1.5 §instance_rigid_body",
)
NOT_RIGID = Rule(
    "link-not-rigid",
    _WARNING,
    "A node's transform scales, skews or mirrors, which a rigid body cannot.",
    "Apply the scale to the shapes, and leave only translate and rotate in the node.",
    "COLLADA 1.5 §rigid_body",
)
UNKNOWN_SCENE = Rule(
    "link-unknown-scene",
    _ERROR,
    "The document has no such physics scene or model.",
    "Look at doc.scenes for the scenes that there are.",
)
SCENE_ID = Rule(
    "store-scene-id",
    _ERROR,
    "A new scene cannot have this id.",
    "Choose an id that begins with a letter and that no element of the document has.",
)
UNIT = Rule(
    "store-unit",
    _ERROR,
    "A World has another unit or up axis than the document that it is to be stored in.",
    "Load into a World of the document's unit and axes: World(unit=doc.unit, up_axis=doc.up_axis).",
)

CONTENT = Rule(
    "store-content",
    _ERROR,
    "A document cannot be made of this.",
    "Pass a colladaphy_schema.Collada or an lxml tree, or read a file with colladaphy.read.",
)

RULES = (
    CONTENT,
    MISSING,
    WRONG_TYPE,
    CYCLE,
    BUDGET,
    SEVERAL_PLACES,
    NOT_RIGID,
    UNKNOWN_SCENE,
    SCENE_ID,
    UNIT,
)
