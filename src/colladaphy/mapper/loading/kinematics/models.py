"""Kinematics models: links, and the joints that hold them together (COLLADA 1.5 §kinematics_model).

A link holds others by attachments: the joint stands at the attachment's transform in the frame of
the outer link, and moves the inner one along with its own transform.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.links.names import c
from colladaphy.links.pool import Pool
from colladaphy.links.poses import DEGREE, Poses
from colladaphy.links.steps import Steps, poses_of_steps
from colladaphy_schema.kinematics_model_columns import (
    JointTypeRows,
    KinematicsModelTypeRows,
)
from colladaphy_schema.rows import Rows

__all__ = [
    "Attachment",
    "Axis",
    "JointModel",
    "Link",
    "Model",
    "numbers_of",
    "read_joints",
    "read_model",
]

Array = NDArray[Any]
Place = tuple[int, int]
"""The number of a document, and that of an element in it."""


@dataclass(frozen=True, slots=True)
class Axis:
    """One freedom of a joint."""

    place: Place
    slides: bool
    direction: tuple[float, float, float]
    """Of length one; zero where the joint does not move at all."""
    low: float
    high: float
    """Limits, in radians or lengths; ±inf for none."""
    locked: bool = False

    @property
    def is_still(self) -> bool:
        """Whether nothing moves along it."""
        return self.locked or not any(self.direction) or self.low == self.high


@dataclass(frozen=True, slots=True)
class JointModel:
    """A joint of a model or of a library: its axes act one after the other."""

    place: Place
    name: str | None
    axes: tuple[Axis, ...]

    @property
    def moving(self) -> tuple[Axis, ...]:
        """Those of its axes that move."""
        return tuple(axis for axis in self.axes if not axis.is_still)


@dataclass(slots=True)
class Link:
    """A rigid part of a kinematics model."""

    place: Place
    sid: str | None
    name: str | None
    pose: Poses
    """One row: its own transform, behind the joint that moves it."""

    @property
    def label(self) -> str:
        """What it is called."""
        return self.name or self.sid or "?"


@dataclass(slots=True)
class Attachment:
    """What binds two links at a joint."""

    place: Place
    joint: str
    """The reference to the joint."""
    outer: int
    """The link that the joint stands on, by its number."""
    before: Poses
    """One row: where the joint stands in it."""
    inner: int
    """The link that the joint moves; -1 while nobody ends what is started."""
    after: Poses | None = None
    """One row: where the joint stands in the inner link, of what closes a loop; else None."""


@dataclass(slots=True)
class Model:
    """The links of a model, outer ones first, and what binds them."""

    place: Place
    name: str
    links: list[Link] = field(default_factory=list)
    roots: list[int] = field(default_factory=list)
    attachments: list[Attachment] = field(default_factory=list)
    formulas: list[int] = field(default_factory=list)
    """The elements that make axes follow others."""
    unended: list[Attachment] = field(default_factory=list)
    """Loops of which one end is missing."""


def numbers_of(rows: Rows) -> list[int]:
    """The numbers of the elements that rows are of."""
    assert rows.ordinals is not None
    listed: list[int] = rows.ordinals.tolist()
    return listed


def read_model(pool: Pool, row: int) -> Model:
    """The kinematics_model of a row of its table."""
    table = pool.table(KinematicsModelTypeRows, c("kinematics_model"))
    home = int(table.homes(np.array([row]))[0])
    rows = table.parts[home].select(np.array([row - table.start(home)]))
    place = home, int(table.ordinals[row])
    model = Model(place, rows.name[0] or rows.id[0] or "?")
    common = rows.technique_common
    for child in (common.formula, common.instance_formula):
        model.formulas += numbers_of(child)
    level, outer, befores = common.link, None, Poses.none(0)
    starts: list[Attachment] = []
    ends: list[tuple[str, int, Poses, int]] = []
    while len(level):
        first = len(model.links)
        own = poses_of_steps(Steps.of(level))
        for number, (ordinal, sid, name) in enumerate(
            zip(numbers_of(level), level.sid, level.name, strict=True)
        ):
            model.links.append(Link((home, ordinal), sid, name, own.take(np.array([number]))))
            if outer is None:
                model.roots.append(first + number)
            else:
                held, joint, stands = outer[number]
                model.attachments.append(
                    Attachment(
                        stands, joint, held, befores.take(np.array([number])), first + number
                    )
                )
        for part, closing in ((level.attachment_start, False), (level.attachment_end, True)):
            poses = poses_of_steps(Steps.of(part))
            for number, (owner, joint, ordinal) in enumerate(
                zip(part.owner.tolist(), part.joint, numbers_of(part), strict=True)
            ):
                pose = poses.take(np.array([number]))
                if closing:
                    ends.append((joint, first + owner, pose, ordinal))
                else:
                    starts.append(Attachment((home, ordinal), joint, first + owner, pose, -1))
        full = level.attachment_full
        inner = full.link
        befores = poses_of_steps(Steps.of(full)).take(inner.owner)
        outer = [
            (first + int(full.owner[at]), full.joint[at], (home, numbers_of(full)[at]))
            for at in inner.owner.tolist()
        ]
        level = inner
    _close(model, starts, ends)
    return model


def _close(model: Model, starts: list[Attachment], ends: list[tuple[str, int, Poses, int]]) -> None:
    """Put each end to the start of the same joint."""
    left = list(ends)
    for start in starts:
        found = next((end for end in left if end[0] == start.joint), None)
        if found is None:
            model.unended.append(start)
            continue
        left.remove(found)
        start.inner, start.after = found[1], found[2]
        model.attachments.append(start)
    home = model.place[0]
    model.unended += [
        Attachment((home, ordinal), joint, link, pose, -1) for joint, link, pose, ordinal in left
    ]


def read_joints(pool: Pool) -> dict[Place, JointModel]:
    """All joints of the documents of a pool."""
    found: dict[Place, JointModel] = {}
    for home, rows in enumerate(pool.table(JointTypeRows, c("joint")).parts):
        axes: dict[int, list[tuple[int, Axis]]] = {}
        for kind, slides in (("prismatic", True), ("revolute", False)):
            part = getattr(rows, kind)
            lows = _limits(part, "min", -math.inf)
            highs = _limits(part, "max", math.inf)
            for owner, ordinal, direction, low, high in zip(
                part.owner.tolist(), numbers_of(part), part.axis.value, lows, highs,
                strict=True,
            ):  # fmt: skip
                axis = _axis((home, ordinal), slides, direction, low, high)
                axes.setdefault(owner, []).append((ordinal, axis))
        for row, (ordinal, sid, name) in enumerate(
            zip(numbers_of(rows), rows.sid, rows.name, strict=True)
        ):
            listed = tuple(axis for _, axis in sorted(axes.get(row, []), key=lambda one: one[0]))
            found[home, ordinal] = JointModel((home, ordinal), name or sid, listed)
    return found


def _limits(part: Any, name: str, default: float) -> list[float]:
    made = [default] * len(part)
    limits = part.limits
    child = getattr(limits, name)
    for owner, value in zip(child.owner.tolist(), child.value.tolist(), strict=True):
        made[int(limits.owner[owner])] = value
    return made


def _axis(place: Place, slides: bool, direction: Array, low: float, high: float) -> Axis:
    length = math.hypot(*direction.tolist())
    unit = (0.0, 0.0, 0.0)
    if 0.0 < length < math.inf:
        x, y, z = (direction / length).tolist()
        unit = (x, y, z)
    scale = 1.0 if slides else DEGREE
    return Axis(place, slides, unit, low * scale, high * scale)
