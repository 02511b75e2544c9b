"""Physics materials as materials of a World (thesis 4.4, 5.3, 5.5).

A physics material has three values; what pe needs beyond them is in the pe profile, or the standard
values below. A shape's own density makes a variant of its material. Materials are deduplicated by
value: a file with a material a body, or a density a body, gives no more materials than it has
different ones.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from lxml import etree

from colladaphy.document.names import c, local_name
from colladaphy.errors import DocumentError
from colladaphy.findings import Severity
from colladaphy.mapper import rules
from colladaphy.mapper.markup import token
from colladaphy.mapper.profile import numbers, techniques
from colladaphy.mapper.staleness import Precision

if TYPE_CHECKING:
    from colladaphy.document import Document, Prefer
    from colladaphy.world import World

__all__ = ["STANDARD_DENSITY", "MaterialRecord", "MaterialTable"]

STANDARD_DENSITY = 1.0
_STANDARD = {
    "density": STANDARD_DENSITY,
    "restitution": 0.0,
    "static_friction": 0.0,
    "dynamic_friction": 0.0,
    "poisson_ratio": 0.24,
    "young_modulus": 200.0,
    "stiffness": 200.0,
    "damping_normal": 0.0,
    "damping_tangential": 0.0,
}
"""What is assumed for values that a file does not give: COLLADA's zeros, and pe's iron."""
_NOTHING = {**_STANDARD, "restitution": 0.5, "static_friction": 0.1, "dynamic_friction": 0.1}
"""A body without any material: what pe's five materials have in common."""

_COMMON = ("dynamic_friction", "restitution", "static_friction")
_LIMITS = {
    "density": (0.0, math.inf),
    "restitution": (0.0, 1.0),
    "static_friction": (0.0, math.inf),
    "dynamic_friction": (0.0, math.inf),
    "poisson_ratio": (-1.0, 0.5),
    "young_modulus": (0.0, math.inf),
    "stiffness": (0.0, math.inf),
    "damping_normal": (0.0, math.inf),
    "damping_tangential": (0.0, math.inf),
}
_POSITIVE = ("density", "young_modulus", "stiffness")
_OUR_ID = re.compile(r"(?:.*-)?Material(\d{1,18})\Z")


@dataclass(slots=True)
class MaterialRecord:
    """A physics material as it is read, before it becomes a World's (thesis: ColladaMaterial)."""

    name: str
    values: dict[str, float]
    wanted_id: int | None = None
    """The id that it had in the World that was stored."""
    has_density: bool = False
    """Whether the pe profile gives its density."""


