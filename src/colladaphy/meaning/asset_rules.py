"""What can be wrong with assets in a document that is schema-valid."""

from __future__ import annotations

from colladaphy.findings import Rule, Severity

__all__ = ["RULES"]

UNIT = Rule(
    "asset-unit",
    Severity.ERROR,
    "The unit of length is no length.",
    "meter is the size of the unit in metres: 1, or 0.01 for centimetres.",
    "COLLADA 1.5 §unit",
    "Every length of the document is measured in it.",
)
UNIT_NAME = Rule(
    "asset-unit-name",
    Severity.WARNING,
    "The name of the unit of length is that of another size.",
    "Correct the name, or meter; meter is what counts, and is 1 where it is left out.",
    "COLLADA 1.5 §unit",
    "Programs that go by the name show the scene in another size.",
)
DATES = Rule(
    "asset-dates",
    Severity.HINT,
    "The document was modified before it was created.",
    "Correct one of the dates.",
    "COLLADA 1.5 §asset",
    why="Programs that go by the dates take the older of two versions.",
)
INNER_AXIS = Rule(
    "asset-inner-axis",
    Severity.HINT,
    "An asset within the document has another up axis or unit than the document.",
    "Convert the content, and let the asset agree with that of the document.",
    "COLLADA 1.5 §asset",
    "Hardly any reader converts what is within, so that it stands askew or in another size.",
)
PLACE = Rule(
    "asset-place",
    Severity.WARNING,
    "The geographic location is not on Earth.",
    "Longitude is from -180 to 180 degrees, latitude from -90 to 90.",
    "COLLADA 1.5 §geographic_location",
    why="Maps would show the scene nowhere.",
)

RULES = (
    UNIT,
    UNIT_NAME,
    DATES,
    INNER_AXIS,
    PLACE,
)
