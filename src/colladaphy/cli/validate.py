"""``colladaphy validate``."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from colladaphy.cli.console import EXIT_FINDINGS, EXIT_IO, say, say_findings, say_report, steps
from colladaphy.cli.files import format_option, limits_option, source_of

if TYPE_CHECKING:
    from colladaphy.source.limits import Limits

__all__ = ["command"]


@click.command("validate")
@click.argument("files", nargs=-1, required=True, metavar="FILE...")
@limits_option
@format_option
@click.option(
    "--fail-level",
    type=click.Choice(["error", "warning", "info", "hint"]),
    default="error",
    show_default=True,
    help="The least severity of a finding for which the exit code is 1.",
)
def command(files: tuple[str, ...], form: str, fail_level: str, limits: Limits | None) -> int:
    """Check documents (.dae, .zae) and report everything that is wrong with them.

    Exits with 0 when all are valid COLLADA 1.5, with 1 when there are errors, and with 2 when a
    file cannot be read.
    """
    from colladaphy.errors import InputError
    from colladaphy.findings import Report, Severity
    from colladaphy.validation import validate
    from colladaphy.validation.reporters import as_json

    reports = []
    unreadable = False
    for file in steps(files, "checking"):
        try:
            report = validate(source_of(file), limits=limits)
        except InputError as error:
            reports.append(Report(file, list(error.findings)))
            unreadable = True
            if form == "text":
                say_findings(error.findings)
            continue
        if report.file is None or file == "-":
            report.file = file
        reports.append(report)
        if form == "text":
            say_report(report)
    if form == "json":
        say(as_json(reports))
    if unreadable:
        return EXIT_IO
    levels = [str(severity) for severity in Severity]
    grave = levels[: levels.index(fail_level) + 1]
    failed = any(report.counts[level] for report in reports for level in grave)
    return EXIT_FINDINGS if failed else 0
