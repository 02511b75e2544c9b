"""File arguments: a path, or - for a standard stream."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, BinaryIO, TypeVar

import click

if TYPE_CHECKING:
    from colladaphy.source.limits import Limits

__all__ = ["convention_option", "format_option", "limits_option", "source_of", "target_of"]

_Function = TypeVar("_Function", bound=Callable[..., Any])


def source_of(name: str) -> str | BinaryIO:
    """What a file argument reads from."""
    return sys.stdin.buffer if name == "-" else name


def target_of(name: str) -> str | BinaryIO:
    """What a file argument writes to."""
    return sys.stdout.buffer if name == "-" else name


def format_option(function: _Function) -> _Function:
    """The option ``--format text|json``."""
    option = click.option(
        "--format",
        "form",
        type=click.Choice(["text", "json"]),
        default="text",
        show_default=True,
        help="For people, or for programs.",
    )
    return option(function)


def convention_option(function: _Function) -> _Function:
    """The option ``--convention``."""
    option = click.option(
        "--convention",
        default="auto",
        show_default=True,
        metavar="NAME",
        help="Whose reading of the standard the document follows; 'none' takes the standard's.",
    )
    return option(function)


def limits_option(function: _Function) -> _Function:
    """The option ``--limit NAME=NUMBER``, which becomes a `Limits` or None."""
    option = click.option(
        "--limit",
        "limits",
        multiple=True,
        metavar="NAME=NUMBER",
        callback=_limits,
        help="For trusted files: bytes, depth, text, elements, archive_entries, archive_ratio "
        "or total may be larger (or smaller) than usual.",
    )
    return option(function)


def _limits(_: click.Context, __: click.Parameter, values: tuple[str, ...]) -> Limits | None:
    if not values:
        return None
    from colladaphy.source.limits import Limits

    chosen: dict[str, int] = {}
    for value in values:
        name, _sign, number = value.partition("=")
        if not number.isdecimal():
            raise click.BadParameter(f"{value!r} is not of the form NAME=NUMBER.")
        chosen[name] = int(number)
    try:
        return Limits(**chosen)
    except TypeError:
        names = ", ".join(Limits.__slots__)
        raise click.BadParameter(f"The limits are {names}.") from None
    except ValueError as error:
        raise click.BadParameter(f"{error}.") from None
