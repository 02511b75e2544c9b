"""Writing a World as a scene: into the document that it came from, or as one of its own."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from colladaphy.findings import Report
    from colladaphy.world import World

__all__ = ["SceneDocument", "save_scene"]


class SceneDocument(Protocol):
    """What a simulated World came from: a `colladaphy.Document`."""

    @property
    def related(self) -> Sequence[str]:
        """The other documents that it refers to."""

    @property
    def report(self) -> Report:
        """What was noticed about it."""

    def update(self, world: World) -> None:
        """Write the World back into it."""

    def write(self, target: Any, *, check: bool = True) -> None:
        """Write it to a file."""


def save_scene(
    world: World, target: str | os.PathLike[str], document: SceneDocument | None
) -> None:
    """Write a World to a file that can be read from anywhere.

    With a document, all else of it is kept; but one that refers to other documents could not find
    these from another folder, so that its World is written by itself.
    """
    if document is None or document.related:
        from colladaphy.document import write

        write(world, target)
        return
    document.update(world)
    document.write(target, check=False)
