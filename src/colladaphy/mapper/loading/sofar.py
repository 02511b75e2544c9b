"""Models that go into one World one after the other (thesis 5.3), and the joints between them.

A joint needs both of its bodies. Where a model is loaded whose constraints, or whose robot's
joints, reach into another model, they wait until that one is loaded into the same World too.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.findings import Finding
from colladaphy.links.resource import Resource
from colladaphy.mapper import rules
from colladaphy.mapper.joining import join_joints
from colladaphy.mapper.loading.loaded import Loaded
from colladaphy.world import World
from colladaphy.world.joints import JOINT_FIELDS

__all__ = ["Late", "Sofar", "are_waiting", "key_of"]

Array = NDArray[Any]
Key = tuple[str | None, int]

_WAITING = {rules.CONSTRAINT_SKIPPED.code, rules.JOINT_UNMAPPED.code, rules.ROBOT_EMPTY.code}


class Sofar:
    """What a World has of one document."""

    def __init__(self) -> None:
        self.is_waiting = False
        """Whether joints were left out for want of a body."""
        self._bodies: dict[Key, list[int]] = {}
        self._added: list[tuple[_Owned, Sequence[Key], dict[int, int] | None]] = []

    def add(self, loaded: Loaded, models: Sequence[Key], ids: dict[int, int] | None) -> None:
        """Remember the bodies of models; `ids` are those in the World, where they are others."""
        self._added.append((_Owned.of(loaded), models, ids))

    @property
    def bodies(self) -> dict[Key, list[int]]:
        """System ids in the World of the bodies of each instance of a model, in their order."""
        # Few documents are loaded model by model: the others need not be sorted out.
        for owned, models, ids in self._added:
            for key, mine in zip(models, owned.by_place(len(models)), strict=True):
                here = mine if ids is None else [ids.get(sid, 0) for sid in mine]
                self._bodies.setdefault(key, here)
        self._added.clear()
        return self._bodies


def key_of(model: tuple[Resource, int]) -> Key:
    """What an instance of a model is remembered by."""
    return model[0].file, model[1]


def are_waiting(findings: Iterable[Finding]) -> bool:
    """Whether any of them says that a joint was left out for want of a body."""
    return any(finding.code in _WAITING for finding in findings)


class Late:
    """Joints of models that are loaded now with bodies of those that were loaded before.

    `loaded` has all of these models, those of before first; what is not new is taken out of it.
    """

    def __init__(self, loaded: Loaded, before: Sequence[Key], sofar: Sofar) -> None:
        owned = _Owned.of(loaded)
        self._ids: dict[int, int] = {}
        for key, mine in zip(before, owned.by_place(len(before)), strict=True):
            known = sofar.bodies[key]
            if len(mine) == len(known):
                self._ids.update(zip(mine, known, strict=True))
        owners, sids = owned.owners(), owned.sids
        world = loaded.world
        table = world.joint_table
        fresh = _is_new(loaded, len(before))
        bodies, earlier = table.column("bodies"), sids[owners < len(before)]
        old = np.isin(bodies, earlier)
        partly = np.any(~old & (bodies != 0), axis=1)
        rows = np.flatnonzero(old.any(axis=1) & (fresh | partly))
        self._sids = table.column("sids")[rows].tolist()
        self._values = {name: table.column(name)[rows] for name in JOINT_FIELDS}
        self._names = {sid: world.joint_names[sid] for sid in self._sids
                       if sid in world.joint_names}  # fmt: skip
        gone = set(earlier.tolist())
        for body in [body for body in world.bodies if body.sid in gone]:
            world.destroy(body)

    def add(self, world: World, ids: dict[int, int], document: Resource) -> None:
        """Create them in the World that has both ends; `ids` are those of the new bodies in it."""
        everyone = {**self._ids, **ids, 0: 0}
        there = {0, *world.sids.tolist()}
        ends = [[everyone.get(end, -1) for end in pair] for pair in self._values["bodies"].tolist()]
        kept = [row for row, pair in enumerate(ends) if there.issuperset(pair)]
        if len(kept) < len(ends):
            message = f"{len(ends) - len(kept)} joints bind bodies that are not in the World now."
            document.note(rules.CONSTRAINT_SKIPPED, message=message)
        if kept:
            values = {name: column[kept] for name, column in self._values.items()}
            values["bodies"] = np.array([ends[row] for row in kept], np.int64)
            join_joints(world, [self._sids[row] for row in kept], values, self._names, document)
            message = f"{len(kept)} joints bind bodies to those of models that were loaded before."
            document.note(rules.JOINT_LATE, message=message)


@dataclass(frozen=True, slots=True)
class _Owned:
    """Bodies that were created, and the models that they are of."""

    sids: Array
    """(n,) system ids."""
    tops: Array
    """(n,) rows of the outermost instances of models around them."""
    roots: Array
    """(k,) rows of the instances that were asked for, by their places."""

    @classmethod
    def of(cls, loaded: Loaded) -> _Owned:
        bodies, kept = loaded.bodies, loaded.created
        sids = bodies.parts.sids[bodies.tops]
        return cls(sids[kept], _tops(loaded, bodies.found.models[kept]), loaded.roots)

    def owners(self) -> Array:
        """(n,) places of the models, -1 for none of those that were asked for."""
        return _places(self.roots, self.tops)

    def by_place(self, count: int) -> Iterator[list[int]]:
        """The system ids of the bodies of each of the first `count` models."""
        owners = self.owners()
        order = np.argsort(owners, kind="stable")
        cuts = np.searchsorted(owners[order], np.arange(count + 1)).tolist()
        sids = self.sids[order].tolist()
        return (sids[begin:end] for begin, end in itertools.pairwise(cuts))


def _tops(loaded: Loaded, instances: Array) -> Array:
    """The rows of the outermost instances around instances of models."""
    around, tops = loaded.expansion.around, np.asarray(instances)
    while np.any(around[tops] >= 0):
        tops = np.where(around[tops] >= 0, around[tops], tops)
    return np.asarray(loaded.expansion.rows[tops])


def _places(roots: Array, tops: Array) -> Array:
    """The places of rows among those of the instances that were asked for, the last of equals."""
    places = {row: place for place, row in enumerate(roots.tolist())}
    return np.array([places.get(row, -1) for row in tops.tolist()], np.int64)


def _is_new(loaded: Loaded, count: int) -> Array:
    """Which joints of the World are of constraints in models after the first `count`."""
    table = loaded.world.joint_table
    joints = loaded.joints
    mine = joints.sids[_places(loaded.roots, _tops(loaded, joints.models)) >= count]
    return np.isin(table.column("sids"), mine)
