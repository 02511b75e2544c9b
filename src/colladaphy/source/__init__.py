"""Opening, archives, limits and atomic saving: the only room that touches files.

`parse` turns a path, bytes or a file object into a tree that is well-formed and has COLLADA as its
root; `save` puts bytes in a file's place. Nothing is ever fetched, expanded, or extracted to disk.
"""

from colladaphy.source.archive import Archive, pack
from colladaphy.source.limits import Limits
from colladaphy.source.packing import packed_for
from colladaphy.source.reading import Loaded, Parsed, Source, load, parse, parse_loaded
from colladaphy.source.references import Resource
from colladaphy.source.saving import Target, save
from colladaphy.source.xml import COLLADA_1_4, COLLADA_1_5

__all__ = [
    "COLLADA_1_4",
    "COLLADA_1_5",
    "Archive",
    "Limits",
    "Loaded",
    "Parsed",
    "Resource",
    "Source",
    "Target",
    "load",
    "pack",
    "packed_for",
    "parse",
    "parse_loaded",
    "save",
]
