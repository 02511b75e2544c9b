"""What can be wrong with rigid bodies and constraints in a document that is schema-valid."""

from __future__ import annotations

from colladaphy.findings import Rule, Severity

__all__ = ["RULES"]

MASS_VALUE = Rule(
    "physics-mass-value",
    Severity.ERROR,
    "A mass is negative or not finite.",
    "Give it a positive number.",
    "COLLADA 1.5 §mass",
    "No engine can move such a body.",
)
MASS_ZERO = Rule(
    "physics-mass-zero",
    Severity.WARNING,
    "A body that moves has no mass.",
    "Give it a mass, or say <dynamic>false</dynamic>.",
    "COLLADA 1.5 §mass",
    "Some engines take it for fixed, others divide by zero.",
)
INERTIA_VALUE = Rule(
    "physics-inertia-value",
    Severity.ERROR,
    "An inertia is negative or not finite.",
    "Give it three positive numbers, or leave it out to have it computed.",
    "COLLADA 1.5 §inertia",
    "The body turns the wrong way, or its state becomes NaN.",
)
INERTIA_ZERO = Rule(
    "physics-inertia-zero",
    Severity.WARNING,
    "A body that moves has no inertia about an axis.",
    "Leave the inertia out to have it computed from the shapes.",
    "COLLADA 1.5 §inertia",
    "The body cannot be turned, or turns infinitely fast, from engine to engine.",
)
INERTIA_TRIANGLE = Rule(
    "physics-inertia-triangle",
    Severity.ERROR,
    "No body can have such an inertia: one moment is more than the other two together.",
    "Correct the inertia, or leave it out to have it computed from the shapes.",
    "COLLADA 1.5 §inertia",
    "Engines refuse it, or the body gains energy as it turns.",
)
INERTIA_SIZE = Rule(
    "physics-inertia-size",
    Severity.WARNING,
    "An inertia is far from what the mass and the shapes allow.",
    "Give it in the document's units: mass times length squared. kg mm² are a million times kg m².",
    "COLLADA 1.5 §inertia",
    "The body hardly turns at all, or spins at a touch.",
)
DENSITY_VALUE = Rule(
    "physics-density-value",
    Severity.ERROR,
    "A density is negative or not finite.",
    "Give it a positive number: mass over length cubed, in the document's units.",
    "COLLADA 1.5 §density",
    "No engine can move such a body.",
)
DENSITY_ZERO = Rule(
    "physics-density-zero",
    Severity.WARNING,
    "A body that moves has a shape of density zero.",
    "Give it a density or a mass, or say <dynamic>false</dynamic>.",
    "COLLADA 1.5 §density",
    "Its mass is zero: some engines take it for fixed, others divide by it.",
)
MASS_DENSITY = Rule(
    "physics-mass-density",
    Severity.WARNING,
    "Mass and density of a shape contradict each other.",
    "Leave one of them out; the mass is what counts.",
    "COLLADA 1.5 §shape",
    "The shape is lighter or heavier from reader to reader.",
)
MASS_SUM = Rule(
    "physics-mass-sum",
    Severity.WARNING,
    "The mass of a body is not the sum of the masses of its shapes.",
    "Correct one of them; the mass of the body is what counts.",
    "COLLADA 1.5 §rigid_body",
    "The body is lighter or heavier from reader to reader.",
)
MASS_MISSING = Rule(
    "physics-mass-missing",
    Severity.WARNING,
    "A body that moves has neither mass nor density.",
    "Give the body a mass, or its shapes a density.",
    "COLLADA 1.5 §rigid_body; thesis 4.4",
    "A density of 1 is assumed, which is that of air rather than of a solid.",
)
MASS_FRAME = Rule(
    "physics-mass-frame",
    Severity.WARNING,
    "The centre of mass of a body is far outside of its shapes.",
    "Give the mass frame in the document's units of length, relative to the body.",
    "COLLADA 1.5 §mass_frame",
    "The body turns about a point that is not near it.",
)
SHAPE_SIZE = Rule(
    "physics-shape-size",
    Severity.ERROR,
    "A shape has a size that is not positive, or not finite.",
    "Give all lengths and radii a value greater than zero.",
    "COLLADA 1.5 §box, §capsule, §cylinder, §sphere",
    "It has no volume, and its body cannot be loaded.",
)
PLANE_NORMAL = Rule(
    "physics-plane-normal",
    Severity.ERROR,
    "A plane has no normal.",
    "The equation is A B C D with A x + B y + C z + D = 0; A B C is the normal.",
    "COLLADA 1.5 §plane",
    "Where the plane is cannot be told, and its body cannot be loaded.",
)
PLANE_MOVES = Rule(
    "physics-plane-moves",
    Severity.WARNING,
    "A body that moves has a plane for a shape.",
    "Say <dynamic>false</dynamic>, or use a box.",
    "COLLADA 1.5 §plane",
    "A plane has no end and no mass; engines take it for fixed.",
)
HOLLOW = Rule(
    "physics-hollow",
    Severity.WARNING,
    "A hollow shape has no mass of its own.",
    "Give it the mass of its shell.",
    "COLLADA 1.5 §hollow",
    "Its mass is that of a solid, and its inertia that of a shell.",
)
MATERIAL_NUMBER = Rule(
    "physics-material-number",
    Severity.ERROR,
    "A value of a material is no number.",
    "Replace NaN by a number.",
    "COLLADA 1.5 §physics_material",
    "Every contact of the material becomes NaN.",
)
MATERIAL_RANGE = Rule(
    "physics-material-range",
    Severity.WARNING,
    "A value of a material is out of its range.",
    "Restitution is from 0 to 1; frictions are finite and not negative.",
    "COLLADA 1.5 §physics_material",
    "Bodies gain energy at every contact; loading takes the nearest value within the range.",
)
MATERIAL_FRICTIONS = Rule(
    "physics-material-frictions",
    Severity.WARNING,
    "The dynamic friction is larger than the static one.",
    "What slides is held less than what rests: correct one of them.",
    "COLLADA 1.5 §physics_material",
    "No material is like that, and many engines take the larger one for both.",
)
VELOCITY_NUMBER = Rule(
    "physics-velocity-number",
    Severity.ERROR,
    "A velocity is not finite.",
    "Replace NaN and INF by numbers.",
    "COLLADA 1.5 §instance_rigid_body",
    "After one step the body is nowhere, and so is what touches it.",
)
VELOCITY_FIXED = Rule(
    "physics-velocity-fixed",
    Severity.WARNING,
    "A body that cannot move has a velocity.",
    "Remove the velocity, or let the body be dynamic.",
    "COLLADA 1.5 §instance_rigid_body",
    "Some engines ignore it, others let everything slide on the body.",
)
BODIES_NESTED = Rule(
    "physics-bodies-nested",
    Severity.WARNING,
    "A body moves a node that stands in the node of another body that moves.",
    "Let the nodes stand side by side, and bind the bodies by a constraint.",
    "COLLADA 1.5 §instance_rigid_body",
    "As the outer body moves it takes the inner node along, and the inner body moves it once more.",
)
NODE_SHARED = Rule(
    "physics-node-shared",
    Severity.WARNING,
    "Two bodies move the same node.",
    "Give each body a node of its own.",
    "COLLADA 1.5 §instance_rigid_body",
    "The node follows one of them, or jumps from one to the other.",
)
JOINT_LIMITS = Rule(
    "physics-joint-limits",
    Severity.ERROR,
    "A lower limit of a joint is above the upper one, or is no number.",
    "Exchange them; a free axis has -INF and INF.",
    "COLLADA 1.5 §limits",
    "There is no position that the joint can have.",
)
JOINT_RADIANS = Rule(
    "physics-joint-radians",
    Severity.HINT,
    "Angular limits look like radians.",
    "Give them in degrees: 90, not 1.5707963.",
    "COLLADA 1.5 §swing_cone_and_twist",
    "The joint hardly moves.",
)
JOINT_SPRING = Rule(
    "physics-joint-spring",
    Severity.WARNING,
    "A spring of a joint pushes away, or is not of finite numbers.",
    "Stiffness and damping are finite and not negative.",
    "COLLADA 1.5 §spring",
    "The joint gains energy until it breaks apart, or cannot be loaded.",
)
JOINT_SELF = Rule(
    "physics-joint-self",
    Severity.ERROR,
    "A joint binds a body to itself.",
    "Let the attachments name two bodies, or leave one of them empty for the world.",
    "COLLADA 1.5 §rigid_constraint",
    "There is nothing to hold, and the joint cannot be loaded.",
)
JOINT_FIXED = Rule(
    "physics-joint-fixed",
    Severity.HINT,
    "A joint is between two bodies that cannot move.",
    "Remove it, or let one of the bodies be dynamic.",
    "COLLADA 1.5 §rigid_constraint",
    why="Who wrote the joint expected something to move.",
)
FRAMES_APART = Rule(
    "physics-frames-apart",
    Severity.WARNING,
    "The frames of a joint do not meet at time 0.",
    "Move the attachments, or the nodes of the bodies, to where both frames are at one place.",
    "COLLADA 1.5 §ref_attachment, §attachment",
    "The first step pulls the bodies together at one stroke, and they fly apart.",
)
FRAMES_TURNED = Rule(
    "physics-frames-turned",
    Severity.WARNING,
    "The frames of a joint are turned against each other beyond its limits at time 0.",
    "Turn one of the attachments, or widen the limits.",
    "COLLADA 1.5 §ref_attachment, §attachment",
    "The first step turns the bodies back at one stroke, and they fly apart.",
)
GRAVITY_NUMBER = Rule(
    "physics-gravity-number",
    Severity.ERROR,
    "The gravity is not finite.",
    "Replace NaN and INF by numbers.",
    "COLLADA 1.5 §gravity",
    "After one step no body is anywhere.",
)
GRAVITY_UNIT = Rule(
    "physics-gravity-unit",
    Severity.WARNING,
    "The gravity is 9.81, but not in metres.",
    "Give it in the document's unit of length: 981 where that is a centimetre.",
    "COLLADA 1.5 §gravity, §unit",
    "Everything falls as on another planet.",
)
GRAVITY_AXIS = Rule(
    "physics-gravity-axis",
    Severity.WARNING,
    "The gravity is along another axis than the document's up axis.",
    "Let it point down the up axis, or correct <up_axis>.",
    "COLLADA 1.5 §gravity, §up_axis",
    "Everything falls sideways.",
)
TIME_STEP = Rule(
    "physics-time-step",
    Severity.ERROR,
    "The time step is no time.",
    "Give it a positive number of seconds.",
    "COLLADA 1.5 §time_step",
    "The simulation cannot go on.",
)
TIME_STEP_LONG = Rule(
    "physics-time-step-long",
    Severity.WARNING,
    "The time step is very long.",
    "It is in seconds: 0.01, not 10.",
    "COLLADA 1.5 §time_step",
    "Bodies pass through each other from one step to the next.",
)
SEVERAL_GRAVITIES = Rule(
    "physics-several-gravities",
    Severity.WARNING,
    "Two physics scenes that are in effect have different gravity or time step.",
    "Give them the same, or instance one of them only.",
    "COLLADA 1.5 §scene; thesis 4.1",
    "Loaded into one world, all bodies have the gravity of the first.",
)

