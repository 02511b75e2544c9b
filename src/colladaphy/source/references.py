"""Other files that a document refers to: where they may be, and how they are read."""

from __future__ import annotations

import stat
from dataclasses import dataclass, field
from pathlib import Path
from posixpath import dirname, join, normpath
from typing import BinaryIO
from urllib.parse import unquote, urlsplit

from colladaphy.errors import InputError
from colladaphy.findings import Finding
from colladaphy.source import rules
from colladaphy.source.archive import Archive
from colladaphy.source.limits import Limits
from colladaphy.source.names import shown_name

__all__ = ["ArchiveOrigin", "FolderOrigin", "Origin", "Resource", "Spent", "read_limited"]


@dataclass(frozen=True, slots=True)
class Resource:
    """A file that a document refers to: its bytes, and the name to show for it."""

    data: bytes
    file: str
    origin: Origin


@dataclass(slots=True)
class Spent:
    """Bytes read so far for one document and all the files it refers to."""

    limits: Limits
    bytes: int = 0

    def add(self, size: int, file: str) -> None:
        """Count `size` more bytes; InputError beyond the total."""
        self.bytes += size
        if self.bytes > self.limits.total:
            message = f"The document's files have more than {self.limits.total} bytes in all."
            raise InputError(rules.TOO_LARGE.at(message=message, file=file))


@dataclass(frozen=True, slots=True)
class FolderOrigin:
    """A document in a folder: files in that folder and below it can be referred to.

    `root` is the folder of the first document, and stays the border for the documents that it
    refers to; `folder` is the folder of the document at hand, which names are relative to.
    """

    root: Path
    folder: Path
    spent: Spent = field(compare=False)

    def open(self, url: str) -> Resource:
        """Read the file that `url` names."""
        name = relative_name(url)
        path = self.folder / name
        try:
            real = path.resolve(strict=True)
            inside = real.is_relative_to(self.root.resolve(strict=True))
            regular = stat.S_ISREG(real.stat().st_mode)
        except (OSError, RuntimeError, ValueError):
            raise InputError(_missing(url)) from None
        if not inside:
            raise InputError(_refused(url, "it leads out of the document's folder"))
        if not regular:
            raise InputError(_refused(url, "it is not a plain file"))
        limits = self.spent.limits
        shown = shown_name(path)
        try:
            with real.open("rb") as stream:
                data = read_limited(stream, limits.bytes, shown)
        except OSError as error:
            if isinstance(error, InputError):
                raise
            reason = error.strerror or str(error)
            raise InputError(rules.UNREADABLE.at(message=f"{reason}.", file=shown)) from None
        self.spent.add(len(data), shown)
        return Resource(data, shown, FolderOrigin(self.root, real.parent, self.spent))


@dataclass(frozen=True, slots=True)
class ArchiveOrigin:
    """A document in an archive: all entries of the archive can be referred to."""

    archive: Archive
    name: str
    spent: Spent = field(compare=False)

    def open(self, url: str) -> Resource:
        """Unpack the entry that `url` names."""
        name = normpath(join(dirname(self.name), relative_name(url)))
        if name.startswith("../"):
            raise InputError(_refused(url, "it leads out of the archive"))
        if name not in self.archive.names:
            raise InputError(_missing(url))
        data = self.archive.read(name)
        shown = f"{self.archive.file or 'archive'}!{name}"
        self.spent.add(len(data), shown)
        return Resource(data, shown, ArchiveOrigin(self.archive, name, self.spent))


Origin = FolderOrigin | ArchiveOrigin


def relative_name(url: str) -> str:
    """The plain relative file name of a URL; InputError for anything that is more than that."""
    text = url.strip().replace("\\", "/")
    try:
        parts = urlsplit(text)
    except ValueError:
        raise InputError(_refused(url, "it is not a URL")) from None
    if parts.scheme:
        raise InputError(_refused(url, f"{parts.scheme}: is never followed"))
    name = unquote(parts.path).replace("\\", "/")
    if parts.netloc or name.startswith("/") or ":" in name.split("/")[0]:
        raise InputError(_refused(url, "only relative names are followed"))
    if "\0" in name or not name:
        raise InputError(_refused(url, "it does not name a file"))
    return name


def read_limited(stream: BinaryIO, limit: int, file: str | None) -> bytes:
    """All bytes of a binary stream, but InputError beyond `limit`."""
    parts: list[bytes] = []
    size = 0
    while True:
        part = stream.read(min(limit + 1 - size, 1 << 24))
        if isinstance(part, str):
            raise InputError(rules.NOT_BINARY.at(file=file))
        if part is not None and not isinstance(part, bytes | bytearray | memoryview):
            message = f"The file object gives {part!r:.40} where bytes are needed."
            raise InputError(rules.UNREADABLE.at(message=message, file=file))
        if not part:
            return parts[0] if len(parts) == 1 else b"".join(parts)
        size += len(part)
        if size > limit:
            message = f"The input has more than {limit} bytes, which is the limit."
            raise InputError(rules.TOO_LARGE.at(message=message, file=file))
        parts.append(bytes(part))


def _refused(url: str, why: str) -> Finding:
    return rules.REFERENCE_REFUSED.at(message=f"The reference {url!r} is not followed: {why}.")


def _missing(url: str) -> Finding:
    return rules.REFERENCE_MISSING.at(message=f"The file of the reference {url!r} does not exist.")
