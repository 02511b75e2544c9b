"""What can be noticed while a document becomes a World, or a World a document."""

from __future__ import annotations

from colladaphy.findings import Rule, Severity

__all__ = ["RULES"]

_ERROR = Severity.ERROR
_WARNING = Severity.WARNING
_INFO = Severity.INFO

NO_SCENE = Rule(
    "load-no-scene",
    _WARNING,
    "The document instances no physics scene, so there is nothing to load.",
    "Choose a scene: doc.scenes[...].load(), or add <instance_physics_scene> to <scene>.",
    "thesis 5.3",
    why="The World stays empty.",
)
EMPTY_SHAPE = Rule(
    "load-empty-shape",
    _WARNING,
    "A shape has no volume, so it cannot be represented.",
    "Give all lengths and radii a value greater than zero.",
    "thesis 6.2.2",
    why="It has no mass, and nothing can touch it.",
)
NO_GEOMETRY = Rule(
    "load-no-geometry",
    _WARNING,
    "The geometry of a shape cannot be represented.",
    "Rigid bodies need a mesh of polygons that encloses a volume, or a primitive.",
    "thesis 4.2",
    why="The body is without that shape: lighter, and with nothing to touch there.",
)
BODY_SKIPPED = Rule(
    "load-body-skipped",
    _WARNING,
    "None of the shapes of a body can be represented, and the body is skipped.",
    "Correct its shapes; a body that states its mass and inertia needs none.",
    "thesis 6.2.2",
    why="What it should hold up falls, and its joints are gone.",
)
NO_BODY = Rule(
    "load-no-body",
    _INFO,
    "A body has neither a shape nor a mass: it is a frame of reference, and no body is made of it.",
    "Give it a mass, and an inertia, if it is to move.",
    "COLLADA 1.5 §rigid_body",
    why="Who expects a body there does not find one.",
)
BAD_VALUE = Rule(
    "load-bad-value",
    _WARNING,
    "A body has a value that a World cannot hold, and is skipped.",
    "Masses are not negative, poses and velocities are finite numbers.",
    section="COLLADA 1.5 §rigid_body",
    why="One value that is no number spoils all that are computed with it.",
)
CONVERSION = Rule(
    "load-conversion",
    _ERROR,
    "Lengths cannot be converted to the unit that is asked for.",
    "Correct the document's <unit>, or load in the document's own unit.",
    section="COLLADA 1.5 §unit",
    why="Every length would be zero, infinite or no number.",
)
CONSTRAINT_SKIPPED = Rule(
    "load-constraint-skipped",
    _WARNING,
    "A constraint attaches to a body that was not loaded, and is skipped.",
    "Load the model that holds the body too, or correct the attachment.",
    "thesis 5.3",
    why="The body that is there moves freely.",
)
JOINT_LATE = Rule(
    "load-joint-late",
    _INFO,
    "Joints that waited for a body of another model are in the World, now that it is loaded too.",
    None,
    "thesis 5.3",
    why="Who counted the joints before finds more of them.",
)
CONSTRAINT_FAULTY = Rule(
    "load-constraint-faulty",
    _WARNING,
    "A constraint cannot be represented, and is skipped.",
    "A constraint binds two different bodies, or a body and the world, within limits min to max.",
    "thesis 4.5",
    why="The bodies move freely.",
)
KINEMATICS_UNUSED = Rule(
    "kinematics-not-instanced",
    _INFO,
    "The document has kinematics models, but its scene instances none: they make no joints.",
    "Add an <instance_kinematics_scene> to <scene>.",
    "COLLADA 1.5 §instance_kinematics_scene",
    why="The robot falls apart into its links.",
)
KINEMATICS_LOST = Rule(
    "kinematics-reference",
    _WARNING,
    "A reference in the kinematics leads nowhere, and is not followed.",
    "Correct the path: the sids lead from instances to what they are of.",
    "COLLADA 1.5 §Address syntax",
    why="What it should say of the robot is not known: the joint, its limits or its place.",
)
ROBOT_EMPTY = Rule(
    "kinematics-no-bodies",
    _INFO,
    "None of the links of a kinematics model is a body that is loaded, so it makes no joints.",
    "Bind links and rigid bodies to the same nodes, or give them the same names.",
    "COLLADA 1.5 §bind_kinematics_model",
    why="The robot is no part of the World.",
)
LINK_IN_WORLD = Rule(
    "kinematics-link-in-world",
    _INFO,
    "The outermost link of a robot has neither shape nor mass: the world holds what hangs on it.",
    "Give the link a mass and an inertia, if the robot is to move about.",
    section="COLLADA 1.5 §link",
    why="The robot is held where it stands.",
)
LINK_UNCLEAR = Rule(
    "kinematics-link-unclear",
    _WARNING,
    "Several bodies have the name of a link, so which of them it is cannot be told.",
    "Bind the link to the node of its body with <bind_joint_axis>.",
    "COLLADA 1.5 §bind_joint_axis",
    why="The joint would hold the wrong body.",
)
FORCE_FIELD = Rule(
    "load-force-field",
    _WARNING,
    "The scene has force fields, which a World has not.",
    "Say what they do by Simulation(forces=...); they stay in the document.",
    "COLLADA 1.5 §force_field",
    why="Bodies move as if there were none.",
)
JOINT_EMPTY = Rule(
    "kinematics-joint-empty",
    _INFO,
    "A joint fixes a link that has no body, so there is nothing to bind.",
    None,
    "COLLADA 1.5 §attachment_full",
    why="Who expects the joint in the World does not find it.",
)
JOINT_UNMAPPED = Rule(
    "kinematics-joint-skipped",
    _WARNING,
    "A kinematic joint cannot be a joint of a World, and is skipped.",
    "A World's joints bind two bodies and have axes at right angles.",
    "COLLADA 1.5 §joint",
    why="The two links move freely against each other.",
)
JOINT_FOLLOWS = Rule(
    "kinematics-joint-follows",
    _WARNING,
    "Formulas make axes follow other axes, which a World cannot express.",
    "The axes begin where linear formulas put them, and move freely within their limits.",
    "COLLADA 1.5 §formula",
    why="Grippers and parallel arms move otherwise than they should.",
)
PAIRS = Rule(
    "kinematics-pairs-collide",
    _WARNING,
    "The file lets pairs of links pass through each other that cannot be found: they collide.",
    "Correct the paths, or add a rigid_constraint with all axes free and interpenetrate true.",
    "OpenRAVE's extra of the type collision",
    why="Links that overlap by design push each other apart.",
)
PAIRS_PASS = Rule(
    "kinematics-pairs-pass",
    _INFO,
    "The file lets pairs of links pass through each other: joints with all axes free do it.",
    None,
    "OpenRAVE's extra of the type collision",
    why="A World's joints are more than those of the robot.",
)
JOINT_BEYOND = Rule(
    "kinematics-joint-beyond",
    _WARNING,
    "A joint stands beyond its limits, which are widened to where it stands.",
    "Write the robot in a pose that its limits allow.",
    "COLLADA 1.5 §axis_info",
    why="At the first step the joint would throw its links back within the limits.",
)
JOINT_DOUBLED = Rule(
    "kinematics-joint-doubled",
    _INFO,
    "A kinematic joint binds two bodies that a rigid_constraint binds; the latter counts.",
    None,
    "COLLADA 1.5 §rigid_constraint",
    why="Two joints for one would work against each other.",
)
JOINT_FRAMES = Rule(
    "kinematics-joint-frames",
    _WARNING,
    "The nodes put a joint elsewhere than the kinematics model does; the nodes count.",
    "Write both from the same values.",
    "COLLADA 1.5 §bind_joint_axis",
    why="Robot and picture come apart.",
)
DENSITY_ASSUMED = Rule(
    "load-density-assumed",
    _INFO,
    "Neither mass nor density is given: the density 1 is assumed.",
    "Give the body a mass or its shapes a density.",
    "thesis 4.4",
    why="The body may be a thousand times too light or too heavy.",
)
MATERIAL_ASSUMED = Rule(
    "load-material-assumed",
    _INFO,
    "A body has no physics material: standard values are assumed.",
    "Give the body or its shapes a physics material.",
    "thesis 4.4",
    why="How it slides and bounces is what colladaphy assumes.",
)
MATERIAL_RENAMED = Rule(
    "load-material-renamed",
    _INFO,
    "A material's name is in use by another one in the World; a number is appended.",
    None,
    "thesis 4.4",
    why="Who looks for the old name finds another material.",
)
SYSTEM_ID_TAKEN = Rule(
    "load-system-id-taken",
    _INFO,
    "A body's or joint's system id is in use in the World, so it got the next free one.",
    "Load into an empty World to keep all system ids.",
    "thesis 6.1",
    why="Who kept the old id finds another body.",
)
ID_LARGE = Rule(
    "load-id-large",
    _WARNING,
    "An id has more than 64 bits, and another one is given in its place.",
    "A World's ids are whole numbers of 64 bits with a sign.",
    "thesis 6.1",
    why="Who kept the old id does not find the body.",
)
HULL = Rule(
    "load-hull",
    _INFO,
    "The convex hull of a geometry was computed.",
    None,
    "COLLADA 1.5 §convex_mesh",
    why="The shape is one that stands nowhere in the document.",
)
OPEN = Rule(
    "load-mesh-open",
    _WARNING,
    "The faces of a mesh do not enclose a volume: its convex hull is taken.",
    "Close the surface, and wind its faces counter-clockwise as seen from outside.",
    "COLLADA 1.5 §mesh",
    why="Holes are filled, so mass and contacts are those of another shape.",
)
BAD_PROFILE = Rule(
    "profile-not-understood",
    _WARNING,
    "The pe profile of an element does not fit its common profile, and is not used.",
    "Write the document again with colladaphy.",
    "thesis 4.3",
    why="What it said exactly is now as coarse as the common profile.",
)

RULES = (
    NO_SCENE,
    EMPTY_SHAPE,
    NO_GEOMETRY,
    BODY_SKIPPED,
    NO_BODY,
    BAD_VALUE,
    CONVERSION,
    CONSTRAINT_SKIPPED,
    CONSTRAINT_FAULTY,
    JOINT_LATE,
    KINEMATICS_UNUSED,
    KINEMATICS_LOST,
    ROBOT_EMPTY,
    LINK_IN_WORLD,
    LINK_UNCLEAR,
    FORCE_FIELD,
    JOINT_EMPTY,
    JOINT_UNMAPPED,
    JOINT_FOLLOWS,
    PAIRS,
    PAIRS_PASS,
    JOINT_BEYOND,
    JOINT_DOUBLED,
    JOINT_FRAMES,
    DENSITY_ASSUMED,
    MATERIAL_ASSUMED,
    MATERIAL_RENAMED,
    SYSTEM_ID_TAKEN,
    ID_LARGE,
    HULL,
    OPEN,
    BAD_PROFILE,
)
