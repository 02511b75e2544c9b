"""``python -m tests.meaning.golden`` writes the golden report anew, to be looked through."""

from __future__ import annotations

import tempfile
from pathlib import Path

from tests.meaning.test_cases import GOLDEN, golden

if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        GOLDEN.write_text(golden(Path(folder)), "utf-8")
