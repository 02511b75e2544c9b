"""What can be wrong with references in a document that is schema-valid."""

from __future__ import annotations

from colladaphy.findings import Rule, Severity

__all__ = ["RULES"]

NO_HASH = Rule(
    "link-no-hash",
    Severity.WARNING,
    "A reference to an element of the same document has no '#'.",
    "Write '#' before the id.",
    "COLLADA 1.5 §Address syntax",
    "By the standard it is the name of a file; most readers find nothing.",
)
BODY_TWICE = Rule(
    "link-body-twice",
    Severity.ERROR,
    "A body that a constraint attaches to is instanced twice in one instance of its model.",
    "Instance the physics model twice instead, or give each instance a rigid_body of its own.",
    "thesis 3.3",
    "Which of the two the constraint means cannot be told, so the scene is not loaded.",
)
BODY_NOT_INSTANCED = Rule(
    "link-body-not-instanced",
    Severity.WARNING,
    "A constraint that is instanced attaches to a body that is not.",
    "Instance the body too, or leave the instance of the constraint out.",
    "COLLADA 1.5 §instance_physics_model",
    "There is nothing to bind, so the constraint is left out.",
)
DUPLICATE_SID = Rule(
    "link-duplicate-sid",
    Severity.WARNING,
    "Two siblings have the same scoped id.",
    "Rename one of them, and what refers to it.",
    "COLLADA 1.5 §Address syntax",
    "An address with that sid means the first one only.",
)
IMAGE_MISSING = Rule(
    "link-image-missing",
    Severity.WARNING,
    "The file of an image is not there.",
    "Put the file where the reference says, or correct the reference.",
    "COLLADA 1.5 §init_from",
    "Surfaces are shown without it.",
)
IMAGE_EMPTY = Rule(
    "link-image-empty",
    Severity.WARNING,
    "An image names no file.",
    "Give it the name of a file, or remove the image and what uses it.",
    "COLLADA 1.5 §init_from",
    why="Surfaces with it show no picture.",
)
IMAGE_ABSOLUTE = Rule(
    "link-image-absolute",
    Severity.WARNING,
    "An image is named by its place on one computer.",
    "Put the file beside the document, and name it relative to the document.",
    "COLLADA 1.5 §init_from",
    "The file is found on that computer only.",
)
MATERIAL_SYMBOL = Rule(
    "link-material-symbol",
    Severity.WARNING,
    "A material is bound to a symbol that no primitive of the geometry has.",
    "Let the symbol be the material attribute of a primitive.",
    "COLLADA 1.5 §instance_material",
    "The material is not seen.",
)
MATERIAL_UNBOUND = Rule(
    "link-material-unbound",
    Severity.WARNING,
    "A primitive has a material symbol that is not bound to a material.",
    "Add an <instance_material> with that symbol.",
    "COLLADA 1.5 §bind_material",
    "The primitive is shown without a material.",
)
MATERIAL_TWICE = Rule(
    "link-material-twice",
    Severity.WARNING,
    "A symbol is bound to two materials.",
    "Remove one of them.",
    "COLLADA 1.5 §bind_material",
    why="Programs differ in which of the two they show.",
)
VERTEX_INPUT = Rule(
    "link-vertex-input",
    Severity.WARNING,
    "A vertex input is bound to what the mesh does not have.",
    "Bind it to a semantic and set that an input of the primitive has.",
    "COLLADA 1.5 §bind_vertex_input",
    "The texture has no coordinates.",
)
PARAMETER_TYPE = Rule(
    "link-parameter-type",
    Severity.WARNING,
    "A parameter of an effect is of another type than is needed.",
    "Let it be of the type that is needed, or name another parameter.",
    "COLLADA 1.5 §setparam",
    why="Programs take the value for another one, or leave it out.",
)
TEXTURE_SAMPLER = Rule(
    "link-texture-sampler",
    Severity.WARNING,
    "A texture names no sampler of its effect.",
    "Let it be the sid of a <newparam> with a <sampler2D>, in the profile or the effect.",
    "COLLADA 1.5 §texture",
    "The surface is shown without it.",
)
TEXTURE_COORDINATES = Rule(
    "link-texture-coordinates",
    Severity.WARNING,
    "The coordinates of a texture are bound by no vertex input.",
    "Add a <bind_vertex_input> of that semantic to the <instance_material>.",
    "COLLADA 1.5 §texture",
    "Where the texture lies on the surface cannot be told.",
)
CHANNEL_MEMBER = Rule(
    "link-channel-member",
    Severity.WARNING,
    "A channel moves a member that its target does not have.",
    "X Y Z of vectors, ANGLE of rotations, R G B A of colours, (row)(column) of matrices.",
    "COLLADA 1.5 §channel",
    "The animation does nothing.",
)

CONSTRAINT_TWICE = Rule(
    "link-constraint-twice",
    Severity.WARNING,
    "A constraint is instanced twice in one instance of its model.",
    "Remove one of the instances.",
    "COLLADA 1.5 §instance_rigid_constraint",
    "The bodies are bound twice, and springs are twice as stiff.",
)
SCENE_TWICE = Rule(
    "link-scene-twice",
    Severity.WARNING,
    "A physics scene is instanced twice.",
    "Remove one of the instances.",
    "COLLADA 1.5 §instance_physics_scene",
    "All bodies are there twice, in the same places.",
)
NODE_NOWHERE = Rule(
    "link-node-nowhere",
    Severity.WARNING,
    "The node that a body moves stands in no scene.",
    "Instance the node in the visual scene, or name another one.",
    "COLLADA 1.5 §instance_rigid_body",
    "Where the body is cannot be told, and nothing that is seen moves.",
)

RULES = (
    CONSTRAINT_TWICE,
    SCENE_TWICE,
    NODE_NOWHERE,
    NO_HASH,
    BODY_TWICE,
    BODY_NOT_INSTANCED,
    DUPLICATE_SID,
    IMAGE_MISSING,
    IMAGE_EMPTY,
    IMAGE_ABSOLUTE,
    MATERIAL_SYMBOL,
    MATERIAL_UNBOUND,
    MATERIAL_TWICE,
    VERTEX_INPUT,
    PARAMETER_TYPE,
    TEXTURE_SAMPLER,
    TEXTURE_COORDINATES,
    CHANNEL_MEMBER,
)
