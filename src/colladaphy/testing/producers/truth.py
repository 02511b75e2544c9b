"""What the author of a file meant: scenes with known physics, from which producers write files.

All is in the standard's meaning (COLLADA 1.5 §rigid_body): solids and centres of mass in the frame
of the body's node, capsules and cylinders along y, angles in radians, angular velocities in rad/s.
Nothing here uses the library.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "Joint",
    "Link",
    "Scene",
    "Solid",
    "Step",
    "Steps",
    "mass_properties",
    "matrix_of",
]

Floats = NDArray[np.float64]
Step = tuple[str, tuple[float, ...]]
"""("translate", (x, y, z)) or ("rotate", (x, y, z, degrees))."""
Steps = tuple[Step, ...]


def matrix_of(steps: Steps) -> Floats:
    """The steps as one matrix, each within the one before."""
    result = np.eye(4)
    for name, values in steps:
        own = np.eye(4)
        if name == "translate":
            own[:3, 3] = values
        else:
            axis = np.array(values[:3]) / np.linalg.norm(values[:3])
            angle = math.radians(values[3])
            cross = np.array(
                [[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]]
            )
            own[:3, :3] = (
                np.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross
            )
        result = result @ own
    return result


@dataclass(frozen=True)
class Solid:
    """A shape: a box by half extents, a sphere, a cylinder or capsule along y, or a box's mesh."""

    kind: str
    size: tuple[float, ...]
    steps: Steps = ()

    @property
    def points(self) -> Floats:
        """The corners of a box or a mesh (8, 3)."""
        x, y, z = self.size
        return np.array([(i * x, j * y, k * z) for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)])

    @property
    def volume(self) -> float:
        """What the solid encloses."""
        if self.kind in ("box", "mesh"):
            return 8.0 * math.prod(self.size)
        r = self.size[0]
        ball = 4 / 3 * math.pi * r**3
        if self.kind == "sphere":
            return ball
        return math.pi * r * r * self.size[1] + (ball if self.kind == "capsule" else 0.0)

    @property
    def inertia(self) -> Floats:
        """Inertia for mass one, about the centre (3, 3)."""
        if self.kind in ("box", "mesh"):
            x, y, z = self.size
            return np.diag([y * y + z * z, x * x + z * z, x * x + y * y]) / 3.0
        r = self.size[0]
        if self.kind == "sphere":
            return 0.4 * r * r * np.eye(3)
        h = self.size[1]
        across, along = r * r / 4 + h * h / 12, r * r / 2
        if self.kind == "capsule":
            ball = 4 / 3 * math.pi * r**3 / self.volume
            along = (1 - ball) * along + ball * 0.4 * r * r
            ends = 0.4 * r * r + 0.375 * r * h + h * h / 4
            across = (1 - ball) * across + ball * ends
        made: Floats = np.diag([across, along, across])
        return made

    def support(self, directions: Floats) -> Floats:
        """How far the solid reaches along directions (n, 3), in its own frame."""
        if self.kind in ("box", "mesh"):
            return np.asarray(np.max(directions @ self.points.T, axis=1))
        r = self.size[0]
        if self.kind == "sphere":
            return np.full(len(directions), r)
        half = self.size[1] / 2 * np.abs(directions[:, 1])
        if self.kind == "capsule":
            return half + r
        return half + r * np.hypot(directions[:, 0], directions[:, 2])


@dataclass(frozen=True)
class Link:
    """A body at a place. `centre` is the frame of its centre of mass and principal axes."""

    name: str
    steps: Steps
    solids: tuple[Solid, ...]
    mass: float
    centre: Steps | None = None
    inertia: tuple[float, float, float] | None = None
    fixed: bool = False
    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)
    spin: tuple[float, float, float] = (0.0, 0.0, 0.0)
    parent: int | None = None
    """The link whose node holds its node, where nodes are nested; `steps` are relative to it."""
    joint: float = 0.0
    """Degrees about z by which a robot's joint is turned in the file, after `steps`."""


@dataclass(frozen=True)
class Joint:
    """A constraint between two links (None is the world), with frames in their nodes."""

    name: str
    first: int | None
    second: int
    frames: tuple[Steps, Steps] = ((), ())
    linear: tuple[tuple[float, ...], tuple[float, ...]] = ((0.0,) * 3, (0.0,) * 3)
    angular: tuple[tuple[float, ...], tuple[float, ...]] = ((0.0,) * 3, (0.0,) * 3)
    """Degrees."""


@dataclass(frozen=True)
class Scene:
    """Links and joints, and the world that they are in."""

    links: tuple[Link, ...]
    joints: tuple[Joint, ...] = ()
    gravity: tuple[float, float, float] | None = (0.0, 0.0, -9.81)
    time_step: float | None = None
    unit: float = 1.0
    up_axis: str = "Z_UP"
    friction: tuple[float, float, float] = (0.5, 0.25, 0.125)
    """Static and dynamic friction, restitution."""
    root: Steps = field(default=())
    """Where the node above all links is (robots)."""

    def place(self, index: int, *, rest: bool = False) -> Floats:
        """The node of a link in the world; with `rest` with all joints at zero."""
        link = self.links[index]
        outer = matrix_of(self.root) if link.parent is None else self.place(link.parent, rest=rest)
        turn: Steps = () if rest else (("rotate", (0.0, 0.0, 1.0, link.joint)),)
        return outer @ matrix_of((*link.steps, *turn))

    def place_in_model(self, index: int) -> Floats:
        """The node of a link in the frame of the robot's root, with all joints at zero."""
        return np.linalg.inv(matrix_of(self.root)) @ self.place(index, rest=True)


def mass_properties(link: Link) -> tuple[Floats, Floats]:
    """Centre of mass and inertia about it, in the node's frame; from the solids if not stated."""
    volume = sum(solid.volume for solid in link.solids)
    parts = [
        (link.mass * solid.volume / volume, matrix_of(solid.steps), solid.inertia)
        for solid in link.solids
    ]
    if link.centre is not None:
        frame = matrix_of(link.centre)
        centre = frame[:3, 3]
        if link.inertia is not None:
            turn = frame[:3, :3]
            return centre, turn @ np.diag(link.inertia) @ turn.T
    else:
        centre = np.sum([mass * place[:3, 3] for mass, place, _ in parts], axis=0) / link.mass
        if link.inertia is not None:
            return centre, np.diag(link.inertia)
    tensor = np.zeros((3, 3))
    for mass, place, own in parts:
        turn, arm = place[:3, :3], place[:3, 3] - centre
        tensor += mass * turn @ own @ turn.T
        tensor += mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))
    return centre, tensor
