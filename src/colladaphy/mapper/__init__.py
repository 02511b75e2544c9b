"""The mapper: documents become Worlds, and Worlds documents (thesis 5.3, 5.4)."""

from colladaphy.mapper.loading.deciding import Prefer
from colladaphy.mapper.loading.load import Chosen, Loaded, load, trace
from colladaphy.mapper.loading.sofar import Sofar, key_of
from colladaphy.mapper.options import WriteOptions
from colladaphy.mapper.storing import store

__all__ = [
    "Chosen",
    "Loaded",
    "Prefer",
    "Sofar",
    "WriteOptions",
    "key_of",
    "load",
    "store",
    "trace",
]
