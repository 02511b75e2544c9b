"""What other packages offer by entry points (``importlib.metadata``): engines, conventions, rules.

What cannot be loaded is told with a finding, and costs nothing but itself.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from functools import cache
from importlib.machinery import PathFinder
from typing import TYPE_CHECKING, Any, Final

from colladaphy.findings import Finding
from colladaphy.source.rules import EXTENSION_BROKEN

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

__all__ = ["CONVENTIONS", "ENGINES", "RULES", "broken", "loaded", "offered"]

ENGINES: Final = "colladaphy.engines"
CONVENTIONS: Final = "colladaphy.conventions"
RULES: Final = "colladaphy.rules"


@cache
def offered(group: str) -> tuple[EntryPoint, ...]:
    """The entry points of a group, by name; of several of one name the first."""
    if not _may_be_offered(group):
        return ()
    from importlib.metadata import entry_points

    found: dict[str, EntryPoint] = {}
    for point in entry_points(group=group):
        found.setdefault(point.name, point)
    return tuple(found[name] for name in sorted(found))


def _may_be_offered(group: str) -> bool:
    """Whether an installed package names the group; false only where it is sure.

    `importlib.metadata` tells as much, but takes longer than the check of a small document.
    """
    header = f"[{group}]".encode()
    if any(finder is not PathFinder and hasattr(finder, "find_distributions")
           for finder in sys.meta_path):  # fmt: skip
        return True
    for folder in sys.path:
        try:
            with os.scandir(folder or ".") as entries:
                names = [entry.path for entry in entries
                         if entry.name.endswith((".dist-info", ".egg-info", ".egg"))]  # fmt: skip
        except NotADirectoryError:  # an archive, which can hold packages
            return True
        except OSError:
            continue
        for name in names:
            if name.endswith(".egg"):
                return True
            try:
                with open(os.path.join(name, "entry_points.txt"), "rb") as stream:  # noqa: PTH118, PTH123
                    if header in stream.read():
                        return True
            except OSError:
                continue
    return False


def broken(group: str, name: str, why: str) -> Finding:
    """That something of a group cannot be used."""
    message = f"{name!r} ({group}) cannot be used: {why}."
    return EXTENSION_BROKEN.at(message=message)


@cache
def loaded(
    group: str, fault: Callable[[Any], str | None]
) -> tuple[tuple[tuple[str, Any], ...], tuple[Finding, ...]]:
    """All that a group offers, with names, and what is wrong with the rest of it.

    `fault` says of an object why it is not what it should be, or None.
    """
    good: list[tuple[str, Any]] = []
    findings: list[Finding] = []
    for point in offered(group):
        try:
            thing = point.load()
            why = fault(thing)
        except Exception as error:  # other people's code can fail in any way
            why = f"{type(error).__name__}: {error}"
        if why is None:
            good.append((point.name, thing))
        else:
            findings.append(broken(group, point.name, why))
    return tuple(good), tuple(findings)
