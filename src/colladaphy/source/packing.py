"""Whether an archive is to be written, and what of an older one is kept in it."""

from __future__ import annotations

import os
from collections.abc import Mapping

from colladaphy.source.archive import MANIFEST, Archive, pack
from colladaphy.source.saving import Target

__all__ = ["packed_for"]


def packed_for(
    target: Target,
    document: bytes,
    archive: Archive | None = None,
    member: str | None = None,
    others: Mapping[str, bytes] | None = None,
) -> bytes:
    """What to save at `target`: the document's bytes, or a `.zae` of them.

    An archive is written where the target's name ends in .zae, and where the target is the archive
    that the document came from, whatever its name. All other files of that archive are kept, and
    the document keeps its own name `member` there. `others` by name go into an archive that is
    new.
    """
    name = _name(target)
    if not name.lower().endswith(".zae") and not _is_at(archive, name):
        return document
    if archive is None or member is None:
        name = "scene.dae"
        while name in (others or {}):
            name = f"the-{name}"
        return pack(document, name=name, others=others)
    kept = [other for other in archive.names if other not in (member, MANIFEST)]
    return pack(document, name=member, others=archive.read_all(kept))


def _name(target: Target) -> str:
    """The file name of a target; of a file object, the one it was opened with, if any."""
    if isinstance(target, str | os.PathLike):
        return os.fspath(target)
    name = getattr(target, "name", "")
    return name if isinstance(name, str) else ""


def _is_at(archive: Archive | None, name: str) -> bool:
    file = None if archive is None else archive.file
    return bool(file and name) and os.path.realpath(str(file)) == os.path.realpath(name)
