"""The values of validate's options, checked and taken apart."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

import click

from colladaphy.findings import Severity
from colladaphy.validation.formats import FORMATS

if TYPE_CHECKING:
    from colladaphy.validation.patterns import Patterns

__all__ = ["codes", "outputs", "patterns", "severities", "workers"]


def codes(_: click.Context, option: click.Parameter, values: tuple[str, ...]) -> tuple[str, ...]:
    """Codes and beginnings of codes, several of them with commas between."""
    from colladaphy.validation.configuration import known_names

    names = [name.strip() for value in values for name in value.split(",") if name.strip()]
    return known_names(names, lambda _rule, message: _refuse(option, message))


def severities(
    context: click.Context, option: click.Parameter, values: tuple[str, ...]
) -> dict[str, Severity]:
    """``CODE=LEVEL``, several of them with commas between."""
    found = {}
    for pair in (pair for value in values for pair in value.split(",")):
        name, sign, chosen = pair.partition("=")
        if not sign or chosen not in list(Severity):
            _refuse(option, f"{pair!r} is not of the form CODE=LEVEL, LEVEL one of "
                            f"{', '.join(Severity)}.")  # fmt: skip
        found[name.strip()] = Severity(chosen)
    codes(context, option, tuple(found))
    return found


def outputs(
    _: click.Context, option: click.Parameter, values: tuple[str, ...]
) -> tuple[tuple[str, str], ...]:
    """``FORMAT=FILE``."""
    found: list[tuple[str, str]] = []
    for value in values:
        name, _sign, file = value.partition("=")
        if name not in FORMATS or not file:
            _refuse(option, f"{value!r} is not of the form FORMAT=FILE, FORMAT one of "
                            f"{', '.join(FORMATS)}.")  # fmt: skip
        if file != "-" and any(
            Path(file).resolve() == Path(other).resolve() for _n, other in found
        ):
            _refuse(option, f"{file!r} is another report of this command.")
        found.append((name, file))
    return tuple(found)


def patterns(_: click.Context, option: click.Parameter, values: tuple[str, ...]) -> Patterns:
    """Patterns of files as .gitignore spells them."""
    from colladaphy.validation.patterns import Patterns

    try:
        return Patterns.of(values)
    except ValueError as error:
        return _refuse(option, f"{error}.")


def workers(_: click.Context, __: click.Parameter, value: int) -> int:
    """A number of processes; 0 stands for as many as there are processors."""
    return value or os.cpu_count() or 1


def _refuse(option: click.Parameter, message: str) -> NoReturn:
    raise click.BadParameter(message, param_hint=option.opts[-1])
