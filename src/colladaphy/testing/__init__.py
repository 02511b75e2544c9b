"""Worlds and documents for property-based tests of whatever reads or writes them.

    from hypothesis import given
    from colladaphy.testing import documents, mutants, worlds

    @given(worlds())                         # anything that a World can hold; see its parameters
    def test_writer(world: World) -> None: ...

    @given(physics_documents())              # valid, and there are bodies in it
    def test_importer(document: bytes) -> None: ...

    @given(documents())                      # schema-valid, any area of the schema
    def test_reader(document: bytes) -> None: ...

    @given(documents(areas=["physics"]))     # only what physics and what it builds on declare
    def test_physics_reader(document: bytes) -> None: ...

    @given(mutants())                        # a few changes away from valid, mostly invalid
    def test_reader_survives(document: bytes) -> None: ...

`covering_documents()` is a fixed series of small valid documents that together hold every element
declaration and every attribute of the schema; `Coverage` records which of them documents hold.

Needs hypothesis: ``pip install colladaphy[testing]``.
"""

try:
    import hypothesis as _hypothesis
except ImportError as error:  # say what to install, not only what is missing
    raise ImportError(
        "colladaphy.testing needs hypothesis: pip install 'colladaphy[testing]'"
    ) from error

from colladaphy.testing.broken import BROKEN_RULES, BrokenDocument, broken_documents
from colladaphy.testing.changes import EDITS, REWRITES, edits, equivalents
from colladaphy.testing.coverage import Component, Coverage
from colladaphy.testing.covering import covering_documents
from colladaphy.testing.documents import AREAS, documents
from colladaphy.testing.files import LinkedFiles, linked_files
from colladaphy.testing.foreign_documents import (
    FOREIGN_PRODUCERS,
    ForeignDocument,
    foreign_documents,
)
from colladaphy.testing.hostile import HOSTILE_KINDS, hostile_inputs
from colladaphy.testing.importers import CHECKS, check_importer
from colladaphy.testing.kit.report import ImporterReport
from colladaphy.testing.making.crowds import crowd
from colladaphy.testing.mutations import MUTATIONS, mutants
from colladaphy.testing.physics import physics_documents
from colladaphy.testing.worlds import JOINTS, SHAPES, worlds

del _hypothesis

__all__ = [
    "AREAS",
    "BROKEN_RULES",
    "CHECKS",
    "EDITS",
    "FOREIGN_PRODUCERS",
    "HOSTILE_KINDS",
    "JOINTS",
    "MUTATIONS",
    "REWRITES",
    "SHAPES",
    "BrokenDocument",
    "Component",
    "Coverage",
    "ForeignDocument",
    "ImporterReport",
    "LinkedFiles",
    "broken_documents",
    "check_importer",
    "covering_documents",
    "crowd",
    "documents",
    "edits",
    "equivalents",
    "foreign_documents",
    "hostile_inputs",
    "linked_files",
    "mutants",
    "physics_documents",
    "worlds",
]
