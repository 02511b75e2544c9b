"""How much an input may ask for before it is refused."""

from __future__ import annotations

from dataclasses import dataclass, fields

__all__ = ["LIBXML2_DEPTH", "LIBXML2_DEPTH_MAX", "LIBXML2_TEXT", "Limits"]

#: libxml2's own limits; beyond them it must be told that a huge tree is wanted.
LIBXML2_DEPTH = 256
LIBXML2_DEPTH_MAX = 2048
LIBXML2_TEXT = 10_000_000

_LARGEST_BUFFER = 2**31 - 1


@dataclass(frozen=True, slots=True, kw_only=True)
class Limits:
    """Limits of one reading operation; every one can be set, none can be switched off.

    Defaults let a million rigid bodies through, and stop what only an attack needs. A `text` or a
    `depth` above libxml2's own limit is a decision of the caller: only then is the parser allowed
    to build a huge tree.
    """

    #: Bytes of one document, as XML (of an archive: after unpacking).
    bytes: int = _LARGEST_BUFFER
    #: Levels of nested elements, at most 2048.
    depth: int = LIBXML2_DEPTH
    #: Characters of one text, comment or attribute value.
    text: int = LIBXML2_TEXT
    #: Elements, comments and processing instructions of one document.
    elements: int = 60_000_000
    #: Entries of one archive.
    archive_entries: int = 10_000
    #: Unpacked size of an archive's entry to its packed size.
    archive_ratio: int = 300
    #: Bytes of everything that is unpacked or read for one document, other files included.
    total: int = 2 * _LARGEST_BUFFER

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if isinstance(value, bool) or not isinstance(value, int) or value < 1:
                raise ValueError(f"limit {field.name} must be a positive integer, not {value!r}")
        if self.depth > LIBXML2_DEPTH_MAX:
            raise ValueError(f"limit depth can be {LIBXML2_DEPTH_MAX} at most, not {self.depth}")
        if self.bytes > _LARGEST_BUFFER:
            raise ValueError(f"limit bytes can be {_LARGEST_BUFFER} at most, not {self.bytes}")
