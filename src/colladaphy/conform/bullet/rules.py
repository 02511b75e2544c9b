"""The rules of writing for Bullet: what its COLLADA converter misreads, ignores or lacks."""

from __future__ import annotations

from colladaphy.findings import Rule, Severity

_INFO, _WARNING, _ERROR = Severity.INFO, Severity.WARNING, Severity.ERROR

SCENE_REMOVED = Rule(
    "downgrade-bullet-scene-removed",
    _WARNING,
    "Bullet loads every physics scene of a file, so only one was written",
    "write the other scenes to files of their own",
    section="Bullet's ColladaConverter",
    why="bodies of all scenes would lie in one another",
)
NO_SCENE = Rule(
    "downgrade-bullet-no-scene",
    _WARNING,
    "there is no physics scene for Bullet to load",
    section="Bullet's ColladaConverter",
    why="the file would open as an empty world",
)
GRAVITY = Rule(
    "downgrade-bullet-gravity",
    _INFO,
    "a scene without gravity got a gravity of zero, where Bullet assumes ten",
    section="Bullet's ColladaConverter §preparePhysicsScene",
    why="bodies would fall where nothing was to pull them",
)
UNIT = Rule(
    "downgrade-bullet-unit",
    _INFO,
    "Bullet ignores the unit: it takes lengths and gravity as they are",
    "its default tolerances suit lengths of 0.05 to 10",
    section="COLLADA 1.5 §unit",
    why="margins and thresholds of contact are lengths, and do not scale with the scene",
)
IGNORED = Rule(
    "downgrade-bullet-ignored",
    _INFO,
    "Bullet's converter ignores this",
    section="Bullet's ColladaConverter",
    why="Bullet's run differs from that of a reader who heeds it",
)
EXTERNAL = Rule(
    "downgrade-bullet-external",
    _WARNING,
    "a model that is not in this file was not written for Bullet",
    "bring the model into the document first",
    section="COLLADA 1.5 §instance_physics_model",
    why="Bullet opens one file only, and would lack the bodies",
)
FLATTENED = Rule(
    "downgrade-bullet-flattened",
    _INFO,
    "nested physics models became one, as Bullet's converter handles nothing deeper soundly",
    section="COLLADA 1.5 §instance_physics_model",
    why="bodies of inner models would be found twice, or not at all",
)
BODY_COPIED = Rule(
    "downgrade-bullet-body-copied",
    _INFO,
    "a body got a sid of its own, as Bullet finds bodies by their plain sid in the whole file",
    section="Bullet's ColladaConverter",
    why="an instance would get the body of another model that has the same sid",
)
NO_BODY = Rule(
    "downgrade-bullet-no-body",
    _WARNING,
    "an instance of a body that its model does not have was left out",
    section="COLLADA 1.5 §instance_rigid_body",
    why="Bullet's converter would read memory that is not there",
)
NO_SHAPE = Rule(
    "downgrade-bullet-no-shape",
    _WARNING,
    "a body that has no shape that Bullet can read was left out, and is kept for the way back",
    section="COLLADA 1.5 §shape",
    why="Bullet cannot make a body without a shape",
)
SHAPE_LEFT_OUT = Rule(
    "downgrade-bullet-shape",
    _WARNING,
    "a shape that Bullet cannot read was left out; what it weighs stays with the body",
    "tessellate the geometry",
    section="COLLADA 1.5 §shape",
    why="what touched that shape touches nothing in Bullet",
)
MASS = Rule(
    "downgrade-bullet-mass",
    _INFO,
    "the mass of a body was written out, as Bullet reads neither densities nor masses of shapes",
    section="COLLADA 1.5 §mass",
    why="Bullet would take 1 for every mass that is not there",
)
MASS_UNKNOWN = Rule(
    "downgrade-bullet-mass-unknown",
    _WARNING,
    "the mass of a body is not known; Bullet takes 1",
    "give the body a mass",
    section="COLLADA 1.5 §mass",
    why="the body is as light or heavy as Bullet assumes",
)
MADE_STATIC = Rule(
    "downgrade-bullet-static",
    _WARNING,
    "a body that Bullet can only hold still was made static",
    section="COLLADA 1.5 §dynamic",
    why="the body stands still where another engine would move it",
)
KINEMATIC = Rule(
    "downgrade-bullet-kinematic",
    _INFO,
    "an element named kinematic, which makes Bullet hold the body still, was renamed",
    section="Bullet's ColladaConverter",
    why="the body would stand still for a name",
)
NODE_MOVED = Rule(
    "downgrade-bullet-node",
    _INFO,
    "a node was moved to the top of the scene and holds its whole transform, "
    "as Bullet reads no parents",
    section="COLLADA 1.5 §node",
    why="the body would be where its node is without its parents",
)
NODE_ADDED = Rule(
    "downgrade-bullet-node-added",
    _WARNING,
    "a body got a node of its own; what its node shows stays where it is",
    section="COLLADA 1.5 §instance_rigid_body",
    why="one node cannot follow two bodies",
)
NO_NODE = Rule(
    "downgrade-bullet-no-node",
    _WARNING,
    "the target of a body is not in this file; it got a node at the origin",
    section="COLLADA 1.5 §instance_rigid_body",
    why="the body is not where the other file has it",
)
ANIMATED = Rule(
    "downgrade-bullet-animated",
    _WARNING,
    "an animation of a body's node lost its target, as the node was rewritten",
    section="COLLADA 1.5 §channel",
    why="the animation would move something else, or nothing",
)
SCALE = Rule(
    "downgrade-bullet-scale",
    _WARNING,
    "a node's scale or skew was kept for what it shows, and does not change the body",
    section="COLLADA 1.5 §scale",
    why="Bullet's converter would take the scale for a turn",
)
CONVEX = Rule(
    "downgrade-bullet-convex",
    _WARNING,
    "Bullet takes the convex hull of a mesh that moves",
    "write the mesh as several convex shapes",
    section="COLLADA 1.5 §mesh",
    why="hollows and holes are filled, so that bodies rest on what is not there",
)
TESSELLATED = Rule(
    "downgrade-bullet-tessellated",
    _INFO,
    "a shape with different radii became a convex mesh, as Bullet reads the first radius only",
    section="COLLADA 1.5 §capsule",
    why="an oval shape would become a round one",
)
GEOMETRY = Rule(
    "downgrade-bullet-geometry",
    _INFO,
    "a mesh got a plain copy for physics, as Bullet reads one set of triangles of plain positions",
    section="COLLADA 1.5 §triangles",
    why="Bullet's converter would misread the indices of other inputs as those of vertices",
)
CONSTRAINT_LEFT_OUT = Rule(
    "downgrade-bullet-constraint",
    _WARNING,
    "a constraint was left out; one that can come back is kept in an extra",
    section="COLLADA 1.5 §rigid_constraint",
    why="the bodies move freely in Bullet",
)
SPRING = Rule(
    "downgrade-bullet-spring",
    _WARNING,
    "Bullet's converter ignores the springs of constraints",
    section="COLLADA 1.5 §spring",
    why="the joint swings freely in Bullet",
)
SWAPPED = Rule(
    "downgrade-bullet-swapped",
    _INFO,
    "a constraint to the world has its body as reference, with limits the other way round",
    section="COLLADA 1.5 §ref_attachment",
    why="Bullet's converter reads the body from the reference only",
)
WORLD_FRAME = Rule(
    "downgrade-bullet-world-frame",
    _WARNING,
    "Bullet ties a body to the world where it stands, not where the constraint says",
    section="COLLADA 1.5 §attachment",
    why="limits count from another pose than the document says",
)
ONE_SIDED = Rule(
    "downgrade-bullet-one-sided",
    _INFO,
    "a limit on one side only got a very far one on the other, as Bullet would free the axis",
    section="COLLADA 1.5 §limits",
    why="the limit on the one side would be lost with the other",
)
RADIANS = Rule(
    "downgrade-bullet-radians",
    _INFO,
    "angles of limits and angular velocities are written in radians, as Bullet reads them",
    section="COLLADA 1.5 §limits",
    why="limits and spins would be 57 times as large",
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
