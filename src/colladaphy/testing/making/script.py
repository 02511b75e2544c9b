"""Makes a World by calls that are kept, so that a failing example can be read and run again."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any, TypeVar

import numpy as np

from colladaphy.world import Body, Joint, Material, Mesh, World

__all__ = ["Script"]

T = TypeVar("T")


class Script:
    """A World under construction, and the Python that constructs it."""

    def __init__(self, **options: Any) -> None:
        self.world = World(**options)
        self._steps: list[tuple[str | None, str, tuple[Any, ...], Mapping[str, Any]]] = [
            ("world", "World", (), options)
        ]
        self._names: dict[tuple[str, Any], str] = {}

    def call(self, what: Callable[..., T], *arguments: Any, **options: Any) -> T:
        """Calls a method of the World, or a function that takes it first, and keeps the call."""
        result = what(*arguments, **options)
        owner = getattr(what, "__self__", None)
        name = what.__name__ if owner is None else f"{self._shown(owner)}.{what.__name__}"
        label = None
        key = _key(result)
        if key is not None:
            label = f"{key[0]}{sum(known[0] == key[0] for known in self._names) + 1}"
        self._steps.append((label, name, self._frozen(arguments), options))
        if key is not None and label is not None:
            self._names[key] = label
        return result

    def set(self, owner: Any, **values: Any) -> None:
        """Sets attributes of the World or of a body, and keeps that."""
        for name, value in values.items():
            setattr(owner, name, value)
            target = f"{self._shown(owner)}.{name}"
            self._steps.append((target, "", (self._frozen(value),), {}))

    def _frozen(self, value: Any) -> Any:
        """Handles as their names, which they may not have any more when the text is made."""
        if isinstance(value, (tuple, list)):
            return type(value)(self._frozen(each) for each in value)
        key = _key(value)
        return value if key is None and value is not self.world else _Name(self._shown(value))

    def _shown(self, value: Any) -> str:
        if value is self.world:
            return "world"
        key = _key(value)
        if key is not None and key in self._names:
            return self._names[key]
        if isinstance(value, Mesh):
            return f"world.meshes[{value.id}]"
        return repr(value.name) if isinstance(value, Material) else repr(value)

    def __repr__(self) -> str:
        lines = []
        for target, function, arguments, options in self._steps:
            shown = [_text(each) for each in arguments]
            shown += [f"{key}={_text(value)}" for key, value in options.items()]
            call = f"{function}({', '.join(shown)})" if function else shown[0]
            lines.append(call if target is None else f"{target} = {call}")
        return "\n".join(lines)


class _Name(str):
    """A name in the program."""

    __slots__ = ()

    def __repr__(self) -> str:
        return str(self)


def _key(value: Any) -> tuple[str, Any] | None:
    if isinstance(value, Body):
        return ("body", value.sid)
    if isinstance(value, Joint):
        return ("joint", value.sid)
    if isinstance(value, Material):
        return ("material", value.id)
    if isinstance(value, Mesh):
        return ("mesh", value.id)
    return None


def _text(value: Any) -> str:
    """A value as Python spells it."""
    if isinstance(value, np.ndarray):
        return _text(value.tolist())
    if isinstance(value, (tuple, list)):
        inner = ", ".join(map(_text, value))
        if isinstance(value, list):
            return f"[{inner}]"
        return f"({inner},)" if len(value) == 1 else f"({inner})"
    if isinstance(value, float) and math.isinf(value):
        return "math.inf" if value > 0 else "-math.inf"
    return repr(value)
