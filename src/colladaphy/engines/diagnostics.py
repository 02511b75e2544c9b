"""Energy and momentum of a World, for all bodies that move; in units of kg, s and the World's."""

from __future__ import annotations

from collections.abc import Callable, Sized
from dataclasses import dataclass, field
from functools import cached_property
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, Final, cast

import numpy as np
from numpy.typing import NDArray

from colladaphy.world import rotations

if TYPE_CHECKING:
    from colladaphy.world import Joint, World

__all__ = [
    "Summary",
    "angular_momentum",
    "kinetic_energy",
    "momentum",
    "potential_energy",
    "spring_energy",
    "summarise",
]

Floats = NDArray[np.float64]


class ContactCount:
    """How many contacts there are, counted when somebody asks: it can take longer than a step."""

    __slots__ = ("__weakref__", "_contacts", "_count")

    def __init__(self, contacts: Callable[[], Sized]) -> None:
        self._contacts: Callable[[], Sized] | None = contacts
        self._count = 0

    def read(self) -> int:
        """The number; it has to be read before the engine goes on."""
        if self._contacts is not None:
            self._count = len(self._contacts())
            self._contacts = None
        return self._count


class Moment:
    """The bodies of a World as they were, of which energy and momentum are computed when asked for.

    Copying them takes far less time than a step.
    """

    def __init__(self, world: World) -> None:
        self._still = SimpleNamespace(
            **{name: np.array(getattr(world, name)) for name in _MEASURED},
            gravity=np.array(world.gravity), joints=(),
        )  # fmt: skip
        self._springs = spring_energy(world)

    @cached_property
    def kinetic_energy(self) -> float:
        return kinetic_energy(cast("World", self._still))

    @cached_property
    def potential_energy(self) -> float:
        return self._springs + potential_energy(cast("World", self._still))

    @cached_property
    def momentum(self) -> tuple[float, ...]:
        return tuple(momentum(cast("World", self._still)).tolist())

    @cached_property
    def angular_momentum(self) -> tuple[float, ...]:
        return tuple(angular_momentum(cast("World", self._still)).tolist())

    def __eq__(self, other: object) -> bool:
        names = ("kinetic_energy", "potential_energy", "momentum", "angular_momentum")
        return isinstance(other, Moment) and all(
            getattr(self, name) == getattr(other, name) for name in names
        )

    __hash__ = object.__hash__


_MEASURED: Final = ("fixed", "masses", "inertias", "positions", "orientations",
                    "linear_velocities", "angular_velocities")  # fmt: skip


@dataclass(frozen=True, slots=True)
class Summary:
    """How a World is at one moment."""

    engine: str
    time: float
    step_count: int
    bodies: int
    """Top-level bodies that can move."""
    sleeping: int
    count: ContactCount = field(repr=False, compare=False)
    moment: Moment = field(repr=False)

    @property
    def kinetic_energy(self) -> float:
        """½ Σ m·v² + ω·I·ω over the bodies that can move."""
        return self.moment.kinetic_energy

    @property
    def potential_energy(self) -> float:
        """Of gravity, zero at the origin, and of the springs of joints."""
        return self.moment.potential_energy

    @property
    def momentum(self) -> tuple[float, ...]:
        """Σ m·v."""
        return self.moment.momentum

    @property
    def angular_momentum(self) -> tuple[float, ...]:
        """About the origin."""
        return self.moment.angular_momentum

    @property
    def contacts(self) -> int:
        """Points in which bodies touch."""
        return self.count.read()

    @property
    def energy(self) -> float:
        """Kinetic and potential energy together."""
        return self.kinetic_energy + self.potential_energy


def _spin(world: World, moving: NDArray[Any]) -> tuple[Floats, Floats]:
    """Angular velocities and angular momenta (n, 3) about the bodies' own centres."""
    angular = world.angular_velocities[moving]
    turn = world.orientations[moving]
    local = rotations.unrotate(turn, angular)
    inertias = np.asarray(world.inertias[moving])
    return angular, rotations.rotate(turn, np.einsum("nij,nj->ni", inertias, local))


def kinetic_energy(world: World) -> float:
    """½ Σ m·v² + ω·I·ω over the bodies that can move."""
    moving = ~world.fixed
    linear = world.linear_velocities[moving]
    angular, spin = _spin(world, moving)
    straight = float(world.masses[moving] @ np.einsum("ni,ni->n", linear, linear))
    return 0.5 * (straight + float(np.sum(angular * spin)))


def potential_energy(world: World) -> float:
    """−Σ m·g·x over the bodies that can move, and the energy of springs."""
    moving = ~world.fixed
    height = world.positions[moving] @ world.gravity
    return spring_energy(world) - float(world.masses[moving] @ height)


def momentum(world: World) -> Floats:
    """Σ m·v (3,) over the bodies that can move."""
    moving = ~world.fixed
    return np.asarray(world.masses[moving] @ world.linear_velocities[moving])


def angular_momentum(world: World) -> Floats:
    """Σ x × m·v + I·ω (3,) about the origin, over the bodies that can move."""
    moving = ~world.fixed
    straight = world.masses[moving, None] * world.linear_velocities[moving]
    orbital = np.cross(world.positions[moving], straight)
    return np.asarray((orbital + _spin(world, moving)[1]).sum(axis=0))


def spring_energy(world: World) -> float:
    """½ Σ k·(q − target)² over the free axes of the joints that are enabled and have springs."""
    return sum(
        _spring_energy(joint)
        for joint in world.joints
        if joint.enabled and (joint.linear_spring[0] or joint.angular_spring[0])
    )


def _spring_energy(joint: Joint) -> float:
    shift, turn = joint_coordinates(joint)
    total = 0.0
    for values, low, high, spring in (
        (shift, joint.linear_min, joint.linear_max, joint.linear_spring),
        (turn, joint.angular_min, joint.angular_max, joint.angular_spring),
    ):
        free = low != high
        total += 0.5 * spring[0] * float(np.sum((values[free] - spring[2]) ** 2))
    return total


def joint_coordinates(joint: Joint) -> tuple[Floats, Floats]:
    """Displacement (3,) along and rotation vector (3,) about the axes of frame 1."""
    poses = []
    for body, frame in ((joint.body1, joint.frame1), (joint.body2, joint.frame2)):
        origin = np.zeros(3) if body is None else body.position
        turn = np.array(rotations.IDENTITY) if body is None else body.orientation
        point = origin + rotations.rotate(turn, frame[0])
        poses.append((point, rotations.multiply(turn, frame[1])))
    (origin1, turn1), (origin2, turn2) = poses
    shift = rotations.unrotate(turn1, origin2 - origin1)
    axis, angle = rotations.to_axis_angle(rotations.multiply(rotations.conjugate(turn1), turn2))
    return shift, axis * angle


def summarise(world: World, engine: str, count: ContactCount) -> Summary:
    """The summary of `world` as `engine` left it."""
    moving = ~world.fixed
    return Summary(
        engine=engine,
        time=world.time,
        step_count=world.step_count,
        bodies=int(moving.sum()),
        sleeping=int((world.sleeping & moving).sum()),
        count=count,
        moment=Moment(world),
    )
