"""Rules of conform: bodies and constraints."""

from __future__ import annotations

from colladaphy.findings import Rule, Severity

__all__ = ["RULES"]

_INFO, _WARNING = Severity.INFO, Severity.WARNING

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

RULES = (
    MISSING_SID,
    BARE_INSTANCE,
    MISSING_ATTACHMENT,
    EMPTY_MASS_FRAME,
    MASS_FRAME_ORIGIN,
    MATRIX,
    INERTIA,
    SCALED,
)
