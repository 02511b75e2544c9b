"""The one entrance: path, bytes or file object to a checked tree."""

from __future__ import annotations

import os
import stat
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

from lxml import etree

from colladaphy.errors import InputError, XmlError
from colladaphy.findings import Finding
from colladaphy.source import rules
from colladaphy.source.archive import MAGIC, Archive
from colladaphy.source.limits import Limits
from colladaphy.source.mending import mend_text
from colladaphy.source.names import shown_name
from colladaphy.source.references import (
    ArchiveOrigin,
    FolderOrigin,
    Origin,
    Resource,
    Spent,
    read_limited,
)
from colladaphy.source.xml import parse_bytes, root_start

__all__ = ["Loaded", "Parsed", "Source", "load", "parse", "parse_loaded"]

#: What can be read: the path of a file, its bytes, or a binary file object.
Source = str | os.PathLike[str] | os.PathLike[bytes] | bytes | bytearray | memoryview | BinaryIO

_DEFAULTS = Limits()


class _Placed:
    """A document that is in some place, from which its relative references start."""

    __slots__ = ()
    file: str | None
    limits: Limits
    origin: Origin | None
    mended: bool

    @property
    def base(self) -> Path | None:
        """The folder that relative references start from; None in archives and for bytes."""
        return self.origin.folder if isinstance(self.origin, FolderOrigin) else None

    @property
    def member(self) -> str | None:
        """The name of the archive's entry that this document is."""
        return self.origin.name if isinstance(self.origin, ArchiveOrigin) else None

    @property
    def archive(self) -> Archive | None:
        """The archive that this document comes from."""
        return self.origin.archive if isinstance(self.origin, ArchiveOrigin) else None

    def open_relative(self, url: str) -> Resource:
        """The file that a relative URL of this document names.

        Only files under the document's folder, or in its archive, are opened. InputError for
        everything else, and for what does not exist; the fragment of the URL is ignored.
        """
        if self.origin is None:
            message = f"The reference {url!r} cannot be followed: the document has no folder."
            hint = "Read the document from its path, so that its folder is known."
            raise InputError(rules.REFERENCE_REFUSED.at(message=message, file=self.file, hint=hint))
        return self.origin.open(url)

    def load_relative(self, url: str) -> Loaded:
        """The bytes of the document that a relative URL names, with the same border and limits."""
        resource = self.open_relative(url)
        return Loaded(resource.data, resource.file, resource.origin, self.limits)


@dataclass(frozen=True, slots=True)
class Loaded(_Placed):
    """The bytes of a document before they are parsed (of an archive: of its root document)."""

    data: bytes
    file: str | None
    origin: Origin | None
    limits: Limits
    mended: bool = False


@dataclass(frozen=True, slots=True)
class Parsed(_Placed):
    """A document whose XML is well-formed and whose root is COLLADA, of any version.

    `file` is its name for messages, `base` the path it was read from where there is one (for an
    archive: the archive). `member` is the entry of the archive it comes from.
    """

    tree: etree._ElementTree
    file: str | None
    limits: Limits
    origin: Origin | None = None
    mended: bool = False
    """Whether text that is not well-formed was to be mended; `findings` say what was."""
    findings: tuple[Finding, ...] = ()


def parse(source: Source, limits: Limits = _DEFAULTS, *, mend: bool = False) -> Parsed:
    """Read and parse a `.dae` or `.zae` (told apart by content, not by name).

    InputError where it cannot be read or unpacked, XmlError where it is not well-formed XML with
    COLLADA as its root. The tree can be of any version and is not validated. With `mend`, prefixes
    that nobody declared and bytes of another encoding are mended, with findings.
    """
    return parse_loaded(load(source, limits), mend=mend)


def parse_loaded(loaded: Loaded, *, mend: bool = False) -> Parsed:
    """Parse what `load` has read; see `parse`."""
    findings: list[Finding] = []
    try:
        tree = parse_bytes(loaded.data, loaded.file, loaded.limits)
    except XmlError:
        if not mend:
            raise
        data, findings = mend_text(loaded.data, root_start(loaded.data), loaded.file)
        if not findings:
            raise
        tree = parse_bytes(data, loaded.file, loaded.limits)
    return Parsed(
        tree, loaded.file, loaded.limits, loaded.origin, mended=mend, findings=tuple(findings)
    )


def load(source: Source, limits: Limits = _DEFAULTS) -> Loaded:
    """Read a document's bytes, out of its archive where it is one; InputError if that fails."""
    if not isinstance(limits, Limits):
        message = f"Limits are given as colladaphy.Limits(...), not as {limits!r:.40}."
        raise InputError(rules.UNREADABLE.at(message=message, hint="Say which limit is meant."))
    spent = Spent(limits)
    if isinstance(source, bytes | bytearray | memoryview):
        data, file, folder = bytes(source), None, None
        _check_size(len(data), limits, None)
    elif isinstance(source, str | os.PathLike):
        data, file, folder = _from_path(source, limits)
    elif hasattr(source, "read"):
        data, file, folder = _from_stream(source, limits)
    else:
        kind = type(source).__name__
        raise TypeError(f"a path, bytes or a binary file object is needed, not {kind}")
    if data.startswith(MAGIC):
        archive = Archive(data, file, limits)
        name = archive.root()
        shown = f"{file}!{name}" if file else name
        return Loaded(archive.read(name), shown, ArchiveOrigin(archive, name, spent), limits)
    spent.add(len(data), file or "")
    origin = FolderOrigin(folder, folder, spent) if folder is not None else None
    return Loaded(data, file, origin, limits)


def _from_path(
    source: str | os.PathLike[str] | os.PathLike[bytes], limits: Limits
) -> tuple[bytes, str, Path]:
    name = os.fspath(source)
    shown = shown_name(name)
    if isinstance(name, str) and name.lstrip().startswith("<"):
        message = "The file name looks like the text of a document."
        raise InputError(
            rules.MISSING.at(message=message, hint="Pass the document's text as bytes.")
        )
    try:
        path = Path(os.fsdecode(name))
        mode = path.stat()
        if stat.S_ISDIR(mode.st_mode):
            raise InputError(rules.FOLDER.at(file=shown))
        if stat.S_ISREG(mode.st_mode):
            _check_size(mode.st_size, limits, shown)
        with path.open("rb") as stream:
            return read_limited(stream, limits.bytes, shown), shown, path.parent
    except FileNotFoundError:
        raise InputError(rules.MISSING.at(file=shown)) from None
    except IsADirectoryError:
        raise InputError(rules.FOLDER.at(file=shown)) from None
    except InputError:
        raise
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        message = f"The file cannot be read: {reason}."
        raise InputError(rules.UNREADABLE.at(message=message, file=shown)) from None


def _from_stream(stream: BinaryIO, limits: Limits) -> tuple[bytes, str | None, Path | None]:
    name = getattr(stream, "name", None)
    file = name if isinstance(name, str) else None
    shown = shown_name(file) if file else None
    try:
        data = read_limited(stream, limits.bytes, shown)
    except InputError:
        raise
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        message = f"The file object cannot be read: {reason}."
        raise InputError(rules.UNREADABLE.at(message=message, file=shown)) from None
    folder = Path(file).parent if file and Path(file).is_file() else None
    return data, shown, folder


def _check_size(size: int, limits: Limits, file: str | None) -> None:
    if size > limits.bytes:
        message = f"The input has {size} bytes; the limit is {limits.bytes}."
        raise InputError(rules.TOO_LARGE.at(message=message, file=file))