class MaterialTable:
    """The materials of a World that is being loaded, by the elements they come from."""

    def __init__(self, document: Document, world: World, prefer: Prefer) -> None:
        self._document = document
        self._world = world
        self._prefer = prefer
        self._records: dict[etree._Element, MaterialRecord] = {}
        self._missing: set[etree._Element] = set()
        self._nothing: MaterialRecord | None = None
        self._ids: dict[tuple[object, ...], int] = {}

    def record(self, element: etree._Element, document: Document) -> MaterialRecord | None:
        """The material of an instance_physics_material or of a physics_material in place."""
        known = self._records.get(element)
        if known is None:
            material, home = element, document
            if local_name(element.tag) == "instance_physics_material":
                try:
                    target = document.resolve(element.get("url", ""), element, "physics_material")
                except DocumentError as error:
                    if element not in self._missing:  # every shape asks again
                        self._missing.add(element)
                        warnings = (replace(f, severity=Severity.WARNING) for f in error.findings)
                        self._document.report.extend(warnings)
                    return None
                material, home = target.element, target.document
            known = self._records.get(material)
            if known is None:
                known = self._records[material] = self._read(material, home)
            self._records[element] = known
        return known

    def unspecified(self, element: etree._Element, document: Document) -> MaterialRecord:
        """The standard material of a body that has none; noted once."""
        if self._nothing is None:
            self._nothing = MaterialRecord("unspecified", dict(_NOTHING))
            self._document.note(rules.MATERIAL_ASSUMED, element, file=document.file)
        return self._nothing

    def id_of(self, record: MaterialRecord, density: float | None = None) -> int:
        """The id of the World's material; `density` makes a variant where it is another one."""
        values = record.values
        if density is not None and 0.0 < density < math.inf and density != values["density"]:
            values = {**values, "density": density}
            record = MaterialRecord(record.name, values)
        name = record.name if record.wanted_id is not None else None
        key = (name, record.wanted_id, *(value.hex() for value in values.values()))
        known = self._ids.get(key)
        if known is None:
            known = self._ids[key] = self._create(record)
        return known

    def known_id(self, element: etree._Element) -> int | None:
        """The id of the World's material that a physics_material in use became."""
        record = self._records.get(element)
        return None if record is None else self.id_of(record)

    def _create(self, record: MaterialRecord) -> int:
        materials = self._world.materials
        if record.name in materials:
            same = materials[record.name]
            if all(
                getattr(same, name).hex() == value.hex() for name, value in record.values.items()
            ):
                return same.id
        wanted = record.wanted_id
        if wanted is not None and wanted in materials:
            wanted = None
        material = self._world.create_material(
            unique_name(record.name, materials), id=wanted, **record.values
        )
        return material.id

    def _read(self, element: etree._Element, document: Document) -> MaterialRecord:
        values = dict(_STANDARD)
        common = element.find(c("technique_common"))
        for child in () if common is None else common:
            name = local_name(child.tag)
            if name in _COMMON:
                values[name] = numbers(child)[0]
        profile = _profile_values(element)
        record = MaterialRecord(element.get("name") or element.get("id") or "material", values)
        if profile is not None:
            self._apply(record, profile, element, document)
        self._check(record, element, document)
        return record

    def _apply(
        self,
        record: MaterialRecord,
        profile: tuple[etree._Element, dict[str, float]],
        element: etree._Element,
        document: Document,
    ) -> None:
        holder, given = profile
        ours = _OUR_ID.match(element.get("id", ""))
        if local_name(holder.tag) == "material":
            record.wanted_id = int(ours.group(1)) if ours else None
            name = element.get("name")
            kept = holder.get("name")
            if kept is not None and name is not None and token(kept) == token(name):
                record.name = kept
            elif name is not None:
                record.name = name
        common = element.find(c("technique_common"))
        precision = Precision(() if common is None else (common,))
        for name, value in given.items():
            stated = record.values[name]
            if (
                name not in _COMMON
                or self._prefer == "profile"
                or (self._prefer == "newer" and precision.same(stated, value))
            ):
                record.values[name] = value
            elif self._prefer == "newer":
                message = (
                    f"The {name} of material {record.name!r} is {stated!r} in the common profile, "
                    f"{value!r} in the pe profile; the common one was edited and is taken."
                )
                self._document.note(rules.STALE, element, message, file=document.file)
        record.has_density = "density" in given

    def _check(self, record: MaterialRecord, element: etree._Element, document: Document) -> None:
        for name, value in record.values.items():
            low, high = _LIMITS[name]
            nearest = value
            if not math.isfinite(value) or (name in _POSITIVE and value <= 0.0):
                nearest = _STANDARD[name]
            elif not low <= value <= high:
                nearest = low if value < low else high
            if nearest != value:
                message = (
                    f"The {name} of material {record.name!r} is {value!r}; {nearest!r} is taken."
                )
                self._document.note(rules.MATERIAL_BAD, element, message, file=document.file)
                record.values[name] = nearest


def unique_name(name: str, taken: object) -> str:
    """`name`, with a number appended where it is in use already (thesis 4.4)."""
    if name not in taken:  # type: ignore[operator]
        return name
    number = 1
    while f"{name}_{number}" in taken:  # type: ignore[operator]
        number += 1
    return f"{name}_{number}"


def _profile_values(
    element: etree._Element,
) -> tuple[etree._Element, dict[str, float]] | None:
    """The values of the pe profile, and the element that holds them, in either spelling."""
    for extra in (True, False):
        for technique in techniques(element, extra=extra):
            holder = technique
            for child in technique:
                if local_name(child.tag) == "material":
                    holder = child
            values = {}
            for child in holder:
                name = local_name(child.tag)
                if name in _STANDARD:
                    try:
                        values[name] = numbers(child)[0]
                    except (ValueError, IndexError):
                        continue
            if values or holder is not technique:
                return holder, values
    return None
