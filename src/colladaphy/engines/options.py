"""Options of engines: checked, read from text, and in a form that a checkpoint can hold."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from typing import Any, ClassVar, Self

from colladaphy.engines.rules import OPTION, refuse

__all__ = ["Options", "Value"]

Value = str | int | float | bool


@dataclass(frozen=True, slots=True)
class Options:
    """The base of an engine's options: a frozen dataclass of words, numbers and switches.

    `CHOICES` lists the words that an option can be; a number has to be at least 1. EngineError
    (``engine-option``) says what else there is.
    """

    CHOICES: ClassVar[Mapping[str, tuple[str, ...]]] = {}

    def __post_init__(self) -> None:
        for field in fields(self):
            name, value = field.name, getattr(self, field.name)
            kind = type(field.default)
            choices = self.CHOICES.get(name)
            if choices and value not in choices:
                raise refuse(OPTION, f"{name} is {value!r}, not one of {', '.join(choices)}.")
            number = kind is int and isinstance(value, int) and not isinstance(value, bool)
            if not choices and not (number or type(value) is kind):
                raise refuse(OPTION, f"{name} is {value!r}, which is no {kind.__name__}.")
            if number and value < 1:
                raise refuse(OPTION, f"{name} is {value}, less than 1.")

    @classmethod
    def of(cls, given: Mapping[str, Any]) -> Self:
        """Options by name; numbers and switches may be texts ("20", "true", "off")."""
        known = {field.name: type(field.default) for field in fields(cls)}
        values: dict[str, Any] = {}
        for name, value in given.items():
            if name not in known:
                there = ", ".join(known)
                raise refuse(OPTION, f"There is no option {name!r}; there are {there}.")
            values[name] = _read(value, known[name]) if isinstance(value, str) else value
        return cls(**values)

    def plain(self) -> dict[str, Value]:
        """All options by name."""
        return asdict(self)


def _read(text: str, kind: type) -> Any:
    """A text as a switch or number; the text itself if it is neither, to be refused."""
    word = text.strip().lower()
    if kind is bool and word in ("true", "yes", "on", "1", "false", "no", "off", "0"):
        return word in ("true", "yes", "on", "1")
    if kind is int and word.isdigit():
        return int(word)
    return text if kind is not str else word
