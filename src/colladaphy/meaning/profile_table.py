"""Elements of the pe profile, which stand in techniques."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.links.names import p
from colladaphy.meaning.context import Context, FloatRows
from colladaphy_schema.rows import Lists

__all__ = ["Profile", "profile_of"]

Array = NDArray[Any]


class Profile:
    """The elements of the profile, by name."""

    def __init__(self, context: Context) -> None:
        self.context = context
        self._firsts: dict[str, dict[int, int]] = {}
        self._elements: dict[str, Array] = {}
        self._lists: dict[str, Lists] = {}

    def elements(self, name: str) -> Array:
        """All elements of a name."""
        columns = self.context.columns
        if name not in self._elements:
            parts = [columns.index.rows(code) for code in columns.codes_of(p(name))]
            found = np.concatenate(parts) if parts else np.zeros(0, np.int32)
            self._elements[name] = np.sort(found) if len(parts) > 1 else found
        return self._elements[name]

    def child(self, parent: int, name: str) -> int:
        """The first child of a name; -1 for none."""
        if name not in self._firsts:
            found = self.elements(name)
            above = self.context.parent[found]
            self._firsts[name] = dict(
                zip(reversed(above.tolist()), reversed(found.tolist()), strict=True)
            )
        return self._firsts[name].get(parent, -1)

    def values(self, name: str, width: int, *outer: str) -> tuple[Array, Array, Array]:
        """Elements of a name in elements of others, these, and the numbers (n, width) in them."""
        found = self.elements(name)
        above = self.context.parent[found]
        codes = [code for each in outer for code in self.context.columns.codes_of(p(each))]
        mine = np.flatnonzero(self.context.columns.have_code(above, codes))
        first = self.lists(name).offsets[mine]
        values = self.lists(name).values[first[:, None] + np.arange(width)]
        return found[mine], above[mine], values

    def lists(self, name: str) -> Lists:
        """The numbers in all elements of a name."""
        if name not in self._lists:
            self._lists[name] = self.context.at(FloatRows, self.elements(name)).value
        return self._lists[name]

    def holders(self, elements: Array) -> Array:
        """The COLLADA elements (n,) whose techniques elements stand in; -1 for none."""
        techniques = self.context.ancestor(elements, "technique")
        return np.where(techniques >= 0, self.context.parent[techniques], -1)

    @property
    def is_empty(self) -> bool:
        """Whether the document has nothing of the profile."""
        columns = self.context.columns
        return not any(columns.codes_of(p(name))
                       for name in ("world", "body", "motion", "joint", "material"))  # fmt: skip


def profile_of(context: Context) -> Profile:
    """The pe profile of a document."""
    return context.shared(Profile)
