"""What can be wrong with kinematics in a document that is schema-valid."""

from __future__ import annotations

from colladaphy.findings import Rule, Severity

__all__ = ["RULES"]

AXIS = Rule(
    "kinematics-axis",
    Severity.ERROR,
    "A joint has no axis.",
    "Give it a direction: x y z, not all zero.",
    "COLLADA 1.5 §axis",
    "Which way it turns or slides cannot be told.",
)
LIMITS = Rule(
    "kinematics-limits",
    Severity.ERROR,
    "The lower limit of a joint is above the upper one, or is no number.",
    "Exchange them; a joint without limits has no <limits>.",
    "COLLADA 1.5 §limits",
    "There is no position that it can have.",
)

NUMBER = Rule(
    "kinematics-number",
    Severity.ERROR,
    "A number of a robot's axis is none.",
    "Replace NaN by a number.",
    "COLLADA 1.5 §axis_info",
    "The robot is nowhere after one step.",
)
RATE = Rule(
    "kinematics-rate",
    Severity.WARNING,
    "A speed or acceleration is negative.",
    "They are largest values, without a direction.",
    "COLLADA 1.5 §axis_info",
    "The axis can never move.",
)
JOINT_TWICE = Rule(
    "kinematics-joint-twice",
    Severity.WARNING,
    "A joint binds more than one link to another.",
    "Give every link a joint of its own.",
    "COLLADA 1.5 §attachment_full",
    "Which of the links the joint moves cannot be told.",
)
AXIS_TWICE = Rule(
    "kinematics-axis-twice",
    Severity.WARNING,
    "An axis is described twice.",
    "Remove one of the descriptions.",
    "COLLADA 1.5 §axis_info",
    "Which limits count is different from reader to reader.",
)
BOUND_TWICE = Rule(
    "kinematics-bound-twice",
    Severity.WARNING,
    "Two joints move the same transform.",
    "Let each move a transform of its own.",
    "COLLADA 1.5 §bind_joint_axis",
    "The node follows one of them, or jumps from one to the other.",
)
VALUE = Rule(
    "kinematics-value",
    Severity.WARNING,
    "A joint starts beyond its limits.",
    "Correct the value, or the limits.",
    "COLLADA 1.5 §bind_joint_axis",
    "The robot jumps at the first step.",
)
TRANSFORM = Rule(
    "kinematics-transform",
    Severity.WARNING,
    "A joint is bound to a transform of another kind.",
    "A revolute joint turns a <rotate>, a prismatic one moves a <translate>.",
    "COLLADA 1.5 §bind_joint_axis",
    "The joint moves nothing, or something else.",
)
LOOP = Rule(
    "kinematics-loop",
    Severity.WARNING,
    "A joint that closes a loop of links is attached at one end only.",
    "Give each <attachment_start> an <attachment_end> of the same joint, on the other link.",
    "COLLADA 1.5 §attachment_start",
    "The loop stays open, and the joint binds nothing.",
)

RULES = (
    LOOP,
    NUMBER,
    RATE,
    JOINT_TWICE,
    AXIS_TWICE,
    BOUND_TWICE,
    VALUE,
    TRANSFORM,
    AXIS,
    LIMITS,
)
