"""Images that are made: sizes and levels (COLLADA 1.5 §create_2d, §create_3d, §create_cube)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.meaning import scene_rules
from colladaphy.meaning.context import Context
from colladaphy.meaning.hits import Hit
from colladaphy_schema.rows import Column, Masked, Rows

__all__ = ["CHECKS"]

_MADE = ("create_2d", "create_3d", "create_cube")


class _SizeRows(Rows):
    """Sizes of images, with what they have of width, height and depth."""

    __slots__ = ()
    width: Column[Masked[NDArray[Any]]] = Column("width", "attribute", "float", optional=True)
    height: Column[Masked[NDArray[Any]]] = Column("height", "attribute", "float", optional=True)
    depth: Column[Masked[NDArray[Any]]] = Column("depth", "attribute", "float", optional=True)


class _MipRows(Rows):
    """How many levels an image has; 0 for all there can be."""

    __slots__ = ()
    levels: Column[Masked[NDArray[Any]]] = Column("levels", "attribute", "float", optional=True)


class _LevelRows(Rows):
    """What a level of an image is read from."""

    __slots__ = ()
    level: Column[Masked[NDArray[Any]]] = Column("mip_index", "attribute", "float", optional=True)


def sizes(context: Context) -> Iterator[Hit]:
    """Images without an extent."""
    rows = context.rows(_SizeRows, "size_exact", "size_ratio", "size")
    if not len(rows):
        return
    assert rows.ordinals is not None
    mine = context.is_within(rows.ordinals, *_MADE)
    for name in ("width", "height", "depth"):
        column: Masked[NDArray[Any]] = getattr(rows, name)
        none = mine & column.present & ~(column.values > 0.0)
        for row in np.flatnonzero(none).tolist():
            message = f"The {name} of the image is {column.values[row]:g}."
            yield Hit(scene_rules.IMAGE_SIZE, int(rows.ordinals[row]), message, (), name)
        mine &= ~none


def levels(context: Context) -> Iterator[Hit]:
    """Files for levels that an image does not have."""
    rows = context.rows(_LevelRows, "init_from")
    held = context.rows(_MipRows, "mips")
    if not len(rows) or not len(held):
        return
    assert rows.ordinals is not None
    assert held.ordinals is not None
    at = context.places_in(context.parent[held.ordinals], context.parent[rows.ordinals])
    most = np.where(held.levels.present, held.levels.values, 0.0)
    count = np.append(most, 0.0)[at]
    wrong = rows.level.present & (count > 0.0) & (rows.level.values >= count)
    for row in np.flatnonzero(wrong).tolist():
        level = rows.level.values[row]
        message = f"The level is {level:g}, but there are {count[row]:g} from 0 on."
        yield Hit(scene_rules.IMAGE_SIZE, int(rows.ordinals[row]), message,
                  (int(held.ordinals[at[row]]),), "mip_index")  # fmt: skip


CHECKS = (sizes, levels)
