"""Names for what stands in a choice: `shape.box` for the box in `shape.choice`.

A field that holds a choice of elements keeps them in the order of the document, whatever they are;
these look among them for those of one class. They are no fields: nothing is kept twice.
"""

from __future__ import annotations

from typing import Any, Generic, Never, Self, TypeVar, overload

__all__ = ["Every", "One"]

T = TypeVar("T")


class _Named:
    """Looks in a field for objects of a class, which it knows by name: it is imported late."""

    __slots__ = ("_field", "_kind")

    def __init__(self, field: str, kind: str) -> None:
        self._field = field
        self._kind = kind

    def _is_one(self, value: Any) -> bool:
        kind = type(value)
        return kind.__name__ == self._kind or any(k.__name__ == self._kind for k in kind.__mro__)


class One(_Named, Generic[T]):
    """The object in a field that holds one of several classes; None while it holds another.

    Setting it replaces whatever is there; setting None empties the field if this is in it.
    """

    __slots__ = ()

    @overload
    def __get__(self, obj: None, owner: type) -> Self: ...
    @overload
    def __get__(self, obj: Any, owner: type) -> T | None: ...
    def __get__(self, obj: Any, owner: type) -> Any:
        if obj is None:
            return self
        value = getattr(obj, self._field)
        return value if self._is_one(value) else None

    def __set__(self, obj: Any, value: T | None) -> None:
        if value is not None:
            if not self._is_one(value):
                raise TypeError(f"A {self._kind} stands here, not a {type(value).__name__}.")
            setattr(obj, self._field, value)
        elif self._is_one(getattr(obj, self._field)):
            setattr(obj, self._field, None)


class Every(_Named, Generic[T]):
    """The objects of a class in a field that holds a list, in their order.

    It is a tuple: what is to be added or removed is so in the list itself.
    """

    __slots__ = ()

    @overload
    def __get__(self, obj: None, owner: type) -> Self: ...
    @overload
    def __get__(self, obj: Any, owner: type) -> tuple[T, ...]: ...
    def __get__(self, obj: Any, owner: type) -> Any:
        if obj is None:
            return self
        return tuple(value for value in getattr(obj, self._field) if self._is_one(value))

    def __set__(self, obj: Any, value: Never) -> None:
        raise AttributeError(f"Add to the list {self._field!r}, or remove from it.")
