"""Rules of conform: what references lead to."""

from __future__ import annotations

from colladaphy.findings import Rule, Severity

__all__ = ["RULES"]

_INFO, _WARNING = Severity.INFO, Severity.WARNING

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

RULES = (
    MISSING_BODY,
    MISSING_TARGET,
    BODY_REFERENCE,
    ATTACHMENT_REFERENCE,
    HASH,
    DANGLING_INSTANCE,
    AMBIGUOUS_CONSTRAINT,
    CYCLE,
    DANGLING_SCENE,
    MISSING_SCENE,
    DANGLING_TARGET,
    PARENT,
    INPUT_ARRAY,
    INPUT_PATH,
    COUNT,
    ESCAPED,
    SUFFIXED,
)
