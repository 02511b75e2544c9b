"""What is measured: one World of spheres, and the ways to read and to write it."""

from __future__ import annotations

from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from typing import Any

STOCK = ("xsdata parse", "xsdata serialize")
STEPS = ("parse", "load", "store", *STOCK)


def spheres(count: int) -> Any:
    """A World of spheres of one material, each with pose, velocity and mass of its own."""
    import numpy as np

    from colladaphy.world import Kind, World
    from colladaphy.world.columns import BodyColumns

    world = World(gravity=(0.0, 0.0, -9.81))
    material = world.create_material(
        "soft",
        density=1.2,
        restitution=0.4,
        static_friction=0.5,
        dynamic_friction=0.1,
        poisson_ratio=0.2,
        young_modulus=1.0,
        stiffness=8.0,
        damping_normal=0.0,
        damping_tangential=0.0,
    )
    random = np.random.default_rng(count)
    quaternions = random.standard_normal((count, 4))
    quaternions /= np.linalg.norm(quaternions, axis=1)[:, None]
    dimensions = np.zeros((count, 4))
    dimensions[:, 0] = random.uniform(0.5, 2.0, count)
    world.extend(
        BodyColumns(
            kinds=np.full(count, int(Kind.SPHERE)),
            uids=np.arange(count),
            positions=random.uniform(-100.0, 100.0, (count, 3)),
            orientations=quaternions,
            linear_velocities=random.standard_normal((count, 3)),
            angular_velocities=random.standard_normal((count, 3)),
            masses=random.uniform(1.0, 10.0, count),
            material_ids=np.full(count, material.id),
            dimensions=dimensions,
        )
    )
    return world


def document(count: int) -> bytes:
    """The file of that World."""
    import colladaphy

    target = BytesIO()
    colladaphy.write(spheres(count), target)
    return target.getvalue()


def prepare(step: str, file: Path) -> Callable[[], object]:
    """A step of STEPS as a function of nothing, with everything it needs already there."""
    if step == "parse":
        from lxml import etree

        return lambda: etree.parse(str(file))
    data = file.read_bytes()
    if step in STOCK:
        return _stock(step, data)

    import colladaphy

    if step == "load":
        return lambda: colladaphy.read(data).load()
    world = colladaphy.read(data).load()
    return lambda: colladaphy.write(world, BytesIO())


def _stock(step: str, data: bytes) -> Callable[[], object]:
    from xsdata.formats.dataclass.context import XmlContext
    from xsdata.formats.dataclass.parsers import XmlParser
    from xsdata.formats.dataclass.serializers import XmlSerializer

    import colladaphy_schema
    from colladaphy_schema import Collada

    colladaphy_schema.load_all()
    context = XmlContext()
    parser = XmlParser(context=context)
    if step == "xsdata parse":
        return lambda: parser.from_bytes(data, Collada)
    root = parser.from_bytes(data, Collada)
    serializer = XmlSerializer(context=context)
    return lambda: serializer.render(root)
