"""Animations: samplers, and what channels move (COLLADA 1.5 §animation, §sampler, §channel)."""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.findings import Severity
from colladaphy.links.rules import MISSING, WRONG_TYPE
from colladaphy.meaning import animation_rules, link_rules
from colladaphy.meaning.context import Context
from colladaphy.meaning.hits import Hit, listed
from colladaphy.meaning.inputs import inputs_of
from colladaphy.meaning.source_table import sources_of
from colladaphy_schema.rows import Column, Masked, Rows

__all__ = ["CHECKS", "addressed"]

Array = NDArray[Any]


_KNOWN = frozenset({"LINEAR", "BEZIER", "CARDINAL", "HERMITE", "BSPLINE", "STEP"})
_VECTOR, _COLOR = frozenset("XYZ"), frozenset("RGBA")
_MEMBERS: dict[str, tuple[frozenset[str] | None, int]] = {
    "translate": (_VECTOR, 3),
    "scale": (_VECTOR, 3),
    "rotate": (_VECTOR | {"ANGLE"}, 4),
    "color": (_COLOR, 0),
    "matrix": (frozenset(), 16),
    "lookat": (frozenset(), 9),
    "skew": (frozenset(), 7),
    **dict.fromkeys(("gravity", "inertia"), (_VECTOR, 3)),
    **dict.fromkeys(
        (
            "xfov", "yfov", "znear", "zfar", "aspect_ratio", "xmag", "ymag",
            "constant_attenuation", "linear_attenuation", "quadratic_attenuation",
            "falloff_angle", "falloff_exponent", "float", "mass", "density", "stiffness",
            "damping", "target_value", "time_step", "restitution", "static_friction",
            "dynamic_friction",
        ),
        (None, 1),
    ),
}  # fmt: skip
"""Names of members, and how many values there are; 0 where that differs.

A number has no members, but some exporters name it (``fov.ANGLE``).
"""
_WHOLE = frozenset({"node", "visual_scene", "geometry", "mesh", "material", "effect", "camera",
                    "light", "controller", "skin", "animation", "sampler", "image",
                    "vertices", "Name_array", "IDREF_array", "SIDREF_array", "animation_clip",
                    "physics_model", "physics_scene", "physics_material",
                    "force_field"})  # fmt: skip
_INDEX = re.compile(r"\((\d+)\)")
_SPLIT = re.compile(r"(.*?)(\.[A-Za-z_]+|(?:\(\d+\))+)\Z")


def samplers(context: Context) -> Iterator[Hit]:
    """Samplers whose keys do not fit each other."""
    elements = context.ordinals("sampler")
    # Effects have samplers too, in another namespace of names.
    elements = elements[context.is_within(elements, "animation")]
    inputs, table = inputs_of(context), sources_of(context)
    told: set[int] = set()  # arrays, which several samplers may have
    for element in elements.tolist():
        counts: dict[str, int | None] = {}
        for row in inputs.of(element):
            if inputs.sources[row] >= 0:
                counts.setdefault(inputs.semantic(row), table.count(int(inputs.sources[row])))
        known = {count for count in counts.values() if count is not None}
        if len(known) > 1:
            wanted = max(known)
            shorts = [table.short(int(inputs.sources[row]), wanted) for row in inputs.of(element)]
            if found := [short for short in shorts if short]:
                yield from found
                continue
            said = ", ".join(f"{count} {name}" for name, count in counts.items())
            yield Hit(animation_rules.KEY_COUNT, element, f"The inputs differ in number: {said}.")
            continue
        source = inputs.source(element, "INPUT")
        times = None if source < 0 else table.numbers(source)
        if times is not None and np.isfinite(times).all():
            steps = np.diff(times[:, 0])
            if bool(np.any(steps <= 0.0)) and int(table.arrays[source]) not in told:
                told.add(int(table.arrays[source]))
                place = int(np.flatnonzero(steps <= 0.0)[0])
                message = f"Time {times[place + 1, 0]:g} comes after {times[place, 0]:g}."
                yield Hit(animation_rules.KEY_ORDER, int(table.arrays[source]), message, (element,))
        yield from _interpolations(context, element, told)
        yield from _tangents(context, element)


def _interpolations(context: Context, element: int, told: set[int]) -> Iterator[Hit]:
    inputs, table = inputs_of(context), sources_of(context)
    source = inputs.source(element, "INTERPOLATION")
    words = None if source < 0 else table.words(source)
    if words is None:
        return
    array = int(table.arrays[source])
    known = _KNOWN if context.name(element) == "sampler" else _KNOWN | {"NURBS"}
    strange = sorted(set(words) - known)
    if strange and array in told:
        return
    if strange:
        told.add(array)
        yield Hit(
            animation_rules.INTERPOLATION,
            array,
            f"There is no interpolation {listed(strange)}.",
            (element,),
        )
    elif {"BEZIER", "HERMITE"} & set(words):
        lacking = [name for name in ("IN_TANGENT", "OUT_TANGENT")
                   if inputs.named(element, name) < 0]  # fmt: skip
        if lacking:
            name = context.name(element)
            message = f"{words[0]} needs {' and '.join(lacking)}, which the <{name}> has not."
            yield Hit(animation_rules.INTERPOLATION, element, message, (array,))


