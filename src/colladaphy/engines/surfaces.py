"""What holds where materials meet, for all pairs at once: restitution and friction."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from colladaphy.world.materials import Materials

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from colladaphy.world import World

__all__ = ["FRICTION_RULES", "PairTable", "used_materials"]

Floats = NDArray[np.float64]

FRICTION_RULES: Final[dict[str, Callable[[Floats, Floats], Floats]]] = {
    "sum": np.add,
    "average": lambda one, two: 0.5 * (one + two),
    "product": np.multiply,
    "maximum": np.maximum,
}
"""How the frictions of two materials make that of the pair. pe adds them up."""


@dataclass(frozen=True, slots=True)
class PairTable:
    """Coefficients (k, k) of the pairs of k materials, which are known by ascending ids."""

    ids: NDArray[np.int64]
    restitution: Floats
    static: Floats
    dynamic: Floats

    @classmethod
    def of(cls, world: World, ids: Iterable[int], rule: str = "sum") -> PairTable:
        """The pairs of the materials of `ids`, by pe's rules, `rule`, and what was set by hand.

        As `World.pair` has them for the rule "sum"; pe's own five materials keep pe's table.
        """
        known = np.array(sorted(ids), dtype=np.int64)
        materials = [world.materials[id] for id in known.tolist()]

        def column(name: str) -> Floats:
            return np.array([getattr(material, name) for material in materials], dtype=np.float64)

        stiffness = column("stiffness")
        low = np.minimum(stiffness[:, None], stiffness)
        together = low / (1.0 + low / np.maximum(stiffness[:, None], stiffness))
        own = column("restitution")[:, None] * np.sqrt(together / stiffness[:, None])
        restitution = np.hypot(own, own.T)
        combine = FRICTION_RULES[rule]
        frictions = []
        for name in ("static_friction", "dynamic_friction"):
            values = column(name)
            frictions.append(np.array(combine(values[:, None], values)))
        table = cls(known, restitution, *frictions)
        table._set_by_pe()
        table._set_by_hand(world)
        return table

    def _set_by_pe(self) -> None:
        own = self.ids < Materials.DEFAULT_COUNT
        both = own[:, None] & own
        for values, value in ((self.restitution, 0.25), (self.static, 0.2), (self.dynamic, 0.2)):
            values[both] = value

    def _set_by_hand(self, world: World) -> None:
        places = {id: place for place, id in enumerate(self.ids.tolist())}
        for pair in world.pair_overrides:
            if pair.first not in places or pair.second not in places:
                continue
            i, j = places[pair.first], places[pair.second]
            for values, value in (
                (self.restitution, pair.restitution),
                (self.static, pair.static_friction),
                (self.dynamic, pair.dynamic_friction),
            ):
                if value is not None:
                    values[i, j] = values[j, i] = value

    def places(self, ids: NDArray[np.int64]) -> NDArray[np.int64]:
        """The rows of this table for material ids."""
        return np.searchsorted(self.ids, ids)

    def differing(self, world: World, meets: NDArray[np.bool_], most: int = 5) -> str:
        """The pairs that meet whose static and dynamic friction differ, as a text; "" if none."""
        different = np.triu(meets & (self.static != self.dynamic))
        rows = np.argwhere(different)
        if not len(rows):
            return ""
        named = [
            f"{world.materials[int(self.ids[i])].name} on {world.materials[int(self.ids[j])].name}"
            f" ({self.static[i, j]:g}, {self.dynamic[i, j]:g})"
            for i, j in rows[:most].tolist()
        ]
        more = f" and {len(rows) - most} more pairs" if len(rows) > most else ""
        return ", ".join(named) + more


def used_materials(world: World) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
    """The ids (k,) of the materials of all shapes, and which pairs (k, k) of them can meet."""
    members = world.member_columns
    still = set(world.sids[world.fixed].tolist())
    roots = [world.root_of(sid) in still for sid in members.sids.tolist()]
    ids = np.concatenate([world.material_ids, members.material_ids])
    fixed = np.concatenate([world.fixed, np.array(roots, dtype=np.bool_)])
    shapes = ids >= 0
    used, places = np.unique(ids[shapes], return_inverse=True)
    moving = np.bincount(places[~fixed[shapes]], minlength=len(used))
    resting = np.bincount(places[fixed[shapes]], minlength=len(used))
    meets = (moving[:, None] > 0) & ((moving > 0) | (resting > 0))
    meets |= meets.T
    np.fill_diagonal(meets, (moving > 1) | ((moving > 0) & (resting > 0)))
    return used, meets
