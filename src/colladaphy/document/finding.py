"""Find dataclasses in `Document.root` by id and by paths of sids (COLLADA 1.5 §Address syntax)."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from typing import Any

from colladaphy.errors import DocumentError
from colladaphy.links import rules
from colladaphy.links.addresses import split_reference

__all__ = ["find"]


def find(root: Any, reference: str, file: str | None = None) -> Any:
    """The dataclass below `root` that ``#id``, ``id/sid`` or ``#id/sid/sid`` leads to.

    Raises DocumentError where there is none.
    """
    _, head, sids = split_reference(str(reference))
    found = _first(root, "id", head)
    for sid in sids:
        found = None if found is None else _first(found, "sid", sid)
    if found is None:
        message = f"The reference {reference!r} leads to nothing in the document."
        raise DocumentError(rules.MISSING.at(message=message, file=file))
    return found


def _first(scope: Any, name: str, value: str) -> Any:
    """The nearest dataclass in a scope with an attribute of a value, breadth before depth."""
    waiting = deque(_children(scope))
    while waiting:
        item = waiting.popleft()
        if getattr(item, name, None) == value:
            return item
        waiting.extend(_children(item))
    return None


def _children(item: Any) -> Iterator[Any]:
    for field in fields(item):
        value = getattr(item, field.name)
        for child in value if isinstance(value, list) else (value,):
            if is_dataclass(child) and not isinstance(child, type):
                yield child
