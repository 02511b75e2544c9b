"""Materials and what happens where two of them meet, by pe's rules."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from colladaphy.world.rules import (
    MATERIAL_NAME,
    MATERIAL_UNKNOWN,
    MATERIAL_VALUE,
    refuse,
)

__all__ = ["Material", "MaterialPair", "Materials", "PairOverride"]


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


class Materials:
    """The materials of a World, by name and by id, in the order of their ids.

    The five of pe come first (ids 0 to 4); custom ones follow. Ids may have gaps, as a file
    keeps only the materials that are used (thesis 5.4).
    """

    __slots__ = ("_by_id", "_by_name", "_next_id", "_overrides")

    DEFAULT_COUNT = len(_DEFAULTS)

    def __init__(self) -> None:
        self._by_id: dict[int, Material] = {}
        self._by_name: dict[str, Material] = {}
        self._next_id = 0
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

    def create(self, name: str, *, id: int | None = None, **values: float) -> Material:
        """Add a material; values are checked against pe's ranges (WorldError)."""
        if name in self._by_name:
            raise refuse(MATERIAL_NAME, f"There is a material named {name!r} already.")
        if id is None:
            id = self._next_id
        elif id in self._by_id or id < 0:
            raise refuse(MATERIAL_NAME, f"The material id {id} is in use, or negative.")
        numbers = {key: float(value) for key, value in values.items()}
        for key in VALUES:
            check_value(name, key, numbers[key])
        material = Material(id=id, name=str(name), **numbers)
        self._by_id[id] = material
        self._next_id = max(self._next_id, id + 1)
        self._by_name[material.name] = material
        return material

    def copy(self) -> Materials:
        """The same materials and pairs, which change independently from now on."""
        twin = Materials.__new__(Materials)
        twin._by_id = dict(self._by_id)
        twin._by_name = dict(self._by_name)
        twin._next_id = self._next_id
        twin._overrides = dict(self._overrides)
        return twin

    def __getitem__(self, key: str | int) -> Material:
        """The material of a name or of an id; KeyError if there is none."""
        return self._by_name[key] if isinstance(key, str) else self._by_id[key]

    def __contains__(self, key: object) -> bool:
        if isinstance(key, Material):
            return self._by_id.get(key.id) is key
        return key in self._by_name or key in self._by_id

    def __iter__(self) -> Iterator[Material]:
        """All materials in the order of their ids."""
        return iter([self._by_id[id] for id in sorted(self._by_id)])

    def __len__(self) -> int:
        return len(self._by_id)

    def resolve(self, material: Material | str | int) -> Material:
        """The material of this World that is meant, or WorldError."""
        if isinstance(material, Material):
            if self._by_id.get(material.id) is material:
                return material
        elif material in self:
            return self[material]
        name = material.name if isinstance(material, Material) else material
        raise refuse(MATERIAL_UNKNOWN, f"There is no material {name!r} in this World.")

    def by_id(self) -> dict[int, Material]:
        """All materials by id, as a new dictionary."""
        return dict(self._by_id)

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
        given = {key: float(value) for key, value in values.items() if value is not None}
        for key, value in given.items():
            check_value(f"{first.name} with {second.name}", key, value)
        if given:
            self._overrides[low, high] = PairOverride(low, high, **given)
        else:
            self._overrides.pop((low, high), None)

    def pair(self, first: Material, second: Material) -> MaterialPair:
        """What holds between two materials: pe's rules, then what was set by hand."""
        if first.id > second.id:
            first, second = second, first
        stiffness = _series(first.stiffness, second.stiffness)
        if second.id < self.DEFAULT_COUNT:
            restitution, static, dynamic = 0.25, 0.2, 0.2
        else:
            restitution = math.hypot(
                first.restitution * math.sqrt(stiffness / first.stiffness),
                second.restitution * math.sqrt(stiffness / second.stiffness),
            )
            static = first.static_friction + second.static_friction
            dynamic = first.dynamic_friction + second.dynamic_friction
        override = self._overrides.get((first.id, second.id))
        if override is not None:
            if override.restitution is not None:
                restitution = override.restitution
            if override.static_friction is not None:
                static = override.static_friction
            if override.dynamic_friction is not None:
                dynamic = override.dynamic_friction
        compliance = (1 - first.poisson_ratio**2) / first.young_modulus + (
            1 - second.poisson_ratio**2
        ) / second.young_modulus
        return MaterialPair(
            restitution=restitution,
            static_friction=static,
            dynamic_friction=dynamic,
            young_modulus=1 / compliance if compliance else math.inf,
            stiffness=stiffness,
            damping_normal=_series(first.damping_normal, second.damping_normal),
            damping_tangential=_series(first.damping_tangential, second.damping_tangential),
        )


def _series(first: float, second: float) -> float:
    """1/(1/a + 1/b), zero where either is zero."""
    low, high = sorted((first, second))
    return low / (1.0 + low / high) if low else 0.0


def check_value(name: str, key: str, value: float) -> None:
    """Raise WorldError if the value of a material is out of its range."""
    low, high, closed = _RANGES[key]
    if (low <= value <= high if closed else low < value <= high) and math.isfinite(value):
        return
    raise refuse(MATERIAL_VALUE, f"Material {name}: {key} is {value!r}.")
