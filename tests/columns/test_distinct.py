"""Elements among others, without what imports masked arrays."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from colladaphy.columns.distinct import are_among

ELEMENTS = st.lists(st.integers(-1, 60), max_size=30)


@given(ELEMENTS, ELEMENTS)
def test_elements_are_found_among_others(elements: list[int], others: list[int]) -> None:
    found = are_among(np.array(elements, np.int32), np.array(others, np.int64))
    assert found.tolist() == [element in others for element in elements]
    assert np.array_equal(are_among(np.array(elements, np.int64), set(others)), found)


def test_masked_arrays_are_not_imported_for_it() -> None:
    # Many that are far apart, of which numpy.isin would call numpy.unique.
    script = (
        "import sys, numpy as np; from colladaphy.columns.distinct import are_among;"
        "are_among(np.arange(2), np.arange(0, 4000, 100)); print('numpy.ma' in sys.modules)"
    )
    made = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
    assert made.stdout.strip() == "False", made.stderr
