"""``colladaphy convert``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import click

from colladaphy.cli.console import note_changes
from colladaphy.cli.files import convention_option, limits_option, refuse_same, source_of, target_of
from colladaphy.cli.reporting import write_report

if TYPE_CHECKING:
    from colladaphy.conform.exporting import Target
    from colladaphy.source.limits import Limits

__all__ = ["command"]


@click.command("convert")
@click.argument("source", metavar="IN")
@click.argument("target", metavar="OUT")
@click.option("--report", "report_file", metavar="FILE", help="Write what was changed to FILE.")
@click.option(
    "--for",
    "reader",
    type=click.Choice(["collada", "collada-1.4", "bullet"]),
    default="collada",
    show_default=True,
    help="Who will read it: readers of COLLADA 1.5, of 1.4.1, or Bullet's converter (1.4.1).",
)
@convention_option
@limits_option
def command(
    source: str,
    target: str,
    report_file: str | None,
    reader: Target | Literal["collada"],
    convention: str,
    limits: Limits | None,
) -> None:
    """Read a document of any version, mend it, and write it as valid COLLADA.

    What was changed goes to standard error, or to the FILE of --report (as JSON where its name
    ends in .json). IN is never changed, and OUT only as a whole.
    """
    from colladaphy.validation.mending import mend

    if report_file is not None:
        inputs = () if source == "-" else (source,)
        refuse_same("--report", report_file, (*inputs, target))
    mended = mend(source_of(source), convention=convention, limits=limits)
    report = mended.report
    data = None
    if reader != "collada":
        from colladaphy.conform.exporting import export

        data, changes = export(mended.tree, reader)
        report.extend(changes)
    mended.save(target_of(target), data)
    if report_file is not None:
        write_report(report, report_file)
    elif report.findings:
        note_changes(report)
