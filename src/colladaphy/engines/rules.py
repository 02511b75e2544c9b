"""Findings of the engines: what they refuse, drop or approximate."""

from __future__ import annotations

from colladaphy.errors import EngineError
from colladaphy.findings import Rule, Severity

__all__ = ["RULES", "refuse"]

TIME_STEP = Rule(
    "engine-time-step",
    Severity.ERROR,
    "The time step is not a positive number.",
    "Give dt=..., or --dt on the command line.",
    "COLLADA 1.5 §time_step",
    why="Time would stand still, or run backwards.",
)
TIME_STEP_DEFAULT = Rule(
    "engine-time-step-default",
    Severity.INFO,
    "The scene names no time step; 1/240 is assumed.",
    "Give dt=..., or --dt on the command line.",
    "COLLADA 1.5 §time_step",
    why="Another program may take another step, and come to other results.",
)
UNKNOWN = Rule(
    "engine-unknown",
    Severity.ERROR,
    "There is no engine of this name.",
    "Choose auto, pymunk or mujoco.",
    section="colladaphy docs/engines.md",
    why="There is nothing to run the scene with.",
)
NOT_INSTALLED = Rule(
    "engine-not-installed",
    Severity.ERROR,
    "The library under this engine is not installed.",
    "Install it: pip install 'colladaphy[mujoco]'.",
    section="colladaphy docs/engines.md",
    why="There is nothing to run the scene with.",
)
DIVERGED = Rule(
    "engine-diverged",
    Severity.ERROR,
    "The simulation has diverged: a pose or velocity is not finite, or beyond all measure.",
    "Take a smaller time step, or softer springs; the last checkpoint is good.",
    section="thesis 2.2",
    why="What follows is noise, however plausible it may look.",
)
SEED_UNUSED = Rule(
    "engine-seed-unused",
    Severity.INFO,
    "The engine draws no random numbers: the run is the same for every seed.",
    "Leave the seed out.",
    section="colladaphy docs/engines.md §Options",
    why="Who varies the seed gets the same run again and again.",
)
FRICTIONS = Rule(
    "engine-frictions",
    Severity.WARNING,
    "The engine has one coefficient of sliding friction; static and dynamic friction differ here.",
    "The dynamic coefficient is taken; set both to the same value to be sure.",
    "thesis 4.4",
    why="Bodies begin to slide earlier or later than the materials say.",
)
MASS = Rule(
    "engine-mass",
    Severity.ERROR,
    "A body that can move needs a positive mass and a positive definite inertia.",
    "Give the body a mass and an inertia, or fix it.",
    section="thesis 2.1",
    why="A force would accelerate it without bounds.",
)
INERTIA_ASSUMED = Rule(
    "engine-inertia-assumed",
    Severity.WARNING,
    "A point mass can move: the engine gives it a small inertia, as it needs one.",
    "Give the body an inertia.",
    section="thesis 2.1",
    why="How fast it spins after an impact is the engine's choice.",
)
INERTIA_TRIANGLE = Rule(
    "engine-inertia-triangle",
    Severity.ERROR,
    "No rigid body can have this inertia: one principal moment is larger than the other two "
    "together.",
    "Correct the inertia, or leave it out to have it computed from the shapes.",
    section="thesis 2.1",
    why="Its turns would gain or lose energy by themselves.",
)
SHAPE_APPROXIMATED = Rule(
    "engine-shape-approximated",
    Severity.WARNING,
    "The engine takes a convex polyhedron for a shape that it does not know.",
    section="colladaphy docs/engines.md",
    why="Bodies roll over its edges and touch a little earlier or later.",
)
MESH_HULL = Rule(
    "engine-mesh-hull",
    Severity.WARNING,
    "The mesh is not convex: the engine lets its convex hull collide.",
    "Make a union of convex parts to keep the hollows.",
    section="colladaphy docs/engines.md",
    why="Bodies rest on hollows that are open.",
)
NOT_PLANAR = Rule(
    "engine-not-planar",
    Severity.ERROR,
    "The scene does not stay in one plane.",
    "Run it with MuJoCo: pip install 'colladaphy[mujoco]'.",
    section="colladaphy docs/engines.md",
    why="An engine of the plane would leave out a dimension of the motion.",
)
PLANE_FINITE = Rule(
    "engine-plane-finite",
    Severity.WARNING,
    "The engine takes a thick, finite slab for a plane.",
    "Bodies that leave the scene far behind fall off its end.",
    section="COLLADA 1.5 §plane",
    why="The ground has an end that the document does not have.",
)
MOVING_PLANE = Rule(
    "engine-moving-plane",
    Severity.ERROR,
    "A body with a plane in it cannot move.",
    "Fix the body: a plane has infinite mass.",
    section="COLLADA 1.5 §plane",
    why="No finite force moves an infinite mass.",
)
SIZE = Rule(
    "engine-size",
    Severity.ERROR,
    "A dimension or mass is too small or too large for the engine.",
    "Scale the scene to other units.",
    section="colladaphy docs/engines.md",
    why="The engine's own thresholds would swallow it, or rounding spoil it.",
)
OPTION = Rule(
    "engine-option",
    Severity.ERROR,
    "The engine has no such option, or the option no such value.",
    "The engines' options are in docs/engines.md.",
    section="colladaphy docs/engines.md §Options",
    why="A misspelt option would be without effect.",
)
SETTINGS = Rule(
    "engine-settings",
    Severity.INFO,
    "What the engine computes with.",
    "Give other options to the engine; docs/engines.md says what they do.",
    section="colladaphy docs/engines.md §Options",
    why="The result depends on it, and should be repeatable.",
)
SETUP = Rule(
    "engine-setup",
    Severity.INFO,
    "Setting up the engine takes long.",
    "Run planar scenes with pymunk, or fix what need not move.",
    section="colladaphy docs/engines.md",
    why="Nothing seems to happen meanwhile.",
)
STILL_VELOCITY = Rule(
    "engine-still-velocity",
    Severity.WARNING,
    "A body that cannot move has a velocity, which the engine does not use.",
    "Let the body move, or take its velocity away.",
    section="COLLADA 1.5 §instance_rigid_body",
    why="Who wrote the velocity expected the body to move.",
)
UNION_DIFFERS = Rule(
    "engine-union-differs",
    Severity.INFO,
    "The mass, centre or inertia of a union is not that of its members together; its own is used.",
    "If members were changed through columns, call Body.add_up of the union; else all is well.",
    "thesis 2.1",
    why="It moves otherwise than its members together would.",
)
AWAKE = Rule(
    "engine-awake",
    Severity.INFO,
    "Bodies do not sleep: those that did are awake.",
    "Give the engine sleep=True to let bodies sleep that rest.",
    section="thesis 6.1",
    why="Bodies that rested may begin to creep.",
)
MATERIAL_UNUSED = Rule(
    "engine-material-unused",
    Severity.INFO,
    "The engine does not use all values of the materials.",
    "Contacts are rigid: they follow restitution and friction alone.",
    "thesis 4.4",
    why="Two materials that differ in these values alone behave alike.",
)
JOINT_LIMITS = Rule(
    "engine-joint-limits",
    Severity.ERROR,
    "The engine cannot keep these limits of a joint.",
    "Each axis is locked, free, or has limits around zero; see the documentation of the engine.",
    "COLLADA 1.5 §rigid_constraint",
    why="The joint would stop elsewhere than the document says.",
)
JOINT_APPROXIMATED = Rule(
    "engine-joint-approximated",
    Severity.WARNING,
    "The engine keeps a joint only approximately.",
    None,
    "COLLADA 1.5 §rigid_constraint",
    why="The joint gives a little, or stops elsewhere.",
)
JOINT_DISPLACED = Rule(
    "engine-joint-displaced",
    Severity.WARNING,
    "The two bodies of a joint are not where the joint holds them.",
    "The engine brings them there before or in the first steps; check the frames of the joint.",
    "COLLADA 1.5 §rigid_constraint",
    why="Bodies that jump into place get velocities that nobody meant.",
)
JOINT_OUTSIDE = Rule(
    "engine-joint-outside",
    Severity.WARNING,
    "The two bodies of a joint start outside of its limits.",
    "The engine pushes them back with some force; check the limits and the poses.",
    "COLLADA 1.5 §rigid_constraint",
    why="The push gives the bodies energy that they did not have.",
)
JOINT_VELOCITY = Rule(
    "engine-joint-velocity",
    Severity.WARNING,
    "The velocities of the two bodies of a joint contradict it.",
    "The engine changes them to the nearest ones that fit, by impulses in the joints: momentum "
    "and angular momentum are kept, energy is lost as in an impact.",
    "thesis 2.2",
    why="No motion has these velocities; some of them have to change.",
)
JOINT_OVERLAP = Rule(
    "engine-joint-overlap",
    Severity.WARNING,
    "Two bodies of a joint overlap and collide: contact and joint work against each other.",
    "Let them interpenetrate (interpenetrate=True), or place them apart.",
    "COLLADA 1.5 §interpenetrate",
    why="The two push against each other for ever, and the scene trembles.",
)
JOINT_MOTOR = Rule(
    "engine-joint-motor",
    Severity.ERROR,
    "The engine cannot run the motor of a joint.",
    "Motors drive the only free axis of a hinge, or of a slider with MuJoCo, outside of loops.",
    "colladaphy docs/engines.md §Motors",
    why="Without it the joint would move otherwise than the scene says.",
)
JOINT_LOOP = Rule(
    "engine-joint-loop",
    Severity.ERROR,
    "The joint closes a loop of joints, in which the engine cannot keep joints of this kind.",
    "Close the loop with a fixed, ball or free hinge joint instead.",
    section="colladaphy docs/engines.md",
    why="The loop would drift apart.",
)
JOINT_INERT = Rule(
    "engine-joint-inert",
    Severity.INFO,
    "A joint between bodies that cannot move has no effect.",
    section="COLLADA 1.5 §rigid_constraint",
    why="Who wrote the joint expected something to move.",
)
CHOSEN = Rule(
    "engine-chosen",
    Severity.INFO,
    "The engine was chosen by the scene.",
    "Name an engine to choose it yourself.",
    section="colladaphy docs/engines.md",
    why="Engines come to different results.",
)
NO_ENGINE = Rule(
    "engine-none",
    Severity.ERROR,
    "No engine that is installed can run this scene: it is not planar, and MuJoCo is missing.",
    "Install it: pip install 'colladaphy[mujoco]'.",
    section="colladaphy docs/engines.md",
    why="There is nothing to run the scene with.",
)
LIBRARY = Rule(
    "engine-library",
    Severity.ERROR,
    "The library under the engine refuses the scene.",
    section="colladaphy docs/engines.md",
    why="There is no run without it.",
)
OVERTAKEN = Rule(
    "engine-edit",
    Severity.ERROR,
    "What was changed in the World cannot be taken up while the engine runs.",
    "Make such changes between two runs.",
    section="colladaphy docs/engines.md §Steering",
    why="The engine would go on with what it took up before.",
)
STEPS = Rule(
    "engine-steps",
    Severity.ERROR,
    "A number of steps is not what it can be.",
    "Steps are not negative; intervals between checkpoints or observations are positive.",
    section="colladaphy.Simulation",
    why="The run would never end, or never begin.",
)

RULES = (
    TIME_STEP,
    TIME_STEP_DEFAULT,
    UNKNOWN,
    NOT_INSTALLED,
    DIVERGED,
    SEED_UNUSED,
    FRICTIONS,
    MASS,
    INERTIA_ASSUMED,
    INERTIA_TRIANGLE,
    SHAPE_APPROXIMATED,
    MESH_HULL,
    NOT_PLANAR,
    PLANE_FINITE,
    MOVING_PLANE,
    SIZE,
    OPTION,
    SETTINGS,
    SETUP,
    STILL_VELOCITY,
    UNION_DIFFERS,
    AWAKE,
    MATERIAL_UNUSED,
    JOINT_LIMITS,
    JOINT_APPROXIMATED,
    JOINT_DISPLACED,
    JOINT_OUTSIDE,
    JOINT_VELOCITY,
    JOINT_OVERLAP,
    JOINT_MOTOR,
    JOINT_LOOP,
    JOINT_INERT,
    CHOSEN,
    NO_ENGINE,
    LIBRARY,
    OVERTAKEN,
    STEPS,
)


def refuse(rule: Rule, message: str) -> EngineError:
    """The error of a rule, to be raised."""
    return EngineError(rule.at(message=message))
