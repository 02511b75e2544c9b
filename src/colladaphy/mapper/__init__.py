"""The mapper: documents become Worlds, and Worlds documents (thesis 5.3, 5.4)."""

from colladaphy.mapper.loading.deciding import Prefer
from colladaphy.mapper.loading.load import Chosen, load
from colladaphy.mapper.options import WriteOptions
from colladaphy.mapper.storing import store

__all__ = ["Chosen", "Prefer", "WriteOptions", "load", "store"]
