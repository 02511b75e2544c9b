"""Documents as other programs write them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from hypothesis import strategies as st

from colladaphy.testing.producers import flat, habits, robots
from colladaphy.testing.producers.meaning import world_of
from colladaphy.testing.producers.scenes import scenes
from colladaphy.testing.producers.truth import Scene
from colladaphy.world import World

__all__ = ["FOREIGN_PRODUCERS", "ForeignDocument", "foreign_documents"]

FOREIGN_PRODUCERS: tuple[str, ...] = tuple(sorted([*habits.PRODUCERS, *robots.TOOLS]))
"""Whose manners are known: "bullet" (its ColladaConverter), "chimera" (Blender's exporter for
Chimera), "colladamaya", "illusoft" (Blender 2.4's), "nxustream2" (of PhysX), "opencollada",
"openhrp3", "openrave", "ros" (urdf_to_collada), and "thesis" (the listings of the thesis)."""


@dataclass(frozen=True)
class ForeignDocument:
    """A document that some other program could have written, and what was meant by it."""

    data: bytes
    """The file: COLLADA 1.4 or 1.5, hardly ever valid."""
    producer: str
    """One of FOREIGN_PRODUCERS."""
    habits: frozenset[str]
    """What deviates in it beyond what the producer always does."""
    meant: Scene
    """What the author of the file meant: solids, masses and joints, in the standard's terms."""

    @property
    def world(self) -> World:
        """The World that was meant, made anew; see `colladaphy.testing.producers.meaning`.

        A loader gives other ids and names, and bodies may have other axes of their own. Compare
        what does not depend on these: masses, centres of mass, inertias and velocities in the
        frame of the world, and joints.
        """
        return world_of(self.meant)


def foreign_documents(
    producer: str | Iterable[str] | None = None, *, habits: bool = True
) -> st.SearchStrategy[ForeignDocument]:
    """Documents in the manner of one producer, of some, or (None) of all that are known.

    Each has the deviations that its producer always has, and with `habits` any mixture of those
    that it may have besides. What they mean is known: frames, units of angles, whose space the
    shapes are in. The library reads all of them with ``read(..., repair=True)``.

    Raises ValueError for an unknown producer.
    """
    if producer is None:
        names = list(FOREIGN_PRODUCERS)
    else:
        names = [producer] if isinstance(producer, str) else list(producer)
    for name in names:
        if name not in FOREIGN_PRODUCERS:
            known = ", ".join(FOREIGN_PRODUCERS)
            raise ValueError(f"no producer {name!r}; there are {known}")
    if not names:
        raise ValueError("name a producer, or leave it out for all")

    @st.composite
    def document(draw: st.DrawFn) -> ForeignDocument:
        name = draw(st.sampled_from(names))
        if name in robots.TOOLS:
            return _robot(draw, name, habits)
        return _flat(draw, name, habits)

    return document()


def _some(draw: st.DrawFn, known: tuple[str, ...], wanted: bool) -> frozenset[str]:
    if not known or not wanted:
        return frozenset()
    return frozenset(draw(st.sets(st.sampled_from(known), max_size=6)))


def _robot(draw: st.DrawFn, name: str, wanted: bool) -> ForeignDocument:
    scene = draw(robots.robots())
    found = _some(draw, robots.QUIRKS, wanted)
    scene = robots.meant(scene, found)
    return ForeignDocument(robots.write(scene, name, found), name, found, scene)


def _flat(draw: st.DrawFn, name: str, wanted: bool) -> ForeignDocument:
    producer = habits.PRODUCERS[name]
    scene = draw(scenes_of(name))
    found = _some(draw, producer.may, wanted)
    return ForeignDocument(flat.write(scene, producer, found), name, found, scene)


def scenes_of(name: str) -> st.SearchStrategy[Scene]:
    """Scenes that a producer of `colladaphy.testing.producers.habits` can write."""
    producer = habits.PRODUCERS[name]
    return scenes(
        kinds=producer.kinds,
        joints=producer.joints,
        moving=producer.moving,
        centred=producer.centred,
        nested=name == "colladamaya",
    ).map(lambda scene: habits.meant(scene, producer))
