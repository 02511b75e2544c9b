"""What is to be done with each body, and where its node goes."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.document.updating.differences import Differences
from colladaphy.document.updating.joints import joint_sids
from colladaphy.document.updating.placing import Places, Wishes, places_of
from colladaphy.links.poses import Poses
from colladaphy.mapper import Loaded
from colladaphy.mapper.numbers import differs
from colladaphy.world import World, rotations
from colladaphy.world.kinds import Kind

__all__ = ["Demands", "Plan"]

Array = NDArray[Any]


@dataclass(slots=True)
class Demands:
    """What has to be written although it did not change, for the document to read back exactly."""

    pins: bool = False
    """Whether all bodies and joints say their system ids."""
    values: set[int] = field(default_factory=set)
    poses: set[int] = field(default_factory=set)
    """Bodies that get nodes of their own."""
    motions: set[int] = field(default_factory=set)
    joints: set[int] = field(default_factory=set)
    driven: bool = False
    """Whether joints of the kinematics are written as rigid_constraints."""
    anew: set[int] = field(default_factory=set)
    """Bodies that are taken out and added anew."""


class Plan:
    """System ids of bodies and joints by what is to be done with them."""

    def __init__(
        self, loaded: Loaded, world: World, changes: Differences, demands: Demands,
        kept: dict[int, NDArray[np.float64]],
    ) -> None:  # fmt: skip
        """`kept` are the bodies, by row, whose nodes keep their steps (see `Wishes`)."""
        self._loaded, self._world = loaded, world
        self._changes, self._demands = changes, demands
        self.kept = kept
        bodies = loaded.bodies
        sids = bodies.parts.sids[bodies.tops].tolist()
        self.row: dict[int, int] = {sid: row for row, sid in enumerate(sids) if loaded.created[row]}
        """The rows of the bodies among those that were loaded."""
        self.joint_row: dict[int, int] = joint_sids(loaded)
        # A rigid_constraint between two links is taken in the place of their kinematic joint.
        driven = set(loaded.driven.tolist()) if demands.driven else set()
        self.joints_new: set[int] = changes.joints_new | (
            driven & set(world.joint_table.column("sids").tolist())
        )
        self.planes: set[int] = set(world.sids[world.kinds == Kind.PLANE].tolist())
        self.anew: set[int] = set()
        """Bodies that are taken out and added anew."""
        self.still: set[int] = set()
        """Bodies that stay where they stand."""
        self.values: set[int] = set()
        """Bodies that are described anew."""
        self.gone: set[int] = set()
        self.new: set[int] = set()
        self.reframed: set[int] = set()
        """Bodies whose rigid_bodies, and so their nodes, get the frame of the body."""
        self.poses: set[int] = set()
        self.motions: set[int] = set()
        self.pins = False
        """Whether all say their system ids, which else depend on what other bodies there are."""
        self.body_poses: Poses
        """Where they are, by row."""
        self.places: Places
        self._settle()

    def _settle(self) -> None:
        anew: set[int] = set()
        while True:
            self._sort(anew)
            self._place()
            there = np.flatnonzero(self.places.own).tolist()
            sids = self._loaded.bodies.parts.sids[self._loaded.bodies.tops[there]].tolist()
            stuck = {sid for sid, row in zip(sids, there, strict=True)
                     if sid in self.planes and not self._is_at_origin(row)}  # fmt: skip
            if not stuck - anew:
                return
            anew |= stuck

    def _sort(self, anew: set[int]) -> None:
        changes, demands = self._changes, self._demands
        kept = set(self.row) - changes.gone
        values = (changes.values | demands.values) & kept
        stuck = {sid for sid in values & self.planes if not self._is_at_origin(self.row[sid])}
        self.anew = (anew | stuck | demands.anew) & kept
        self.still = kept - self.anew
        self.values = values & self.still
        self.gone = (changes.gone & self.row.keys()) | self.anew
        self.new = changes.new | self.anew
        framed = self._loaded.bodies.origins.is_identity()
        self.reframed = {sid for sid in self.values - self.planes if not framed[self.row[sid]]}
        self.poses = (changes.poses | demands.poses | self.reframed) & self.still
        self.motions = changes.motions | demands.motions | self.poses | self.values
        self.motions &= self.still
        self.pins = demands.pins or bool(self.gone or self.new)

    def _is_at_origin(self, row: int) -> bool:
        """Whether the frame of a rigid_body is that of the world, by itself."""
        found = self._loaded.bodies.found
        chain = int(self._loaded.expansion.chains[found.models[row]])
        return chain < 0 and bool(found.poses.is_identity()[row])

    def _place(self) -> None:
        """Where the nodes of bodies go."""
        loaded, world = self._loaded, self._world
        found, count = loaded.bodies.found, len(loaded.bodies.found)
        sids = sorted(self.still)
        rows = np.array([self.row[sid] for sid in sids], np.int64)
        at = np.searchsorted(world.sids, np.array(sids, np.int64))
        positions, turns = world.positions[at], world.orientations[at]
        poses = Poses.none(count)
        poses.put(rows, Poses.of(
            len(rows), positions, rotations.normalize(turns), moved=differs(positions, np.zeros(3)),
            turned=differs(turns, rotations.IDENTITY)))  # fmt: skip
        flat = np.zeros(count, np.bool_)
        flat[rows] = world.kinds[at] == Kind.PLANE
        wanted = found.poses.take(np.arange(count))
        solid = rows[~flat[rows]]
        wanted.put(solid, poses.then(loaded.bodies.origins).take(solid))
        still, moved, apart = (np.zeros(count, np.bool_) for _ in range(3))
        still[rows] = True
        moved[[self.row[sid] for sid in self.poses - self.planes]] = True
        apart[[self.row[sid] for sid in self._demands.poses & self.still]] = True
        self.body_poses = poses
        origins = Poses.none(count)
        reframed = np.array(sorted(self.row[sid] for sid in self.reframed), np.int64)
        origins.put(reframed, loaded.bodies.origins.take(reframed).inverse())
        wishes = Wishes(wanted, moved, apart | flat, still, origins, self.kept)
        self.places = places_of(loaded, wishes)
