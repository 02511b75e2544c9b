"""Bodies, nodes and motions of one instance of a model joined to one row a body."""

from __future__ import annotations

from collections.abc import Container
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.document.poses import NO_ROTATION, quaternion_from_axis_angle
from colladaphy.mapper.columns.bodies import BodyTable
from colladaphy.mapper.columns.freshness import same_numbers, same_turns
from colladaphy.mapper.columns.motions import KEPT, MotionTable
from colladaphy.mapper.columns.nodes import NodeTable
from colladaphy.world.columns import BodyColumns

if TYPE_CHECKING:
    from colladaphy.document import Prefer

__all__ = ["Joined"]

Array = NDArray[Any]


class Joined:
    """The regular bodies among the instances of a model.

    An instance is left out where one of its three records is not regular, where the profiles are
    not plainly the same, or where the World would refuse a number.
    """

    def __init__(
        self,
        motions: MotionTable,
        table: BodyTable,
        nodes: NodeTable,
        materials: Container[str],
        prefer: Prefer,
    ) -> None:
        self._motions = motions
        self._table = table
        count = len(motions.regular)
        bodies = np.array([table.index.get(name, -1) for name in motions.bodies], dtype=np.int64)
        places = np.array([nodes.rows.get(name, -1) for name in motions.targets], dtype=np.int64)
        regular = motions.regular & (bodies >= 0) & (places >= 0)
        usable = table.regular.copy()
        if any(url not in materials for url in set(table.materials)):
            usable &= np.array([url in materials for url in table.materials], dtype=np.bool_)
        regular[regular] = usable[bodies[regular]]
        self._positions, self._orientations = np.zeros((count, 3)), np.zeros((count, 4))
        rows = np.flatnonzero(regular)
        self._positions[rows] = nodes.positions[places[rows]]
        turned, turns = np.zeros(count, dtype=np.bool_), np.zeros((count, 4))
        turned[rows] = nodes.turned[places[rows]]
        turns[rows] = nodes.turns[places[rows]]
        self._decide(regular, turned, turns, prefer)
        for column in (self._positions, self._orientations, motions.linear, motions.angular,
                       motions.kept["force"], motions.kept["torque"]):  # fmt: skip
            regular &= np.all(np.isfinite(column), axis=1)
        regular &= np.any(self._orientations != 0.0, axis=1)
        self.regular = regular
        """Which instances are regular."""
        self.rows = np.flatnonzero(regular)
        """The places of the regular ones among all."""
        self.bodies = bodies[self.rows]
        """The rows of their bodies in the table."""
        known, listed = table.materials, self.bodies.tolist()
        self.materials = [known[row] for row in listed]
        self.sids = [table.sids[row] for row in listed]

    def _decide(self, regular: Array, turned: Array, turns: Array, prefer: Prefer) -> None:
        """Take the pe profile's values where they are the newer ones (see `staleness`)."""
        kept, has = self._motions.kept, self._motions.has
        if prefer == "common":
            for name in KEPT:
                kept[name][...] = 0.0
                has[name][...] = False
            self._motions.sleeping[...] = False
        for name, column in (
            ("position", self._positions),
            ("linear_velocity", self._motions.linear),
            ("angular_velocity", self._motions.angular),
        ):
            rows = np.flatnonzero(regular & has[name])
            if prefer == "newer":
                same = same_numbers(column[rows], kept[name][rows])
                regular[rows] = same
            column[rows] = kept[name][rows]
        given = has["orientation"]
        rows = np.flatnonzero(regular & given)
        if prefer == "newer":
            regular[rows] = same_turns(turned[rows], turns[rows], kept["orientation"][rows])
        self._orientations[rows] = kept["orientation"][rows]
        self._orientations[regular & ~given] = NO_ROTATION
        # One by one, so that sine and cosine are those of the path for everything.
        for row in np.flatnonzero(regular & ~given & turned).tolist():
            turn = quaternion_from_axis_angle(*turns[row].tolist())
            self._orientations[row] = NO_ROTATION if turn is None else turn

    def columns(self, material_ids: dict[str, int]) -> BodyColumns:
        """The bodies as `World.extend` takes them, without system ids."""
        table, motions, rows, bodies = self._table, self._motions, self.rows, self.bodies
        return BodyColumns(
            kinds=table.kinds[bodies],
            uids=table.uids[bodies],
            positions=self._positions[rows],
            orientations=self._orientations[rows],
            linear_velocities=motions.linear[rows],
            angular_velocities=motions.angular[rows],
            forces=motions.kept["force"][rows],
            torques=motions.kept["torque"][rows],
            masses=table.masses[bodies],
            fixed=table.fixed[bodies],
            sleeping=motions.sleeping[rows],
            material_ids=np.array([material_ids[url] for url in self.materials], dtype=np.int64),
            dimensions=table.dimensions[bodies],
            hollow=table.hollow[bodies],
            names=self._names(),
        )

    def _names(self) -> list[str | None] | None:
        names, others = self._table.names, self._motions.names
        if not names and not others:
            return None
        return [
            names.get(body, others.get(row))
            for row, body in zip(self.rows.tolist(), self.bodies.tolist(), strict=True)
        ]
