"""``colladaphy validate``."""

from __future__ import annotations

import click

from colladaphy.cli.console import EXIT_FINDINGS, EXIT_IO, say, say_findings, say_report, steps
from colladaphy.cli.files import format_option, source_of

__all__ = ["command"]


@click.command("validate")
@click.argument("files", nargs=-1, required=True, metavar="FILE...")
@format_option
def command(files: tuple[str, ...], form: str) -> int:
    """Check documents (.dae, .zae) and report everything that is wrong with them.

    Exits with 0 when all are valid COLLADA 1.5, with 1 when there are errors, and with 2 when a
    file cannot be read.
    """
    from colladaphy import validate
    from colladaphy.errors import InputError
    from colladaphy.findings import Report
    from colladaphy.validation.reporters import as_json

    reports = []
    unreadable = False
    for file in steps(files, "checking"):
        try:
            report = validate(source_of(file))
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
    return 0 if all(report.valid for report in reports) else EXIT_FINDINGS
