"""The rules of the way back to COLLADA 1.4.1: what it cannot say, or says in other words."""

from __future__ import annotations

from colladaphy.findings import Rule, Severity

_INFO, _WARNING, _ERROR = Severity.INFO, Severity.WARNING, Severity.ERROR
_IN_EXTRA = "it is kept in an extra with the technique profile colladaphy-1.5"

ELEMENT_KEPT = Rule(
    "downgrade-element",
    _WARNING,
    f"an element that COLLADA 1.4.1 does not have: {_IN_EXTRA}",
    "a reader of 1.4.1 passes it over; write 1.5 where it matters",
    section="COLLADA 1.4.1 §extra",
    why="readers of 1.4.1 lack what it says",
)
ATTRIBUTE_KEPT = Rule(
    "downgrade-attribute",
    _INFO,
    f"an attribute that COLLADA 1.4.1 does not have: {_IN_EXTRA}",
    section="COLLADA 1.4.1 §extra",
    why="the schema of 1.4.1 would refuse the document",
)
LIBRARY_KEPT = Rule(
    "downgrade-library",
    _WARNING,
    f"a library that COLLADA 1.4.1 does not have: {_IN_EXTRA}",
    "a reader of 1.4.1 sees no kinematics, joints, articulated systems or formulas",
    section="COLLADA 1.4.1 §COLLADA",
    why="readers of 1.4.1 lack what the library holds",
)
BREP_KEPT = Rule(
    "downgrade-brep",
    _WARNING,
    f"a boundary representation, replaced by an empty convex mesh: {_IN_EXTRA}",
    "tessellate the geometry before you write 1.4.1",
    section="COLLADA 1.4.1 §convex_mesh",
    why="readers of 1.4.1 see nothing in its place",
)
PROFILE_KEPT = Rule(
    "downgrade-effect-profile",
    _WARNING,
    f"a shader profile in the form of 1.5: {_IN_EXTRA}",
    "profile_COMMON is the one that is carried over",
    section="COLLADA 1.4.1 §effect",
    why="readers of 1.4.1 show the surface by its common profile",
)
EMPTY_PROFILE = Rule(
    "downgrade-empty-profile",
    _WARNING,
    "an effect without profile_COMMON got an empty one, as 1.4.1 asks for a profile",
    section="COLLADA 1.4.1 §effect",
    why="readers of 1.4.1 show the surface as they show any without a colour",
)
EVALUATION_KEPT = Rule(
    "downgrade-evaluate-scene",
    _WARNING,
    f"a scene evaluation that COLLADA 1.4.1 cannot say: {_IN_EXTRA}",
    section="COLLADA 1.4.1 §evaluate_scene",
    why="readers of 1.4.1 show the scene in their own way",
)
ARRAY_CHANGED = Rule(
    "downgrade-array",
    _INFO,
    "an array of tokens or sid references was written as the Name_array of 1.4.1",
    section="COLLADA 1.4.1 §Name_array",
    why="the schema of 1.4.1 would refuse the document",
)
ARRAY_KEPT = Rule(
    "downgrade-array-kept",
    _WARNING,
    "an array whose items are no names is kept in a technique of its source",
    "a reader of 1.4.1 finds a source without data there",
    section="COLLADA 1.4.1 §Name_array",
    why="what reads the source finds nothing in 1.4.1",
)
NAME_CHANGED = Rule(
    "downgrade-name",
    _INFO,
    "a name with characters that 1.4.1 does not allow was changed",
    section="COLLADA 1.4.1 §Name_array",
    why="who looks for the old name does not find it",
)
IMAGE_KEPT = Rule(
    "downgrade-image",
    _WARNING,
    "an image that 1.4.1 can only say in part; the whole is kept in its extra",
    section="COLLADA 1.4.1 §image",
    why="readers of 1.4.1 see a part of the image's settings",
)
SAMPLER_CHANGED = Rule(
    "downgrade-sampler",
    _WARNING,
    "a sampler setting that COLLADA 1.4.1 does not have",
    "the nearest setting was written, the original is kept in the sampler's extra",
    section="COLLADA 1.4.1 §sampler2D",
    why="textures may repeat or blur otherwise",
)
OPAQUE_CHANGED = Rule(
    "downgrade-opaque",
    _INFO,
    "the opaque mode of a transparent colour was written as one that 1.4.1 has",
    section="COLLADA 1.4.1 §transparent",
    why="the schema of 1.4.1 would refuse the document",
)
OPAQUE_KEPT = Rule(
    "downgrade-opaque-kept",
    _WARNING,
    "a transparency whose opaque mode 1.4.1 does not have is kept in an extra",
    "a reader of 1.4.1 shows the material opaque",
    section="COLLADA 1.4.1 §transparent",
    why="what was seen through hides what is behind it",
)
CAPSULE_RADIUS = Rule(
    "downgrade-capsule-radius",
    _WARNING,
    "1.4.1 has two radii for a capsule; the radius along its axis is left out",
    section="COLLADA 1.4.1 §capsule",
    why="the caps are as high as they are wide for readers of 1.4.1",
)
BODY_ID = Rule(
    "downgrade-rigid-body-id",
    _INFO,
    "1.4.1 has no id on rigid bodies; references to it became references to the sid",
    section="COLLADA 1.4.1 §rigid_body",
    why="references to the id would lead nowhere",
)
SCHEMA_HINT = Rule(
    "downgrade-schema-hint",
    _INFO,
    "an xsi attribute that speaks of the 1.5 schema was left out",
    section="COLLADA 1.4.1 §COLLADA",
    why="validators would look for the wrong schema",
)
CONTENT_LEFT = Rule(
    "downgrade-foreign-content",
    _INFO,
    "content of a technique stays in the namespace of 1.5: it uses element names of 1.4.1",
    section="COLLADA 1.4.1 §technique",
    why="it would be taken for elements of 1.4.1 and refused",
)
INVALID = Rule(
    "downgrade-invalid",
    _ERROR,
    "the result is not valid COLLADA 1.4.1, so it was not written",
    "validate the document first; if it is valid, report this as a fault of colladaphy",
    section="COLLADA 1.4.1 §COLLADA",
    why="a file that is neither 1.4.1 nor 1.5 helps nobody",
)

RULES = (
    ELEMENT_KEPT,
    ATTRIBUTE_KEPT,
    LIBRARY_KEPT,
    BREP_KEPT,
    PROFILE_KEPT,
    EMPTY_PROFILE,
    EVALUATION_KEPT,
    ARRAY_CHANGED,
    ARRAY_KEPT,
    NAME_CHANGED,
    IMAGE_KEPT,
    SAMPLER_CHANGED,
    OPAQUE_CHANGED,
    OPAQUE_KEPT,
    CAPSULE_RADIUS,
    BODY_ID,
    SCHEMA_HINT,
    CONTENT_LEFT,
    INVALID,
)
