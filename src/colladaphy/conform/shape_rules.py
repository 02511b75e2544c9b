"""Rules of conform: shapes."""

from __future__ import annotations

from colladaphy.findings import Rule, Severity

__all__ = ["RULES"]

_INFO, _WARNING = Severity.INFO, Severity.WARNING

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

RULES = (
    TAPERED,
    CAPSULE_RADIUS,
    SHAPE_SIZE,
    SPHERE_RADII,
    INLINE_MESH,
    SHAPE_SPLIT,
    EMPTY_SHAPE,
    MISSING_SHAPE,
    WINDING,
)