def splines(context: Context) -> Iterator[Hit]:
    """Splines whose interpolations are not known, or lack their tangents."""
    told: set[int] = set()
    for element in context.ordinals("control_vertices").tolist():
        yield from _interpolations(context, element, told)


def _tangents(context: Context, element: int) -> Iterator[Hit]:
    """Tangents of another width than the keys: as many values as these, one more, or twice."""
    inputs, table = inputs_of(context), sources_of(context)
    keys = inputs.source(element, "OUTPUT")
    width = 0 if keys < 0 else int(table.steps[keys])
    if not width or int(table.arrays[keys]) < 0:
        return
    for name in ("IN_TANGENT", "OUT_TANGENT"):
        source = inputs.source(element, name)
        if source < 0 or int(table.arrays[source]) < 0:
            continue
        found = int(table.steps[source])
        if found not in (width, width + 1, 2 * width):
            row = inputs.named(element, name)
            message = f"Keys of {width} values have tangents of {found}."
            yield Hit(animation_rules.TANGENT_WIDTH, int(inputs.elements[row]), message,
                      (int(table.accessors[source]), element))  # fmt: skip


def channels(context: Context) -> Iterator[Hit]:
    """Channels whose targets are not there, or do not fit."""
    references = context.references("target", "channel")
    samplers = context.references("source", "channel")
    clips = _Clips(context)
    moved: dict[tuple[int, str | None, int], int] = {}
    for reference, source in zip(references, samplers, strict=True):
        element, text = reference.element, reference.text.strip()
        found = addressed(context, text)
        if isinstance(found, str):
            scope = context.target(text.partition("/")[0])
            related = (scope,) if scope >= 0 else ()
            yield Hit(MISSING, element, found, related, "target", Severity.WARNING)
            continue
        if text[:1] == "#":
            message = f"{text!r} begins with '#', as addresses by scoped ids do not."
            yield Hit(MISSING, element, message, (found[0],), "target", Severity.WARNING,
                      f"Write {text[1:]!r}.")  # fmt: skip
            continue
        target, member = found
        name = context.name(target)
        if name in _WHOLE:
            message = f"A <{name}> is nothing that moves; name what is in it."
            yield Hit(WRONG_TYPE, element, message, (target,), "target", Severity.WARNING)
            continue
        part = _number(name, member)
        # The whole, and what is in it, cannot both be moved at a time.
        mine, others = clips.of(element)
        parts = (part, "") if part else (None,)
        against = [(target, each, clip) for clip in others for each in parts]
        other = next((moved[key] for key in against if key in moved), None)
        for key in ((target, each, clip) for clip in mine for each in (part, None)):
            moved.setdefault(key, element)
        if other is not None:
            message = f"Another channel moves {text!r}, too."
            yield Hit(animation_rules.CHANNEL_TWICE, element, message, (other, target), "target")
            continue
        members, width = _MEMBERS.get(name, (None, 0))
        if name == "source" and member:
            members, width = frozenset(), _held(context, target)
        if member and members is not None and not _has(name, members, width, member):
            message = f"A <{name}> has no member {member!r}."
            yield Hit(link_rules.CHANNEL_MEMBER, element, message, (target,), "target")
            continue
        wanted = 1 if member else width
        sampler = context.target(source.text)
        if wanted and sampler >= 0:
            yield from _width(context, element, sampler, name + member, wanted)


class _Clips:
    """The clips in which animations are played; those that are in none are always played."""

    _ALWAYS, _SOME = -1, -2

    def __init__(self, context: Context) -> None:
        self._context = context
        self._by_animation: dict[int, set[int]] = {}
        self._some_are_lost = False
        for reference in context.references("url", "instance_animation"):
            animation = context.target(reference.text.strip())
            here = reference.text.strip().find("#") <= 0
            if here and (animation < 0 or context.name(animation) != "animation"):
                self._some_are_lost = True
            clip = int(context.parent[reference.element])
            self._by_animation.setdefault(animation, set()).add(clip)

    def of(self, element: int) -> tuple[set[int], set[int]]:
        """When a channel moves, and when others move that move at the same time."""
        found: set[int] = set()
        around = int(self._context.parent[element])
        while element >= 0 and self._by_animation:
            found |= self._by_animation.get(element, set())
            element = int(self._context.parent[element])
        if not found and self._some_are_lost:
            # It may be that of a clip that leads nowhere: only with its own is it surely played.
            return {self._SOME - 1 - around}, {self._SOME - 1 - around}
        if not found:
            return {self._ALWAYS}, {self._ALWAYS, self._SOME}
        return found | {self._SOME}, found | {self._ALWAYS}


