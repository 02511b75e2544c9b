"""Masses of shapes and centres of mass, where a document leaves them to densities.

A shape's mass is given, or its volume times its density, or times that of its material in the pe
profile (thesis 4.4), or times 1 (COLLADA 1.5 §shape, §mass_frame).
"""

from __future__ import annotations

import math

import numpy as np
from lxml import etree

from colladaphy.conform.bullet.geometries import Geometries
from colladaphy.conform.bullet.markup import children, first
from colladaphy.conform.bullet.shapes import solid_of
from colladaphy.conform.downgrade.draft import Draft, local, tag15
from colladaphy.conform.frames import Matrix, floats_of, transform_of, translation

__all__ = ["Weights"]

_MATERIALS = ("instance_physics_material", "physics_material")


class Weights:
    """What the shapes of bodies weigh, and about which point."""

    def __init__(self, draft: Draft, geometries: Geometries) -> None:
        self._geometries = geometries
        self._materials = {
            material.get("id", ""): material for material in draft.all("physics_material")
        }

    def masses(self, common: etree._Element) -> list[float]:
        """The mass of each shape of a rigid_body's technique_common; NaN where nobody knows."""
        return [self._mass(common, shape) for shape in children(common, "shape")]

    def _mass(self, common: etree._Element, shape: etree._Element) -> float:
        mass, density = first(shape, "mass"), first(shape, "density")
        if mass is not None:
            return floats_of(mass)[0]
        solid = solid_of(shape, self._geometries)
        if solid is None:
            return math.nan
        if density is not None:
            return solid.volume * floats_of(density)[0]
        return solid.volume * self._density(common, shape)

    def _density(self, common: etree._Element, shape: etree._Element) -> float:
        """The density of the material that counts, from the pe profile."""
        for material in (*children(common, *_MATERIALS), *children(shape, *_MATERIALS)):
            url = material.get("url", "").strip().removeprefix("#")
            source = material if local(material) == "physics_material" else self._materials.get(url)
            if source is None:
                continue
            for technique in source.iter(tag15("technique")):
                if technique.get("profile") == "pe":
                    for value in technique.iter("{*}density"):
                        return floats_of(value)[0]
        return 1.0

    def center_of_mass(self, common: etree._Element) -> Matrix:
        """Its frame in the rigid_body: the mass_frame, or else that of what the shapes weigh."""
        frame = first(common, "mass_frame")
        if frame is not None:
            return transform_of(frame)
        weighted, total = np.zeros(3), 0.0
        for shape, mass in zip(children(common, "shape"), self.masses(common), strict=True):
            if 0.0 < mass < math.inf:
                solid = solid_of(shape, self._geometries)
                inner = np.zeros(3) if solid is None else solid.center
                weighted += mass * (transform_of(shape) @ [*inner, 1.0])[:3]
                total += mass
        return translation((weighted / total).tolist()) if total > 0.0 else np.eye(4)
