"""What holds where two materials meet: pe's rules, and what is set by hand."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from colladaphy.world.materials import Material, MaterialPair, Materials
from colladaphy.world.rules import ARGUMENT, refuse

__all__ = ["FRICTION_RULES", "PairTable", "pair"]

Floats = NDArray[np.float64]

FRICTION_RULES: Final[dict[str, Callable[[Floats, Floats], Floats]]] = {
    "sum": np.add,
    "average": lambda one, two: 0.5 * (one + two),
    "product": np.multiply,
    "maximum": np.maximum,
}
"""How the frictions of two materials make that of the pair. pe adds them up."""
_MOST: Final = np.finfo(np.float64).max


@dataclass(frozen=True, slots=True)
class PairTable:
    """Coefficients (k, k) of the pairs of k materials, which are known by ascending ids."""

    ids: NDArray[np.int64]
    restitution: Floats
    static: Floats
    dynamic: Floats

    @classmethod
    def of(cls, materials: Materials, ids: Iterable[int], rule: str = "sum") -> PairTable:
        """The pairs of the materials of `ids`, by pe's rules, `rule`, and what was set by hand.

        pe's own five materials keep pe's numbers.
        """
        known = np.array(sorted(ids), dtype=np.int64)
        stiffness = materials.values("stiffness", known)[:, None]
        together = _series(stiffness, stiffness.T)
        own = materials.values("restitution", known)[:, None] * np.sqrt(together / stiffness)
        frictions = []
        for name in ("static_friction", "dynamic_friction"):
            values = materials.values(name, known)
            with np.errstate(over="ignore"):
                made = FRICTION_RULES[rule](values[:, None], values)
            frictions.append(np.minimum(made, _MOST))
        table = cls(known, np.hypot(own, own.T), *frictions)
        table._set_by_pe()
        table._set_by_hand(materials)
        return table

    def _set_by_pe(self) -> None:
        own = self.ids < Materials.DEFAULT_COUNT
        both = own[:, None] & own
        for values, value in ((self.restitution, 0.25), (self.static, 0.2), (self.dynamic, 0.2)):
            values[both] = value

    def _set_by_hand(self, materials: Materials) -> None:
        places = {id: place for place, id in enumerate(self.ids.tolist())}
        for override in materials.overrides:
            if override.first not in places or override.second not in places:
                continue
            i, j = places[override.first], places[override.second]
            for values, value in (
                (self.restitution, override.restitution),
                (self.static, override.static_friction),
                (self.dynamic, override.dynamic_friction),
            ):
                if value is not None:
                    values[i, j] = values[j, i] = value

    def places(self, ids: NDArray[np.int64]) -> NDArray[np.int64]:
        """The rows of this table for material ids."""
        return np.searchsorted(self.ids, ids)


def pair(materials: Materials, first: Material, second: Material, rule: str) -> MaterialPair:
    """All values of one pair."""
    if rule not in FRICTION_RULES:
        raise refuse(ARGUMENT, f"Frictions make {', '.join(FRICTION_RULES)}, not {rule!r}.")
    low, high = sorted((first, second), key=lambda material: material.id)
    table = PairTable.of(materials, {low.id, high.id}, rule)
    compliance = sum((1 - each.poisson_ratio**2) / each.young_modulus for each in (low, high))

    def together(name: str) -> float:
        one, two = (np.array(getattr(each, name)) for each in (low, high))
        return float(_series(one, two))

    return MaterialPair(
        restitution=float(table.restitution[0, -1]),
        static_friction=float(table.static[0, -1]),
        dynamic_friction=float(table.dynamic[0, -1]),
        young_modulus=1 / compliance if compliance else np.inf,
        stiffness=together("stiffness"),
        damping_normal=together("damping_normal"),
        damping_tangential=together("damping_tangential"),
    )


def _series(one: Floats, two: Floats) -> Floats:
    """1/(1/a + 1/b), zero where either is zero."""
    low, high = np.minimum(one, two), np.maximum(one, two)
    share = np.divide(low, high, out=np.zeros_like(high), where=high > 0)
    return np.asarray(low / (1.0 + share))
