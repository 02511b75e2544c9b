"""Faults of meaning: edits of documents in which nothing is wrong, one fault each."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

__all__ = ["Case", "cases"]


@dataclass(frozen=True, slots=True)
class Case:
    """An edit of a base: a fault, which breaks a rule alone, or one that nearly does."""

    name: str
    rule: str
    is_fault: bool
    base: str
    edits: tuple[tuple[str, str], ...]

    @property
    def data(self) -> bytes:
        """The document after the edits."""
        text = _base(self.base)
        for old, new in self.edits:
            text = text.replace(old, new, 1)
        return text.encode()


@cache
def cases() -> tuple[Case, ...]:
    """All of them; the tests of the rules hold each to its one finding, and these to none."""
    found = []
    for path in sorted((_folder() / "cases").glob("*.toml")):
        content = tomllib.loads(path.read_text("utf-8"))
        for kind in ("fault", "near"):
            found += [_case(entry, kind == "fault", content) for entry in content.get(kind, ())]
    return tuple(found)


def _case(entry: dict[str, Any], is_fault: bool, content: dict[str, Any]) -> Case:
    edits = tuple(
        (old.replace("\\n", "\n"), new.replace("\\n", "\n")) for old, new in entry["edits"]
    )
    return Case(entry["name"], entry["rule"], is_fault, entry.get("base", content["base"]), edits)


@cache
def _base(name: str) -> str:
    return (_folder() / "bases" / f"{name}.dae").read_text("utf-8")


@cache
def _folder() -> Path:
    """Where the documents are: beside this module when installed, else with the tests."""
    here = Path(__file__).resolve().parent
    for folder in (here / "meaning", here.parents[3] / "tests" / "meaning"):
        if (folder / "cases").is_dir():
            return folder
    raise FileNotFoundError(f"the cases of colladaphy.testing are missing beside {here}")
