"""The rigid_bodies of a physics model as columns (thesis 5.3; COLLADA 1.5 §rigid_body)."""

from __future__ import annotations

import re
from functools import cached_property
from typing import Any

import numpy as np
from lxml import etree
from numpy.typing import NDArray

from colladaphy.document.names import c
from colladaphy.mapper.bodies import system_id
from colladaphy.mapper.columns.texts import Column, count_of, number_rows, recognised
from colladaphy.world.kinds import Kind
from colladaphy.world.shapes import NEEDED

__all__ = ["BodyTable"]

Array = NDArray[Any]

_MATERIAL = r'<instance_physics_material url="(?P<{0}>[^"]*)"/>\s*'

# One primitive, in its own place, with a mass and a material; of the pe profile nothing but the
# user id.
_REGULAR = re.compile(
    r'\s*<rigid_body(?: sid="(?P<sid>[^"&]*)">|\s[^>]*>)\s*<technique_common>\s*'
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
    r"</technique>\s*)?</rigid_body>"
)
_OUR_SIDS = re.compile(r"Body[0-9]{1,18}(?: Body[0-9]{1,18})*+")
_TURNED = np.array([0.0, 0.0, 1.0, -90.0])
"""The step of a capsule or cylinder that lies along x, as the World's do."""


class BodyTable:
    """One row for each rigid_body of a model."""

    def __init__(self, model: etree._Element) -> None:
        self._model = model
        count = count_of(model, "rigid_body")
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
        self._sids: Column = ("",) * count
        try:
            self._read(*recognised(_REGULAR, model, "rigid_body", count))
        except (ValueError, OverflowError):
            self.regular[...] = False
        self.index: dict[str, int] = {}
        """The first row of each sid."""
        for row, sid in enumerate(self._sids):
            self.index.setdefault(sid or self.elements[row].get("sid", ""), row)

    @cached_property
    def elements(self) -> list[etree._Element]:
        """The rigid_body elements, which are not needed where all are regular."""
        return list(self._model.iterchildren(c("rigid_body")))

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
        self._identify(rows.tolist(), columns)
        self.regular[rows] = good

    def _identify(self, rows: list[int], columns: dict[str, Column]) -> None:
        """Sids, names and references to materials."""
        sids = list(columns["sid"])
        for place, sid in enumerate(sids):
            if not sid:  # there are other attributes
                element = self.elements[rows[place]]
                sids[place] = element.get("sid", "")
                name = element.get("name")
                if name is not None:
                    self.names[rows[place]] = name
        urls = [
            outer or inner
            for outer, inner in zip(columns["body_material"], columns["material"], strict=True)
        ]
        wanted = [
            sid if profile else None
            for profile, sid in zip(columns["profile"], system_ids(sids), strict=True)
        ]
        if len(rows) == len(self.regular):
            self._sids, self.materials, self.sids = tuple(sids), urls, wanted
            return
        known = list(self._sids)
        for row, sid, url, system in zip(rows, sids, urls, wanted, strict=True):
            known[row], self.materials[row], self.sids[row] = sid, url, system
        self._sids = tuple(known)

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


def system_ids(sids: list[str]) -> list[int | None]:
    """The system ids that our own sids of bodies are made of."""
    joined = " ".join(sids)
    if _OUR_SIDS.fullmatch(joined):
        made: list[int | None] = np.fromstring(
            joined.replace("Body", ""), dtype=np.int64, sep=" "
        ).tolist()
        return made
    return [system_id(sid, "Body") for sid in sids]


def _booleans(texts: Column, *, default: bool) -> Array:
    """xs:boolean; `default` where there is none."""
    known = {text: text.strip() in ("true", "1") if text else default for text in set(texts)}
    return np.array([known[text] for text in texts], dtype=np.bool_)
