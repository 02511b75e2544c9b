"""Many documents in one process: one that fails stops no other, and the end says what became."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from colladaphy.cli.console import EXIT_FINDINGS, EXIT_IO, note, say_findings, steps
from colladaphy.cli.outputs import Job
from colladaphy.cli.progress import waiting
from colladaphy.errors import ColladaError, InputError, OutputError
from colladaphy.findings import Finding

__all__ = ["run_jobs"]

_SHOWN = 10


def run_jobs(jobs: Sequence[Job], work: Callable[[Job], int], done: str) -> int:
    """Do the work of each job, and give the gravest exit code.

    A single job raises its errors. Of several, each error is told with its file, and a summary
    ends it all; `done` is what is done to the others.
    """
    if len(jobs) == 1:
        with waiting(jobs[0].source):
            return work(jobs[0])
    code = 0
    failed: list[str] = []
    for job in steps(jobs, done):
        try:
            result = work(job)
        except ColladaError as error:
            _tell(job, error)
            result = EXIT_IO if isinstance(error, InputError | OutputError) else EXIT_FINDINGS
        except (OSError, MemoryError) as error:
            why = getattr(error, "strerror", None) or str(error) or "there is not enough memory"
            note(f"{job.source}: error: {why}.")
            result = EXIT_IO
        else:
            if result:
                failed.append(f"{job.source} (with losses)")
                code = max(code, result)
            continue
        failed.append(job.source)
        code = max(code, result)
    shown = "".join(f"\n    {name}" for name in failed[:_SHOWN])
    if len(failed) > _SHOWN:
        shown += f"\n    and {len(failed) - _SHOWN} more"
    rest = f", {len(failed)} not well:{shown}" if failed else ""
    note(f"{len(jobs)} documents: {len(jobs) - len(failed)} {done}{rest}")
    return code


def _tell(job: Job, error: ColladaError) -> None:
    from dataclasses import replace

    if not error.findings:
        note(f"{job.source}: error: {error}")
        return
    named: list[Finding] = [
        finding if finding.file else replace(finding, file=job.source) for finding in error.findings
    ]
    say_findings(named)
