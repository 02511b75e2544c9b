"""Which materials of a World can meet, and where their frictions differ."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from colladaphy.world.pairing import PairTable

if TYPE_CHECKING:
    from colladaphy.world import World

__all__ = ["differing", "used_materials"]


def differing(table: PairTable, world: World, meets: NDArray[np.bool_], most: int = 5) -> str:
    """The pairs that meet whose static and dynamic friction differ, as a text; "" if none."""
    different = np.triu(meets & (table.static != table.dynamic))
    rows = np.argwhere(different)
    if not len(rows):
        return ""
    named = [
        f"{world.materials[int(table.ids[i])].name} on {world.materials[int(table.ids[j])].name}"
        f" ({table.static[i, j]:g}, {table.dynamic[i, j]:g})"
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
