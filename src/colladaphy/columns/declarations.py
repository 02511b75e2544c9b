"""What the schema declares the elements of a path as."""

from __future__ import annotations

from typing import Any, Final

from colladaphy.columns.index import Index
from colladaphy.columns.paths import Paths
from colladaphy.columns.tags import Tags
from colladaphy_schema.content import NOT_LOCAL
from colladaphy_schema.document_columns import ColladaRows
from colladaphy_schema.rows import Child, Column, Rows

__all__ = ["Declarations"]

_ROOT: Final = "{http://www.collada.org/2008/03/COLLADASchema}COLLADA"

Declared = type[Rows] | Column[Any] | None


class Declarations:
    """Looked up along paths, each once."""

    def __init__(self, index: Index, tags: Tags, paths: Paths) -> None:
        self._index = index
        self._tags = tags
        self._paths = paths
        self._kinds = tags.kinds[paths.first].tolist()
        self._parents = paths.parents.tolist()
        self._found: dict[int, tuple[Declared, dict[bytes, bytes]]] = {}

    def is_local(self, path: int) -> bool:
        """Whether what may follow a child is known from the child alone."""
        if path < 0:
            return True
        declared, scope = self._declared(path)
        return declared is not None and self._tag(path, scope) not in NOT_LOCAL

    def is_closed(self, path: int) -> bool:
        """Whether the tags of a path are closed in themselves."""
        first = self._paths.first[path]
        return bool(self._index.bytes[self._index.stop[first] - 1] == ord("/"))

    def attributes(self, path: int) -> list[Column[Any] | None]:
        """What the attributes of the elements are declared as; of namespaces' nothing."""
        declared, _ = self._declared(path)
        found: list[Column[Any] | None] = []
        for text in self._tags.attributes[self._kinds[path]]:
            name = text.strip().rstrip(b"=").decode()
            fields = declared.FIELDS if isinstance(declared, type) else ()
            found.append(
                next((field for field in fields if isinstance(field, Column)
                      and field.form == "attribute" and field.tag == name), None)
            )  # fmt: skip
        return found

    def text(self, path: int) -> Column[Any] | None:
        """What the text of the elements is declared as."""
        declared, _ = self._declared(path)
        if isinstance(declared, Column):
            return declared
        fields = () if declared is None else declared.FIELDS
        return next((field for field in fields if isinstance(field, Column)
                     and field.form == "text"), None)  # fmt: skip

    def _declared(self, path: int) -> tuple[Declared, dict[bytes, bytes]]:
        found = self._found.get(path)
        if found is None:
            found = self._found[path] = self._look_up(path)
        return found

    def _look_up(self, path: int) -> tuple[Declared, dict[bytes, bytes]]:
        parent = self._parents[path]
        around, scope = (None, {b"": b""}) if parent < 0 else self._declared(parent)
        for text in self._tags.attributes[self._kinds[path]]:
            name, _, uri = text.strip().partition(b"=")
            prefix, _, local = name.partition(b":")
            if prefix == b"xmlns":
                scope = scope | {local: uri.strip(b'"')}
        tag = self._tag(path, scope)
        if parent < 0:
            return (ColladaRows if tag == _ROOT else None), scope
        if not isinstance(around, type):
            return None, scope
        for field in around.FIELDS:
            if isinstance(field, Child) and field.tag == tag:
                return field.type, scope
            if isinstance(field, Column) and field.form == "element" and field.tag == tag:
                return field, scope
        return None, scope

    def _tag(self, path: int, scope: dict[bytes, bytes]) -> str:
        """The qualified name of the elements."""
        written = self._index.names.texts[int(self._index.codes[self._paths.first[path]])]
        prefix, _, local = written.rpartition(b":")
        uri = scope.get(prefix, b"")
        return f"{{{uri.decode()}}}{local.decode()}" if uri else local.decode()
