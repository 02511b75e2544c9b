"""Attributes of a World that check what is assigned to them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Generic, Never, Protocol, TypeVar, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from colladaphy.world import values
from colladaphy.world.rules import ARGUMENT, COLUMNS, refuse
from colladaphy.world.table import Table

__all__ = ["Column", "Held", "Setting"]

Scalar = TypeVar("Scalar", bound=np.generic)
Value = TypeVar("Value")


class HasTop(Protocol):
    """What has a table of top-level bodies."""

    @property
    def top(self) -> Table: ...


class Column(Generic[Scalar]):
    """One number or more of every top-level body: a writable view; an assignment fills it."""

    def __init__(self, dtype: type[Scalar], description: str) -> None:
        self._dtype = dtype
        self.__doc__ = description

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    @overload
    def __get__(self, holder: None, owner: type) -> Column[Scalar]: ...
    @overload
    def __get__(self, holder: HasTop, owner: type) -> NDArray[Scalar]: ...
    def __get__(self, holder: HasTop | None, owner: type) -> Column[Scalar] | NDArray[Scalar]:
        return self if holder is None else holder.top.column(self._name)

    def __set__(self, holder: HasTop, value: ArrayLike) -> None:
        column = holder.top.column(self._name)
        numbers = values.fitting(self._name, value, self._dtype)
        try:
            column[...] = np.broadcast_to(numbers, column.shape)
        except ValueError as error:
            shapes = f"{numbers.shape}, not {column.shape}"
            raise refuse(COLUMNS, f"The column {self._name} has the shape {shapes}.") from error


class Held(Generic[Value]):
    """What the storage of a World holds: it may be changed in place, but not be replaced."""

    def __init__(self, description: str) -> None:
        self.__doc__ = description

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    @overload
    def __get__(self, holder: None, owner: type) -> Held[Value]: ...
    @overload
    def __get__(self, holder: object, owner: type) -> Value: ...
    def __get__(self, holder: object | None, owner: type) -> Held[Value] | Value:
        if holder is None:
            return self
        value: Value = getattr(vars(holder)["_storage"], self._name)
        return value

    def __set__(self, holder: object, value: Never) -> None:
        raise refuse(ARGUMENT, f"The {self._name} of a World are changed, never replaced.")


class Setting(Generic[Value]):
    """A single value that goes through a check: a function of its name and what is assigned.

    It is kept where it is set, or in the attribute `of`.
    """

    def __init__(
        self, check: Callable[[str, Any], Value], description: str, *, of: str | None = None
    ) -> None:
        self._check = check
        self._of = of
        self.__doc__ = description

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    @overload
    def __get__(self, holder: None, owner: type) -> Setting[Value]: ...
    @overload
    def __get__(self, holder: object, owner: type) -> Value: ...
    def __get__(self, holder: object | None, owner: type) -> Setting[Value] | Value:
        if holder is None:
            return self
        value: Value = self._home(holder)[self._name]
        return value

    def __set__(self, holder: object, value: Value) -> None:
        self._home(holder)[self._name] = self._check(self._name.replace("_", " "), value)

    def _home(self, holder: object) -> dict[str, Any]:
        return vars(holder if self._of is None else vars(holder)[self._of])
