"""What differs between two Worlds, thing by thing, and by how much."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.world.columns import BODY_FIELDS, MEMBER_FIELDS
from colladaphy.world.materials import VALUES
from colladaphy.world.world import World

__all__ = ["Difference", "Tolerance", "differences", "texts"]

Array = NDArray[Any]
Columns = Mapping[str, Array]


@dataclass(frozen=True, slots=True)
class Tolerance:
    """How much numbers may be apart: absolute + relative × the larger size of the two.

    The size of a vector or matrix is that of its largest number. Quaternions may differ in sign,
    as both mean the same turn. With nothing allowed, numbers are equal if their bits are.
    """

    relative: float = 0.0
    absolute: float = 0.0

    @property
    def exact(self) -> bool:
        """True if the bits count."""
        return not (self.relative or self.absolute)


@dataclass(frozen=True, slots=True)
class Difference:
    """One value that differs between two Worlds."""

    kind: str
    """world, body, member, joint, material or pair of materials."""
    id: int | tuple[int, ...] | None
    """System id of the body or joint, id of the material; None of the World itself."""
    what: str
    """The value, named as the World's column or attribute; "presence" if only one World has it."""
    first: Any
    second: Any
    """As plain numbers, texts and lists; None where there is no such value."""
    apart: float | None = None
    """The largest difference of two numbers."""
    relative: float | None = None
    """The same over the larger size of the two."""

    def __str__(self) -> str:
        place = self.what if self.id is None else f"{self.kind} {self.id}, {self.what}"
        by = f" (apart by {self.apart:.3g}, {self.relative:.3g} of it)" if self.apart else ""
        return f"{place}: {self.first!r} and {self.second!r}{by}"


def differences(
    first: World, second: World, tolerance: Tolerance | None = None, *, unused_materials: bool
) -> list[Difference]:
    """Every difference; see `colladaphy.world.compare`."""
    compared = _Compared(tolerance or Tolerance())
    compared.settings(first, second)
    compared.columns("body", _top(first), _top(second))
    compared.columns("member", _inner(first), _inner(second))
    compared.columns("joint", first.joints.columns(), second.joints.columns())
    compared.mappings("body", "name", first.names, second.names)
    compared.mappings("joint", "name", first.joint_names, second.joint_names)
    compared.mappings("body", "members", first.children, second.children)
    compared.meshes(first, second)
    compared.materials(first, second, unused_materials)
    return compared.found


