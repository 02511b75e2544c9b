"""References in kinematics: paths of sids through instances, and parameters that stand for them.

A parameter is a number, a flag or the address of something; it is bound on every level between
the model and the scene, so that a chain of them has to be followed (COLLADA 1.5 §newparam, §bind,
§setparam, §Address syntax).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any
from urllib.parse import unquote

import numpy as np

from colladaphy.errors import ColladaError
from colladaphy.links.names import c
from colladaphy.links.pool import Pool
from colladaphy.mapper.loading.kinematics.models import Place, numbers_of
from colladaphy_schema.kinematics_columns import (
    KinematicsBindTypeRows,
    KinematicsSetparamTypeRows,
)
from colladaphy_schema.kinematics_model_columns import KinematicsNewparamTypeRows

__all__ = ["References", "Value"]

_MOST_STEPS = 64
_HOLDERS = frozenset({
    "instance_kinematics_model", "instance_articulated_system", "instance_kinematics_scene",
    "instance_joint",
})  # fmt: skip


@dataclass(frozen=True, slots=True)
class Value:
    """What a reference or a parameter amounts to."""

    number: float | None = None
    flag: bool | None = None
    place: Place | None = None
    """The element that is meant."""
    through: frozenset[Place] = frozenset()
    """The instances that lead to it."""


@dataclass(frozen=True, slots=True)
class _Stated:
    """What a parameter says in the document."""

    number: float | None
    flag: bool | None
    address: str | None
    parameter: str | None


class References:
    """Follows references in the kinematics of a pool of documents."""

    def __init__(self, pool: Pool) -> None:
        self._pool = pool
        self._read: dict[int, dict[int, _Stated]] = {}
        self._symbols: dict[int, dict[str, list[int]]] = {}
        self._set: dict[Place, _Stated] = {}

    def instance_of(self, place: Place) -> Place | None:
        """The element that an instance is of."""
        home, element = place
        resource = self._pool.resources[home]
        url = resource.columns.attribute_of(element, "url")
        if not url:
            return None
        try:
            target, found = resource.follow(url, element)
        except ColladaError:
            return None
        return self._pool.number(target), found

    def axis_of(self, place: Place) -> Place | None:
        """The revolute or prismatic that an element is, holds or stands in."""
        home, element = place
        columns = self._pool.resources[home].columns
        name = columns.local_name(element)
        if name == "instance_joint":
            inner = self.instance_of(place)
            return None if inner is None else self.axis_of(inner)
        if name == "joint":
            end = columns.end_of(element)
            inside = (number for number in range(element + 1, end)
                      if columns.local_name(number) in ("revolute", "prismatic"))  # fmt: skip
            first = next(inside, None)
            return None if first is None else (home, first)
        while element >= 0:
            if columns.local_name(element) in ("revolute", "prismatic"):
                return home, element
            element = columns.parent_of(element)
        return None

    def resolve(self, reference: str, origin: Place) -> Value | None:
        """What a path of sids, or the name of a parameter, means at an element."""
        return self._resolve(reference, origin, frozenset(), _MOST_STEPS)

    def _resolve(
        self, reference: str, origin: Place, through: frozenset[Place], left: int
    ) -> Value | None:
        if left == 0:
            return None
        for start in self._starts(reference, origin):
            found = self._walk(start, reference, through)
            if found is not None:
                return self._value(*found, left - 1)
        return None

    def _starts(self, reference: str, origin: Place) -> Iterator[Place]:
        """Where a path may begin: at an id, a symbol, or the nearest sid."""
        head = _parts(reference)[0]
        home, element = origin
        resource = self._pool.resources[home]
        if head == ".":
            yield home, max(resource.columns.parent_of(element), 0)
            return
        symbols = self._symbols_of(home).get(head, ())
        yield from ((home, found) for found in symbols if found != element)
        if head in resource.ids:
            yield home, resource.ids[head]
        scope = resource.columns.parent_of(element)
        while scope >= 0:
            inner = resource.sids.within(scope, head)
            if inner is not None and inner != element:
                yield home, inner
                return
            scope = resource.columns.parent_of(scope)

    def _walk(
        self, start: Place, reference: str, through: frozenset[Place]
    ) -> tuple[Place, frozenset[Place]] | None:
        """Down the sids of a path, through instances to what they are of."""
        at = start
        for sid in _parts(reference)[1:]:
            for _ in range(_MOST_STEPS):
                home, element = at
                resource = self._pool.resources[home]
                inner = resource.sids.within(element, sid)
                if inner is not None:
                    at = home, inner
                    break
                target = None
                if resource.columns.local_name(element) in _HOLDERS:
                    through |= {at}
                    target = self.instance_of(at)
                if target is None:
                    return None
                at = target
            else:
                return None
        return at, through

    def _value(self, place: Place, through: frozenset[Place], left: int) -> Value | None:
        """What an element amounts to: a parameter what it is bound to, any other itself."""
        home, element = place
        resource = self._pool.resources[home]
        stated = self._parameters(home).get(element)
        if stated is None:
            if resource.columns.local_name(element) in _HOLDERS:
                through |= {place}
            return Value(place=place, through=through)
        above = home, resource.columns.parent_of(element)
        if resource.columns.local_name(above[1]) in _HOLDERS:
            through |= {above}
        stated = self._set.get(place, stated)
        if stated.number is not None or stated.flag is not None:
            return Value(stated.number, stated.flag, None, through)
        reference = stated.address or stated.parameter
        return self._resolve(reference, place, through, left) if reference else None

    # --- what stands in the documents

    def _symbols_of(self, home: int) -> dict[str, list[int]]:
        self._parameters(home)
        return self._symbols[home]

    def _parameters(self, home: int) -> dict[int, _Stated]:
        """Everything that can be bound, by its element."""
        known = self._read.get(home)
        if known is not None:
            return known
        columns = self._pool.resources[home].columns
        known = self._read[home] = {}
        symbols = self._symbols[home] = {}
        params = columns.rows(KinematicsNewparamTypeRows, c("newparam"))
        inside = _in_kinematics(columns, params.ordinals)
        params = params.select(inside)
        for ordinal, sid, stated in zip(numbers_of(params), params.sid, _stated(params),
                                        strict=True):  # fmt: skip
            known[ordinal] = stated
            symbols.setdefault(sid or "", []).append(ordinal)
        binds = columns.rows(KinematicsBindTypeRows, c("bind"))
        binds = binds.select(_in_kinematics(columns, binds.ordinals))
        references: list[str | None] = [None] * len(binds)
        for owner, name in zip(binds.param.owner.tolist(), binds.param.ref, strict=True):
            references[owner] = name
        for ordinal, symbol, stated, parameter in zip(
            numbers_of(binds), binds.symbol, _stated(binds), references, strict=True
        ):
            known[ordinal] = _Stated(stated.number, stated.flag, stated.address, parameter)
            symbols.setdefault(symbol, []).append(ordinal)
        sets = columns.rows(KinematicsSetparamTypeRows, c("setparam"))
        sets = sets.select(_in_kinematics(columns, sets.ordinals))
        for ordinal, ref, stated in zip(numbers_of(sets), sets.ref, _stated(sets), strict=True):
            for start in self._starts(ref, (home, ordinal)):
                found = self._walk(start, ref, frozenset())
                if found is not None:
                    self._set[found[0]] = stated
                    break
        return known


def _parts(reference: str) -> list[str]:
    return [unquote(part) for part in reference.strip().lstrip("#").split("/")]


def _in_kinematics(columns: Any, ordinals: Any) -> Any:
    """Which parameters are those of kinematics, not of effects or formulas."""
    parents = columns.index.parent[ordinals]
    names = {int(row): columns.local_name(int(row)) for row in np.unique(parents)}
    wanted = _HOLDERS | {"axis_info", "technique_common", "effector_info"}
    return np.array([names[int(row)] in wanted for row in parents], np.bool_)


def _stated(rows: Any) -> list[_Stated]:
    numbers, wholes, flags = rows.float, rows.int, rows.bool
    made = []
    for row, address in enumerate(rows.SIDREF):
        number = float(numbers.values[row]) if numbers.present[row] else None
        if number is None and wholes.present[row]:
            number = float(wholes.values[row])
        flag = bool(flags.values[row]) if flags.present[row] else None
        made.append(_Stated(number, flag, address, None))
    return made
