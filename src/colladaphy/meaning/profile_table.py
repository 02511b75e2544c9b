"""Elements of the pe profile, which stand in techniques."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.links.names import c, p
from colladaphy.meaning.context import Context, FloatRows

__all__ = ["Profile", "profile_of"]

Array = NDArray[Any]


class Profile:
    """The elements of the profile, by name."""

    def __init__(self, context: Context) -> None:
        self.context = context
        self._firsts: dict[str, dict[int, int]] = {}

    def elements(self, name: str) -> Array:
        """All elements of a name."""
        columns = self.context.columns
        parts = [columns.index.rows(code) for code in columns.codes_of(p(name))]
        return np.sort(np.concatenate(parts)) if parts else np.zeros(0, np.int32)

    def child(self, parent: int, name: str) -> int:
        """The first child of a name; -1 for none."""
        if name not in self._firsts:
            found = self.elements(name)
            above = self.context.parent[found]
            self._firsts[name] = dict(
                zip(reversed(above.tolist()), reversed(found.tolist()), strict=True)
            )
        return self._firsts[name].get(parent, -1)

    def numbers(self, element: int) -> Array:
        """The numbers in an element."""
        rows = self.context.at(FloatRows, np.array([element]))
        return rows.value[0]

    def holder(self, element: int) -> int:
        """The COLLADA element that the technique around an element belongs to; -1 for none."""
        technique = self.technique(element)
        return -1 if technique < 0 else int(self.context.parent[technique])

    def technique(self, element: int) -> int:
        """The technique around an element; -1 for none."""
        codes = self.context.columns.codes_of(c("technique"))
        index = self.context.columns.index
        current = int(index.parent[element])
        while current >= 0 and int(index.codes[current]) not in codes:
            current = int(index.parent[current])
        return current

    @property
    def is_empty(self) -> bool:
        """Whether the document has nothing of the profile."""
        columns = self.context.columns
        return not any(columns.codes_of(p(name))
                       for name in ("world", "body", "motion", "joint", "material"))  # fmt: skip


def profile_of(context: Context) -> Profile:
    """The pe profile of a document."""
    return context.shared(Profile)
