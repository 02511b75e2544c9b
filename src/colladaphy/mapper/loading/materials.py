"""Physics materials as materials of a World (thesis 4.4, 5.3, 5.5).

A physics material has three values; what pe needs beyond them is in the pe profile, or the standard
values below. A shape's own density makes a variant of its material. Materials are deduplicated by
value: a file with a material a body, or a density a body, gives no more materials than it has
different ones.
"""

from __future__ import annotations

import math
import re
from collections.abc import Container
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from colladaphy.findings import Severity
from colladaphy.mapper import rules
from colladaphy.mapper.loading.profile import first_of
from colladaphy.mapper.loading.sameness import Sameness, tolerance_of
from colladaphy.mapper.loading.shapes import MaterialRefs
from colladaphy.mapper.loading.tables import Tables
from colladaphy.mapper.tokens import same_token
from colladaphy.meaning.physics_rules import MATERIAL_RANGE
from colladaphy.meaning.profile_rules import OLD_VALUE
from colladaphy.world import World
from colladaphy.world.materials import VALUES

__all__ = ["STANDARD_DENSITY", "UNSPECIFIED", "MaterialTable", "unique_name"]

Array = NDArray[Any]
Prefer = Literal["newer", "profile", "common"]

STANDARD_DENSITY = 1.0
_STANDARD = {
    "density": STANDARD_DENSITY,
    "restitution": 0.0,
    "static_friction": 0.0,
    "dynamic_friction": 0.0,
    "poisson_ratio": 0.24,
    "young_modulus": 200.0,
    "stiffness": 200.0,
    "damping_normal": 0.0,
    "damping_tangential": 0.0,
}
"""What is assumed for values that a file does not give: COLLADA's zeros, and pe's iron."""
_NOTHING = {**_STANDARD, "restitution": 0.5, "static_friction": 0.1, "dynamic_friction": 0.1}
"""A body without any material: what pe's five materials have in common."""

_COMMON = ("dynamic_friction", "restitution", "static_friction")
_RANGES = {
    "density": (0.0, math.inf),
    "restitution": (0.0, 1.0),
    "static_friction": (0.0, math.inf),
    "dynamic_friction": (0.0, math.inf),
    "poisson_ratio": (-1.0, 0.5),
    "young_modulus": (0.0, math.inf),
    "stiffness": (0.0, math.inf),
    "damping_normal": (0.0, math.inf),
    "damping_tangential": (0.0, math.inf),
}
_POSITIVE = ("density", "young_modulus", "stiffness")
_OUR_ID = re.compile(r"(?:.*-)?Material(\d{1,18})\Z")
_COLUMN = {name: column for column, name in enumerate(VALUES)}

UNSPECIFIED = -1
"""The row of what a body without material has."""


@dataclass(slots=True)
class _Records:
    """The physics materials of all documents."""

    names: list[str]
    values: Array
    """(n, 9) in the order of `VALUES`."""
    wanted: Array
    """(n,) the id in the World that was stored; -1 for none."""
    has_density: Array
    """(n,) whether the pe profile gives the density."""


@dataclass(slots=True)
class _Raw:
    """What stands in the documents, undecided."""

    stated: Array
    """(n, 9) standard values, and those of the common profile."""
    kept: Array
    """(n, 9) NaN where the pe profile says nothing."""
    given: Array
    """(n, 9) where it says something."""
    in_profile: Array
    """(n,) whether there is a pe:material."""
    kept_names: list[str | None]
    names: list[str | None]
    ids: list[str | None]


def _read(materials: Any, home: int, start: int) -> _Raw:
    count = len(materials)
    stated = np.tile([_STANDARD[name] for name in VALUES], (count, 1))
    common = materials.technique_common
    for name in _COMMON:
        child = getattr(common, name)
        if len(child):
            stated[common.owner[child.owner], _COLUMN[name]] = child.value
    kept = np.full((count, len(VALUES)), np.nan)
    given = np.zeros((count, len(VALUES)), np.bool_)
    names: list[str | None] = [None] * count
    extras = materials.extra
    there = np.zeros(count, np.bool_)
    found, inner = first_of(extras, extras.technique, "material")
    owner = extras.owner[inner]
    if len(owner) > 1:
        first = np.append(True, owner[1:] != owner[:-1])
        if not first.all():
            found, owner = found.select(first), owner[first]
    there[owner] = True
    for name in VALUES:
        column = getattr(found, name)
        kept[owner, _COLUMN[name]] = column.values
        given[owner, _COLUMN[name]] = column.present
    for row, name in zip(owner.tolist(), found.name, strict=True):
        names[row] = name
    return _Raw(stated, kept, given, there, names, list(materials.name), list(materials.id))


