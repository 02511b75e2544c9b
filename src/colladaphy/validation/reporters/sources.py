"""The lines of documents that findings are shown in."""

from __future__ import annotations

import io
import re
from collections.abc import Iterable, Mapping
from itertools import islice
from pathlib import Path

from colladaphy.errors import ColladaError
from colladaphy.source.limits import Limits

__all__ = ["Sources"]

_DECLARED = re.compile(
    rb"""\A(?:\xef\xbb\xbf)?<\?xml[^>]*?\bencoding\s*=\s*["']([A-Za-z0-9._-]+)"""
)
_BOMS = ((b"\xef\xbb\xbf", "utf-8"), (b"\xff\xfe", "utf-16"), (b"\xfe\xff", "utf-16"))


class Sources:
    """Reads documents once more, for those of their lines that are to be shown.

    `given` are the bytes of those that are no files: of standard input.
    """

    def __init__(
        self, given: Mapping[str, bytes] | None = None, limits: Limits | None = None
    ) -> None:
        self._given = given or {}
        self._limits = limits or Limits()

    def lines(self, file: str, numbers: Iterable[int]) -> dict[int, str]:
        """Some lines of a document, counted from 1; without those that it does not have."""
        wanted = sorted({number for number in numbers if number > 0})
        if not wanted:
            return {}
        try:
            data = self._read(file)
        except (ColladaError, OSError, KeyError):  # it was there a moment ago
            return {}
        stream: Iterable[bytes | str] = io.BytesIO(data)
        encoding = _encoding(data)
        if encoding != "utf-8":
            stream = io.StringIO(data.decode(encoding, "replace"), newline="\n")
        found = {}
        at = 0
        walk = iter(stream)
        for number in wanted:
            line = next(islice(walk, number - 1 - at, None), None)
            if line is None:
                break
            at = number
            text = line if isinstance(line, str) else line.decode("utf-8", "replace")
            found[number] = text.rstrip("\r\n").removeprefix("\ufeff")
        return found

    def _read(self, file: str) -> bytes:
        from colladaphy.source.archive import MAGIC, Archive
        from colladaphy.validation.reporters.places import split_member

        data = self._given.get(file)
        outer, member = file, None
        if data is None:
            outer, member = split_member(file)
            data = self._given.get(outer)
        if data is None:
            data = Path(outer).read_bytes()
        if data.startswith(MAGIC):
            archive = Archive(data, outer, self._limits)
            return archive.read(member or archive.root())
        return data


def _encoding(data: bytes) -> str:
    for bom, name in _BOMS:
        if data.startswith(bom):
            return name
    declared = _DECLARED.match(data)
    name = declared[1].decode().lower() if declared else "utf-8"
    try:
        b"".decode(name)
    except LookupError:
        return "latin-1"
    return "utf-8" if name in ("utf8", "us-ascii", "ascii") else name
