"""How results look: text for people, JSON and others for programs. Repeatable: no time stamps."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from importlib import import_module

from colladaphy.validation.checking import Checked
from colladaphy.validation.reporters.json import as_json
from colladaphy.validation.reporters.presentation import Presentation
from colladaphy.validation.reporters.text import as_text, changes, summary

__all__ = ["Presentation", "as_json", "as_text", "changes", "reporter", "summary"]


def reporter(name: str) -> Callable[[Iterable[Checked], Presentation], Iterator[str]]:
    """What makes the lines of a report in a format of `FORMATS`; text comes as results come."""
    render = import_module(f"colladaphy.validation.reporters.{name}").render
    assert callable(render)
    return render  # type: ignore[no-any-return]
