"""``colladaphy demo``."""

from __future__ import annotations

import click

__all__ = ["command"]


@click.command("demo")
def command() -> int:
    """Build the six test cases of the thesis, store them, load them, and compare bit by bit.

    Exits with 1 on any difference.
    """
    from colladaphy.demo import main

    return int(main() or 0)
