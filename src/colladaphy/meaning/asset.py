"""Assets: unit, dates, axes (COLLADA 1.5 §asset, §unit, §up_axis)."""

from __future__ import annotations

import math
from collections.abc import Iterator
from datetime import UTC, datetime

import numpy as np

from colladaphy.meaning import asset_rules
from colladaphy.meaning.context import Context, FloatRows, TextRows
from colladaphy.meaning.hits import Hit
from colladaphy_schema.rows import Column, Floats, Rows

__all__ = ["CHECKS", "is_unit_doubtful"]


_SIZES = {
    "meter": 1.0, "metre": 1.0, "meters": 1.0, "metres": 1.0, "m": 1.0,
    "centimeter": 0.01, "centimetre": 0.01, "centimeters": 0.01, "centimetres": 0.01, "cm": 0.01,
    "millimeter": 0.001, "millimetre": 0.001, "millimeters": 0.001, "millimetres": 0.001,
    "mm": 0.001, "decimeter": 0.1, "decimetre": 0.1, "dm": 0.1, "micrometer": 1e-6,
    "kilometer": 1000.0, "kilometre": 1000.0, "kilometers": 1000.0, "km": 1000.0,
    "inch": 0.0254, "inches": 0.0254, "foot": 0.3048, "feet": 0.3048, "ft": 0.3048,
    "yard": 0.9144, "yards": 0.9144, "mile": 1609.344, "miles": 1609.344,
}  # fmt: skip
_TOLERANCE = 0.01
_FAR = 1e300
"""What is not finite is further away."""


class UnitRows(Rows):
    """Units of length."""

    __slots__ = ()
    name: Column[list[str]] = Column("name", "attribute", "token", default="meter")
    meter: Column[Floats] = Column("meter", "attribute", "float", default=1.0)


def units(context: Context) -> Iterator[Hit]:
    """Units that are no lengths, or whose names are those of others."""
    rows = context.rows(UnitRows, "unit")
    assert rows.ordinals is not None
    for element, name, size in zip(
        rows.ordinals.tolist(), rows.name, rows.meter.tolist(), strict=True
    ):
        if not 0.0 < size < math.inf:
            yield Hit(
                asset_rules.UNIT, element, f"The unit {name!r} is {size} metres long.", (), "meter"
            )
            continue
        known = _SIZES.get(name.lower().strip())
        if known is not None and abs(size - known) > _TOLERANCE * known:
            message = f"The unit is named {name!r}, which is {known} metres, but meter is {size}."
            yield Hit(asset_rules.UNIT_NAME, element, message, (), "name")


def is_unit_doubtful(context: Context) -> bool:
    """Whether the document's unit of length is told to be wrong, so that nothing follows of it."""
    return any(int(context.parent[context.parent[hit.element]]) == 0 for hit in units(context))


def dates(context: Context) -> Iterator[Hit]:
    """Assets that were modified before they were created."""
    rows = context.rows(TextRows, "modified")
    created = context.rows(TextRows, "created")
    assert rows.ordinals is not None and created.ordinals is not None
    begin = dict(zip(context.parent[created.ordinals].tolist(), created.value, strict=True))
    for element, text in zip(rows.ordinals.tolist(), rows.value, strict=True):
        first = _moment(begin.get(int(context.parent[element]), ""))
        last = _moment(text)
        if first is not None and last is not None and last < first:
            message = f"Modified at {text}, before it was created."
            yield Hit(asset_rules.DATES, element, message)


def _moment(text: str) -> datetime | None:
    try:
        made = datetime.fromisoformat(text.strip())
    except ValueError:  # a year beyond 9999, or the hour 24
        return None
    return made if made.tzinfo else made.replace(tzinfo=UTC)


def inner_assets(context: Context) -> Iterator[Hit]:
    """Assets within the document that disagree with it."""
    axes = context.rows(TextRows, "up_axis")
    assert axes.ordinals is not None
    outer = context.resource.up_axis
    for element, text in zip(axes.ordinals.tolist(), axes.value, strict=True):
        asset = int(context.parent[element])
        if int(context.parent[asset]) > 0 and text.strip() != outer:
            message = f"{text.strip()} here, but {outer} in the document; nobody converts it."
            yield Hit(asset_rules.INNER_AXIS, element, message)
    rows = context.rows(UnitRows, "unit")
    assert rows.ordinals is not None
    whole = context.resource.unit[1]
    for element, size in zip(rows.ordinals.tolist(), rows.meter.tolist(), strict=True):
        asset = int(context.parent[element])
        if int(context.parent[asset]) > 0 and size > 0 and abs(size - whole) > 1e-9 * whole:
            message = f"The unit is {size} metres here, but {whole} in the document."
            yield Hit(asset_rules.INNER_AXIS, element, message, (), "meter")


def places(context: Context) -> Iterator[Hit]:
    """Locations that are not on Earth."""
    for name, most in (("longitude", 180.0), ("latitude", 90.0), ("altitude", _FAR)):
        rows = context.rows(FloatRows, name)
        if not len(rows):
            continue
        assert rows.ordinals is not None
        wrong = ~(np.abs(rows.value.values) <= most)
        for row in np.flatnonzero(wrong).tolist():
            unit = "metres" if name == "altitude" else "degrees"
            message = f"The {name} is {rows.value.values[row]} {unit}."
            yield Hit(asset_rules.PLACE, int(rows.ordinals[row]), message)


CHECKS = (units, dates, inner_assets, places)
