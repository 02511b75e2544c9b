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
DECIMAL_COMMA = Rule(
    "repair-decimal-comma",
    _WARNING,
    "a comma was a decimal mark",
    "check the numbers; write them with a point, and separate them with blanks",
)
SURPLUS_VALUES = Rule(
    "repair-surplus-values",
    _WARNING,
    "a list of fixed length was longer",
    "the first values count; the whole list is kept in an extra nearby",
)
FAULTY_PROFILE = Rule(
    "repair-faulty-profile",
    _WARNING,
    "an element of the pe profile was not valid",
    "it is kept as text in an extra nearby; the common profile counts",
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
TOO_WIDE = Rule(
    "repair-too-many-attributes",
    _ERROR,
    "an element has more attributes or declarations of namespaces than can be mended",
    "no such element is COLLADA's; nothing was changed",
)
# Identifiers and references.
ID_FORM = Rule(
    "repair-id-form", _WARNING, "an id was not an NCName", "references to it were rewritten"
)
ID_DUPLICATE = Rule(
    "repair-duplicate-id",
    _WARNING,
    "an id was used more than once",
    "later ones were renamed; references go to the nearest definition of the kind they expect",
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
# Structure.
MISSPELT = Rule(
    "repair-misspelt-element",
    _WARNING,
    "an element's name was misspelt",
    "the standard's name is used",
)
WRAPPED = Rule(
    "repair-wrapper",
    _INFO,
    "an element stood beside the wrapper it belongs in, or inside one it does not",
    "values are unchanged",
)
STRAY = Rule(
    "repair-outside-library",
    _WARNING,
    "an element that belongs in a library stood outside of one",
    "it was moved into its library",
)
EMPTY_LIBRARY = Rule(
    "repair-empty-library", _INFO, "a library was empty", "the standard allows no empty libraries"
)
EMPTY_BINDING = Rule(
    "repair-empty-bind-material",
    _INFO,
    "a material binding bound nothing",
    "the standard asks for at least one material",
)
EMPTY_GEOMETRY = Rule(
    "repair-empty-geometry", _WARNING, "a geometry had no content", "complete it at its source"
)
# Shapes.
TAPERED = Rule(
    "upgrade-tapered-shape",
    _WARNING,
    "1.5 has no tapered shapes",
    "the shape is a convex mesh now; the original is kept in an extra",
)
CAPSULE_RADIUS = Rule(
    "upgrade-capsule-radius",
    _INFO,
    "a capsule has three radii in 1.5",
    "check capsules that are not round",
)
SHAPE_SIZE = Rule(
    "repair-shape-size",
    _WARNING,
    "a shape had too few numbers for its size",
    "the one number is taken for each of them",
)
SPHERE_RADII = Rule(
    "repair-sphere-radius",
    _WARNING,
    "a sphere had more than one radius",
    "equal radii are one; others are an ellipsoid's",
)
INLINE_MESH = Rule(
    "repair-inline-mesh", _WARNING, "a mesh stood directly in a shape", "shapes instance geometries"
)
SHAPE_SPLIT = Rule(
    "repair-shape-split",
    _WARNING,
    "a shape had several geometries",
    "write one shape for each geometry",
)
EMPTY_SHAPE = Rule(
    "repair-empty-shape",
    _INFO,
    "a shape was empty",
    "Bullet's converter writes one for every compound",
)
MISSING_SHAPE = Rule(
    "repair-missing-shape",
    _WARNING,
    "a rigid body had no shape",
    "the shape is assumed and marked so; give the body one at its source",
)
WINDING = Rule(
    "repair-winding",
    _WARNING,
    "the faces of a closed mesh were wound both ways",
    "faces run counter-clockwise, seen from outside",
)
# Bodies and constraints.
MISSING_SID = Rule(
    "repair-missing-sid",
    _WARNING,
    "a rigid body or constraint had no sid",
    "instances refer to it by its sid",
)
BARE_INSTANCE = Rule(
    "repair-bare-instance",
    _WARNING,
    "a body was instanced outside of its model's instance",
    "instance the physics model",
)
MISSING_ATTACHMENT = Rule(
    "repair-missing-attachment",
    _WARNING,
    "a constraint had one attachment only",
    "the other side is the world",
)
EMPTY_MASS_FRAME = Rule(
    "repair-empty-mass-frame", _INFO, "a mass_frame had no transforms", "it is the default one"
)
MASS_FRAME_ORIGIN = Rule(
    "repair-mass-frame-origin",
    _INFO,
    "a mass_frame turned, but did not say where it is",
    "without a translate it is at the origin of the body, not at its shapes",
)
MATRIX = Rule(
    "repair-matrix",
    _INFO,
    "a matrix stood where only translate and rotate may stand",
    "it was split into both",
)
INERTIA = Rule(
    "repair-inertia-matrix",
    _WARNING,
    "inertia was a tensor of six or nine numbers",
    "its principal values are given, in a turned mass_frame",
)
SCALED = Rule(
    "repair-scaled-node",
    _WARNING,
    "the node of a body was scaled or mirrored",
    "bodies are rigid: write their shapes in the size that they have",
)
# References.
MISSING_BODY = Rule(
    "repair-missing-body",
    _WARNING,
    "an instance did not say what it instances",
    "check the assumed body or constraint",
)
MISSING_TARGET = Rule(
    "repair-missing-target",
    _WARNING,
    "an instance of a body had no target node",
    "check the assumed node",
)
BODY_REFERENCE = Rule(
    "repair-body-reference",
    _INFO,
    "an instance named its body otherwise than by its plain sid",
    "the form that matched is reported",
)
ATTACHMENT_REFERENCE = Rule(
    "repair-attachment-reference",
    _INFO,
    "an attachment named its body otherwise than by model-id/sid",
    "the form that matched is reported",
)
HASH = Rule(
    "repair-url-hash",
    _INFO,
    "a reference within the document did not begin with #",
    "without # a url names another file",
)
DANGLING_INSTANCE = Rule(
    "repair-dangling-instance",
    _WARNING,
    "an instance or a constraint referred to what is not there",
    "it is kept in an extra nearby; add what it refers to, or correct the reference",
)
AMBIGUOUS_CONSTRAINT = Rule(
    "repair-ambiguous-constraint",
    _WARNING,
    "a constraint held a body that is instanced more than once in the same place",
    "instance the physics model twice instead, or give each instance a body of its own",
)
CYCLE = Rule(
    "repair-cycle",
    _WARNING,
    "a node or a physics model was instanced within itself",
    "it is kept in an extra nearby; instance something else",
)
DANGLING_SCENE = Rule(
    "repair-dangling-scene",
    _WARNING,
    "a physics scene was instanced that is not there",
    "check the scene that was taken",
)
MISSING_SCENE = Rule(
    "repair-missing-scene",
    _WARNING,
    "the document's scene put no physics scene into effect",
    "instance in <scene> the physics scene that you mean",
)
DANGLING_TARGET = Rule(
    "repair-dangling-target",
    _WARNING,
    "an instance of a body was to move a node that is not there",
    "check the node that was taken or added",
)
PARENT = Rule(
    "repair-parent",
    _WARNING,
    "the parent of a physics model's instance was not a node",
    "it is kept in an extra; the instance has no parent now",
)
INPUT_ARRAY = Rule(
    "repair-input-array",
    _INFO,
    "an input named an array instead of what holds it",
    "inputs refer to sources and vertices",
)
INPUT_PATH = Rule(
    "repair-input-path",
    _INFO,
    "an input named what it means by a path",
    "inputs refer to sources and vertices by their ids",
)
COUNT = Rule(
    "repair-count",
    _WARNING,
    "a count was not that of the values",
    "an array counts its values, an accessor the rows that it makes of them",
)
ESCAPED = Rule(
    "repair-escaped-reference",
    _INFO,
    "a reference held percent-escapes",
    "ids and sids are compared without",
)
SUFFIXED = Rule(
    "repair-suffixed-reference",
    _INFO,
    "a reference had the suffix that an instance gives to the ids of what it instances",
    "refer to the element itself",
)
# Images and effects.
EFFECT_IMAGE = Rule(
    "upgrade-effect-image",
    _INFO,
    "an image stood inside an effect",
    "1.5 has images in their library only",
)
IMAGE = Rule(
    "upgrade-image",
    _INFO,
    "an image's source is written otherwise in 1.5",
    "its location or data is unchanged",
)
SAMPLER = Rule(
    "upgrade-sampler",
    _INFO,
    "a sampler's content has no place in 1.5's schema",
    "it is kept in an extra of the profile",
)
SURFACE = Rule(
    "upgrade-surface",
    _INFO,
    "a surface has no place in 1.5",
    "it is kept in an extra of the profile",
)
SHADER_PROFILE = Rule(
    "upgrade-shader-profile",
    _WARNING,
    "a shader profile of 1.4 is built otherwise in 1.5",
    "it is kept whole in an extra of the effect",
)
# Conventions: what a producer means otherwise than the standard.
CONVENTION = Rule(
    "convention-chosen",
    _INFO,
    "the document follows a producer's own reading of the standard",
    'choose another with convention=..., or "none"',
)
FRAMES = Rule(
    "convention-frames",
    _INFO,
    "mass frames or shapes stood in the model's space",
    "they are in the body's space now",
)
FRAMES_LOCAL = Rule(
    "convention-frames-local",
    _INFO,
    "frames were taken to be in the body's space already",
    "the numbers say so, though the producer often writes them otherwise",
)
FRAMES_DOUBTFUL = Rule(
    "convention-frames-doubtful",
    _WARNING,
    "the numbers speak against the chosen reading of frames",
    "compare the result with what you expect",
)
ANGLE_UNIT = Rule(
    "convention-angle-unit",
    _INFO,
    "angles or angular velocities were in radians",
    "they are in degrees now, as the standard has them",
)
FREE_LIMITS = Rule(
    "convention-free-limits",
    _INFO,
    "a free axis was not written with infinite limits",
    "it is -INF to INF now",
)
WORLD_JOINT = Rule(
    "convention-world-joint",
    _INFO,
    "a joint had the same body at both ends",
    "Bullet writes joints to the world so; its frame there is where the body is now",
)
MASS_CENTRE = Rule(
    "convention-mass-centre",
    _INFO,
    "bodies had no mass_frame",
    "to Bullet the centre of mass is the origin of the node, wherever the shapes are",
)
INERT_SPRING = Rule(
    "convention-inert-spring",
    _INFO,
    "a spring without stiffness had a target that is no number",
    "it pulls nowhere; its target is kept in an extra",
)
PLANE_SIGN = Rule(
    "convention-plane-sign",
    _INFO,
    "a plane's constant had the opposite sign",
    "the standard's equation is n.x + D = 0",
)
HALF_HEIGHT = Rule(
    "convention-half-height",
    _INFO,
    "a height was written halved",
    "the standard has the full height",
)
AXIS = Rule(
    "convention-axis", _INFO, "a solid stood along z", "the standard's stand along y; it was turned"
)
GRAVITY_UNIT = Rule(
    "convention-gravity-unit",
    _WARNING,
    "gravity was in metres, whatever the document's unit",
    "it is in the document's unit now",
)
HOLLOW = Rule(
    "convention-hollow",
    _INFO,
    "shapes were called hollow without a mass of their own",
    "the producer writes so for solid shapes",
)
RESTITUTION = Rule(
    "convention-restitution",
    _INFO,
    "a restitution stood where a spring's target belongs",
    "it is kept in an extra",
)
RULES: tuple[Rule, ...] = tuple(
    value for value in list(globals().values()) if isinstance(value, Rule)
)