class MaterialTable:
    """The materials that a World gets, in the order in which bodies use them."""

    def __init__(self, tables: Tables, world: World, prefer: Prefer) -> None:
        self._tables = tables
        self._world = world
        self._prefer = prefer
        self._records: _Records | None = None
        self._known = 0
        self._checked: set[int] = set()
        self._missing: set[tuple[int, int]] = set()
        self._noted_unspecified = False
        self._ids: dict[tuple[Any, ...], int] = {}
        self._used: set[int] = set()

    # --- references

    def rows(self, refs: MaterialRefs, homes: Array) -> Array:
        """The rows of the materials that elements refer to or hold; `UNSPECIFIED` for none.

        A reference that leads nowhere is noted as a warning.
        """
        tables = self._tables
        rows = np.full(len(refs.ordinals), UNSPECIFIED, np.int64)
        given = refs.ordinals >= 0
        outer = given & ~refs.inline
        places = np.flatnonzero(outer)
        listed = refs.urls if len(places) == len(refs.urls) else [
            refs.urls[place] for place in places.tolist()]  # fmt: skip
        found, errors = tables.pool.follow(
            tables.materials,
            listed,
            homes[places],
            refs.ordinals[places],
            "physics_material",
            needed=False,
        )
        rows[places] = found
        for place, error in errors.items():
            key = (int(homes[places[place]]), int(refs.ordinals[places[place]]))
            if key not in self._missing:  # every shape asks again
                self._missing.add(key)
                tables.resource.note_broken(error, Severity.WARNING)
        for place in np.flatnonzero(given & refs.inline).tolist():
            rows[place] = tables.materials.row_of(int(homes[place]), int(refs.ordinals[place]))
        return rows

    # --- records

    def _all(self) -> _Records:
        table = self._tables.materials
        if self._records is None or self._known != len(table.parts):
            raw = table.gather(_read)
            self._records = self._decided(raw)
            self._known = len(table.parts)
        return self._records

    def densities(self, rows: Array) -> Array:
        """What the pe profile gives as the density of materials (n,); NaN for nothing."""
        records = self._all()
        known = rows >= 0
        found = np.full(len(rows), np.nan)
        mine = rows[known]
        has = records.has_density[mine]
        found[known] = np.where(has, records.values[mine, _COLUMN["density"]], np.nan)
        return found

    def _decided(self, raw: _Raw) -> _Records:
        """Values of both profiles, the newer one of each."""
        count = len(raw.names)
        values = raw.stated.copy()
        names = [name or id or "material" for name, id in zip(raw.names, raw.ids, strict=True)]
        wanted = np.full(count, -1, np.int64)
        for row in np.flatnonzero(raw.in_profile).tolist():
            ours = _OUR_ID.match(raw.ids[row] or "")
            wanted[row] = int(ours.group(1)) if ours else -1
            kept, stated = raw.kept_names[row], raw.names[row]
            if kept is not None and stated is not None and same_token(kept, stated):
                names[row] = kept
            elif stated is not None:
                names[row] = stated
        sameness = Sameness(count, self._tolerance)
        for name in VALUES:
            column = _COLUMN[name]
            rows = np.flatnonzero(raw.given[:, column])
            taken = np.ones(len(rows), np.bool_)
            if name in _COMMON and self._prefer != "profile":
                if self._prefer == "common":
                    taken[...] = False
                else:
                    taken = sameness.each(rows, values[rows, column], raw.kept[rows, column])
                    for row in rows[~taken].tolist():
                        self._note_stale(name, row, names, values, raw)
            values[rows[taken], column] = raw.kept[rows[taken], column]
        return _Records(names, values, wanted, raw.given[:, _COLUMN["density"]])

    def _place(self, row: int) -> tuple[Any, int]:
        table = self._tables.materials
        home = int(table.homes(np.array([row]))[0])
        return self._tables.pool.resources[home], int(table.ordinals[row])

    def _tolerance(self, row: int) -> float:
        home, element = self._place(row)
        return tolerance_of(home, element)

    def _note_stale(self, name: str, row: int, names: list[str], values: Array, raw: _Raw) -> None:
        column = _COLUMN[name]
        home, element = self._place(row)
        message = (
            f"The {name} of material {names[row]!r} is {float(values[row, column])!r} in the "
            f"common profile, {float(raw.kept[row, column])!r} in the pe profile; the common one "
            "was edited and is taken."
        )
        self._tables.resource.note(OLD_VALUE, element, message, home=home)

    def _check(self, row: int, records: _Records) -> None:
        """Bring the values of a material into their ranges, with a finding each."""
        for name, value in zip(VALUES, records.values[row].tolist(), strict=True):
            low, high = _RANGES[name]
            nearest = value
            if not math.isfinite(value) or (name in _POSITIVE and value <= 0.0):
                nearest = _STANDARD[name]
            elif not low <= value <= high:
                nearest = low if value < low else high
            if nearest != value:
                home, element = self._place(row)
                message = (
                    f"The {name} of material {records.names[row]!r} is {value!r}; "
                    f"{nearest!r} is taken."
                )
                self._tables.resource.note(MATERIAL_RANGE, element, message, home=home)
                records.values[row, _COLUMN[name]] = nearest

    # --- materials of the World

    def ids(self, rows: Array, densities: Array, homes: Array, origins: Array) -> Array:
        """The ids of the World's materials (n,), created in this order.

        `rows` are of this table, `densities` (NaN for none) make variants; `homes` and `origins`
        tell where a body without a material stands.
        """
        records = self._all()
        distinct = np.unique(rows[rows >= 0])
        self._used.update(distinct.tolist())
        self._ensure_range(distinct, records)
        variant = ~np.isnan(densities) & (densities > 0.0) & (densities < np.inf)
        own = np.where(rows >= 0, records.values[rows, _COLUMN["density"]] if len(records.names)
                       else np.nan, STANDARD_DENSITY)  # fmt: skip
        variant &= densities != own
        key = np.column_stack([rows, np.where(variant, densities, 0.0).view(np.int64)])
        _, first, inverse = np.unique(key, axis=0, return_index=True, return_inverse=True)
        order = np.argsort(first, kind="stable")
        ids = np.empty(len(first), np.int64)
        fresh = first[order]
        ids[order] = self._in_order(rows[fresh], np.where(variant, densities, np.nan)[fresh],
                                    homes[fresh], origins[fresh], records)  # fmt: skip
        return ids[inverse.reshape(-1)]

    def _ensure_range(self, rows: Array, records: _Records) -> None:
        values = records.values[rows]
        bad = np.zeros(len(rows), np.bool_)
        for name, (low, high) in _RANGES.items():
            column = values[:, _COLUMN[name]]
            good = np.isfinite(column) & (column >= low) & (column <= high)
            if name in _POSITIVE:
                good &= column > 0.0
            bad |= ~good
        for row in rows[bad].tolist():
            if row not in self._checked:
                self._checked.add(row)
                self._check(row, records)

    def _in_order(
        self, rows: Array, densities: Array, homes: Array, origins: Array, records: _Records
    ) -> list[int]:
        """The World's materials of distinct rows and densities, one after the other."""
        materials = self._world.materials
        plain = np.isnan(densities) & (rows >= 0)
        if len(rows) > 1 and plain.all():
            wanted = records.wanted[rows]
            names = [records.names[row] for row in rows.tolist()]
            if (
                bool(np.all(wanted >= 0))
                and len(np.unique(wanted)) == len(wanted)
                and len(set(names)) == len(names)
                and not any(name in materials for name in names)
                and not any(id in materials for id in wanted.tolist())
            ):
                values = {name: records.values[rows, _COLUMN[name]] for name in VALUES}
                materials.extend(names, values, wanted)
                return [int(id) for id in wanted]
        return [
            self._id_of(row, density, home, origin, records)
            for row, density, home, origin in zip(
                rows.tolist(), densities.tolist(), homes.tolist(), origins.tolist(), strict=True
            )
        ]

    def _id_of(self, row: int, density: float, home: int, origin: int, records: _Records) -> int:
        if row == UNSPECIFIED:
            if not self._noted_unspecified:
                self._noted_unspecified = True
                resource = self._tables.pool.resources[home]
                self._tables.resource.note(rules.MATERIAL_ASSUMED, origin, home=resource)
            name, values, wanted = "unspecified", dict(_NOTHING), -1
        else:
            name, wanted = records.names[row], int(records.wanted[row])
            values = dict(zip(VALUES, records.values[row].tolist(), strict=True))
        if density == density:
            values["density"] = density
            wanted = -1
        key = (name if wanted >= 0 else None, wanted, *(value.hex() for value in values.values()))
        known = self._ids.get(key)
        if known is None:
            known = self._ids[key] = self._create(name, wanted, values)
        return known

    def _create(self, name: str, wanted: int, values: dict[str, float]) -> int:
        materials = self._world.materials
        if name in materials:
            same = materials[name]
            if all(getattr(same, key).hex() == value.hex() for key, value in values.items()):
                return same.id
        id = None if wanted < 0 or wanted in materials else wanted
        return self._world.create_material(unique_name(name, materials), id=id, **values).id

    def rows_of_ids(self) -> dict[int, int]:
        """The first row of a physics_material by the id of the material that it became.

        One that keeps its id whatever else is in the World comes before others.
        """
        records = self._all()
        found: dict[int, int] = {}
        order = sorted(self._used, key=lambda row: (records.wanted[row] < 0, row))
        for row in order:
            id = self.known_id(row)
            if id is not None:
                found.setdefault(id, row)
        return found

    def keeps_id(self, row: int, id: int) -> bool:
        """Whether a physics_material says itself which id its material has."""
        return bool(self._all().wanted[row] == id)

    def known_id(self, row: int) -> int | None:
        """The id of the World's material that a physics_material in use became."""
        if row not in self._used:
            return None
        return self._id_of(row, math.nan, 0, 0, self._all())


def unique_name(name: str, taken: Container[object]) -> str:
    """`name`, with a number appended where it is in use already (thesis 4.4)."""
    if name not in taken:
        return name
    number = 1
    while f"{name}_{number}" in taken:
        number += 1
    return f"{name}_{number}"
