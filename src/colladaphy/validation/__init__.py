"""Checking documents: the stages, the catalogue of rules, the reporters.

The package is named for the noun so that ``colladaphy.validate`` can be the function: a
subpackage of that name would take its place as soon as something imports it. `validate` is
imported when it is first used, so that the catalogue and the reporters need no numpy.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from colladaphy.validation.catalogue import all_rules, find_rule
from colladaphy.validation.options import Options

if TYPE_CHECKING:
    from colladaphy.validation.stages import validate as validate

__all__ = ["Options", "all_rules", "find_rule", "validate"]


def __getattr__(name: str) -> Any:
    if name != "validate":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from colladaphy.validation.stages import validate

    return validate
