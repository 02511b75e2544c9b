"""``colladaphy convert``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import click

from colladaphy.cli.batch import run_jobs
from colladaphy.cli.console import EXIT_FINDINGS, note, note_changes
from colladaphy.cli.files import (
    convention_option,
    limits_option,
    refuse_same,
    source_of,
    target_of,
    units_options,
)
from colladaphy.cli.outputs import Job, jobs_of, output_options
from colladaphy.cli.reporting import write_reports

if TYPE_CHECKING:
    from lxml import etree

    from colladaphy.conform.exporting import Target
    from colladaphy.findings import Report
    from colladaphy.source import Parsed
    from colladaphy.source.limits import Limits
    from colladaphy.validation.companions import Render
    from colladaphy.validation.mending import Mended

__all__ = ["command"]

_REASONS = 3


@click.command("convert")
@output_options
@click.option("--report", "report_file", metavar="FILE", help="Write what was changed to FILE.")
@click.option(
    "--for",
    "reader",
    type=click.Choice(["collada", "collada-1.4", "bullet"]),
    default="collada",
    show_default=True,
    help="Who will read it: readers of COLLADA 1.5, of 1.4.1, or Bullet's converter (1.4.1).",
)
@click.option(
    "--kinematics", is_flag=True, help="Write joints as kinematics, too, for readers of robots."
)
@units_options
@click.option("--merge", is_flag=True, help="Bring in the documents that IN refers to.")
@click.option("--strict", is_flag=True, help="Exit with 1 where bodies of IN are lost.")
@convention_option
@limits_option
def command(
    names: tuple[str, ...],
    output: str | None,
    in_place: bool,
    no_backup: bool,
    force: bool,
    report_file: str | None,
    reader: Target | Literal["collada"],
    kinematics: bool,
    merge: bool,
    si: bool,
    up_axis: str | None,
    strict: bool,
    convention: str,
    limits: Limits | None,
) -> int:
    """Read documents of any version, mend them, and write them as valid COLLADA.

    Several IN, or a folder, are written into the folder that -o names. OUT without -o is for one
    IN, and must not exist. Files that IN refers to, such as models and images, are taken along
    to another folder.

    With --si, --up-axis and --kinematics, OUT is the World of IN alone, written anew; what else
    IN holds is left out, and said to be.

    Bodies that are lost are said in the last line, and with --strict by the exit code 1; a World
    that comes out empty, though IN has bodies, is an error: the exit code is 1 either way.

    What was changed goes to standard error, or to the FILE of --report (as JSON where its name
    ends in .json). An OUT is written as a whole or not at all.
    """
    jobs = jobs_of(names, output, in_place=in_place, force=force)
    if report_file is not None:
        files = [name for job in jobs for name in (job.source, job.target) if name and name != "-"]
        refuse_same("--report", report_file, files)
    reports: list[Report] = []

    def work(job: Job) -> int:
        from colladaphy.validation.mending import backup, mend

        mended = mend(source_of(job.source), convention=convention, limits=limits)
        if merge:
            mended = mended.merged(convention)
        if si or up_axis is not None or kinematics:
            mended = mended.as_world(convention, si=si, up_axis=up_axis, kinematics=kinematics)
        report = mended.report
        data = None
        if reader != "collada":
            from colladaphy.conform.exporting import export

            data, changes = export(mended.tree, reader)
            report.extend(changes)
        assert job.target is not None
        if not job.in_place or report.findings:
            if job.in_place and not no_backup:
                backup(job.target)
            job.prepare()
            mended.save(target_of(job.target), data, _render(convention, reader), force=force)
        reports.append(report)
        if report_file is None and report.findings:
            note_changes(report)
        return _say_losses(mended, job, convention, strict)

    try:
        return run_jobs(jobs, work, "written")
    finally:
        if report_file is not None:
            write_reports(reports, report_file)


def _render(convention: str, reader: Target | Literal["collada"]) -> Render:
    """What becomes of documents that IN refers to: the same as of IN."""

    def render(parsed: Parsed) -> tuple[etree._ElementTree, bytes]:
        from colladaphy.conform import conform
        from colladaphy.conform.exporting import export
        from colladaphy.validation.mending import serialise

        tree, _ = conform(parsed.tree, file=parsed.file, convention=convention)
        data = serialise(tree) if reader == "collada" else export(tree, reader)[0]
        return tree, data

    return render


def _say_losses(mended: Mended, job: Job, convention: str, strict: bool) -> int:
    """Say in a last line that bodies were lost, with the exit code for it."""
    if not mended.has_bodies:
        return 0
    there, reasons = mended.bodies(convention)
    lost = len(reasons)
    if there and not lost:
        return 0
    for finding in reasons[:_REASONS]:
        place = f"{finding.line}: " if finding.line else " "
        note(f"{job.source}:{place}{finding.message} [{finding.code}]")
    if lost > _REASONS:
        note(f"... and {lost - _REASONS} more bodies")
    if not there:
        why = f"none of its {lost} bodies can be loaded" if lost else "no scene instances a body"
        note(f"{job.source}: {'error' if lost else 'warning'}: The World is empty: {why}.")
        return EXIT_FINDINGS if lost or strict else 0
    note(f"{job.source}: warning: {lost} of {there + lost} bodies cannot be loaded.")
    return EXIT_FINDINGS if strict else 0
