"""Materials, and the pairs of them that are set by hand (`pairing` has pe's rules)."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, TypedDict, Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray

from colladaphy.world import values as checks
from colladaphy.world.rules import (
    COLUMNS,
    MATERIAL_NAME,
    MATERIAL_UNKNOWN,
    MATERIAL_VALUE,
    refuse,
)
from colladaphy.world.table import Table

__all__ = ["AnyMaterial", "Material", "MaterialPair", "MaterialValues", "Materials", "PairOverride"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Material:
    """A material: immutable, known by its name and by its id. Units are the World's."""

    id: int
    name: str
    density: float
    restitution: float
    static_friction: float
    dynamic_friction: float
    poisson_ratio: float
    young_modulus: float
    stiffness: float
    damping_normal: float
    damping_tangential: float


@dataclass(frozen=True, slots=True)
class MaterialPair:
    """The values that hold where two materials meet."""

    restitution: float
    static_friction: float
    dynamic_friction: float
    young_modulus: float
    stiffness: float
    damping_normal: float
    damping_tangential: float


@dataclass(frozen=True, slots=True)
class PairOverride:
    """Values set for a pair of materials by hand; None leaves pe's rule. `first` ≤ `second`."""

    first: int
    second: int
    restitution: float | None = None
    static_friction: float | None = None
    dynamic_friction: float | None = None


VALUES = (
    "density",
    "restitution",
    "static_friction",
    "dynamic_friction",
    "poisson_ratio",
    "young_modulus",
    "stiffness",
    "damping_normal",
    "damping_tangential",
)
"""The numbers of a material, in the order in which they are checked and compared."""

_RANGES = {
    "density": (0.0, math.inf, False),
    "restitution": (0.0, 1.0, True),
    "static_friction": (0.0, math.inf, True),
    "dynamic_friction": (0.0, math.inf, True),
    "poisson_ratio": (-1.0, 0.5, True),
    "young_modulus": (0.0, math.inf, False),
    "stiffness": (0.0, math.inf, False),
    "damping_normal": (0.0, math.inf, True),
    "damping_tangential": (0.0, math.inf, True),
}

_DEFAULTS = (
    ("iron", 7874.0, 0.24, 200.0),
    ("copper", 8920.0, 0.33, 117.0),
    ("granite", 2800.0, 0.25, 55.0),
    ("oak", 800.0, 0.35, 11.0),
    ("fir", 500.0, 0.34, 13.0),
)


AnyMaterial = Material | str | int
"""A material, its name or its id."""


class MaterialValues(TypedDict):
    """The numbers of a material."""

    density: float
    restitution: float
    static_friction: float
    dynamic_friction: float
    poisson_ratio: float
    young_modulus: float
    stiffness: float
    damping_normal: float
    damping_tangential: float


