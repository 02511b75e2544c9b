"""The mapper: documents become Worlds, and Worlds documents (thesis 5.3, 5.4)."""

from colladaphy.mapper.load import load
from colladaphy.mapper.options import WriteOptions
from colladaphy.mapper.store import store

__all__ = ["WriteOptions", "load", "store"]
