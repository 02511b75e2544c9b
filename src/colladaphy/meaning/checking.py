"""Running the rules of all subjects."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from importlib import import_module
from typing import Any, Final

import numpy as np

from colladaphy.findings import Finding, Rule
from colladaphy.links.names import c
from colladaphy.links.resource import Resource
from colladaphy.meaning.context import Context
from colladaphy.meaning.hits import Hit, findings_of
from colladaphy.source import extensions

__all__ = ["SUBJECTS", "check", "fault_of_rules", "hits_of"]

_PRIMITIVES = ("mesh", "convex_mesh")
_BODIES = ("rigid_body",)
SUBJECTS: Final[dict[str, tuple[str, ...]]] = {
    "asset": (),
    "links": (),
    "models": ("instance_physics_model", "physics_model"),
    "circles": (),
    "addresses": (
        "bind",
        "kinematics_model",
        "articulated_system",
        "instance_kinematics_scene",
        "formula",
    ),
    "images": ("init_from",),
    "picture_sizes": ("create_2d", "create_3d", "create_cube"),
    "layers": ("layer",),
    "effects": ("effect",),
    "techniques": ("effect",),
    "materials": ("bind_material", "texture"),
    "arrays": ("source",),
    "reference_arrays": ("IDREF_array", "SIDREF_array"),
    "inputs": ("input", *_PRIMITIVES, "sampler", "skin", "morph"),
    "semantics": ("input",),
    "primitives": _PRIMITIVES,
    "values": ("float_array",),
    "surfaces": _PRIMITIVES,
    "blank_hulls": ("convex_mesh",),
    "scene": ("node", "camera", "light", "skin", "rigid_body", "link", "rigid_constraint"),
    "controllers": ("controller",),
    "animation": ("animation", "animation_clip", "control_vertices"),
    "bodies": _BODIES,
    "shapes": _BODIES,
    "surface_materials": ("physics_material",),
    "motions": ("instance_rigid_body",),
    "nodes": ("instance_rigid_body",),
    "attachments": ("rigid_constraint",),
    "joints": ("rigid_constraint",),
    "frames": ("instance_rigid_constraint",),
    "worlds": ("physics_scene",),
    "driven": ("channel",),
    "loops": ("attachment_start", "attachment_end"),
    "robots": ("axis_info", "attachment_full", "bind_joint_axis"),
    "kinematics": ("revolute", "prismatic", "axis_info"),
    "profile": ("technique",),
    "profile_kinds": ("technique",),
    "staleness": ("technique",),
    "stale_motions": ("technique",),
    "stale_parts": ("technique",),
}
"""The modules of rules, each with the elements that it is about (none: it is always run).

The functions that report the rules of a module are its `CHECKS`.
"""


def check(resource: Resource, exists: Callable[[str], str | None] | None = None) -> list[Finding]:
    """Everything that is wrong with the meaning of a document, in its order.

    `exists` says why a file that the document refers to cannot be had, or None if it can.
    """
    return findings_of(resource.columns, resource.file, hits_of(resource, exists))


def hits_of(
    resource: Resource, exists: Callable[[str], str | None] | None = None
) -> list[Hit | Finding]:
    """The same, with the numbers of elements in place of their places in the file."""
    context = Context(resource, exists)
    hits: list[Hit | Finding] = []
    with np.errstate(all="ignore"):
        for subject, names in SUBJECTS.items():
            # What there is nothing of need not be imported.
            if names and not any(context.columns.codes_of(c(name)) for name in names):
                continue
            module = import_module(f"colladaphy.meaning.{subject}")
            for function in module.CHECKS:
                hits.extend(function(context))
        hits.extend(_offered(context))
    if len(hits) > 1:
        from colladaphy.meaning.consequences import without_consequences

        return without_consequences(context, hits)
    return hits


def _offered(context: Context) -> Iterator[Hit | Finding]:
    """What the rules of other packages find."""
    modules, findings = extensions.loaded(extensions.RULES, fault_of_rules)
    yield from findings
    for name, module in modules:
        try:
            found = [hit for function in module.CHECKS for hit in function(context)]
        except Exception as error:  # other people's code can fail in any way
            why = f"{type(error).__name__}: {error}"
            yield extensions.broken(extensions.RULES, name, why)
            continue
        yield from found


def fault_of_rules(offered: Any) -> str | None:
    """Why an object offers no rules; they are as those of a module of `SUBJECTS`."""
    if not all(isinstance(rule, Rule) for rule in offered.RULES):
        return "its RULES are no rules"
    return None if all(map(callable, offered.CHECKS)) else "its CHECKS are no functions"
