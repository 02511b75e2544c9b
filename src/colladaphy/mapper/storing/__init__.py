"""Storing: a World as columns, and these as a document that has passed the gate."""

from __future__ import annotations

import logging
from typing import TYPE_CHECKING

from colladaphy.columns.writing import document_bytes
from colladaphy.errors import SchemaError
from colladaphy.mapper.storing.checking import faults_of, has_unique_ids, is_sure
from colladaphy.mapper.storing.document import columns_of, motion_columns, world_columns
from colladaphy_schema.codec import paused_collector

if TYPE_CHECKING:
    from colladaphy.mapper.options import WriteOptions
    from colladaphy.world import World

__all__ = ["columns_of", "motion_columns", "store", "world_columns"]

_log = logging.getLogger(__name__)


def store(world: World, options: WriteOptions | None = None) -> bytes:
    """The World as a schema-valid document in UTF-8; SchemaError if it should not be one."""
    with paused_collector():
        columns = columns_of(world, options)
        unique_ids = has_unique_ids(columns)
        data = document_bytes(columns)
        sure = is_sure(columns, data)
        del columns  # the parser can use the memory
        faults = faults_of(data, unique_ids=unique_ids, sure=sure)
    if faults:
        raise SchemaError(faults)
    _log.info("stored %d bodies, %d joints in %d bytes", len(world.bodies), len(world.joints),
              len(data))  # fmt: skip
    return data
