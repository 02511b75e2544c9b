"""Patterns of files, as .gitignore spells them."""

from __future__ import annotations

import os
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathspec import GitIgnoreSpec

__all__ = ["Patterns"]


@dataclass(frozen=True, slots=True)
class Patterns:
    """Patterns relative to a folder; none match nothing."""

    texts: tuple[str, ...] = ()
    _compiled: GitIgnoreSpec | None = None

    @classmethod
    def of(cls, texts: Iterable[str]) -> Patterns:
        """ValueError where a text is no pattern."""
        known = tuple(texts)
        if not known:
            return cls()
        from pathspec import GitIgnoreSpec

        return cls(known, GitIgnoreSpec.from_lines(known))

    def match(self, path: Path, folder: Path | None) -> bool:
        """Whether a file below `folder` (by default the current one) fits."""
        if self._compiled is None:
            return False
        name = os.path.relpath(path.absolute(), (folder or Path()).resolve())
        if name.startswith(".."):  # by another name: through a link, say
            name = os.path.relpath(path.resolve(), (folder or Path()).resolve())
        return not name.startswith("..") and self._compiled.match_file(name)
