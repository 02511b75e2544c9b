"""What a document gives away about its producer."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from lxml import etree

from colladaphy.conform.context import CONFORM, NS, OWN_MAP, Context, append, local, remove
from colladaphy.conform.frames import Matrix, transform_of
from colladaphy.conform.solids import are_usable, numbers_of

__all__ = [
    "Clues",
    "add_note",
    "drop_note",
    "extents",
    "find_note",
    "place_of",
    "read_clues",
]


@dataclass(frozen=True, slots=True)
class Clues:
    """Authoring tools and comments of the contributors, profiles of the techniques, ids of models.

    `written_for` is what our own writer noted: the program whose reading the file was made for.
    `bare_pe` is true where the pe profile has no namespace of its own. `rewritten` counts the
    bodies that turn as Bullet writes it into the files of other tools, `inert_springs` the springs
    without stiffness whose target is no number.
    """

    tools: str
    profiles: frozenset[str]
    models: frozenset[str]
    written_for: str | None
    bare_pe: bool
    rewritten: int = 0
    authors: str = ""
    inert_springs: int = 0

    def tool(self, *words: str) -> str | None:
        """The sentence about the first of these words that an authoring tool contains."""
        for word in words:
            if word.lower() in self.tools.lower():
                return f"its authoring tool is {self.tools!r}"
        return None

    def author(self, *words: str) -> str | None:
        """The sentence about the first of these words that an author's name contains."""
        for word in words:
            if word.lower() in self.authors.lower():
                return f"its author is {self.authors!r}"
        return None


def read_clues(context: Context) -> Clues:
    """Look at the contributors, the techniques and the models of a document."""
    tools, authors = (
        [" ".join((element.text or "").split()) for element in context.root.iter(NS + name)]
        for name in ("authoring_tool", "author")
    )
    profiles = {
        str(element.get("profile"))
        for element in context.root.iter(NS + "technique")
        if element.get("profile")
    }
    models = {element.get("id", "") for element in context.all("physics_model")}
    note = find_note(context, "written_for")
    written_for = None if note is None else (note.text or "").strip().lower()
    bare_pe = any(
        child.tag.startswith(NS)
        for technique in context.root.iter(NS + "technique")
        if technique.get("profile") == "pe"
        for child in technique.iterchildren(tag=etree.Element)
    )
    return Clues(
        "; ".join(filter(None, tools)),
        frozenset(profiles),
        frozenset(models),
        written_for,
        bare_pe,
        authors="; ".join(filter(None, authors)),
    )


def find_note(context: Context, name: str) -> etree._Element | None:
    """A note of ours in the extras of the document itself."""
    for extra in context.root.iterchildren(NS + "extra"):
        for found in extra.iter(f"{{{CONFORM}}}{name}"):
            return found
    return None


def drop_note(context: Context, name: str) -> None:
    """Take a note of ours out, and the extra that held nothing else."""
    note = find_note(context, name)
    if note is None:
        return
    technique = note.getparent()
    extra = None if technique is None else technique.getparent()
    if technique is not None and extra is not None:
        remove(note)
        if not len(technique) and len(extra) == 1:
            remove(extra)


def add_note(context: Context, tag: str, /, **values: str) -> None:
    """Add a note of ours to the extras of the document itself."""
    extra, technique = context.make("extra"), context.make("technique", profile="colladaphy")
    note = etree.SubElement(technique, f"{{{CONFORM}}}{tag}", nsmap=OWN_MAP)
    for key, value in values.items():
        note.set(key, value)
    extra.append(technique)
    append(context.root, extra)


def place_of(element: etree._Element) -> Matrix | None:
    """The transforms among an element's children, composed; None where one cannot be read."""
    try:
        place = transform_of(element)
    except ValueError:
        return None
    return place if are_usable(place.ravel().tolist()) else None


def extents(context: Context, geometry: etree._Element | None) -> Matrix | None:
    """Least and greatest coordinates (2 × 3) of the vertices of a geometry; None without any."""
    hull = None if geometry is None else geometry.find(NS + "convex_mesh")
    if hull is not None and hull.get("convex_hull_of"):
        geometry = context.by_url(hull.get("convex_hull_of"))
    if geometry is None:
        return None
    for vertices in geometry.iter(NS + "vertices"):
        for source in vertices.iterchildren(NS + "input"):
            if source.get("semantic") == "POSITION":
                holder = context.by_url(source.get("source"))
                array = None if holder is None else holder.find(NS + "float_array")
                numbers = numbers_of(array)
                if len(numbers) >= 3 and len(numbers) % 3 == 0 and are_usable(numbers):
                    points = np.asarray(numbers).reshape(-1, 3)
                    return np.stack([points.min(axis=0), points.max(axis=0)])
    return None


def is_assumed(shape: etree._Element) -> bool:
    """Whether a shape was made up by conform."""
    return any(local(e) == "assumed" for e in shape.iter(f"{{{CONFORM}}}assumed"))
