"""Opening, archives, limits and atomic saving: the only room that touches files.

`parse` turns a path, bytes or a file object into a tree that is well-formed and has COLLADA as its
root; `save` puts bytes in a file's place. Nothing is ever fetched, expanded, or extracted to disk.

Names are imported when they are first used: who needs the rules or the limits needs no lxml.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from colladaphy.source.archive import Archive as Archive
    from colladaphy.source.archive import pack as pack
    from colladaphy.source.limits import Limits as Limits
    from colladaphy.source.packing import packed_for as packed_for
    from colladaphy.source.reading import Loaded as Loaded
    from colladaphy.source.reading import Parsed as Parsed
    from colladaphy.source.reading import Source as Source
    from colladaphy.source.reading import load as load
    from colladaphy.source.reading import parse as parse
    from colladaphy.source.reading import parse_loaded as parse_loaded
    from colladaphy.source.references import Resource as Resource
    from colladaphy.source.saving import Target as Target
    from colladaphy.source.saving import save as save
    from colladaphy.source.xml import COLLADA_1_4 as COLLADA_1_4
    from colladaphy.source.xml import COLLADA_1_5 as COLLADA_1_5

_HOME = {
    "COLLADA_1_4": "xml",
    "COLLADA_1_5": "xml",
    "Archive": "archive",
    "Limits": "limits",
    "Loaded": "reading",
    "Parsed": "reading",
    "Resource": "references",
    "Source": "reading",
    "Target": "saving",
    "load": "reading",
    "pack": "archive",
    "packed_for": "packing",
    "parse": "reading",
    "parse_loaded": "reading",
    "save": "saving",
}

__all__ = [*_HOME]


def __getattr__(name: str) -> Any:
    home = _HOME.get(name)
    if home is None:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(f"{__name__}.{home}"), name)
    globals()[name] = value
    return value
