"""The rules of writing for Bullet: what its COLLADA converter misreads, ignores or lacks."""

from __future__ import annotations

from colladaphy.findings import Rule, Severity

_INFO, _WARNING, _ERROR = Severity.INFO, Severity.WARNING, Severity.ERROR

SCENE_REMOVED = Rule(
    "downgrade-bullet-scene-removed",
    _WARNING,
    "Bullet loads every physics scene of a file, so only one was written",
    "write the other scenes to files of their own",
)
NO_SCENE = Rule(
    "downgrade-bullet-no-scene",
    _WARNING,
    "there is no physics scene for Bullet to load",
)
GRAVITY = Rule(
    "downgrade-bullet-gravity",
    _INFO,
    "a scene without gravity got a gravity of zero, where Bullet assumes ten",
)
UNIT = Rule(
    "downgrade-bullet-unit",
    _INFO,
    "Bullet ignores the unit: it takes lengths and gravity as they are",
    "its default tolerances suit lengths of 0.05 to 10",
)
IGNORED = Rule(
    "downgrade-bullet-ignored",
    _INFO,
    "Bullet's converter ignores this",
)
EXTERNAL = Rule(
    "downgrade-bullet-external",
    _WARNING,
    "a model that is not in this file was not written for Bullet",
    "bring the model into the document first",
)
FLATTENED = Rule(
    "downgrade-bullet-flattened",
    _INFO,
    "nested physics models became one, as Bullet's converter handles nothing deeper soundly",
)
BODY_COPIED = Rule(
    "downgrade-bullet-body-copied",
    _INFO,
    "a body got a sid of its own, as Bullet finds bodies by their plain sid in the whole file",
)
NO_BODY = Rule(
    "downgrade-bullet-no-body",
    _WARNING,
    "an instance of a body that its model does not have was left out",
)
NO_SHAPE = Rule(
    "downgrade-bullet-no-shape",
    _WARNING,
    "a body that has no shape that Bullet can read was left out",
)
SHAPE_LEFT_OUT = Rule(
    "downgrade-bullet-shape",
    _WARNING,
    "a shape that Bullet cannot read was left out",
    "tessellate the geometry",
)
MASS = Rule(
    "downgrade-bullet-mass",
    _INFO,
    "the mass of a body was written out, as Bullet reads neither densities nor masses of shapes",
)
MASS_UNKNOWN = Rule(
    "downgrade-bullet-mass-unknown",
    _WARNING,
    "the mass of a body is not known; Bullet takes 1",
    "give the body a mass",
)
MADE_STATIC = Rule(
    "downgrade-bullet-static",
    _WARNING,
    "a body that Bullet can only hold still was made static",
)
KINEMATIC = Rule(
    "downgrade-bullet-kinematic",
    _INFO,
    "an element named kinematic, which makes Bullet hold the body still, was renamed",
)
NODE_MOVED = Rule(
    "downgrade-bullet-node",
    _INFO,
    "a node was moved to the top of the scene and holds its whole transform, "
    "as Bullet reads no parents",
)
NODE_ADDED = Rule(
    "downgrade-bullet-node-added",
    _WARNING,
    "a body got a node of its own; what its node shows stays where it is",
)
NO_NODE = Rule(
    "downgrade-bullet-no-node",
    _WARNING,
    "the target of a body is not in this file; it got a node at the origin",
)
ANIMATED = Rule(
    "downgrade-bullet-animated",
    _WARNING,
    "an animation of a body's node lost its target, as the node was rewritten",
)
SCALE = Rule(
    "downgrade-bullet-scale",
    _WARNING,
    "a node's scale or skew was kept for what it shows, and does not change the body",
)
CONVEX = Rule(
    "downgrade-bullet-convex",
    _WARNING,
    "Bullet takes the convex hull of a mesh that moves",
    "write the mesh as several convex shapes",
)
TESSELLATED = Rule(
    "downgrade-bullet-tessellated",
    _INFO,
    "a shape with different radii became a convex mesh, as Bullet reads the first radius only",
)
GEOMETRY = Rule(
    "downgrade-bullet-geometry",
    _INFO,
    "a mesh got a plain copy for physics, as Bullet reads one set of triangles of plain positions",
)
CONSTRAINT_LEFT_OUT = Rule(
    "downgrade-bullet-constraint",
    _WARNING,
    "a constraint was left out",
)
SPRING = Rule(
    "downgrade-bullet-spring",
    _WARNING,
    "Bullet's converter ignores the springs of constraints",
)
SWAPPED = Rule(
    "downgrade-bullet-swapped",
    _INFO,
    "a constraint to the world has its body as reference, with limits the other way round",
)
WORLD_FRAME = Rule(
    "downgrade-bullet-world-frame",
    _WARNING,
    "Bullet ties a body to the world where it stands, not where the constraint says",
)
ONE_SIDED = Rule(
    "downgrade-bullet-one-sided",
    _INFO,
    "a limit on one side only got a very far one on the other, as Bullet would free the axis",
)
RADIANS = Rule(
    "downgrade-bullet-radians",
    _INFO,
    "angles of limits and angular velocities are written in radians, as Bullet reads them",
)

RULES = (
    SCENE_REMOVED,
    NO_SCENE,
    GRAVITY,
    UNIT,
    IGNORED,
    EXTERNAL,
    FLATTENED,
    BODY_COPIED,
    NO_BODY,
    NO_SHAPE,
    SHAPE_LEFT_OUT,
    MASS,
    MASS_UNKNOWN,
    MADE_STATIC,
    KINEMATIC,
    NODE_MOVED,
    NODE_ADDED,
    NO_NODE,
    ANIMATED,
    SCALE,
    CONVEX,
    TESSELLATED,
    GEOMETRY,
    CONSTRAINT_LEFT_OUT,
    SPRING,
    SWAPPED,
    WORLD_FRAME,
    ONE_SIDED,
    RADIANS,
)
