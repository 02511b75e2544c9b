"""How many vertices geometries have, and how many skins and morphs are for (§skin, §morph)."""

from __future__ import annotations

from colladaphy.meaning.array_table import CountRows
from colladaphy.meaning.context import Context
from colladaphy.meaning.hits import Hit
from colladaphy.meaning.inputs import inputs_of
from colladaphy.meaning.materials import geometry_of
from colladaphy.meaning.semantics import unfit_inputs
from colladaphy.meaning.source_table import sources_of

__all__ = ["base_of", "geometry_size", "odd_geometries", "positions_of", "short_positions"]


def base_of(context: Context, controller: int) -> int:
    """The geometry that a <skin> or <morph> is of, be it by other controllers; -1 for none."""
    return geometry_of(context, context.columns.attribute_of(controller, "source"))


def positions_of(context: Context, geometry: int) -> int:
    """The input of the positions of a geometry; -1 for none."""
    vertices = context.shared(_vertices).get(geometry)
    return -1 if vertices is None else inputs_of(context).named(vertices, "POSITION")


def geometry_size(context: Context, geometry: int) -> int | None:
    """How many vertices a geometry has; None where that cannot be told."""
    row = positions_of(context, geometry)
    return None if row < 0 or row in unfit_inputs(context) else inputs_of(context).count(row)


def short_positions(context: Context, geometry: int, wanted: int) -> Hit | None:
    """What to say where only an accessor of the geometry of a skin or morph lacks vertices."""
    row = positions_of(context, geometry)
    return None if row < 0 else inputs_of(context).short(row, wanted)


def _vertices(context: Context) -> dict[int, int]:
    """The vertices of each geometry."""
    elements = context.ordinals("vertices")
    around = context.ancestor(elements, "geometry")
    return dict(zip(around.tolist(), elements.tolist(), strict=True))


def odd_geometries(context: Context) -> dict[int, tuple[int, list[int]]]:
    """Geometries that several users take for one number of vertices, which is not theirs.

    That number by the geometry, and the elements that use it.
    """
    return context.shared(_odd)


def _odd(context: Context) -> dict[int, tuple[int, list[int]]]:
    wanted: dict[int, list[tuple[int, int]]] = {}
    rows = context.rows(CountRows, "vertex_weights")
    if len(rows):
        assert rows.ordinals is not None
        for element, count in zip(rows.ordinals.tolist(), rows.count.values.tolist(), strict=True):
            geometry = base_of(context, int(context.parent[element]))
            wanted.setdefault(geometry, []).append((count, element))
    for element in context.ordinals("targets").tolist():
        mine = {base_of(context, int(context.parent[element])), *_targets(context, element)}
        sizes = {each: geometry_size(context, each) for each in mine}
        if len({*sizes.values()}) < 2:  # as nearly always; each is for what all of them are
            sizes = dict(list(sizes.items())[:2])
        for each in mine:
            wanted.setdefault(each, []).extend(
                (size, element)
                for other, size in sizes.items() if other != each and size is not None
            )  # fmt: skip
    found: dict[int, tuple[int, list[int]]] = {}
    for geometry, users in wanted.items():
        counts = {count for count, _ in users}
        size = geometry_size(context, geometry)
        if size is not None and len(users) > 1 and len(counts) == 1 and size not in counts:
            found[geometry] = counts.pop(), list(dict.fromkeys(element for _, element in users))
    return found


def _targets(context: Context, element: int) -> list[int]:
    """The geometries that a morph mixes with its own."""
    source = inputs_of(context).source(element, "MORPH_TARGET")
    words = None if source < 0 else sources_of(context).words(source)
    return [] if words is None else [geometry_of(context, word) for word in words]
