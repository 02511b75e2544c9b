"""Whether files that a document refers to are there, without reading them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from posixpath import dirname, join, normpath

from colladaphy.errors import InputError
from colladaphy.source import Loaded
from colladaphy.source.references import ArchiveOrigin, FolderOrigin, relative_name

__all__ = ["availability"]


def availability(loaded: Loaded) -> Callable[[str], str | None] | None:
    """A function that says why a file cannot be had: "missing", "outside", or None if it can.

    None for documents without a folder or an archive. Nothing outside of these is looked at.
    """
    origin = loaded.origin
    if isinstance(origin, FolderOrigin):
        return lambda url: _in_folder(origin, url)
    if isinstance(origin, ArchiveOrigin):
        return lambda url: _in_archive(origin, url)
    return None


def _in_folder(origin: FolderOrigin, url: str) -> str | None:
    try:
        name = relative_name(url)
    except InputError:
        return "outside"
    root = origin.root.resolve()
    # Told from the names first, so that nothing outside is touched.
    if not Path(normpath(origin.folder.resolve() / name)).is_relative_to(root):
        return "outside"
    try:
        real = (origin.folder / name).resolve(strict=True)
    except (OSError, RuntimeError, ValueError):
        return "missing"
    if not real.is_relative_to(root):
        return "outside"
    return None if real.is_file() else "missing"


def _in_archive(origin: ArchiveOrigin, url: str) -> str | None:
    try:
        name = normpath(join(dirname(origin.name), relative_name(url)))
    except InputError:
        return "outside"
    if name.startswith("../"):
        return "outside"
    return None if name in origin.archive.names else "missing"
