"""Unions in the pe profile: the tree, and of its members what the common profile says otherwise.

Its shapes stand for those of the common profile in their order, and repeat only what these do not
say exactly.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.mapper.numbers import differs
from colladaphy.mapper.storing.geometries import PLANE, add_exact_geometry
from colladaphy.mapper.storing.leaves import Leaves
from colladaphy.mapper.storing.rows import masked
from colladaphy.mapper.storing.tree import Tree
from colladaphy.world import rotations
from colladaphy.world.kinds import Kind
from colladaphy_schema import pe_columns as pe

if TYPE_CHECKING:
    from colladaphy.mapper.options import WriteOptions

__all__ = ["unions_of"]

Array = NDArray[Any]

_MESH = int(Kind.MESH)


def unions_of(bodies: Array, tree: Tree, leaves: Leaves, options: WriteOptions) -> pe.UnionTypeRows:
    """The trees of the bodies (n,) that are unions, numbers among all bodies."""
    leaf_of = np.full(len(tree), -1)
    inner = np.flatnonzero(leaves.is_member)
    leaf_of[leaves.row[inner]] = inner
    outermost = above = pe.UnionTypeRows(len(bodies), bodies)
    parents = bodies
    parent_of = tree.top
    for level in tree.levels:
        # The members of one level stand as their unions do, and then by their place.
        row_of = np.empty(len(tree) if above is not outermost else bodies[-1] + 1, np.int64)
        row_of[parents] = np.arange(len(parents))
        rows = row_of[parent_of[level]]
        united = tree.is_union[level]
        shapes, members = level[~united], level[united]
        if len(shapes):
            above.shape = _shapes(
                shapes, rows[~united], leaf_of[shapes], tree, leaves, options,
                outermost=above is outermost,
            )  # fmt: skip
        if not len(members):
            break
        unions = _unions(members, rows[united], tree, options)
        above.union = unions
        above, parents, parent_of = unions, members, tree.parent
    return outermost


def _shapes(
    members: Array,
    owner: Array,
    leaf: Array,
    tree: Tree,
    leaves: Leaves,
    options: WriteOptions,
    *,
    outermost: bool,
) -> pe.ShapeTypeRows:
    rows = pe.ShapeTypeRows(len(members), owner, order=tree.place[members])
    _identify(rows, members, tree)
    values = tree.values
    rows.mass = masked(values["masses"][members], leaves.says_mass[leaf])
    rows.inertia = masked(values["inertias"][members].reshape(-1, 9), leaves.says_inertia[leaf])
    kinds = values["kinds"][members]
    # Where the common profile says them as well, but for the pose of a mesh and of a plane; and
    # what adds nothing to the pose does not say -0.
    known = outermost and options.profile != "full" and not options.tessellate
    positions = values["positions"][members]
    says_position = (kinds == _MESH) | (kinds == PLANE) | (not known)
    says_position |= differs(positions + 0.0, positions) & ~positions.any(axis=1)
    _place(rows, members, tree, says_position, options)
    add_exact_geometry(rows, leaves.exact_kinds[leaf], values["dimensions"][members], None)
    return rows


def _unions(members: Array, owner: Array, tree: Tree, options: WriteOptions) -> pe.UnionTypeRows:
    rows = pe.UnionTypeRows(len(members), owner, order=tree.place[members])
    _identify(rows, members, tree)
    rows.mass = tree.values["masses"][members]
    rows.inertia = tree.values["inertias"][members].reshape(-1, 9)
    _place(rows, members, tree, np.ones(len(members), np.bool_), options)
    return rows


def _identify(rows: pe.ShapeTypeRows | pe.UnionTypeRows, members: Array, tree: Tree) -> None:
    rows.uid = tree.values["uids"][members]
    rows.sid = tree.sids[members]
    if tree.names is not None:
        rows.name = [tree.names[row] for row in members.tolist()]


def _place(
    rows: pe.ShapeTypeRows | pe.UnionTypeRows,
    members: Array,
    tree: Tree,
    says_position: Array,
    options: WriteOptions,
) -> None:
    """The pose in the union that the members stand in."""
    orientations = tree.values["orientations"][members]
    rows.position = masked(tree.values["positions"][members], says_position)
    says_turn = differs(orientations, rotations.IDENTITY) | (options.profile == "full")
    rows.orientation = masked(orientations, says_turn)
