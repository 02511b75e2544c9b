"""What must hold of files as other programs write them."""

from __future__ import annotations

from random import Random

from hypothesis import strategies as st
from tests.producers.checking import accept
from tests.producers.damage import damaged
from tests.producers.test_damage import FILES
from tests.producers.world_oracle import assert_means

from colladaphy.errors import ColladaError
from colladaphy.testing import ForeignDocument, foreign_documents
from tools.fuzz.registry import note, of

__all__: list[str] = []


@of(foreign_documents, weight=2)
def producer_meant(document: ForeignDocument) -> None:
    """Files of other programs come in with the meaning that their author gave them."""
    assert_means(accept(note(document.data)), document.meant)


def _damaged() -> st.SearchStrategy[bytes]:
    seeds = st.integers(0, 2**32)
    files = st.sampled_from(sorted(FILES.items()))
    return st.builds(lambda file, seed: damaged(file[1], Random(seed)), files, seeds)


@of(_damaged, weight=2)
def producer_damaged(document: bytes) -> None:
    """Damaged files come in, valid and with one meaning, or are refused."""
    try:
        accept(note(document), errors=True, outside=False)
    except ColladaError as error:
        # A unit of length that has no length is beyond repair.
        assert [finding.code for finding in error.findings] == ["physics-dimension"]
