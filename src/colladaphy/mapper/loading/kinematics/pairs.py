"""Pairs of links that never collide, as OpenRAVE's extras of the type collision have them.

A World's way for that is a joint with all axes free that lets its bodies pass.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import product

import numpy as np

from colladaphy.links.names import local_name
from colladaphy.links.pool import Pool
from colladaphy.mapper.loading.kinematics.models import Link, Place
from colladaphy.mapper.loading.kinematics.references import References
from colladaphy.world import JointColumns, Kind, World

__all__ = ["Stated", "free_joints", "pairs_to_pass", "stated_pairs"]

_PAIR = "ignore_link_pair"


class Stated:
    """The pairs of a document: of links, and elements whose links cannot be found."""

    def __init__(self) -> None:
        self.pairs: list[tuple[Place, Place]] = []
        self.first: Place | None = None
        self.lost: list[Place] = []


def stated_pairs(pool: Pool, references: References, links: Sequence[Link]) -> list[Stated]:
    """What each document of a pool says of the links of its robots."""
    places = {link.place for link in links}
    named: dict[str, list[Place]] = {}
    for link in links:
        for name in {link.sid, link.name} - {None}:
            named.setdefault(str(name), []).append(link.place)
    made = []
    for home, resource in enumerate(pool.resources):
        columns = resource.columns
        codes = [code for name in columns.names() if local_name(name) == _PAIR
                 for code in columns.codes_of(name)]  # fmt: skip
        rows = [columns.index.rows(code) for code in codes]
        stated = Stated()
        made.append(stated)
        for element in np.sort(np.concatenate(rows)).tolist() if rows else ():
            place = home, int(element)
            ends = []
            for side in ("link0", "link1"):
                text = columns.attribute_of(place[1], side) or ""
                found = references.resolve(text, place) if text.strip() else None
                where = None if found is None else found.place
                if where not in places:
                    some = named.get(text.rpartition("/")[2], [])
                    where = some[0] if len(some) == 1 else None
                ends.append(where)
            if ends[0] is None or ends[1] is None:
                stated.lost.append(place)
                continue
            stated.first = stated.first or place
            stated.pairs.append((ends[0], ends[1]))
    return made


def pairs_to_pass(
    pairs: Sequence[tuple[Place, Place]], robots: Sequence[Mapping[Place, int]]
) -> list[tuple[int, int]]:
    """The bodies of pairs of links: of one robot, or of any two where no robot has both."""
    made = []
    for one, two in pairs:
        inside = [(robot[one], robot[two]) for robot in robots if one in robot and two in robot]
        if not inside:
            first, second = ([robot[link] for robot in robots if link in robot]
                             for link in (one, two))  # fmt: skip
            inside = list(product(first, second))
        made += inside
    return list(dict.fromkeys((min(pair), max(pair)) for pair in made))


def free_joints(world: World, pairs: Sequence[tuple[int, int]]) -> JointColumns | None:
    """Joints without limits between bodies (system ids) that collide as yet; None for none."""
    table = world.joint_table
    passing = table.column("interpenetrate") & table.column("enabled")
    apart = {tuple(sorted(pair)) for pair in table.column("bodies")[passing].tolist()}
    sids, kinds = world.sids, world.kinds
    solid = set(sids[kinds != Kind.EMPTY].tolist())
    wanted = [pair for pair in dict.fromkeys((min(pair), max(pair)) for pair in pairs)
              if pair[0] != pair[1] and pair not in apart and solid.issuperset(pair)]  # fmt: skip
    if not wanted:
        return None
    count = len(wanted)
    free = np.full((count, 2, 3), np.inf)
    free[:, 0] = -np.inf
    return JointColumns(
        bodies=np.array(wanted),
        linear_limits=free,
        angular_limits=free.copy(),
        interpenetrate=np.ones(count, np.bool_),
    )
