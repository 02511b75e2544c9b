"""Rules of conform: what a producer means otherwise than the standard."""

from __future__ import annotations

from colladaphy.findings import Rule, Severity

__all__ = ["RULES"]

_INFO, _WARNING = Severity.INFO, Severity.WARNING

CONVENTION = Rule(
    "convention-chosen",
    _INFO,
    "the document follows a producer's own reading of the standard",
    'choose another with convention=..., or "none"',
    section="COLLADA 1.5 §authoring_tool",
    why="the same numbers mean different things to different producers",
)
FRAMES = Rule(
    "convention-frames",
    _INFO,
    "mass frames or shapes stood in the model's space",
    "they are in the body's space now",
    section="COLLADA 1.5 §mass_frame",
    why="centres of mass and shapes would be off by the body's own pose",
)
FRAMES_LOCAL = Rule(
    "convention-frames-local",
    _INFO,
    "frames were taken to be in the body's space already",
    "the numbers say so, though the producer often writes them otherwise",
    section="COLLADA 1.5 §mass_frame",
    why="to move them again would put them wrong",
)
FRAMES_DOUBTFUL = Rule(
    "convention-frames-doubtful",
    _WARNING,
    "the numbers speak against the chosen reading of frames",
    "compare the result with what you expect",
    section="COLLADA 1.5 §mass_frame",
    why="if the reading is wrong, bodies are off by their own pose",
)
ANGLE_UNIT = Rule(
    "convention-angle-unit",
    _INFO,
    "angles or angular velocities were in radians",
    "they are in degrees now, as the standard has them",
    section="COLLADA 1.5 §limits",
    why="limits and spins would be 57 times too small",
)
FREE_LIMITS = Rule(
    "convention-free-limits",
    _INFO,
    "a free axis was not written with infinite limits",
    "it is -INF to INF now",
    section="COLLADA 1.5 §limits",
    why="the axis would be locked",
)
WORLD_JOINT = Rule(
    "convention-world-joint",
    _INFO,
    "a joint had the same body at both ends",
    "Bullet writes joints to the world so; its frame there is where the body is now",
    section="COLLADA 1.5 §ref_attachment",
    why="a joint of a body with itself holds nothing",
)
MASS_CENTRE = Rule(
    "convention-mass-centre",
    _INFO,
    "bodies had no mass_frame",
    "to Bullet the centre of mass is the origin of the node, wherever the shapes are",
    section="COLLADA 1.5 §mass_frame",
    why="the body would turn about the centre of its shapes",
)
INERT_SPRING = Rule(
    "convention-inert-spring",
    _INFO,
    "a spring without stiffness had a target that is no number",
    "it pulls nowhere; its target is kept in an extra",
    section="COLLADA 1.5 §spring",
    why="one value that is no number spoils all that are computed with it",
)
PLANE_SIGN = Rule(
    "convention-plane-sign",
    _INFO,
    "a plane's constant had the opposite sign",
    "the standard's equation is n.x + D = 0",
    section="COLLADA 1.5 §plane",
    why="the ground would be as far below as it should be above",
)
HALF_HEIGHT = Rule(
    "convention-half-height",
    _INFO,
    "a height was written halved",
    "the standard has the full height",
    section="COLLADA 1.5 §cylinder",
    why="shapes would have half of their height",
)
AXIS = Rule(
    "convention-axis",
    _INFO,
    "a solid stood along z",
    "the standard's stand along y; it was turned",
    section="COLLADA 1.5 §cylinder",
    why="shapes would lie that should stand",
)
GRAVITY_UNIT = Rule(
    "convention-gravity-unit",
    _WARNING,
    "gravity was in metres, whatever the document's unit",
    "it is in the document's unit now",
    section="COLLADA 1.5 §gravity",
    why="bodies would fall too fast or too slowly by the unit's factor",
)
HOLLOW = Rule(
    "convention-hollow",
    _INFO,
    "shapes were called hollow without a mass of their own",
    "the producer writes so for solid shapes",
    section="COLLADA 1.5 §hollow",
    why="the mass would be that of a shell",
)
RESTITUTION = Rule(
    "convention-restitution",
    _INFO,
    "a restitution stood where a spring's target belongs",
    "it is kept in an extra",
    section="COLLADA 1.5 §spring",
    why="the spring would pull to a place that nobody meant",
)
CURRENT_DISTANCE = Rule(
    "convention-current-distance",
    _INFO,
    "linear limits counted from where the bodies are",
    "the frame of the reference body stands where the other one is now",
    "thesis 5.6",
    why="the bodies would snap together",
)

RULES = (
    CONVENTION,
    FRAMES,
    FRAMES_LOCAL,
    FRAMES_DOUBTFUL,
    ANGLE_UNIT,
    FREE_LIMITS,
    WORLD_JOINT,
    MASS_CENTRE,
    INERT_SPRING,
    PLANE_SIGN,
    HALF_HEIGHT,
    AXIS,
    GRAVITY_UNIT,
    HOLLOW,
    RESTITUTION,
    CURRENT_DISTANCE,
)
