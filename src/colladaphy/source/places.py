"""Exact lines and columns of elements: libxml2 keeps no columns, and lines only up to 65535."""

from __future__ import annotations

import re
from collections.abc import Iterable

__all__ = ["locate"]

_STEP = re.compile(r"/([^/\[\]]+)(?:\[(\d+)\])?")
_Step = tuple[str, int]


class _Branch:
    """Wanted paths as a tree: by step, with the path that ends here."""

    __slots__ = ("branches", "path", "seen")

    def __init__(self) -> None:
        self.branches: dict[_Step, _Branch] = {}
        self.path: str | None = None
        self.seen: dict[str, int] = {}


def locate(data: bytes, paths: Iterable[str]) -> dict[str, tuple[int, int]]:
    """Line and column of the start tags of elements, by their paths as findings give them.

    `data` is a document that was parsed without complaint. One more pass over it is needed, so
    this is for documents with findings. Empty where its encoding is a rare one.
    """
    from xml.parsers import expat

    root = _Branch()
    for path in paths:
        branch = root
        for name, number in _STEP.findall(path):
            branch = branch.branches.setdefault((name, int(number or 1)), _Branch())
        branch.path = path
    found: dict[str, tuple[int, int]] = {}
    stack: list[_Branch | None] = [root]
    parser = expat.ParserCreate()

    def start(tag: str, _: object) -> None:
        parent = stack[-1]
        branch = None
        if parent is not None and parent.branches:
            name = tag.rpartition(":")[2]
            number = parent.seen[name] = parent.seen.get(name, 0) + 1
            branch = parent.branches.get((name, number))
            if branch is not None and branch.path is not None:
                found[branch.path] = (parser.CurrentLineNumber, parser.CurrentColumnNumber + 1)
        stack.append(branch)

    def end(_: str) -> None:
        stack.pop()

    parser.StartElementHandler = start
    parser.EndElementHandler = end
    try:
        parser.Parse(data, True)
    except (expat.ExpatError, LookupError, ValueError):
        return {}
    return found