class _Compared:
    def __init__(self, tolerance: Tolerance) -> None:
        self._tolerance = tolerance
        self.found: list[Difference] = []

    def settings(self, first: World, second: World) -> None:
        names = ["name", "unit_name", "up_axis", "step_count", "next_body_sid", "next_joint_sid"]
        if self._tolerance.exact:
            names.append("engine_state")  # what it is worth, no number says
        for name in names:
            one, two = getattr(first, name), getattr(second, name)
            if one != two:
                self.found.append(Difference("world", None, name, one, two))
        for name in ("gravity", "unit_meter", "time_step", "time"):
            one, two = getattr(first, name), getattr(second, name)
            if one is None or two is None:
                if one is not two:
                    self.found.append(Difference("world", None, name, one, two))
                continue
            self._rows("world", [None], name, np.array([one]), np.array([two]))

    def columns(self, kind: str, first: Columns, second: Columns) -> None:
        sids, others = first["sids"], second["sids"]
        if not np.array_equal(sids, others):
            for sid in np.setxor1d(sids, others).tolist():
                here = bool(np.isin(sid, sids))
                self.found.append(Difference(kind, sid, "presence", here, not here))
            _, rows, places = np.intersect1d(sids, others, return_indices=True)
            first = {name: column[rows] for name, column in first.items()}
            second = {name: column[places] for name, column in second.items()}
        ids = first["sids"].tolist()
        for name, column in first.items():
            self._rows(kind, ids, name, column, second[name])

    def _rows(self, kind: str, ids: list[Any], name: str, first: Array, second: Array) -> None:
        """The rows that differ of a column."""
        if not len(ids):
            return
        if first.dtype != np.float64:
            wrong = ~(first == second).reshape(len(first), -1).all(axis=1)
            for row in np.flatnonzero(wrong).tolist():
                values = first[row].tolist(), second[row].tolist()
                self.found.append(Difference(kind, ids[row], name, *values))
            return
        one, two = (np.ascontiguousarray(a).reshape(len(first), -1) for a in (first, second))
        wrong = np.any(one.view(np.int64) != two.view(np.int64), axis=1)
        rows = np.flatnonzero(wrong)
        if not len(rows):
            return
        apart, relative, close = self._measured(name, one[rows], two[rows])
        for row, by, share, good in zip(
            rows.tolist(), apart.tolist(), relative.tolist(), close.tolist(), strict=True
        ):
            if not good:
                values = first[row].tolist(), second[row].tolist()
                self.found.append(Difference(kind, ids[row], name, *values, by, share))

    def _measured(self, name: str, one: Array, two: Array) -> tuple[Array, Array, Array]:
        """How far rows (n, k) are apart, what share that is, and whether it is allowed."""
        tolerance = self._tolerance
        with np.errstate(all="ignore"):
            same = (one == two) | (np.isnan(one) & np.isnan(two))
            off = np.where(same, 0.0, np.abs(one - two))
            apart = off.max(axis=1)
            if not tolerance.exact and name.endswith("orientations"):
                turned = np.abs(one + two).reshape(len(one), -1, 4).max(axis=2)
                direct = off.reshape(len(one), -1, 4).max(axis=2)
                apart = np.minimum(turned, direct).max(axis=1)
            sizes = np.where(np.isfinite(one), np.abs(one), 0.0).max(axis=1)
            sizes = np.maximum(sizes, np.where(np.isfinite(two), np.abs(two), 0.0).max(axis=1))
            relative = np.divide(apart, sizes, out=np.zeros_like(apart), where=sizes > 0)
            close = apart <= tolerance.absolute + tolerance.relative * sizes
        return apart, relative, close & (not tolerance.exact)

    def mappings(self, kind: str, what: str, first: Mapping[Any, Any], second: Any) -> None:
        if first == second:
            return
        gone = {d.id for d in self.found if d.kind in (kind, "member") and d.what == "presence"}
        for key in sorted(first.keys() | second.keys()):
            one, two = first.get(key), second.get(key)
            if one != two and key not in gone:
                self.found.append(Difference(kind, key, what, one, two))

    def meshes(self, first: World, second: World) -> None:
        equal: dict[tuple[int, ...], bool] = {}
        for table, kind in (("top", "body"), ("inner", "member")):
            one, two = getattr(first, table), getattr(second, table)
            sids, rows, places = np.intersect1d(
                one.column("sids"), two.column("sids"), return_indices=True
            )
            ids = [one.column("mesh_ids")[rows], two.column("mesh_ids")[places]]
            pairs = np.stack(ids, axis=1)
            some = np.any(pairs != -1, axis=1)
            for sid, pair in zip(sids[some].tolist(), map(tuple, pairs[some].tolist()),
                                 strict=True):  # fmt: skip
                if pair not in equal:
                    equal[pair] = self._same_mesh(first, second, pair)
                if not equal[pair]:
                    self.found.append(Difference(kind, sid, "mesh", *pair))

    def _same_mesh(self, first: World, second: World, pair: tuple[int, ...]) -> bool:
        a, b = first.meshes.get(pair[0]), second.meshes.get(pair[1])
        if a is None or b is None:
            return False
        if self._tolerance.exact or a.same_as(b):
            return a.same_as(b)
        if a.vertices.shape != b.vertices.shape or not np.array_equal(a.faces, b.faces):
            return False
        return bool(np.all(self._measured("vertices", a.vertices, b.vertices)[2]))

    def materials(self, first: World, second: World, unused: bool) -> None:
        used = _used(first) | _used(second)
        names = [
            {
                id: world.materials.names[id]
                for id in world.materials.ids.tolist()
                if unused or id in used
            }
            for world in (first, second)
        ]
        self.mappings("material", "name", *names)
        common = np.array(sorted(names[0].keys() & names[1].keys()), dtype=np.int64)
        values = [
            {"sids": common, **{key: world.materials.values(key, common) for key in VALUES}}
            for world in (first, second)
        ]
        self.columns("material", *values)
        pairs = [
            {
                (pair.first, pair.second): pair
                for pair in world.pair_overrides
                if unused or {pair.first, pair.second} <= used
            }
            for world in (first, second)
        ]
        for key in sorted(pairs[0].keys() | pairs[1].keys()):
            for what in ("restitution", "static_friction", "dynamic_friction"):
                one, two = (getattr(side.get(key), what, None) for side in pairs)
                if one is None or two is None:
                    if one is not two:
                        self.found.append(Difference("pair of materials", key, what, one, two))
                else:
                    rows = np.array([one]), np.array([two])
                    self._rows("pair of materials", [key], what, *rows)


def texts(found: Iterable[Difference], most: int) -> list[str]:
    """A line for each difference; of those of one column after the first `most` their number."""
    lines: list[str] = []
    counts: Counter[tuple[str, str]] = Counter()
    for difference in found:
        key = difference.kind, difference.what
        counts[key] += 1
        if counts[key] <= most:
            lines.append(str(difference))
    for (kind, what), count in counts.items():
        if count > most:
            lines.append(f"{kind}, {what}: {count - most} more")
    return lines


def _top(world: World) -> dict[str, Array]:
    names = (name for name in BODY_FIELDS if name != "mesh_ids")
    return {name: getattr(world, name) for name in ("sids", *names)}


def _inner(world: World) -> dict[str, Array]:
    columns = world.member_columns
    names = (name for name in MEMBER_FIELDS if name != "mesh_ids")
    return {name: getattr(columns, name) for name in ("sids", *names)}


def _used(world: World) -> set[int]:
    tops = np.unique(world.material_ids).tolist()
    return set(tops) | set(np.unique(world.member_columns.material_ids).tolist())
