"""Frames in the model's space: OpenRAVE, ROS urdf_to_collada, OpenHRP3 and their relatives.

The standard has mass frames and shapes relative to the body's node. These producers write them
relative to their model (to the node that it is instanced under, or to its base link), with all
joints at zero or as they are shown; newer versions write them as the standard has it. Which it is,
the geometry that the links show decides, for mass frames and for shapes each by themselves. The
vertices of meshes are often in the link's frame already, while the shape repeats the transform
that brought them there; such a mesh stands where its link shows it.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from lxml import etree

from colladaphy.conform import convention_rules
from colladaphy.conform.context import Context
from colladaphy.conform.conventions.clues import Clues, is_assumed, place_of
from colladaphy.conform.conventions.fitting import Votes, mass_evidence, shape_evidence
from colladaphy.conform.conventions.links import LOCAL, READINGS, Link, links_of
from colladaphy.conform.frames import Matrix
from colladaphy.conform.placing import put_place

__all__ = ["apply", "recognise_openhrp3", "recognise_openrave", "recognise_ros"]

_Frame = tuple[Link, etree._Element]


def recognise_openrave(clues: Clues) -> str | None:
    """OpenRAVE and its relatives name themselves, or leave their profile."""
    found = clues.tool("openrave", "mujin")
    profiles = clues.profiles & {"OpenRAVE", "MUJIN"}
    return found or (f"it has the profile {min(profiles)}" if profiles else None)


def recognise_ros(clues: Clues) -> str | None:
    """ROS's urdf_to_collada names itself."""
    return clues.tool("urdf collada writer", "urdf_to_collada", "collada_urdf")


def recognise_openhrp3(clues: Clues) -> str | None:
    """OpenHRP3 names itself."""
    return clues.tool("openhrp", "export_collada")


def apply(context: Context, *, forced: bool) -> None:
    """Bring mass frames and shapes into their body's space, where they were in the model's.

    With `forced` the model's space is taken whatever the numbers say, with a warning.
    """
    links = links_of(context)
    posed = any(link.posed for link in links)
    frames = [(link, shape) for link in links for shape in link.shapes() if not is_assumed(shape)]
    votes = Votes(posed)
    shown: dict[etree._Element, Sequence[Matrix | None]] = {}
    for link, shape in frames:
        evidence = shape_evidence(context, link, shape)
        votes.add(evidence)
        if evidence is not None:
            shown[shape] = evidence.places
    like = _apply(context, "shapes", frames, votes, shown, forced=forced, like=None)
    frames = [(link, frame) for link in links for frame in link.mass_frames()]
    votes = Votes(posed)
    for link, frame in frames:
        votes.add(mass_evidence(link, frame))
    _apply(context, "mass frames", frames, votes, {}, forced=forced, like=like)


def _apply(
    context: Context,
    what: str,
    frames: list[_Frame],
    votes: Votes,
    shown: dict[etree._Element, Sequence[Matrix | None]],
    *,
    forced: bool,
    like: int | None,
) -> int | None:
    """Move the frames of one kind as most of them fit; the reading, where anything told of it."""
    reading = votes.decide(like)
    if forced and reading == LOCAL and votes:
        message = f"{what} were taken from the model's space as asked, but {votes}"
        context.note(convention_rules.FRAMES_DOUBTFUL, context.root, message)
        reading = 0
    elif votes.doubtful(reading):
        message = f"{what} hardly fit {READINGS[reading]}, which is taken: {votes}"
        context.note(convention_rules.FRAMES_DOUBTFUL, context.root, message)
    moves, shifted = [], 0
    for link, holder in frames:
        place = place_of(holder)
        where = shown[holder][reading] if holder in shown else None
        if place is None:
            continue
        shifted += where is not None
        where = link.readings(place)[reading] if where is None else where
        if not np.array_equal(where, place):
            moves.append((holder, where))
    if moves and context.wants(convention_rules.FRAMES):
        remark = f"; {shifted} of them stand where their link shows them" if shifted else ""
        source = READINGS[reading]
        message = f"{len(moves)} {what} moved from {source} to their place: {votes}{remark}"
        context.note(convention_rules.FRAMES, context.root, message)
        for holder, where in moves:
            put_place(context, holder, where)
    elif votes and reading == LOCAL:
        message = f"{what} are in the bodies' own space: {votes}"
        context.note(convention_rules.FRAMES_LOCAL, context.root, message)
    return reading if votes else None