NODE_ANIMATED = Rule(
    "physics-node-animated",
    Severity.WARNING,
    "An animation moves the node of a body that moves.",
    "Remove the animation, or say <dynamic>false</dynamic>.",
    "COLLADA 1.5 §channel, §instance_rigid_body",
    "The node follows one of them, or jumps from one to the other.",
)
GRAVITY_UP = Rule(
    "physics-gravity-up",
    Severity.WARNING,
    "The gravity points up.",
    "Give it the opposite sign.",
    "COLLADA 1.5 §gravity, §up_axis",
    "Everything falls into the sky.",
)
JOINT_TARGET = Rule(
    "physics-joint-target",
    Severity.WARNING,
    "A spring pulls to where the joint cannot be.",
    "Let the target be within the limits.",
    "COLLADA 1.5 §spring",
    "Spring and limit work against each other all the time.",
)

RULES = (
    NODE_ANIMATED,
    GRAVITY_UP,
    JOINT_TARGET,
    MASS_FRAME,
    MASS_VALUE,
    MASS_ZERO,
    INERTIA_VALUE,
    INERTIA_ZERO,
    INERTIA_TRIANGLE,
    INERTIA_SIZE,
    DENSITY_VALUE,
    DENSITY_ZERO,
    MASS_DENSITY,
    MASS_SUM,
    MASS_MISSING,
    SHAPE_SIZE,
    PLANE_NORMAL,
    PLANE_MOVES,
    HOLLOW,
    MATERIAL_NUMBER,
    MATERIAL_RANGE,
    MATERIAL_FRICTIONS,
    VELOCITY_NUMBER,
    VELOCITY_FIXED,
    BODIES_NESTED,
    NODE_SHARED,
    JOINT_LIMITS,
    JOINT_RADIANS,
    JOINT_SPRING,
    JOINT_SELF,
    JOINT_FIXED,
    FRAMES_APART,
    FRAMES_TURNED,
    GRAVITY_NUMBER,
    GRAVITY_UNIT,
    GRAVITY_AXIS,
    TIME_STEP,
    TIME_STEP_LONG,
    SEVERAL_GRAVITIES,
)
