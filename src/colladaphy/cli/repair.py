"""``colladaphy repair``."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from colladaphy.cli.batch import run_jobs
from colladaphy.cli.console import note, note_changes, say
from colladaphy.cli.files import convention_option, limits_option, source_of, target_of
from colladaphy.cli.outputs import Job, jobs_of, output_options

if TYPE_CHECKING:
    from colladaphy.source.limits import Limits

__all__ = ["command"]


@click.command("repair")
@output_options
@click.option("--dry-run", is_flag=True, help="Only say what would be changed.")
@click.option(
    "--only", "codes", multiple=True, metavar="CODE", help="Only these changes; may be repeated."
)
@click.option("--diff", is_flag=True, help="Show the changes as a unified diff.")
@convention_option
@limits_option
def command(
    names: tuple[str, ...],
    output: str | None,
    in_place: bool,
    no_backup: bool,
    force: bool,
    dry_run: bool,
    codes: tuple[str, ...],
    diff: bool,
    convention: str,
    limits: Limits | None,
) -> int:
    """Mend documents, write them to OUT or in their place, and say what was changed.

    Several IN, or a folder, are written into the folder that -o names. OUT without -o is for one
    IN, and must not exist. With --in-place, IN itself is replaced, and IN.bak is what it was.
    Nothing is written with --dry-run, and nothing when a document cannot be made valid; then
    what is missing is listed, and the exit code is 1.
    """
    _check_codes(codes)
    jobs = jobs_of(names, output, in_place=in_place, force=force, writes=not dry_run)

    def work(job: Job) -> int:
        from colladaphy.validation.mending import backup, mend, unified_diff

        mended = mend(
            source_of(job.source), convention=convention, limits=limits, only=codes or None
        )
        if job.target is not None and (not job.in_place or mended.report.findings):
            if job.in_place and not no_backup:
                backup(job.target)
            job.prepare()
            mended.save(target_of(job.target), force=force)
        note_changes(mended.report, None if dry_run else 3)
        if diff:
            for line in unified_diff(mended):
                say(line)
        return 0

    code = run_jobs(jobs, work, "looked at" if dry_run else "mended")
    if dry_run and not diff:
        note("Nothing was written (--dry-run).")
    return code


def _check_codes(codes: tuple[str, ...]) -> None:
    from colladaphy.validation.catalogue import find_rule, similar_codes

    for code in codes:
        if find_rule(code) is None:
            close = similar_codes(code)
            hint = f" Did you mean {' or '.join(close)}?" if close else " See 'colladaphy rules'."
            raise click.BadParameter(f"There is no code {code!r}.{hint}", param_hint="--only")
