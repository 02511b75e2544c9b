"""Conventions: producers that mean something else than the standard by what they write.

Each is recognised by what a document says about itself, checked against its numbers where they
can tell, and translated once. A note in the document's extras (`convention`) keeps it from being
translated again; another (`written_for`) is left by our own writers for other programs.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from colladaphy.conform import convention_rules
from colladaphy.conform.context import Context
from colladaphy.conform.conventions import blender, bullet, model_frames, thesis, units
from colladaphy.conform.conventions.clues import Clues, add_note, drop_note, find_note, read_clues
from colladaphy.findings import Finding
from colladaphy.source import extensions

__all__ = [
    "CONVENTIONS",
    "Clues",
    "Convention",
    "conventions",
    "faults_of_others",
    "recognised",
    "translate",
]


@dataclass(frozen=True, slots=True)
class Convention:
    """A producer's own reading.

    `recognise` gives the evidence in words, or None; `apply` rewrites the document, and is told
    whether the convention was asked for by name and what the document says of itself.
    """

    name: str
    summary: str
    recognise: Callable[[Clues], str | None]
    apply: Callable[[Context, bool, Clues], None]


def _frames(context: Context, named: bool, clues: Clues) -> None:
    model_frames.apply(context, forced=named)


def _bullet(context: Context, named: bool, clues: Clues) -> None:
    bullet.apply(context, whole=named or bullet.is_whole(clues))


def _nothing(context: Context, named: bool, clues: Clues) -> None:
    """The thesis's own files differ in references and in their profile, not in meaning."""


CONVENTIONS: tuple[Convention, ...] = (
    Convention(
        "bullet",
        "radians, mirrored limits, planes n·x = D, halved cylinder heights",
        bullet.recognise,
        _bullet,
    ),
    Convention(
        "bullet-rewritten",
        "another tool's file with the velocities that Bullet gave it, in radians",
        bullet.recognise_rewritten,
        lambda context, named, clues: bullet.apply_rewritten(context),
    ),
    Convention(
        "ros",
        "urdf_to_collada: mass frames and shapes in the model's space",
        model_frames.recognise_ros,
        _frames,
    ),
    Convention(
        "openrave",
        "mass frames and shapes in the model's space",
        model_frames.recognise_openrave,
        _frames,
    ),
    Convention(
        "openhrp3",
        "mass frames and shapes in the model's space",
        model_frames.recognise_openhrp3,
        _frames,
    ),
    Convention(
        "nxustream2",
        "angular velocities in radians, restitution as a spring's target",
        units.recognise_nxustream,
        lambda context, named, clues: units.apply_nxustream(context),
    ),
    Convention(
        "colladamaya",
        "gravity in metres whatever the unit, solid shapes called hollow",
        units.recognise_colladamaya,
        lambda context, named, clues: units.apply_colladamaya(context),
    ),
    Convention(
        "blender",
        "cylinders along z, halved heights, where the shown geometry says so",
        blender.recognise,
        lambda context, named, clues: blender.apply(context),
    ),
    Convention(
        "thesis",
        "paths as references, the pe profile without a namespace of its own",
        lambda clues: "its pe profile has no namespace of its own" if clues.bare_pe else None,
        _nothing,
    ),
    Convention(
        "thesis-current-distance",
        "linear limits count from where the bodies are",
        lambda clues: None,  # only by name: no file says so of itself
        lambda context, named, clues: thesis.count_from_here(context),
    ),
)


def conventions() -> tuple[Convention, ...]:
    """Ours, then those of other packages, in the order in which they are tried."""
    others, _ = extensions.loaded(extensions.CONVENTIONS, _fault)
    return CONVENTIONS + tuple(convention for _, convention in others)


def faults_of_others() -> list[Finding]:
    """What is wrong with the conventions that other packages offer."""
    return list(extensions.loaded(extensions.CONVENTIONS, _fault)[1])


def _fault(offered: object) -> str | None:
    if not isinstance(offered, Convention):
        return f"it is no Convention, but {offered!r}"
    ours = {"auto", "none", *(known.name for known in CONVENTIONS)}
    return f"the name {offered.name!r} is taken" if offered.name in ours else None


def translate(context: Context, convention: str) -> None:
    """Rewrite what the document means otherwise than the standard.

    `convention` is the name of one of `conventions`, "auto" or "none". Raises ValueError for other
    names.
    """
    context.findings.extend(faults_of_others())
    by_name = {known.name: known for known in conventions()}
    if convention not in ("auto", "none", *by_name):
        names = ", ".join(["auto", "none", *by_name])
        raise ValueError(f"there is no convention {convention!r}; choose one of {names}")
    if convention == "none" or find_note(context, "convention") is not None:
        return
    inert = sum(found.code == convention_rules.INERT_SPRING.code for found in context.findings)
    clues = replace(
        read_clues(context), rewritten=bullet.count_rewritten(context), inert_springs=inert
    )
    named = by_name.get(convention)
    chosen = [(named, "asked for by name")] if named else recognised(clues)
    if not chosen or not context.wants(convention_rules.CONVENTION):
        return
    for known, why in chosen:
        message = f"the document is read as {known.name} means it ({known.summary}): {why}"
        context.note(convention_rules.CONVENTION, context.root, message)
        known.apply(context, named is not None, clues)
    drop_note(context, "written_for")  # true of the file, not of the translated document
    digits = {"digits": str(context.digits)} if context.digits else {}
    names_of_chosen = " ".join(known.name for known, _ in chosen)
    add_note(context, "convention", name=names_of_chosen, **digits)


def recognised(clues: Clues) -> list[tuple[Convention, str]]:
    """The first convention that fits; with Bullet also that of the file which Bullet edited."""
    fitting = [(known, why) for known in conventions() if (why := known.recognise(clues))]
    if not fitting or not fitting[0][0].name.startswith("bullet"):
        return fitting[:1]
    if bullet.is_whole(clues):
        return fitting[:1]
    others = [pair for pair in fitting[1:] if not pair[0].name.startswith("bullet")]
    return [fitting[0], *others[:1]]
