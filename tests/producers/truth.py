"""What the author of a file meant: scenes with known physics, from which producers write files.

All is in the standard's meaning (COLLADA 1.5 §rigid_body): solids and centres of mass in the frame
of the body's node, capsules and cylinders along y, angles in radians, angular velocities in rad/s.
Nothing here uses the library.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from hypothesis import strategies as st
from numpy.typing import NDArray

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
        return np.diag([across, along, across])

    def support(self, directions: Floats) -> Floats:
        """How far the solid reaches along directions (n, 3), in its own frame."""
        if self.kind in ("box", "mesh"):
            return np.max(directions @ self.points.T, axis=1)
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
        centre = sum(mass * place[:3, 3] for mass, place, _ in parts) / link.mass
        if link.inertia is not None:
            return centre, np.diag(link.inertia)
    tensor = np.zeros((3, 3))
    for mass, place, own in parts:
        turn, arm = place[:3, :3], place[:3, 3] - centre
        tensor += mass * turn @ own @ turn.T
        tensor += mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))
    return centre, tensor


# --- strategies


def _tame(low: int, high: int) -> st.SearchStrategy[float]:
    return st.integers(low, high).map(lambda number: number / 1000)


LENGTHS = _tame(50, 2000)
COORDINATES = _tame(-5000, 5000)
VECTORS = st.tuples(COORDINATES, COORDINATES, COORDINATES)
AXES = st.sampled_from([(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (0.6, 0.0, 0.8)])
TRANSLATES = VECTORS.map(lambda vector: ("translate", vector))
ROTATES = st.tuples(AXES, st.integers(-180, 180)).map(
    lambda pair: ("rotate", (*pair[0], float(pair[1])))
)


def steps(least: int = 0, most: int = 3) -> st.SearchStrategy[Steps]:
    """Translations and rotations in any order, repeated too."""
    return st.lists(st.one_of(TRANSLATES, ROTATES), min_size=least, max_size=most).map(tuple)


PLACES = st.tuples(TRANSLATES, ROTATES)


@st.composite
def solids(draw: st.DrawFn, kinds: tuple[str, ...], places: bool) -> Solid:
    kind = draw(st.sampled_from(kinds))
    count = {"box": 3, "mesh": 3, "sphere": 1, "cylinder": 2, "capsule": 2}[kind]
    size = tuple(draw(LENGTHS) for _ in range(count))
    return Solid(kind, size, draw(PLACES) if places else ())


@st.composite
def principal(draw: st.DrawFn) -> tuple[float, float, float]:
    """Moments of inertia that a body can have: none exceeds the sum of the others."""
    x, y, z = (draw(_tame(10, 1000)) for _ in range(3))
    return round(y + z, 6), round(x + z, 6), round(x + y, 6)


KINDS = ("box", "sphere", "cylinder", "capsule", "mesh")


@st.composite
def scenes(
    draw: st.DrawFn,
    *,
    kinds: tuple[str, ...] = KINDS,
    placed: bool = True,
    compounds: bool = True,
    centred: bool = False,
    nested: bool = False,
    rooted: bool = False,
    moving: bool = True,
    joints: bool = False,
    most: int = 4,
) -> Scene:
    """A scene of one to `most` links; with `centred` all state a mass frame and an inertia."""
    links = []
    for number in range(draw(st.integers(1, most))):
        several = compounds and draw(st.booleans())
        count = draw(st.integers(2, 3)) if several else 1
        made = tuple(draw(solids(kinds, placed or several)) for _ in range(count))
        stated = centred or draw(st.booleans())
        links.append(
            Link(
                name=f"link{number}",
                steps=draw(PLACES),
                solids=made,
                mass=draw(_tame(100, 20000)),
                centre=draw(PLACES) if stated and centred else None,
                inertia=draw(principal()) if stated and centred else None,
                fixed=draw(st.booleans()) if not centred else False,
                velocity=draw(VECTORS) if moving else (0.0, 0.0, 0.0),
                spin=draw(VECTORS) if moving else (0.0, 0.0, 0.0),
                parent=number - 1 if nested and number and draw(st.booleans()) else None,
            )
        )
    found: list[Joint] = []
    if joints and len(links) > 1:
        found = [draw(_joints(number)) for number in range(1, len(links))]
    return Scene(
        tuple(links),
        tuple(found),
        gravity=draw(st.sampled_from([(0.0, 0.0, -9.81), (0.0, -9.81, 0.0), (0.0, 0.0, 0.0)])),
        root=draw(PLACES) if rooted else (),
    )


@st.composite
def _joints(draw: st.DrawFn, number: int) -> Joint:
    linear = [draw(_ranges()) for _ in range(3)]
    angular = [draw(_ranges()) for _ in range(3)]
    return Joint(
        name=f"joint{number}",
        first=draw(st.sampled_from([None, number - 1])),
        second=number,
        frames=(draw(PLACES), draw(PLACES)),
        linear=(tuple(low for low, _ in linear), tuple(high for _, high in linear)),
        angular=(tuple(low for low, _ in angular), tuple(high for _, high in angular)),
    )


@st.composite
def _ranges(draw: st.DrawFn) -> tuple[float, float]:
    """Locked, limited or free."""
    return draw(
        st.one_of(
            st.just((0.0, 0.0)),
            st.tuples(_tame(-90000, -1), _tame(1, 90000)),
            st.just((-math.inf, math.inf)),
        )
    )
