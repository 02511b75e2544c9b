"""What a property is, and all of them."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from typing import Any

from hypothesis import strategies as st
from hypothesis.strategies import SearchStrategy

__all__ = ["ELSEWHERE", "MODULES", "Property", "all_properties", "note", "noted", "of"]

MODULES = "worlds documents physics producers meaning anything stateful"
"""The modules of `tools.fuzz.properties`."""
ELSEWHERE = "COLLADAPHY_FUZZ_MODULES"
"""Names the modules, in all processes, that are taken in their place."""


@dataclass(frozen=True)
class Property:
    """Something that must hold of every value that a strategy draws."""

    name: str
    values: Callable[[], SearchStrategy[tuple[Any, ...]]]
    """Draws the arguments of `check`: such as `keeping` can write down."""
    check: Callable[..., None]
    """Raises where the property does not hold."""
    weight: float = 1.0
    """How much of the time it gets, beside the others."""

    @property
    def about(self) -> str:
        """What holds, in words."""
        return " ".join((self.check.__doc__ or "").split())


def of(
    *strategies: Callable[[], SearchStrategy[Any]], weight: float = 1.0
) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Make a check a property, of values of these strategies; its name is the check's."""

    def values() -> SearchStrategy[tuple[Any, ...]]:
        return st.tuples(*(strategy() for strategy in strategies))

    def mark(check: Callable[..., None]) -> Callable[..., None]:
        name = check.__name__.replace("_", "-")
        check.property = Property(name, values, check, weight)  # type: ignore[attr-defined]
        return check

    return mark


@cache
def all_properties() -> dict[str, Property]:
    """Every property, by name."""
    ours = " ".join(f"tools.fuzz.properties.{name}" for name in MODULES.split())
    found: dict[str, Property] = {}
    for name in os.environ.get(ELSEWHERE, ours).split():
        for value in vars(import_module(name)).values():
            prop = getattr(value, "property", None)
            if isinstance(prop, Property) and value.__module__ == name:
                assert prop.name not in found, prop.name
                found[prop.name] = prop
    return found


_NOTED: list[bytes] = []


def note(document: bytes) -> bytes:
    """Tell the runner of a document that a check made or was given, for its coverage."""
    _NOTED.append(document)
    return document


def noted() -> list[bytes]:
    """The documents that were noted since the last call."""
    found = _NOTED.copy()
    _NOTED.clear()
    return found
