"""Who writes files of COLLADA 1.4 with physics, what they say of themselves, and their habits.

A habit is what deviates from the standard, or is unusual within it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from colladaphy.testing.producers.truth import Link, Scene

__all__ = ["ANY_QUIRKS", "PRODUCERS", "Producer", "bare", "meant"]

# Habits that any exporter of 1.4 may have, in any mixture.
ANY_QUIRKS = (
    "attachment-matrix",
    "attachment-names",
    "bare-instances",
    "body-paths",
    "capitals",
    "comments",
    "dates-without-zone",
    "digits",
    "dynamic-as-number",
    "dynamic-last",
    "effects",
    "empty-libraries",
    "extra-in-body",
    "free-as-min-over-max",
    "hull",
    "hull-without-hash",
    "inline-material",
    "inline-mesh",
    "linear-first",
    "matrix-nodes",
    "misplaced-scene",
    "no-effects-of-materials",
    "odd-names",
    "polygons",
    "polylist",
    "radius-first",
    "reference-hash",
    "reference-hash-path",
    "reference-dot",
    "reference-path",
    "second-attachment-first",
    "split-models",
    "three-radii",
    "transform-first",
    "unit-last",
    "white-space",
)


@dataclass(frozen=True)
class Producer:
    """What a producer always does, and what it may do."""

    tool: str | None
    version: str = "1.4.1"
    always: frozenset[str] = frozenset()
    may: tuple[str, ...] = ANY_QUIRKS
    kinds: tuple[str, ...] = ("box", "sphere", "capsule", "mesh")
    radians_per_second: bool = False
    radians: bool = False
    mirrored: bool = False
    """Whether angles are measured the other way round."""
    at_origin: bool = False
    """Whether the centre of mass is the node's origin, wherever the shapes are."""
    unit: float = 1.0
    up_axis: str = "Z_UP"
    profile: str | None = None
    joints: bool = False
    moving: bool = False
    centred: bool = False


PRODUCERS = {
    "nxustream2": Producer(
        "NxuStream2 (http://www.ageia.com)",
        "1.4.0",
        always=frozenset({"bounce-target"}),
        radians_per_second=True,
        profile="PhysX",
        joints=True,
        moving=True,
        centred=True,
    ),
    "colladamaya": Producer(
        "Maya 7.0 | ColladaMaya v2.03 | FCollada v1.13",
        always=frozenset({"hollow", "gravity-in-metres"}),
        kinds=("box", "sphere", "capsule", "cylinder", "mesh"),
        unit=0.01,
        up_axis="Y_UP",
        profile="MAYA",
        joints=True,
        moving=True,
    ),
    "illusoft": Producer(
        "Blender v:249 - Illusoft Collada Exporter v:0.3.162",
        "1.4.0",
        always=frozenset({"split-models"}),
        may=(*ANY_QUIRKS, "half-extends", "no-sids"),
        kinds=("box", "sphere", "mesh"),
    ),
    "chimera": Producer(
        None,
        always=frozenset({"inline-mesh", "three-radii", "no-scene", "missing-nodes"}),
        kinds=("sphere", "mesh", "box"),
    ),
    "opencollada": Producer(
        "OpenCOLLADA2015;  Version: 1.6;  Revision: developer_version",
        always=frozenset({"dynamic-as-number", "inline-material", "reference-hash-path"}),
        up_axis="Y_UP",
        profile="PhysX_3.x",
        joints=True,
        moving=True,
        centred=True,
    ),
    # Listing 2 of the thesis, and its technique without a namespace of its own.
    "thesis": Producer(
        None,
        "1.5.0",
        always=frozenset(
            {
                "body-paths",
                "common-in-joints",
                "mass-in-shape",
                "reference-path",
                "second-attachment-first",
                "technique-first",
                "three-radii",
            }
        ),
        may=tuple(quirk for quirk in ANY_QUIRKS if quirk != "effects"),  # they are those of 1.4
        kinds=("box", "sphere", "mesh"),
        profile="pe",
        joints=True,
        moving=True,
    ),
    "bullet": Producer(
        "Bullet Physics SDK 282 Snapshot(BulletColladaConverter) http://bulletphysics.com",
        always=frozenset({"half-heights"}),
        may=(),
        kinds=("box", "sphere", "cylinder", "capsule", "mesh"),
        radians_per_second=True,
        radians=True,
        mirrored=True,
        at_origin=True,
        joints=True,
        moving=True,
    ),
}


def meant(scene: Scene, producer: Producer) -> Scene:
    """The scene with what the producer cannot say otherwise: its unit and axes, its places."""
    gravity = scene.gravity
    if gravity is not None and "gravity-in-metres" in producer.always:
        gravity = tuple(value / producer.unit for value in gravity)  # type: ignore[assignment]
    links = scene.links
    if "missing-nodes" in producer.always:
        links = tuple(replace(link, steps=(), parent=None) for link in links)
    if producer.at_origin:
        links = tuple(replace(link, centre=()) for link in links)
    return replace(
        scene, unit=producer.unit, up_axis=producer.up_axis, gravity=gravity, links=links
    )


def bare(link: Link) -> Link:
    """A link of which only the shape, the mass and the place are stated."""
    return replace(link, centre=None, inertia=None)
