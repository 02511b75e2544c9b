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

# The way from 1.4 to 1.5.
VERSION = Rule(
    "upgrade-version",
    _INFO,
    "the document was COLLADA 1.4",
    "it is read as the same document in COLLADA 1.5",
    section="COLLADA 1.5 §COLLADA",
    why="everything after it has to know one version only",
)
SCHEMA_LOCATION = Rule(
    "upgrade-schema-location",
    _INFO,
    "the schema location named another version's schema",
    "it is only a hint and was removed",
    section="COLLADA 1.5 §COLLADA",
    why="validators would look for the wrong schema",
)
NAMESPACE_FIXED = Rule(
    "repair-namespace",
    _WARNING,
    "the COLLADA namespace was missing or unknown",
    "write the namespace of the version you mean",
    section="COLLADA 1.5 §COLLADA",
    why="without it, no program can tell that this is COLLADA",
)
VERSION_ATTRIBUTE = Rule(
    "repair-version",
    _INFO,
    "the version attribute did not fit the namespace",
    "the namespace decides",
    section="COLLADA 1.5 §COLLADA",
    why="programs that go by the attribute would read another version",
)
NOT_COLLADA = Rule(
    "repair-not-collada",
    _ERROR,
    "the document is not COLLADA",
    "its root must be <COLLADA>; nothing was changed",
    section="COLLADA 1.5 §COLLADA",
    why="there is nothing in it that could be mended",
)
TOO_WIDE = Rule(
    "repair-too-many-attributes",
    _ERROR,
    "an element has more attributes or declarations of namespaces than can be mended",
    "no such element is COLLADA's; nothing was changed",
    section="Namespaces in XML 1.0 §Declaring namespaces",
    why="to look through them takes longer the more there are, as in an attack",
)
# Identifiers and references.
ID_FORM = Rule(
    "repair-id-form",
    _WARNING,
    "an id was not an NCName",
    "references to it were rewritten",
    section="XML Schema 1.0 §ID",
    why="references cannot lead to it",
)
ID_DUPLICATE = Rule(
    "repair-duplicate-id",
    _WARNING,
    "an id was used more than once",
    "later ones were renamed; references go to the nearest definition of the kind they expect",
    section="COLLADA 1.5 §Address syntax",
    why="programs differ in which of the two a reference means",
)
SID_FORM = Rule(
    "repair-sid-form",
    _WARNING,
    "a sid was not an NCName",
    "references by it were rewritten",
    section="COLLADA 1.5 §Address syntax",
    why="paths of sids break at such a name",
)
SID_EMPTY = Rule(
    "repair-empty-sid",
    _INFO,
    "a sid was empty",
    "it was removed, or made up where one is required",
    section="COLLADA 1.5 §Address syntax",
    why="no path can lead to it",
)
SID_DUPLICATE = Rule(
    "repair-duplicate-sid",
    _WARNING,
    "a sid was used twice in one scope",
    "later ones were renamed",
    section="COLLADA 1.5 §Address syntax",
    why="programs differ in which of the two a path means",
)
# Structure.
MISSPELT = Rule(
    "repair-misspelt-element",
    _WARNING,
    "an element's name was misspelt",
    "the standard's name is used",
    section="COLLADA 1.5 §Schema concepts",
    why="programs pass over an element that they do not know",
)
WRAPPED = Rule(
    "repair-wrapper",
    _INFO,
    "an element stood beside the wrapper it belongs in, or inside one it does not",
    "values are unchanged",
    section="COLLADA 1.5 §Schema concepts",
    why="programs look for it in its place only",
)
STRAY = Rule(
    "repair-outside-library",
    _WARNING,
    "an element that belongs in a library stood outside of one",
    "it was moved into its library",
    section="COLLADA 1.5 §COLLADA",
    why="programs look for it in its library only",
)
EMPTY_LIBRARY = Rule(
    "repair-empty-library",
    _INFO,
    "a library was empty",
    "the standard allows no empty libraries",
    section="COLLADA 1.5 §COLLADA",
    why="strict readers refuse the document",
)
EMPTY_BINDING = Rule(
    "repair-empty-bind-material",
    _INFO,
    "a material binding bound nothing",
    "the standard asks for at least one material",
    section="COLLADA 1.5 §bind_material",
    why="strict readers refuse the document",
)
EMPTY_GEOMETRY = Rule(
    "repair-empty-geometry",
    _WARNING,
    "a geometry had no content",
    "complete it at its source",
    section="COLLADA 1.5 §geometry",
    why="there is nothing to show or to collide with",
)
# Shapes.
TAPERED = Rule(
    "upgrade-tapered-shape",
    _WARNING,
    "1.5 has no tapered shapes",
    "the shape is a convex mesh now; the original is kept in an extra",
    section="COLLADA 1.4.1 §tapered_cylinder",
    why="without it, the body would lose its shape",
)
CAPSULE_RADIUS = Rule(
    "upgrade-capsule-radius",
    _INFO,
    "a capsule has three radii in 1.5",
    "check capsules that are not round",
    section="COLLADA 1.5 §capsule",
    why="a capsule with two radii is not valid in 1.5",
)
SHAPE_SIZE = Rule(
    "repair-shape-size",
    _WARNING,
    "a shape had too few numbers for its size",
    "the one number is taken for each of them",
    section="COLLADA 1.5 §box",
    why="programs take zero for what is missing",
)
SPHERE_RADII = Rule(
    "repair-sphere-radius",
    _WARNING,
    "a sphere had more than one radius",
    "equal radii are one; others are an ellipsoid's",
    section="COLLADA 1.5 §sphere",
    why="programs take the first of them only",
)
INLINE_MESH = Rule(
    "repair-inline-mesh",
    _WARNING,
    "a mesh stood directly in a shape",
    "shapes instance geometries",
    section="COLLADA 1.5 §shape",
    why="strict readers refuse the document, and others lose the mesh",
)
SHAPE_SPLIT = Rule(
    "repair-shape-split",
    _WARNING,
    "a shape had several geometries",
    "write one shape for each geometry",
    section="COLLADA 1.5 §shape",
    why="programs take one of the geometries, and lose the others",
)
EMPTY_SHAPE = Rule(
    "repair-empty-shape",
    _INFO,
    "a shape was empty",
    "Bullet's converter writes one for every compound",
    section="COLLADA 1.5 §shape",
    why="strict readers refuse the document",
)
MISSING_SHAPE = Rule(
    "repair-missing-shape",
    _WARNING,
    "a rigid body had no shape",
    "the shape is assumed and marked so; give the body one at its source",
    section="COLLADA 1.5 §rigid_body",
    why="a body without a shape is not valid",
)
WINDING = Rule(
    "repair-winding",
    _WARNING,
    "the faces of a closed mesh were wound both ways",
    "faces run counter-clockwise, seen from outside",
    section="COLLADA 1.5 §mesh",
    why="volume and inertia come out wrong, or negative",
)
# Bodies and constraints.
MISSING_SID = Rule(
    "repair-missing-sid",
    _WARNING,
    "a rigid body or constraint had no sid",
    "instances refer to it by its sid",
    section="COLLADA 1.5 §rigid_body",
    why="no instance could name it",
)
BARE_INSTANCE = Rule(
    "repair-bare-instance",
    _WARNING,
    "a body was instanced outside of its model's instance",
    "instance the physics model",
    section="COLLADA 1.5 §instance_physics_model",
    why="a body's model must be instanced to be in the scene",
)
MISSING_ATTACHMENT = Rule(
    "repair-missing-attachment",
    _WARNING,
    "a constraint had one attachment only",
    "the other side is the world",
    section="COLLADA 1.5 §rigid_constraint",
    why="a joint needs two ends",
)
EMPTY_MASS_FRAME = Rule(
    "repair-empty-mass-frame",
    _INFO,
    "a mass_frame had no transforms",
    "it is the default one",
    section="COLLADA 1.5 §mass_frame",
    why="strict readers refuse the document",
)
MASS_FRAME_ORIGIN = Rule(
    "repair-mass-frame-origin",
    _INFO,
    "a mass_frame turned, but did not say where it is",
    "without a translate it is at the origin of the body, not at its shapes",
    section="COLLADA 1.5 §mass_frame",
    why="programs differ in where they take the centre of mass to be",
)
MATRIX = Rule(
    "repair-matrix",
    _INFO,
    "a matrix stood where only translate and rotate may stand",
    "it was split into both",
    section="COLLADA 1.5 §mass_frame",
    why="strict readers refuse the document",
)
INERTIA = Rule(
    "repair-inertia-matrix",
    _WARNING,
    "inertia was a tensor of six or nine numbers",
    "its principal values are given, in a turned mass_frame",
    section="COLLADA 1.5 §inertia",
    why="programs take the first three of the numbers for the principal moments",
)
SCALED = Rule(
    "repair-scaled-node",
    _WARNING,
    "the node of a body was scaled or mirrored",
    "bodies are rigid: write their shapes in the size that they have",
    section="COLLADA 1.5 §instance_rigid_body",
    why="physics would collide with other sizes than are shown",
)
# References.
MISSING_BODY = Rule(
    "repair-missing-body",
    _WARNING,
    "an instance did not say what it instances",
    "check the assumed body or constraint",
    section="COLLADA 1.5 §instance_rigid_body",
    why="without it, nothing is instanced",
)
MISSING_TARGET = Rule(
    "repair-missing-target",
    _WARNING,
    "an instance of a body had no target node",
    "check the assumed node",
    section="COLLADA 1.5 §instance_rigid_body",
    why="the body would be nowhere, and move nothing",
)
BODY_REFERENCE = Rule(
    "repair-body-reference",
    _INFO,
    "an instance named its body otherwise than by its plain sid",
    "the form that matched is reported",
    section="COLLADA 1.5 §instance_rigid_body",
    why="programs that look for a sid do not find the body",
)
ATTACHMENT_REFERENCE = Rule(
    "repair-attachment-reference",
    _INFO,
    "an attachment named its body otherwise than by model-id/sid",
    "the form that matched is reported",
    section="COLLADA 1.5 §attachment",
    why="programs that look for model and sid do not find the body",
)
HASH = Rule(
    "repair-url-hash",
    _INFO,
    "a reference within the document did not begin with #",
    "without # a url names another file",
    section="COLLADA 1.5 §Address syntax",
    why="programs look for a file of that name",
)
DANGLING_INSTANCE = Rule(
    "repair-dangling-instance",
    _WARNING,
    "an instance or a constraint referred to what is not there",
    "it is kept in an extra nearby; add what it refers to, or correct the reference",
    section="COLLADA 1.5 §Instantiation",
    why="strict readers stop there",
)
AMBIGUOUS_CONSTRAINT = Rule(
    "repair-ambiguous-constraint",
    _WARNING,
    "a constraint held a body that is instanced more than once in the same place",
    "instance the physics model twice instead, or give each instance a body of its own",
    section="COLLADA 1.5 §rigid_constraint",
    why="programs differ in which of the two bodies they hold",
)
CYCLE = Rule(
    "repair-cycle",
    _WARNING,
    "a node or a physics model was instanced within itself",
    "it is kept in an extra nearby; instance something else",
    section="COLLADA 1.5 §Instantiation",
    why="a program that follows the circle never ends",
)
DANGLING_SCENE = Rule(
    "repair-dangling-scene",
    _WARNING,
    "a physics scene was instanced that is not there",
    "check the scene that was taken",
    section="COLLADA 1.5 §instance_physics_scene",
    why="nothing would be simulated",
)
MISSING_SCENE = Rule(
    "repair-missing-scene",
    _WARNING,
    "the document's scene put no physics scene into effect",
    "instance in <scene> the physics scene that you mean",
    section="COLLADA 1.5 §scene",
    why="nothing would be simulated",
)
DANGLING_TARGET = Rule(
    "repair-dangling-target",
    _WARNING,
    "an instance of a body was to move a node that is not there",
    "check the node that was taken or added",
    section="COLLADA 1.5 §instance_rigid_body",
    why="the body would be nowhere, and move nothing",
)
PARENT = Rule(
    "repair-parent",
    _WARNING,
    "the parent of a physics model's instance was not a node",
    "it is kept in an extra; the instance has no parent now",
    section="COLLADA 1.5 §instance_physics_model",
    why="programs differ in where they place the model",
)
INPUT_ARRAY = Rule(
    "repair-input-array",
    _INFO,
    "an input named an array instead of what holds it",
    "inputs refer to sources and vertices",
    section="COLLADA 1.5 §input",
    why="programs that look for a source do not find the values",
)
INPUT_PATH = Rule(
    "repair-input-path",
    _INFO,
    "an input named what it means by a path",
    "inputs refer to sources and vertices by their ids",
    section="COLLADA 1.5 §input",
    why="programs that look for an id do not find the values",
)
COUNT = Rule(
    "repair-count",
    _WARNING,
    "a count was not that of the values",
    "an array counts its values, an accessor the rows that it makes of them",
    section="COLLADA 1.5 §accessor",
    why="programs read too few values, or beyond the last",
)
ESCAPED = Rule(
    "repair-escaped-reference",
    _INFO,
    "a reference held percent-escapes",
    "ids and sids are compared without",
    section="COLLADA 1.5 §Address syntax",
    why="programs that do not unescape it do not find its target",
)
SUFFIXED = Rule(
    "repair-suffixed-reference",
    _INFO,
    "a reference had the suffix that an instance gives to the ids of what it instances",
    "refer to the element itself",
    section="COLLADA 1.5 §Address syntax",
    why="the id is there in the program that wrote it only",
)
# Images and effects.
EFFECT_IMAGE = Rule(
    "upgrade-effect-image",
    _INFO,
    "an image stood inside an effect",
    "1.5 has images in their library only",
    section="COLLADA 1.5 §image",
    why="an image inside an effect is not valid in 1.5",
)
IMAGE = Rule(
    "upgrade-image",
    _INFO,
    "an image's source is written otherwise in 1.5",
    "its location or data is unchanged",
    section="COLLADA 1.5 §init_from",
    why="the image would not be found",
)
SAMPLER = Rule(
    "upgrade-sampler",
    _INFO,
    "a sampler's content has no place in 1.5's schema",
    "it is kept in an extra of the profile",
    section="COLLADA 1.5 §sampler2D",
    why="it would not be valid in 1.5",
)
SURFACE = Rule(
    "upgrade-surface",
    _INFO,
    "a surface has no place in 1.5",
    "it is kept in an extra of the profile",
    section="COLLADA 1.5 §sampler2D",
    why="it would not be valid in 1.5",
)
SHADER_PROFILE = Rule(
    "upgrade-shader-profile",
    _WARNING,
    "a shader profile of 1.4 is built otherwise in 1.5",
    "it is kept whole in an extra of the effect",
    section="COLLADA 1.5 §effect",
    why="it would not be valid in 1.5",
)
# Conventions: what a producer means otherwise than the standard.
CONVENTION = Rule(
    "convention-chosen",
    _INFO,
    "the document follows a producer's own reading of the standard",
    'choose another with convention=..., or "none"',
    section="COLLADA 1.5 §authoring_tool",
    why="the same numbers mean different things to different producers",
)
FRAMES = Rule(
    "convention-frames",
    _INFO,
    "mass frames or shapes stood in the model's space",
    "they are in the body's space now",
    section="COLLADA 1.5 §mass_frame",
    why="centres of mass and shapes would be off by the body's own pose",
)
FRAMES_LOCAL = Rule(
    "convention-frames-local",
    _INFO,
    "frames were taken to be in the body's space already",
    "the numbers say so, though the producer often writes them otherwise",
    section="COLLADA 1.5 §mass_frame",
    why="to move them again would put them wrong",
)
FRAMES_DOUBTFUL = Rule(
    "convention-frames-doubtful",
    _WARNING,
    "the numbers speak against the chosen reading of frames",
    "compare the result with what you expect",
    section="COLLADA 1.5 §mass_frame",
    why="if the reading is wrong, bodies are off by their own pose",
)
ANGLE_UNIT = Rule(
    "convention-angle-unit",
    _INFO,
    "angles or angular velocities were in radians",
    "they are in degrees now, as the standard has them",
    section="COLLADA 1.5 §limits",
    why="limits and spins would be 57 times too small",
)
FREE_LIMITS = Rule(
    "convention-free-limits",
    _INFO,
    "a free axis was not written with infinite limits",
    "it is -INF to INF now",
    section="COLLADA 1.5 §limits",
    why="the axis would be locked",
)
WORLD_JOINT = Rule(
    "convention-world-joint",
    _INFO,
    "a joint had the same body at both ends",
    "Bullet writes joints to the world so; its frame there is where the body is now",
    section="COLLADA 1.5 §ref_attachment",
    why="a joint of a body with itself holds nothing",
)
MASS_CENTRE = Rule(
    "convention-mass-centre",
    _INFO,
    "bodies had no mass_frame",
    "to Bullet the centre of mass is the origin of the node, wherever the shapes are",
    section="COLLADA 1.5 §mass_frame",
    why="the body would turn about the centre of its shapes",
)
INERT_SPRING = Rule(
    "convention-inert-spring",
    _INFO,
    "a spring without stiffness had a target that is no number",
    "it pulls nowhere; its target is kept in an extra",
    section="COLLADA 1.5 §spring",
    why="one value that is no number spoils all that are computed with it",
)
PLANE_SIGN = Rule(
    "convention-plane-sign",
    _INFO,
    "a plane's constant had the opposite sign",
    "the standard's equation is n.x + D = 0",
    section="COLLADA 1.5 §plane",
    why="the ground would be as far below as it should be above",
)
HALF_HEIGHT = Rule(
    "convention-half-height",
    _INFO,
    "a height was written halved",
    "the standard has the full height",
    section="COLLADA 1.5 §cylinder",
    why="shapes would have half of their height",
)
AXIS = Rule(
    "convention-axis",
    _INFO,
    "a solid stood along z",
    "the standard's stand along y; it was turned",
    section="COLLADA 1.5 §cylinder",
    why="shapes would lie that should stand",
)
GRAVITY_UNIT = Rule(
    "convention-gravity-unit",
    _WARNING,
    "gravity was in metres, whatever the document's unit",
    "it is in the document's unit now",
    section="COLLADA 1.5 §gravity",
    why="bodies would fall too fast or too slowly by the unit's factor",
)
HOLLOW = Rule(
    "convention-hollow",
    _INFO,
    "shapes were called hollow without a mass of their own",
    "the producer writes so for solid shapes",
    section="COLLADA 1.5 §hollow",
    why="the mass would be that of a shell",
)
RESTITUTION = Rule(
    "convention-restitution",
    _INFO,
    "a restitution stood where a spring's target belongs",
    "it is kept in an extra",
    section="COLLADA 1.5 §spring",
    why="the spring would pull to a place that nobody meant",
)
RULES: tuple[Rule, ...] = tuple(
    value for value in list(globals().values()) if isinstance(value, Rule)
)
