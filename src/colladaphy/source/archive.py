"""`.zae` archives: read in memory entry by entry, never extracted; written reproducibly."""

from __future__ import annotations

import io
import stat
import zlib
from collections.abc import Iterable, Mapping
from posixpath import normpath
from typing import TYPE_CHECKING
from urllib.parse import unquote

from lxml import etree

from colladaphy.errors import ColladaError, InputError
from colladaphy.findings import Finding
from colladaphy.source import rules
from colladaphy.source.limits import Limits

if TYPE_CHECKING:  # few documents are archives: imported when one is
    import zipfile

__all__ = ["MAGIC", "MANIFEST", "Archive", "pack"]

MAGIC = b"PK\x03\x04"
_CENTRAL_ENTRY = b"PK\x01\x02"
MANIFEST = "manifest.xml"
_NESTED = (".zae", ".zip", ".kmz", ".usdz")
_CHUNK = 1 << 20
# A ratio says nothing about a few bytes.
_RATIO_FLOOR = 1 << 20
_EPOCH = (1980, 1, 1, 0, 0, 0)


class Archive:
    """The entries of a zip archive by their normalised names, all of them checked on opening."""

    def __init__(self, data: bytes, file: str | None, limits: Limits) -> None:
        import zipfile

        self.file = file
        self._limits = limits
        self._entries: dict[str, zipfile.ZipInfo] = {}
        self._total = 0
        # Counted first: the table of contents alone of a hostile archive can fill the memory.
        count = data.count(_CENTRAL_ENTRY)
        if count > limits.archive_entries:
            message = f"The archive has {count} entries; the limit is {limits.archive_entries}."
            raise InputError(rules.ARCHIVE_BOMB.at(message=message, file=file))
        try:
            self._zip = zipfile.ZipFile(io.BytesIO(data))
        except (zipfile.BadZipFile, ValueError, OSError, NotImplementedError) as error:
            raise InputError(self._broken(str(error))) from None
        for info in self._zip.infolist():
            self._admit(info)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the files in the archive, sorted."""
        return tuple(sorted(self._entries))

    def read(self, name: str) -> bytes:
        """Unpack one entry in memory; counted while it streams, whatever the archive declares."""
        import zipfile

        info = self._entries[name]
        limits = self._limits
        parts: list[bytes] = []
        size = 0
        try:
            with self._zip.open(info) as stream:
                while part := stream.read(_CHUNK):
                    size += len(part)
                    self._total += len(part)
                    self._count(name, size, info.compress_size)
                    parts.append(part)
        except (zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError) as error:
            raise InputError(self._broken(f"{name}: {error}")) from None
        except (OSError, RuntimeError, ValueError) as error:
            if isinstance(error, ColladaError):
                raise
            raise InputError(self._broken(f"{name}: {error}")) from None
        if size > limits.bytes:
            message = f"{name} has {size} bytes; the limit is {limits.bytes}."
            raise InputError(rules.TOO_LARGE.at(message=message, file=self.file))
        data = b"".join(parts)
        if data.startswith(MAGIC):
            raise InputError(self._unsafe(f"{name} is an archive in the archive"))
        return data

    def read_all(self, names: Iterable[str]) -> dict[str, bytes]:
        """Several entries by name, for an archive that is written again.

        The total is counted anew, so that a document can be written any number of times.
        """
        before, self._total = self._total, 0
        try:
            return {name: self.read(name) for name in names}
        finally:
            self._total = before

    def root(self) -> str:
        """The name of the entry that is the document (manifest.xml, or the only .dae)."""
        if MANIFEST in self._entries:
            url = self._dae_root(self.read(MANIFEST))
            name = normpath(unquote(url.partition("#")[0]).replace("\\", "/"))
            if name not in self._entries:
                message = f"manifest.xml names {url!r} as the document; it is not in the archive."
                raise InputError(rules.ARCHIVE_ROOT.at(message=message, file=self.file))
            return name
        documents = [name for name in self.names if name.lower().endswith(".dae")]
        if len(documents) != 1:
            what = f"{len(documents)} .dae files" if documents else "no .dae file"
            message = f"The archive has no manifest.xml and {what}."
            raise InputError(rules.ARCHIVE_ROOT.at(message=message, file=self.file))
        return documents[0]

    def _dae_root(self, data: bytes) -> str:
        parser = etree.XMLParser(resolve_entities=False, no_network=True, load_dtd=False)
        try:
            root = etree.fromstring(data, parser)
        except (etree.XMLSyntaxError, ValueError, LookupError) as error:
            message = f"manifest.xml cannot be read: {str(error).split(', line')[0]}."
            raise InputError(rules.ARCHIVE_ROOT.at(message=message, file=self.file)) from None
        if root.getroottree().docinfo.internalDTD is not None:
            raise InputError(
                rules.ARCHIVE_ROOT.at(message="manifest.xml has a DOCTYPE.", file=self.file)
            )
        for element in root.iter("{*}dae_root"):
            if element.text and element.text.strip():
                return element.text.strip()
        message = "manifest.xml has no <dae_root>."
        raise InputError(rules.ARCHIVE_ROOT.at(message=message, file=self.file))

    def _admit(self, info: zipfile.ZipInfo) -> None:
        name = info.orig_filename
        kind = stat.S_IFMT(info.external_attr >> 16)
        parts = name.replace("\\", "/").split("/")
        if "\0" in name or not name:
            raise InputError(self._unsafe(f"an entry has the name {name!r}"))
        if name.startswith(("/", "\\")) or ":" in parts[0]:
            raise InputError(self._unsafe(f"{name!r} is an absolute name"))
        if ".." in parts:
            raise InputError(self._unsafe(f"{name!r} leads out of the archive"))
        if kind not in (0, stat.S_IFREG, stat.S_IFDIR):
            raise InputError(self._unsafe(f"{name!r} is a link or a device"))
        if name.endswith(("/", "\\")):
            return
        if name.lower().endswith(_NESTED):
            raise InputError(self._unsafe(f"{name!r} is an archive in the archive"))
        if info.flag_bits & 0x1:
            raise InputError(self._broken(f"{name} is encrypted"))
        known = normpath("/".join(parts))
        if known in self._entries:
            raise InputError(self._unsafe(f"{name!r} is there twice"))
        self._entries[known] = info

    def _count(self, name: str, size: int, packed: int) -> None:
        limits = self._limits
        if size > _RATIO_FLOOR and size > limits.archive_ratio * max(packed, 1):
            message = f"{name} unpacks to more than {limits.archive_ratio} times its packed size."
        elif size > limits.bytes:
            message = f"{name} unpacks to more than {limits.bytes} bytes."
        elif self._total > limits.total:
            message = f"The archive unpacks to more than {limits.total} bytes."
        else:
            return
        raise InputError(rules.ARCHIVE_BOMB.at(message=message, file=self.file))

    def _broken(self, why: str) -> Finding:
        return rules.ARCHIVE_BROKEN.at(
            message=f"The archive cannot be unpacked: {why.rstrip('.')}.", file=self.file
        )

    def _unsafe(self, why: str) -> Finding:
        return rules.ARCHIVE_UNSAFE.at(message=f"The archive is refused: {why}.", file=self.file)


def pack(
    document: bytes, *, name: str = "scene.dae", others: Mapping[str, bytes] | None = None
) -> bytes:
    """A `.zae` of the document, its manifest, and `others` by name; equal input, equal bytes."""
    import zipfile

    manifest = (
        f'<?xml version="1.0" encoding="utf-8"?>\n<dae_root>./{_escape(name)}</dae_root>\n'
    ).encode()
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED, compresslevel=6) as archive:
        entries = {MANIFEST: manifest, name: document}
        for other, data in sorted((others or {}).items()):
            if other in entries:
                raise ValueError(f"{other!r} would be in the archive twice")
            entries[other] = data
        for entry, data in entries.items():
            info = zipfile.ZipInfo(entry, _EPOCH)
            info.compress_type = zipfile.ZIP_DEFLATED
            info.create_system = 3
            info.external_attr = (stat.S_IFREG | 0o644) << 16
            archive.writestr(info, data, compresslevel=6)
    return buffer.getvalue()


def _escape(name: str) -> str:
    from urllib.parse import quote

    return quote(name, safe="/ ").replace(" ", "%20")
