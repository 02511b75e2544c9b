"""Findings of the World: values and operations that it refuses."""

from __future__ import annotations

from colladaphy.errors import WorldError
from colladaphy.findings import Rule, Severity

__all__ = [
    "ARGUMENT",
    "BODY_GONE",
    "COLUMNS",
    "DIMENSION",
    "INERTIA",
    "JOINT_BODIES",
    "JOINT_VALUE",
    "KIND",
    "MASS",
    "MATERIAL_NAME",
    "MATERIAL_UNKNOWN",
    "MATERIAL_VALUE",
    "MESH",
    "NUMBER",
    "RULES",
    "SYSTEM_ID",
    "UNION_MEMBERS",
    "USER_ID",
    "KindError",
    "refuse",
]

DIMENSION = Rule(
    "physics-dimension",
    Severity.ERROR,
    "A dimension of a body is not a positive, finite number.",
    "Give lengths and radii greater than zero; a plane needs a normal that is not zero.",
    "thesis 2.1",
    why="It has no volume, so it has no mass, and nothing can touch it.",
)
NUMBER = Rule(
    "physics-number",
    Severity.ERROR,
    "A position, orientation or velocity is not made of the right count of finite numbers.",
    "Positions and velocities are three finite numbers, orientations four, not all zero.",
    section="thesis 2.1",
    why="One value that is no number spoils all that are computed with it.",
)
MASS = Rule(
    "physics-mass",
    Severity.ERROR,
    "The mass of a body is not a finite number, or it is negative or lost to rounding.",
    "Give a mass, or dimensions whose volume times density is a normal number.",
    section="thesis 2.1",
    why="No engine can move such a body.",
)
INERTIA = Rule(
    "physics-inertia",
    Severity.ERROR,
    "The inertia of a body is not a 3×3 matrix of finite numbers.",
    "Give the inertia about the centre of mass in the body's own frame.",
    section="thesis 2.1",
    why="No engine can turn such a body.",
)
MATERIAL_VALUE = Rule(
    "physics-material-value",
    Severity.ERROR,
    "A value of a material is out of its range.",
    "Density, Young's modulus and stiffness are positive, restitution is in [0, 1], Poisson's "
    "ratio in [-1, 0.5], frictions and dampings are not negative.",
    "thesis 4.4",
    why="No contact could be computed with it.",
)
MATERIAL_NAME = Rule(
    "physics-material-name",
    Severity.ERROR,
    "The name or the id of a material is already in use.",
    "Material names and ids are unique within a World: choose another one.",
    "thesis 4.4",
    why="Which of the two a body has could not be told.",
)
MATERIAL_UNKNOWN = Rule(
    "physics-material-unknown",
    Severity.ERROR,
    "There is no such material in this World.",
    "Create it with World.create_material, or pass a material of the same World.",
    section="thesis 4.4",
    why="A material of another World says nothing in this one.",
)
MESH = Rule(
    "physics-mesh",
    Severity.ERROR,
    "A mesh is not a closed surface around a volume.",
    "Faces are triangles of indices into the vertices, counter-clockwise seen from outside.",
    section="thesis 2.1",
    why="Mass and inertia are those of the volume that it encloses.",
)
SYSTEM_ID = Rule(
    "physics-system-id",
    Severity.ERROR,
    "The system id is already in use, or is not a positive integer of 64 bits.",
    "Leave the system id out to get the next free one.",
    "thesis 5.4",
    why="Which of two bodies an id means could not be told.",
)
USER_ID = Rule(
    "physics-user-id",
    Severity.ERROR,
    "The user id is not an integer of 64 bits.",
    "User ids need not be unique, but they are integers from -2^63 to 2^63-1.",
    section="thesis 5.4",
    why="It could not be stored.",
)
UNION_MEMBERS = Rule(
    "physics-union-members",
    Severity.ERROR,
    "A union cannot be made of these members.",
    "Members are one or more different top-level bodies of the same World.",
    "thesis 4.3",
    why="A body can be a part of one other body only.",
)
BODY_GONE = Rule(
    "physics-body-gone",
    Severity.ERROR,
    "The body or joint is not in this World any more.",
    "It was destroyed; take it from World.bodies or World.joints again.",
    section="thesis 5.4",
    why="The row may be that of another body now.",
)
KIND = Rule(
    "physics-kind",
    Severity.ERROR,
    "A body of this kind has no such property.",
    "Look at Body.kind first.",
    section="thesis 2.1",
    why="The value would be without effect.",
)
JOINT_BODIES = Rule(
    "physics-joint-bodies",
    Severity.ERROR,
    "A joint binds two different bodies of the same World.",
    "Pass two bodies, of which one may be None for the world; members of one union cannot move "
    "against each other.",
    "thesis 2.2",
    why="A joint of a body with itself holds nothing.",
)
JOINT_VALUE = Rule(
    "physics-joint-value",
    Severity.ERROR,
    "A value of a joint is out of its range.",
    "Limits are three numbers each and never NaN, axes not zero, springs and motors finite.",
    "thesis 4.5",
    why="No engine could keep the joint.",
)
ARGUMENT = Rule(
    "physics-argument",
    Severity.ERROR,
    "An argument is not of the type that is needed.",
    "Names are texts, ids whole numbers, flags True or False; see the documentation of the call.",
    section="colladaphy.World",
    why="What was meant cannot be guessed.",
)
COLUMNS = Rule(
    "physics-columns",
    Severity.ERROR,
    "Columns of bodies or joints do not fit together.",
    "All columns of one call have one row each, and the shapes that BodyColumns, MemberColumns "
    "or JointColumns name.",
    section="colladaphy.World.extend",
    why="A row of one column would belong to another body than that of the next.",
)

RULES = (
    DIMENSION,
    NUMBER,
    MASS,
    INERTIA,
    MATERIAL_VALUE,
    MATERIAL_NAME,
    MATERIAL_UNKNOWN,
    MESH,
    SYSTEM_ID,
    USER_ID,
    UNION_MEMBERS,
    BODY_GONE,
    KIND,
    JOINT_BODIES,
    JOINT_VALUE,
    COLUMNS,
    ARGUMENT,
)


class KindError(WorldError, AttributeError):
    """A property that bodies of this kind don't have (a box has no radius)."""


def refuse(rule: Rule, message: str) -> WorldError:
    """The error of a rule, to be raised."""
    return WorldError(rule.at(message=message))
