"""File arguments: a path, or - for a standard stream."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any, BinaryIO, TypeVar

import click

__all__ = ["convention_option", "format_option", "source_of", "target_of"]

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
