"""The rigid_bodies of a physics model as columns (thesis 5.3; COLLADA 1.5 §rigid_body)."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
from lxml import etree
from numpy.typing import NDArray

from colladaphy.document.names import c
from colladaphy.mapper.bodies import system_id
from colladaphy.mapper.columns.texts import Column, number_rows, recognised, record_texts
from colladaphy.world.kinds import Kind
from colladaphy.world.shapes import NEEDED

__all__ = ["BodyTable"]

Array = NDArray[Any]

_MATERIAL = r'<instance_physics_material url="(?P<{0}>[^"]*)"/>\s*'

# One primitive, in its own place, with a mass and a material; of the pe profile nothing but the
# user id. The end tag is left out.
_REGULAR = re.compile(
    r"\s*<rigid_body\s[^>]*>\s*<technique_common>\s*"
    r"(?:<dynamic>(?P<dynamic>[^<]+)</dynamic>\s*)?"
    r"(?:<mass>(?P<body_mass>[^<]+)</mass>\s*)?"
    rf"(?:{_MATERIAL.format('body_material')})?"
    r"<shape>\s*"
    r"(?:<hollow>(?P<hollow>[^<]+)</hollow>\s*)?"
    r"<mass>(?P<mass>[^<]+)</mass>\s*"
    rf"{_MATERIAL.format('material')}"
    r"(?:<sphere>\s*<radius>(?P<sphere>[^<]+)</radius>\s*</sphere>"
    r"|<box>\s*<half_extents>(?P<box>[^<]+)</half_extents>\s*</box>"
    r"|<capsule>\s*<height>(?P<capsule_height>[^<]+)</height>\s*"
    r"<radius>(?P<capsule>[^<]+)</radius>\s*</capsule>"
    r"|<cylinder>\s*<height>(?P<cylinder_height>[^<]+)</height>\s*"
    r"<radius>(?P<cylinder>[^<]+)</radius>\s*</cylinder>)\s*"
    r"(?:<rotate>(?P<step>[^<]+)</rotate>\s*)?"
    r"</shape>\s*</technique_common>\s*"
    r'(?:<technique profile="(?P<profile>pe)">\s*<pe:body(?: uid="(?P<uid>[^"]*)")?/>\s*'
    r"</technique>\s*)?"
)
_TURNED = np.array([0.0, 0.0, 1.0, -90.0])
"""The step of a capsule or cylinder that lies along x, as the World's do."""


class BodyTable:
    """One row for each rigid_body of a model."""

    def __init__(self, model: etree._Element) -> None:
        self.elements = list(model.iterchildren(c("rigid_body")))
        self._sids = [element.get("sid", "") for element in self.elements]
        rows = range(len(self._sids))
        self.index = dict(zip(reversed(self._sids), reversed(rows), strict=True))
        """The first row of each sid."""
        count = len(self.elements)
        self.regular: Array = np.zeros(count, dtype=np.bool_)
        self.kinds: Array = np.zeros(count, dtype=np.int8)
        self.dimensions: Array = np.zeros((count, 4))
        self.masses: Array = np.zeros(count)
        self.fixed: Array = np.zeros(count, dtype=np.bool_)
        self.hollow: Array = np.zeros(count, dtype=np.bool_)
        self.uids: Array = np.zeros(count, dtype=np.int64)
        self.sids: list[int | None] = [None] * count
        """The system ids that are wanted."""
        self.materials: list[str] = [""] * count
        """References to materials."""
        self.names: dict[int, str] = {}
        """Names by row."""
        texts = record_texts(model, "rigid_body", count)
        if texts:
            try:
                self._read(*recognised(_REGULAR, texts))
            except (ValueError, OverflowError):
                self.regular[...] = False

    def _read(self, rows: Array, columns: dict[str, Column]) -> None:
        if not len(rows):
            return
        masses, _ = number_rows(columns["mass"], 1)
        whole, has = number_rows(columns["body_mass"], 1)
        self.masses[rows] = np.where(has, whole[:, 0], masses[:, 0])
        good = (self.masses[rows] >= 0.0) & (self.masses[rows] < np.inf)
        good &= self._geometry(rows, columns)
        self.fixed[rows] = ~_booleans(columns["dynamic"], default=True)
        self.hollow[rows] = _booleans(columns["hollow"], default=False)
        self.uids[rows] = [int(uid or 0) for uid in columns["uid"]]
        for row, profile, first, second in zip(
            rows.tolist(),
            columns["profile"],
            columns["body_material"],
            columns["material"],
            strict=True,
        ):
            self.materials[row] = (second if first is None else first) or ""
            if profile is not None:
                self.sids[row] = system_id(self._sids[row], "Body")
            name = self.elements[row].get("name")
            if name is not None:
                self.names[row] = name
        self.regular[rows] = good

    def _geometry(self, rows: Array, columns: dict[str, Column]) -> Array:
        """Kinds and dimensions; whether the World can have them."""
        count = len(rows)
        values = np.zeros((count, 4))
        kinds = np.zeros(count, dtype=np.int8)
        steps, has_step = number_rows(columns["step"], 4)
        good = ~has_step
        radii, has = number_rows(columns["sphere"], 1)
        values[has, 0] = radii[has, 0]
        kinds[has] = Kind.SPHERE
        halves, has = number_rows(columns["box"], 3)
        values[has, :3] = 2.0 * halves[has]
        kinds[has] = Kind.BOX
        turned = has_step & np.all(steps == _TURNED, axis=1)
        radii, has = number_rows(columns["capsule"], 3)
        heights = number_rows(columns["capsule_height"], 1)[0]
        # Without height it is an ellipsoid, which keeps its axes and is not turned.
        flat = has & (heights[:, 0] == 0.0)
        long = has & ~flat
        values[flat, :3] = radii[flat]
        kinds[flat] = Kind.ELLIPSOID
        values[long] = np.column_stack([radii[:, [1, 0, 2]], heights])[long]
        kinds[long] = Kind.CAPSULE
        good[long] = turned[long]
        radii, has = number_rows(columns["cylinder"], 2)
        heights = number_rows(columns["cylinder_height"], 1)[0]
        values[has, 1:] = np.column_stack([radii, heights])[has]
        kinds[has] = Kind.CYLINDER
        good[has] = turned[has]
        self.kinds[rows] = kinds
        self.dimensions[rows] = values
        for kind, needed in NEEDED.items():
            where = kinds == kind
            sizes = values[where][:, needed]
            good[where] &= np.all((sizes > 0.0) & (sizes < np.inf), axis=1)
        return good


def _booleans(texts: Column, *, default: bool) -> Array:
    """xs:boolean; `default` for None."""
    known = {text: default if text is None else text.strip() in ("true", "1")
             for text in set(texts)}  # fmt: skip
    return np.array([known[text] for text in texts], dtype=np.bool_)
