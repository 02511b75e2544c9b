"""Contacts as events: two bodies begin to touch, or cease to."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from colladaphy.engines.protocol import Contact

__all__ = ["ContactEvent", "ContactEvents"]


@dataclass(frozen=True, slots=True)
class ContactEvent:
    """Two top-level bodies that touch since a step, or no longer do."""

    step_count: int
    """The World's number of steps after that step."""
    first: int
    """System id of the body with the smaller system id."""
    second: int
    """System id of the other one."""
    began: bool
    """False if they part."""
    contacts: tuple[Contact, ...]
    """The points in which they touch; none if they part."""


class ContactEvents:
    """Tells a callback of every pair that begins or ceases to touch."""

    def __init__(self, callback: Callable[[ContactEvent], object]) -> None:
        self._callback = callback
        self._touching: set[tuple[int, int]] = set()

    def notice(self, contacts: Iterable[Contact], step_count: int) -> None:
        """The contacts of the step that has just been done."""
        found: dict[tuple[int, int], list[Contact]] = {}
        for contact in contacts:
            found.setdefault((contact.first, contact.second), []).append(contact)
        for pair in sorted(self._touching - found.keys()):
            self._callback(ContactEvent(step_count, *pair, False, ()))
        for pair in sorted(found.keys() - self._touching):
            self._callback(ContactEvent(step_count, *pair, True, tuple(found[pair])))
        self._touching = set(found)
