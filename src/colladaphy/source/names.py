"""Names of files, as messages show them."""

from __future__ import annotations

import os

__all__ = ["shown_name"]


def shown_name(name: str | bytes | os.PathLike[str] | os.PathLike[bytes]) -> str:
    """A name as text that any terminal and file can take, whatever is in it."""
    name = os.fspath(name)
    try:
        data = os.fsencode(name)
    except UnicodeEncodeError:  # half of a pair, which no file system has
        data = str(name).encode("utf-8", "backslashreplace")
    return data.decode("utf-8", "backslashreplace")
