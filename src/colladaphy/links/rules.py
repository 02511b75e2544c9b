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
    why="What it should name is missing wherever the document is used.",
)
WRONG_TYPE = Rule(
    "link-wrong-type",
    _ERROR,
    "A reference leads to an element of another type.",
    "Refer to an element of the type that is expected here.",
    "COLLADA 1.5 §Address syntax",
    why="Programs find something that they cannot use in its place.",
)
CYCLE = Rule(
    "link-cycle",
    _ERROR,
    "An element is instanced within itself.",
    "Break the circle of instance elements.",
    "COLLADA 1.5 §Instantiation",
    why="A program that follows the circle never ends.",
)
BUDGET = Rule(
    "link-budget",
    _ERROR,
    "Instances of instances expand to more elements than the limit.",
    "If the file is trusted, raise the limit: colladaphy.read(..., limits=Limits(elements=...)).",
    section="COLLADA 1.5 §Instantiation",
    why="A small file could fill the memory.",
)
SEVERAL_PLACES = Rule(
    "link-several-places",
    _WARNING,
    "A node is instanced several times, so it stands in several places; the first one is taken.",
    "Let each rigid body target a node of its own.",
    "COLLADA 1.5 §instance_rigid_body",
    why="A body is in one place only.",
)
NOT_RIGID = Rule(
    "link-not-rigid",
    _WARNING,
    "A node's transform scales, skews or mirrors, which a rigid body cannot.",
    "Apply the scale to the shapes, and leave only translate and rotate in the node.",
    "COLLADA 1.5 §rigid_body",
    why="Physics would collide with other sizes than are shown.",
)
UNKNOWN_SCENE = Rule(
    "link-unknown-scene",
    _ERROR,
    "The document has no such physics scene or model.",
    "Look at doc.scenes for the scenes that there are.",
    section="COLLADA 1.5 §Address syntax",
    why="There is nothing to load.",
)
SCENE_ID = Rule(
    "store-scene-id",
    _ERROR,
    "A new scene cannot have this id.",
    "Choose an id that begins with a letter and that no element of the document has.",
    section="COLLADA 1.5 §Address syntax",
    why="Two elements of one id cannot be told apart by references.",
)
UNIT = Rule(
    "store-unit",
    _ERROR,
    "A World has another unit or up axis than the document that it is to be stored in.",
    "Load into a World of the document's unit and axes: World(unit=doc.unit, up_axis=doc.up_axis).",
    section="COLLADA 1.5 §unit",
    why="Every length, mass and force would be off by the units' factor.",
)

CONTENT = Rule(
    "store-content",
    _ERROR,
    "A document cannot be made of this.",
    "Pass a colladaphy_schema.Collada or an lxml tree, or read a file with colladaphy.read.",
    section="colladaphy.Document",
    why="What is neither tree nor objects has no elements to write.",
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