class Materials:
    """The materials of a World, by name and by id, in the order of their ids.

    The five of pe come first (ids 0 to 4); custom ones follow. Ids may have gaps, as a file
    keeps only the materials that are used (thesis 5.4). The numbers are kept by column, and a
    `Material` is made when it is first asked for.
    """

    __slots__ = ("_ids", "_made", "_meter", "_names", "_next_id", "_overrides", "_table")

    DEFAULT_COUNT = len(_DEFAULTS)

    def __init__(self) -> None:
        self._table = Table(dict.fromkeys(VALUES, (np.float64, ())))
        self._ids: dict[str, int] = {}
        self._names: dict[int, str] = {}
        self._made: dict[int, Material] = {}
        self._next_id = 0
        self._meter = 1.0
        self._overrides: dict[tuple[int, int], PairOverride] = {}
        for name, density, poisson, young in _DEFAULTS:
            self.create(
                name,
                density=density,
                restitution=0.5,
                static_friction=0.1,
                dynamic_friction=0.1,
                poisson_ratio=poisson,
                young_modulus=young,
                stiffness=young,
                damping_normal=0.0,
                damping_tangential=0.0,
            )

    def create(
        self, name: str, *, id: int | None = None, **values: Unpack[MaterialValues]
    ) -> Material:
        """Add a material; values are checked against pe's ranges (WorldError)."""
        name = checks.text("name of the material", name)
        if name in self._ids:
            raise refuse(MATERIAL_NAME, f"There is a material named {name!r} already.")
        if id is None:
            id = self._next_id
        id = checks.integer("material id", id, MATERIAL_NAME)
        if id in self._names or not 0 <= id < 2**63 - 1:
            raise refuse(MATERIAL_NAME, f"The material id {id} is in use, or out of range.")
        given: Mapping[str, Any] = values
        numbers = {key: check_value(name, key, given[key]) for key in VALUES}
        self._table.append(id, numbers)
        self._ids[name], self._names[id] = id, name
        self._next_id = max(self._next_id, id + 1)
        return self[id]

    def extend(
        self, names: Sequence[str], values: Mapping[str, ArrayLike], ids: ArrayLike | None = None
    ) -> NDArray[np.int64]:
        """Add many materials at once; returns their ids (n,).

        `values` has (n,) numbers for each of `VALUES`. Either all are added or, on WorldError,
        none.
        """
        texts = [checks.text("name of a material", name) for name in names]
        count = len(texts)
        if len(set(texts)) < count or not self._ids.keys().isdisjoint(texts):
            counts = Counter([*self._ids, *texts])
            twice = next(name for name in texts if counts[name] > 1)
            raise refuse(MATERIAL_NAME, f"There is a material named {twice!r} already.")
        if ids is None:
            numbers = np.arange(self._next_id, self._next_id + count, dtype=np.int64)
        else:
            numbers = checks.column("ids", ids, np.int64, (count,))
            used = [id for id in numbers.tolist() if id in self._names or not 0 <= id < 2**63 - 1]
            if used or len(np.unique(numbers)) < count:
                which = f"{used[0]} is in use, or out of range" if used else "s are not different"
                raise refuse(MATERIAL_NAME, f"The material id {which}.")
        columns = {}
        for key in VALUES:
            if key not in values:
                raise refuse(MATERIAL_VALUE, f"The materials have no {key}.")
            column = columns[key] = checks.column(key, values[key], np.float64, (count,))
            self._check_column(key, column, texts)
        self._table.extend(numbers, columns)
        listed = numbers.tolist()
        self._ids.update(zip(texts, listed, strict=True))
        self._names.update(zip(listed, texts, strict=True))
        self._next_id = max(self._next_id, max(listed, default=-1) + 1)
        return numbers

    def change(self, key: str, ids: ArrayLike, values: ArrayLike) -> None:
        """Give materials (n,) other values (n,) of one of `VALUES`, checked as new ones are.

        A `Material` is immutable: those that were handed out keep the old value and are no longer
        of this World.
        """
        if key not in VALUES:
            raise refuse(MATERIAL_VALUE, f"Materials have no {key!r}, but {', '.join(VALUES)}.")
        rows = self.rows(ids)
        found = self.ids[rows].tolist()
        column = checks.column(key, values, np.float64, rows.shape)
        self._check_column(key, column, [self._names[id] for id in found])
        self._table.column(key)[rows] = column
        for id in found:
            self._made.pop(id, None)

    def follow_unit(self, meter: float) -> None:
        """Have the densities of pe's five materials per cubic unit, which has `meter` metres.

        Those that were changed stay as they are.
        """
        if meter == self._meter:
            return
        for id, (_, density, _, _) in enumerate(_DEFAULTS):
            before, after = density * _cubed(self._meter), density * _cubed(meter)
            if self._table.raw("density")[self._table.find(id)] == before:
                self.change("density", [id], [after])
        self._meter = meter

    @staticmethod
    def _check_column(key: str, column: NDArray[np.float64], names: Sequence[str]) -> None:
        low, high, closed = _RANGES[key]
        good = (column >= low) & (column <= high) if closed else (column > low)
        bad = np.flatnonzero(~(good & np.isfinite(column)))
        if len(bad):
            check_value(names[bad[0]], key, float(column[bad[0]]))

    @property
    def ids(self) -> NDArray[np.int64]:
        """The ids of all materials (n,), ascending, read-only."""
        return self._table.frozen("sids")

    def values(self, key: str, ids: ArrayLike | None = None) -> NDArray[np.float64]:
        """One of `VALUES` of many materials (n,), by id, or of all; read-only, see `change`."""
        if key not in VALUES:
            raise refuse(MATERIAL_VALUE, f"Materials have no {key!r}, but {', '.join(VALUES)}.")
        if ids is None:
            return self._table.frozen(key)
        found = np.asarray(self._table.column(key)[self.rows(ids)])
        found.flags.writeable = False  # or else a change of them would change nothing
        return found

    def rows(self, ids: ArrayLike) -> NDArray[np.int64]:
        """Where materials of given ids (n,) are in the order of `ids`; WorldError if nowhere."""
        wanted = checks.fitting("ids", ids, np.int64)
        if wanted.ndim != 1:
            raise refuse(COLUMNS, "The ids of materials are one number each.")
        rows = self._table.find_all(wanted)
        missing = np.flatnonzero(rows < 0)
        if len(missing):
            raise refuse(
                MATERIAL_UNKNOWN, f"There is no material with the id {wanted[missing[0]]}."
            )
        return rows

    @property
    def names(self) -> Mapping[int, str]:
        """The names of all materials by id."""
        return MappingProxyType(self._names)

    def copy(self) -> Materials:
        """The same materials and pairs, which change independently from now on."""
        twin = Materials.__new__(Materials)
        twin._table = self._table.copy()
        twin._ids, twin._names = dict(self._ids), dict(self._names)
        twin._made, twin._overrides = dict(self._made), dict(self._overrides)
        twin._next_id, twin._meter = self._next_id, self._meter
        return twin

    def __getitem__(self, key: str | int) -> Material:
        """The material of a name or of an id; KeyError if there is none."""
        id = self._ids[key] if isinstance(key, str) else key
        made = self._made.get(id)
        if made is None:
            name, row = self._names[id], self._table.find(int(id))
            numbers = {value: float(self._table.raw(value)[row]) for value in VALUES}
            made = self._made[int(id)] = Material(id=int(id), name=name, **numbers)
        return made

    def __contains__(self, key: object) -> bool:
        if isinstance(key, Material):
            return self._made.get(key.id) is key
        return key in self._ids if isinstance(key, str) else key in self._names

    def __iter__(self) -> Iterator[Material]:
        """All materials in the order of their ids."""
        return map(self.__getitem__, self.ids.tolist())

    def __len__(self) -> int:
        return len(self._names)

    def resolve(self, material: AnyMaterial) -> Material:
        """The material of this World that is meant, or WorldError."""
        if isinstance(material, Material):
            if self._made.get(material.id) is material:
                return material
        elif isinstance(material, (str, int, np.integer)) and material in self:
            return self[material]
        name = material.name if isinstance(material, Material) else material
        raise refuse(MATERIAL_UNKNOWN, f"There is no material {name!r} in this World.")

    @property
    def overrides(self) -> tuple[PairOverride, ...]:
        """The pairs set by hand, ordered by the ids of their materials."""
        return tuple(self._overrides[key] for key in sorted(self._overrides))

    def override(
        self,
        first: Material,
        second: Material,
        restitution: float | None,
        static_friction: float | None,
        dynamic_friction: float | None,
    ) -> None:
        """Set the values of a pair; None goes back to pe's rule."""
        low, high = sorted((first.id, second.id))
        values = {
            "restitution": restitution,
            "static_friction": static_friction,
            "dynamic_friction": dynamic_friction,
        }
        given = {
            key: check_value(f"{first.name} with {second.name}", key, value)
            for key, value in values.items()
            if value is not None
        }
        if given:
            self._overrides[low, high] = PairOverride(low, high, **given)
        else:
            self._overrides.pop((low, high), None)


def _cubed(meter: float) -> float:
    """Its cube, as long as densities of that are numbers that a material can have."""
    cube = meter * meter * meter
    return cube if 1e-200 < cube < 1e200 else 1.0


def check_value(name: str, key: str, value: float) -> float:
    """The value of a material as a float; WorldError if it is out of its range."""
    low, high, closed = _RANGES[key]
    number = checks.number(f"{key} of material {name}", value, MATERIAL_VALUE)
    if (low <= number <= high if closed else low < number <= high) and math.isfinite(number):
        return number
    raise refuse(MATERIAL_VALUE, f"Material {name}: {key} is {number!r}.")
