"""``python -m tests.validation.golden`` writes the golden reports anew, to be looked through."""

from __future__ import annotations

import contextlib
import io
import os
import shutil
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

from colladaphy.cli import run
from colladaphy.source import pack
from colladaphy.validation.formats import FORMATS
from colladaphy.version import __version__

DOCUMENTS = Path(__file__).parent / "documents"
GOLDEN = Path(__file__).parent / "golden"


@contextlib.contextmanager
def prepared() -> Iterator[None]:
    """The folder of documents, with an archive of one of them, as the current folder."""
    before = Path.cwd()
    with tempfile.TemporaryDirectory() as folder:
        shutil.copytree(DOCUMENTS, folder, dirs_exist_ok=True)
        packed = pack((DOCUMENTS / "schema.dae").read_bytes(), name="in/schema.dae")
        (Path(folder) / "parts" / "packed.zae").write_bytes(packed)
        os.chdir(folder)
        try:
            yield
        finally:
            os.chdir(before)


def golden(form: str) -> str:
    """The report of the folder, and of a file that is not there."""
    stream = io.StringIO()
    with prepared(), contextlib.redirect_stdout(stream):
        code = run(["validate", ".", "none.dae", "--isolated", "--format", form,
                    "--max-findings", "3"])  # fmt: skip
    assert code == 2
    return stream.getvalue().replace(f'"{__version__}"', '"VERSION"')


if __name__ == "__main__":
    GOLDEN.mkdir(exist_ok=True)
    for name in FORMATS:
        (GOLDEN / f"{name}.txt").write_text(golden(name), "utf-8")
    sys.exit()
