"""The instances of rigid_bodies as columns (thesis 5.3; COLLADA 1.5 §instance_rigid_body)."""

from __future__ import annotations

import re
from functools import cached_property
from typing import Any

import numpy as np
from lxml import etree
from numpy.typing import NDArray

from colladaphy.document.names import c
from colladaphy.mapper.columns.texts import Column, count_of, number_rows, recognised
from colladaphy.mapper.numbers import DEGREE

__all__ = ["KEPT", "MotionTable"]

Array = NDArray[Any]

KEPT = ("position", "orientation", "linear_velocity", "angular_velocity", "force", "torque")
"""What the pe profile says of a motion."""

# Nothing but velocities, and of the pe profile nothing but the motion.
_REGULAR = re.compile(
    r"\s*<instance_rigid_body"
    r'(?: body="(?P<body>[^"&]*)" target="(?P<target>[^"&]*)">|\s[^>]*>)\s*'
    r"(?:<technique_common/>|<technique_common>\s*"
    r"(?:<angular_velocity>(?P<angular>[^<]+)</angular_velocity>\s*)?"
    r"(?:<velocity>(?P<linear>[^<]+)</velocity>\s*)?</technique_common>)\s*"
    r'(?:<technique profile="pe">\s*<pe:motion(?: sleeping="(?P<sleeping>[^"]*)")?(?:/>|>\s*'
    + "".join(rf"(?:<pe:{name}>(?P<{name}>[^<]+)</pe:{name}>\s*)?" for name in KEPT)
    + r"</pe:motion>)\s*</technique>\s*)?</instance_rigid_body>"
)


class MotionTable:
    """One row for each instance_rigid_body of an instance of a model."""

    def __init__(self, model: etree._Element) -> None:
        self._model = model
        count = count_of(model, "instance_rigid_body")
        self.regular: Array = np.zeros(count, dtype=np.bool_)
        self.bodies: list[str] = [""] * count
        self.targets: list[str] = [""] * count
        self.linear: Array = np.zeros((count, 3))
        self.angular: Array = np.zeros((count, 3))
        """In radians."""
        self.sleeping: Array = np.zeros(count, dtype=np.bool_)
        self.kept: dict[str, Array] = {
            name: np.zeros((count, 4 if name == "orientation" else 3)) for name in KEPT
        }
        self.has: dict[str, Array] = {name: np.zeros(count, dtype=np.bool_) for name in KEPT}
        """Where the pe profile has a value."""
        self.names: dict[int, str] = {}
        """Names by row."""
        try:
            rows, columns = recognised(_REGULAR, model, "instance_rigid_body", count)
            self._read(rows, columns)
        except ValueError:
            return
        self.regular[rows] = True

    @cached_property
    def elements(self) -> list[etree._Element]:
        """The instances, which are not needed where all are regular."""
        return list(self._model.iterchildren(c("instance_rigid_body")))

    def _read(self, rows: Array, columns: dict[str, Column]) -> None:
        if not len(rows):
            return
        self.linear[rows] = number_rows(columns["linear"], 3)[0]
        self.angular[rows] = number_rows(columns["angular"], 3)[0] * DEGREE
        self.sleeping[rows] = [text in ("true", "1") for text in columns["sleeping"]]
        for name in KEPT:
            values, has = number_rows(columns[name], self.kept[name].shape[1])
            self.kept[name][rows] = values
            self.has[name][rows] = has
        self._identify(rows.tolist(), list(columns["body"]), list(columns["target"]))

    def _identify(self, rows: list[int], bodies: list[str], targets: list[str]) -> None:
        """References and names."""
        for place, body in enumerate(bodies):
            if not body:  # there are other attributes, or others first
                element = self.elements[rows[place]]
                bodies[place], targets[place] = element.get("body", ""), element.get("target", "")
                name = element.get("name")
                if name is not None:
                    self.names[rows[place]] = name
        if len(rows) == len(self.regular):
            self.bodies, self.targets = bodies, targets
            return
        for row, body, target in zip(rows, bodies, targets, strict=True):
            self.bodies[row], self.targets[row] = body, target