def _held(context: Context, source: int) -> int:
    """How many values a source has; 0 where that is not known."""
    table = sources_of(context)
    row = int(table.rows_of(np.array([source]))[0])
    count = None if row < 0 else table.count(row)
    return int(table.steps[row]) * count if count else 0


def _number(name: str, member: str) -> str:
    """A member by its number, where it has one."""
    order = {"rotate": ("X", "Y", "Z", "ANGLE"), "color": tuple("RGBA")}.get(name, tuple("XYZ"))
    return f"({order.index(member[1:])})" if member[1:] in order else member


def _has(name: str, members: frozenset[str], width: int, member: str) -> bool:
    if member[0] == ".":
        return member[1:] in members
    numbers = [int(number) for number in _INDEX.findall(member)]
    if name == "matrix" and len(numbers) == 2:
        return max(numbers) < 4
    return len(numbers) == 1 and (not width or numbers[0] < width)


def addressed(context: Context, text: str) -> tuple[int, str] | str:
    """The element that a target means, and the member of it; or why there is none."""
    head, *sids = text.split("/")
    if not sids:
        match = _SPLIT.match(head)
        target = context.target(head)
        if target >= 0:
            return target, ""
        if match is not None and context.target(match[1]) >= 0:
            return context.target(match[1]), match[2]
        return f"There is no element of the id {head!r}."
    target = context.target(head)
    if target < 0:
        return f"There is no element of the id {head!r}."
    for place, sid in enumerate(sids):
        match = _SPLIT.match(sid) if place == len(sids) - 1 else None
        spellings = [(sid, ""), (match[1], match[2])] if match is not None else [(sid, "")]
        inner, member = _inner(context, target, spellings)
        sid = spellings[-1][0]
        if inner is None:
            return f"{context.label(target)} holds no sid {sid!r}."
        target = inner
    return target, member


def _inner(
    context: Context, scope: int, spellings: list[tuple[str, str]]
) -> tuple[int | None, str]:
    """The element of a sid, and the member; what is in techniques (of effects, or with values of
    exporters' own) counts where nothing else has that sid.
    """
    for sid, member in spellings:
        found = context.resource.sids.within(scope, sid)
        if found is not None:
            return found, member
    for sid, member in spellings:
        elements = context.shared(_of_techniques).get(sid, [])
        place = bisect_right(elements, scope)  # the first behind it is in it, or none is
        if place < len(elements) and _is_in(context, elements[place], scope):
            return elements[place], member
    return None, ""


def _is_in(context: Context, element: int, scope: int) -> bool:
    """Whether an element that comes after another one stands in it."""
    while element > scope:
        element = int(context.parent[element])
    return element == scope


def _of_techniques(context: Context) -> dict[str, list[int]]:
    """All elements by their sids, those in techniques too."""
    every = context.columns.index.attributed
    numbers, texts = context.columns.factorized(context.at(Rows, every), "sid")
    found: dict[str, list[int]] = {}
    for row in np.flatnonzero(numbers >= 0).tolist():
        found.setdefault(texts[numbers[row]], []).append(int(every[row]))
    return found


def _width(context: Context, element: int, sampler: int, what: str, wanted: int) -> Iterator[Hit]:
    inputs, table = inputs_of(context), sources_of(context)
    source = inputs.source(sampler, "OUTPUT")
    if source < 0 or table.accessors[source] < 0:
        return
    array = int(table.arrays[source])
    if array < 0 or context.name(array) != "float_array":
        return
    stride = int(table.steps[source])
    if stride != wanted:
        message = f"The keys have {stride} values, but {what} has {wanted}."
        yield Hit(
            animation_rules.OUTPUT_WIDTH,
            element,
            message,
            (int(table.accessors[source]), sampler),
            "target",
        )


class ClipRows(Rows):
    """Clips of animations."""

    __slots__ = ()
    start: Column[Masked[Any]] = Column("start", "attribute", "float", optional=True)
    end: Column[Masked[Any]] = Column("end", "attribute", "float", optional=True)


def clips(context: Context) -> Iterator[Hit]:
    """Clips that end before they start."""
    rows = context.rows(ClipRows, "animation_clip")
    if not len(rows):
        return
    assert rows.ordinals is not None
    start = np.where(rows.start.present, rows.start.values, 0.0)
    wrong = rows.end.present & ~(rows.end.values >= start)
    for row in np.flatnonzero(wrong).tolist():
        message = f"The clip starts at {start[row]:g} and ends at {rows.end.values[row]:g}."
        yield Hit(animation_rules.CLIP_RANGE, int(rows.ordinals[row]), message, (), "end")


CHECKS = (samplers, splines, channels, clips)
