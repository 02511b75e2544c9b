"""What follows from another finding, and goes with it: one fault is told once, at its cause.

A rule looks at its own subject alone. Where a fault breaks what several of them hold, this says
which of the findings is at the cause.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from colladaphy.findings import Finding, Rule, Severity
from colladaphy.links.names import c, p
from colladaphy.links.rules import MISSING, NOT_RIGID, WRONG_TYPE
from colladaphy.meaning import (
    animation_rules,
    geometry_rules,
    kinematics_rules,
    link_rules,
    physics_rules,
    profile_rules,
    scene_rules,
)
from colladaphy.meaning.context import Context
from colladaphy.meaning.hits import Hit

__all__ = ["FOLLOWING", "Following", "without_consequences"]

Array = NDArray[Any]


class Following(NamedTuple):
    """Findings of some rules that follow from those of others."""

    rules: tuple[Rule, ...]
    causes: tuple[Rule, ...]
    within: tuple[str, ...] = ()
    """Both are at, or in, one element of such a name; at the same element where there is none."""
    beside: bool = False
    """What counts is where an element stands that the finding names beside its own."""
    causes_beside: bool = False
    """The same of the causes, besides where they stand themselves."""
    at: tuple[str, ...] = ()
    """Only causes at elements of such names."""
    of: tuple[str, ...] = ()
    """Only what follows at elements of such names."""


_BODIES = ("rigid_body", "instance_rigid_body")
_POSES = ("position", "orientation")
_FRAMES = (physics_rules.FRAMES_APART, physics_rules.FRAMES_TURNED)
_PRIMITIVES = ("lines", "linestrips", "polygons", "polylist", "triangles", "trifans", "tristrips")
_OWNERS = (*_PRIMITIVES, "vertices", "control_vertices", "joints", "vertex_weights", "targets",
           "sampler")  # fmt: skip
_OF_ACCESSORS = (geometry_rules.ACCESSOR_STRIDE, geometry_rules.ACCESSOR_RANGE)
_OF_INPUTS = (WRONG_TYPE, geometry_rules.INPUT_VALUES, geometry_rules.INPUT_MISSING,
              geometry_rules.INPUT_TWICE, geometry_rules.INDEX_LACKING,
              geometry_rules.PRIMITIVE_COUNT)  # fmt: skip
FOLLOWING: Final = (
    # What the profile keeps is that of a value which is none itself, or is not compared with one.
    Following(
        (profile_rules.OLD_VALUE, profile_rules.NUMBER, profile_rules.VALUE),
        (*physics_rules.RULES, scene_rules.RADIANS, MISSING, WRONG_TYPE),
        beside=True,
    ),
    # A node that is another body's stands elsewhere.
    Following(
        (profile_rules.OLD_VALUE,), (physics_rules.NODE_SHARED,), ("instance_rigid_body",),
        causes_beside=True, of=_POSES,
    ),
    Following(
        (profile_rules.OLD_VALUE,), _FRAMES, ("instance_rigid_body",), causes_beside=True,
        of=_POSES,
    ),
    # Where the ends of a joint are, and how far they may move.
    Following(
        (profile_rules.OLD_VALUE,),
        (*_FRAMES, physics_rules.JOINT_SELF, physics_rules.JOINT_FIXED),
        ("rigid_constraint",),
        of=_POSES,
    ),
    Following(
        (profile_rules.OLD_VALUE,),
        (physics_rules.JOINT_LIMITS, physics_rules.JOINT_RADIANS, physics_rules.JOINT_TARGET),
        ("rigid_constraint",),
        of=("min", "max", "stiffness", "damping", "target_value", "linear_spring",
            "angular_spring"),
    ),
    Following((physics_rules.MATERIAL_FRICTIONS,), (physics_rules.MATERIAL_RANGE,)),
    Following(
        (profile_rules.OLD_VALUE,), (physics_rules.MATERIAL_FRICTIONS,), ("physics_material",),
        of=("static_friction", "dynamic_friction"),
    ),
    # Of a shape that is none it is not known how it stands, or what it weighs.
    Following(
        (profile_rules.OLD_VALUE,),
        (physics_rules.SHAPE_SIZE, MISSING, WRONG_TYPE),
        ("shape",),
        beside=True,
    ),
    Following(
        (profile_rules.OLD_VALUE,), (physics_rules.MASS_DENSITY,), ("shape",), beside=True,
        of=("mass", "density", "inertia"),
    ),
    Following((profile_rules.OLD_VALUE,), (profile_rules.VALUE,)),
    Following(
        (profile_rules.OLD_VALUE, physics_rules.MASS_SUM), (profile_rules.UNION,), ("rigid_body",),
        of=("mass", "inertia"),
    ),
    Following(
        (profile_rules.OLD_VALUE,), (physics_rules.MASS_ZERO, physics_rules.MASS_SUM),
        ("rigid_body",), of=("mass", "inertia"),
    ),
    Following(
        (profile_rules.SYSTEM_ID,), (profile_rules.TWICE, profile_rules.UNION),
        ("rigid_body", "rigid_constraint"),
    ),
    Following(
        (profile_rules.SYSTEM_ID,),
        (link_rules.DUPLICATE_SID,),
        ("rigid_body", "rigid_constraint"),
        at=("rigid_body", "rigid_constraint"),
    ),
    # One of two of a name is what nobody is called.
    Following(
        (MISSING,),
        (link_rules.DUPLICATE_SID,),
        ("physics_model",),
        at=("rigid_body", "rigid_constraint"),
        of=("attachment", "ref_attachment"),
    ),
    Following(
        (MISSING,),
        (link_rules.DUPLICATE_SID,),
        ("physics_model",),
        beside=True,
        at=("rigid_body", "rigid_constraint"),
        of=("instance_rigid_body", "instance_rigid_constraint"),
    ),
    Following(
        (link_rules.TEXTURE_SAMPLER, MISSING), (link_rules.DUPLICATE_SID,), ("effect",),
        of=("texture", "param"),
    ),
    # A joint that is not there closes no loop, and what is called so has no other end.
    Following(
        (kinematics_rules.LOOP,), (MISSING, WRONG_TYPE), ("kinematics_model",),
        at=("attachment_full", "attachment_start", "attachment_end"),
    ),
    Following(
        (NOT_RIGID,), (scene_rules.SCALE_ZERO, scene_rules.TRANSFORM_NUMBER), ("node",)
    ),
    # A transform that is there twice moves what stands in its node once more.
    Following(
        (MISSING, profile_rules.OLD_VALUE, animation_rules.CHANNEL_TWICE, *_FRAMES),
        (link_rules.DUPLICATE_SID,),
        ("node",),
        beside=True,
        at=("matrix", "translate", "rotate", "scale", "skew", "lookat"),
    ),
    Following(
        (kinematics_rules.JOINT_TWICE, kinematics_rules.AXIS_TWICE),
        (link_rules.DUPLICATE_SID,), ("link", "axis_info"), at=("link", "axis_info"),
    ),
    # With a mass, or a size, that is wrong or has changed there is nothing to compare with.
    Following(
        (physics_rules.INERTIA_SIZE,),
        (physics_rules.MASS_DENSITY, physics_rules.MASS_SUM),
        _BODIES,
    ),
    Following(
        (physics_rules.INERTIA_SIZE,), (profile_rules.OLD_VALUE,), _BODIES,
        at=("mass", "inertia", "density", "lengths", "radius", "radii", "length"),
    ),
    Following((physics_rules.MASS_SUM,), (physics_rules.MASS_DENSITY,), _BODIES),
    # Values that are read in another way than they were written.
    Following((geometry_rules.PARAM_TWICE,), (geometry_rules.ACCESSOR_STRIDE,), ("accessor",)),
    Following((geometry_rules.PARAM_TYPE,), _OF_ACCESSORS, ("accessor",)),
    Following(
        (geometry_rules.INPUT_VALUES, animation_rules.OUTPUT_WIDTH),
        (*_OF_ACCESSORS, geometry_rules.PARAM_TYPE, geometry_rules.PARAM_TWICE),
        ("accessor",),
        beside=True,
    ),
    # Inputs that are others than was meant, and what is compared with what they lead to.
    Following((WRONG_TYPE, geometry_rules.INPUT_VALUES), (geometry_rules.INPUT_TWICE,)),
    Following((animation_rules.INTERPOLATION,), (geometry_rules.INPUT_TWICE,), _OWNERS),
    Following(
        (geometry_rules.VERTEX_COUNT, animation_rules.SKIN_INDEX, animation_rules.SKIN_SUM,
         animation_rules.SKIN_WEIGHT, animation_rules.SKIN_BIND, animation_rules.KEY_COUNT,
         animation_rules.MORPH_TARGETS),
        (WRONG_TYPE, geometry_rules.INPUT_VALUES, geometry_rules.INPUT_MISSING,
         geometry_rules.INPUT_TWICE),
        _OWNERS,
    ),
    Following(
        (animation_rules.OUTPUT_WIDTH,),
        (animation_rules.KEY_COUNT, geometry_rules.INPUT_TWICE),
        ("sampler",),
        beside=True,
    ),
    Following(
        (link_rules.VERTEX_INPUT,),
        (WRONG_TYPE, geometry_rules.INPUT_VALUES, geometry_rules.INPUT_TWICE,
         geometry_rules.INDEX_LACKING, geometry_rules.PRIMITIVE_COUNT),
        _PRIMITIVES,
        beside=True,
    ),
    Following((geometry_rules.INDEX_RANGE,), _OF_INPUTS, _PRIMITIVES),
    Following((geometry_rules.FEW_CORNERS,), (geometry_rules.VCOUNT,)),
    Following((geometry_rules.INPUT_TWICE,), (geometry_rules.INPUT_MISSING,), _OWNERS),
    # A geometry with other vertices than its skins and morphs were made for.
    Following(
        (animation_rules.SKIN_COUNT, animation_rules.MORPH_TARGETS),
        (geometry_rules.INDEX_RANGE, geometry_rules.VERTEX_COUNT),
        ("geometry",),
    ),
    Following(
        (animation_rules.SKIN_COUNT, animation_rules.MORPH_TARGETS),
        (geometry_rules.INDEX_RANGE, geometry_rules.VERTEX_COUNT),
        ("geometry",),
        beside=True,
    ),
)  # fmt: skip
"""What follows from what. What is gone is no cause any more, so that something is always left."""


def without_consequences(context: Context, hits: Sequence[Hit | Finding]) -> list[Hit | Finding]:
    """What was found, but for what follows from other findings.

    Of a finding that stays for another the severity is that of the graver one.
    """
    made = list(hits)
    by_code: dict[str, list[int]] = {}
    for number, hit in enumerate(made):
        if isinstance(hit, Hit):
            by_code.setdefault(hit.rule.code, []).append(number)
    gone: set[int] = set()
    for each in FOLLOWING:
        following = _numbers(by_code, each.rules)
        causes = _numbers(by_code, each.causes) if following else []
        if causes:
            found = _let_follow(context, each, made, following, causes)
            gone |= found
            for rule in each.rules if found else ():
                left = by_code.get(rule.code, ())
                by_code[rule.code] = [number for number in left if number not in found]
    return [hit for number, hit in enumerate(made) if number not in gone] if gone else made


def _numbers(by_code: dict[str, list[int]], rules: tuple[Rule, ...]) -> list[int]:
    return [number for rule in rules for number in by_code.get(rule.code, ())]


def _let_follow(
    context: Context,
    each: Following,
    hits: list[Hit | Finding],
    following: list[int],
    causes: list[int],
) -> set[int]:
    """The numbers of the hits that go; their causes become as grave as they."""
    by_place: dict[int, int] = {}
    for number, place in _placed(context, each, hits, causes, True, each.causes_beside, each.at):
        by_place.setdefault(place, number)
    if each.of:
        elements = np.array([_hit(hits, number).element for number in following], np.int64)
        mine = _are_called(context, elements, each.of).tolist()
        following = [number for number, good in zip(following, mine, strict=True) if good]
    found: set[int] = set()
    for number, place in _placed(context, each, hits, following, not each.beside, each.beside):
        if place < 0 or place not in by_place or number in found:
            continue
        found.add(number)
        cause, hit = _hit(hits, by_place[place]), _hit(hits, number)
        graver = max(_severity(cause), _severity(hit), key=_GRAVE.index)
        if graver is not _severity(cause):
            hits[by_place[place]] = replace(cause, severity=graver)
    return found


def _hit(hits: list[Hit | Finding], number: int) -> Hit:
    hit = hits[number]
    assert isinstance(hit, Hit)
    return hit


_GRAVE: Final = (Severity.HINT, Severity.INFO, Severity.WARNING, Severity.ERROR)


def _severity(hit: Hit) -> Severity:
    return hit.severity or hit.rule.severity


def _placed(
    context: Context,
    each: Following,
    hits: list[Hit | Finding],
    numbers: list[int],
    own: bool,
    beside: bool,
    at: tuple[str, ...] = (),
) -> Iterator[tuple[int, int]]:
    """Some hits with the places of their elements, of those beside them, or of both."""
    owners: list[int] = []
    wanted: list[int] = []
    for number in numbers:
        hit = _hit(hits, number)
        mine = (*((hit.element,) if own else ()), *(hit.related if beside else ()))
        owners += [number] * len(mine)
        wanted += mine
    elements = np.array(wanted, np.int64)
    places = _places(context, elements, each.within)
    if at:
        places[~_are_called(context, elements, at)] = -1
    return zip(owners, places.tolist(), strict=True)


def _are_called(context: Context, elements: Array, names: tuple[str, ...]) -> Array:
    """Which elements (n,) have one of some names, in the common profile or in the pe profile."""
    codes = [code for name in names for tag in (c(name), p(name))
             for code in context.columns.codes_of(tag)]  # fmt: skip
    return context.columns.have_code(elements, codes)


def _places(context: Context, elements: Array, names: tuple[str, ...]) -> Array:
    """The elements (n,) themselves, or the nearest of some names at or around them; -1 for none."""
    if not names or not len(elements):
        return elements.copy()
    around = context.ancestor(elements, *names)
    return np.where(context.is_named(elements, *names), elements, around)
