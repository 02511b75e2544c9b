"""Running the rules of all subjects."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module

import numpy as np

from colladaphy.findings import Finding
from colladaphy.links.resource import Resource
from colladaphy.meaning.context import Context
from colladaphy.meaning.hits import Hit, findings_of

__all__ = ["SUBJECTS", "check"]

SUBJECTS = (
    "asset",
    "links",
    "models",
    "circles",
    "addresses",
    "images",
    "materials",
    "arrays",
    "inputs",
    "primitives",
    "values",
    "surfaces",
    "scene",
    "controllers",
    "animation",
    "bodies",
    "shapes",
    "surface_materials",
    "motions",
    "nodes",
    "joints",
    "frames",
    "worlds",
    "kinematics",
    "profile",
    "staleness",
)
"""The modules of rules; each has the functions that report them in `CHECKS`."""


def check(resource: Resource, exists: Callable[[str], str | None] | None = None) -> list[Finding]:
    """Everything that is wrong with the meaning of a document, in its order.

    `exists` says why a file that the document refers to cannot be had, or None if it can.
    """
    context = Context(resource, exists)
    hits: list[Hit | Finding] = []
    with np.errstate(all="ignore"):
        for subject in SUBJECTS:
            module = import_module(f"colladaphy.meaning.{subject}")
            for function in module.CHECKS:
                hits.extend(function(context))
    return findings_of(resource, hits)
