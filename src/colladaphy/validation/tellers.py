"""Who reports a rule: the uses of the library, which the commands stand on."""

from __future__ import annotations

from functools import cache
from runpy import run_path

from colladaphy.validation.catalogue import rule_modules

__all__ = ["TELLERS", "tellers"]

#: The uses, with what they are in Python and on the command line.
TELLERS = {
    "validate": "colladaphy.validate; the command validate",
    "read": "colladaphy.read and Document.load; every command that opens a document",
    "repair": "colladaphy.read with repair; the commands convert, repair, info and simulate",
    "write": "colladaphy.write, Document.write, add_scene and update; every command that writes",
    "export": "the command convert with --for",
    "simulate": "colladaphy.Simulation; the command simulate",
    "World": "the calls of colladaphy.World and its bodies",
}

_ROOMS = {
    "conform": ("repair",),
    "document": ("write",),
    "engines": ("simulate",),
    "gate": ("validate", "read", "repair", "write"),
    "links": ("validate", "read"),
    "mapper": ("read",),
    "meaning": ("validate", "read", "write"),
    "source": ("validate", "read", "repair"),
    "validation": ("validate",),
    "world": ("read", "World"),
}
# Where a part of a room differs from the rest of it.
_BEGINNINGS = {
    "config-extension-": ("validate", "repair"),
    "downgrade-": ("export",),
    "io-companion-": ("write",),
    "io-output-": ("write",),
    "repair-": ("repair",),
    "store-": ("write",),
}


def tellers(code: str) -> tuple[str, ...]:
    """The uses of `TELLERS` that can report a code; those of other packages are of validate."""
    for beginning, uses in _BEGINNINGS.items():
        if code.startswith(beginning):
            return uses
    return _ROOMS.get(_rooms().get(code, ""), ("validate",))


@cache
def _rooms() -> dict[str, str]:
    """The room of each of our rules."""
    return {
        rule.code: module.split(".")[1]
        for module, path in rule_modules().items()
        for rule in run_path(str(path))["RULES"]
    }
