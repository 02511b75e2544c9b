"""``colladaphy repair``."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from colladaphy.cli.console import note, note_changes, say
from colladaphy.cli.files import convention_option, limits_option, source_of, target_of

if TYPE_CHECKING:
    from colladaphy.source.limits import Limits

__all__ = ["command"]


@click.command("repair")
@click.argument("source", metavar="IN")
@click.argument("target", metavar="[OUT]", required=False)
@click.option("--dry-run", is_flag=True, help="Only say what would be changed.")
@click.option(
    "--only", "codes", multiple=True, metavar="CODE", help="Only these changes; may be repeated."
)
@click.option("--diff", is_flag=True, help="Show the changes as a unified diff.")
@convention_option
@limits_option
def command(
    source: str,
    target: str | None,
    dry_run: bool,
    codes: tuple[str, ...],
    diff: bool,
    convention: str,
    limits: Limits | None,
) -> None:
    """Mend the document IN, write it to OUT, and say what was changed.

    Without OUT, IN itself is replaced. Nothing is written with --dry-run, and nothing when the
    document cannot be made valid; then what is missing is listed, and the exit code is 1.
    """
    from colladaphy.validation.mending import mend, unified_diff

    _check_codes(codes)
    mended = mend(source_of(source), convention=convention, limits=limits, only=codes or None)
    note_changes(mended.report, None if dry_run else 3)
    if diff:
        for line in unified_diff(mended):
            say(line)
    if not dry_run:
        mended.save(target_of(target if target is not None else source))
    elif not diff:
        note("Nothing was written (--dry-run).")


def _check_codes(codes: tuple[str, ...]) -> None:
    from colladaphy.validation.catalogue import find_rule, similar_codes

    for code in codes:
        if find_rule(code) is None:
            close = similar_codes(code)
            hint = f" Did you mean {' or '.join(close)}?" if close else " See 'colladaphy rules'."
            raise click.BadParameter(f"There is no code {code!r}.{hint}", param_hint="--only")
