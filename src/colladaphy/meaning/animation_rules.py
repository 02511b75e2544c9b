"""What can be wrong with skins, morphs and animations in a document that is schema-valid."""

from __future__ import annotations

from colladaphy.findings import Rule, Severity

__all__ = ["RULES"]

SKIN_COUNT = Rule(
    "animation-skin-count",
    Severity.ERROR,
    "The weights of a skin are not those of as many vertices as there are.",
    "There is one number in <vcount>, and its pairs in <v>, for every vertex of the geometry.",
    "COLLADA 1.5 §vertex_weights",
    "Vertices are moved by the weights of others, or not at all.",
)
SKIN_INDEX = Rule(
    "animation-skin-index",
    Severity.ERROR,
    "A skin refers to a joint or a weight that is not there.",
    "Correct the index, or add the joint or weight.",
    "COLLADA 1.5 §vertex_weights",
    "There is nothing to move the vertex by; readers refuse the skin, or crash.",
)
SKIN_SUM = Rule(
    "animation-skin-sum",
    Severity.WARNING,
    "The weights of a vertex do not add up to 1.",
    "Divide the weights of a vertex by their sum.",
    "COLLADA 1.5 §vertex_weights",
    "The vertex is drawn towards the origin, or away from it.",
)
SKIN_BIND = Rule(
    "animation-skin-bind",
    Severity.ERROR,
    "There are not as many inverse bind matrices as joints.",
    "Give every joint one matrix.",
    "COLLADA 1.5 §joints",
    "Joints are left without a matrix, or have that of another one.",
)
SKIN_JOINT = Rule(
    "animation-skin-joint",
    Severity.WARNING,
    "A joint of a skin is the scoped id of no node.",
    "Let the names be the sids of the nodes of the skeleton.",
    "COLLADA 1.5 §skin",
    "The vertices of that joint do not move.",
)
MORPH_TARGETS = Rule(
    "animation-morph-targets",
    Severity.ERROR,
    "The targets of a morph do not fit its weights or its geometry.",
    "Give every target one weight, and as many vertices as the geometry has.",
    "COLLADA 1.5 §morph",
    "Weights are those of other targets, or vertices are mixed that do not belong together.",
)
KEY_COUNT = Rule(
    "animation-key-count",
    Severity.ERROR,
    "The inputs of a sampler differ in number.",
    "Give every key one time, one output and one interpolation.",
    "COLLADA 1.5 §sampler",
    "Keys are left without a value.",
)
KEY_ORDER = Rule(
    "animation-key-order",
    Severity.WARNING,
    "The times of a sampler do not ascend.",
    "Sort the keys by time, each time once.",
    "COLLADA 1.5 §sampler",
    "What is between two keys cannot be told.",
)
INTERPOLATION = Rule(
    "animation-interpolation",
    Severity.WARNING,
    "An interpolation is not known, or lacks its tangents.",
    "LINEAR, BEZIER, CARDINAL, HERMITE, BSPLINE or STEP; BEZIER and HERMITE with IN_TANGENT and "
    "OUT_TANGENT.",
    "COLLADA 1.5 §sampler",
    why="Programs differ in how they move between the keys.",
)
OUTPUT_WIDTH = Rule(
    "animation-output-width",
    Severity.WARNING,
    "A sampler has another number of values in a key than the target of its channel.",
    "Give every key as many values as the target has: 1 for a member, 3 for a translation.",
    "COLLADA 1.5 §channel",
    "The animation does nothing, or moves something else.",
)
TANGENT_WIDTH = Rule(
    "animation-tangent-width",
    Severity.WARNING,
    "The tangents of a sampler have another number of values than its keys.",
    "Give a tangent as many values as the key has, or one more: the time before them.",
    "COLLADA 1.5 §sampler",
    "The curve between the keys is another one, or is read past its end.",
)
CHANNEL_TWICE = Rule(
    "animation-channel-twice",
    Severity.WARNING,
    "Two channels move the same target.",
    "Remove one of them.",
    "COLLADA 1.5 §channel",
    "Which of the two wins is different from reader to reader.",
)
CLIP_RANGE = Rule(
    "animation-clip-range",
    Severity.WARNING,
    "A clip ends before it starts.",
    "Let end be after start.",
    "COLLADA 1.5 §animation_clip",
    why="Nothing is played.",
)

SKIN_MATRIX = Rule(
    "animation-skin-matrix",
    Severity.WARNING,
    "A matrix of a skin makes everything flat, or is written column by column.",
    "Write it row by row, with 0 0 0 1 as the last row and a determinant other than zero.",
    "COLLADA 1.5 §joints",
    "The vertices of that joint collapse.",
)
SKIN_WEIGHT = Rule(
    "animation-skin-weight",
    Severity.WARNING,
    "A weight of a skin is negative.",
    "Give every weight a value from 0 to 1.",
    "COLLADA 1.5 §vertex_weights",
    "The vertex moves against the joint.",
)
SKIN_JOINT_TWICE = Rule(
    "animation-skin-joint-twice",
    Severity.WARNING,
    "A skin names a joint twice.",
    "Name every joint once.",
    "COLLADA 1.5 §skin",
    "Which of the two matrices counts is different from reader to reader.",
)

RULES = (
    TANGENT_WIDTH,
    SKIN_MATRIX,
    SKIN_JOINT_TWICE,
    SKIN_WEIGHT,
    SKIN_COUNT,
    SKIN_INDEX,
    SKIN_SUM,
    SKIN_BIND,
    SKIN_JOINT,
    MORPH_TARGETS,
    KEY_COUNT,
    KEY_ORDER,
    INTERPOLATION,
    OUTPUT_WIDTH,
    CHANNEL_TWICE,
    CLIP_RANGE,
)
