"""Checking many documents, one after the other or several at once, in a fixed order."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace

from colladaphy.errors import InputError
from colladaphy.findings import Report
from colladaphy.source.limits import Limits
from colladaphy.validation.options import Options
from colladaphy.validation.settings import Settings

__all__ = ["Checked", "Job", "check", "check_all"]


@dataclass(frozen=True, slots=True)
class Job:
    """A document to check: a path, or the bytes of one that has only a name."""

    name: str
    settings: Settings
    data: bytes | None = None
    limits: Limits | None = None


@dataclass(slots=True)
class Checked:
    """What a check has found, after the configuration."""

    report: Report
    settings: Settings
    readable: bool = True
    """False where there was nothing to read: the report says why."""
    ignored: int = 0
    """Findings that the configuration leaves out."""
    known: int = 0
    """Findings that the baseline leaves out."""

    @property
    def failed(self) -> bool:
        """Whether something is grave enough to fail the check."""
        return any(map(self.settings.grave, self.report))


def check(job: Job) -> Checked:
    """Check one document; nothing about its content is raised."""
    from colladaphy.validation.stages import validate

    settings = job.settings
    options = Options(collada_14=settings.collada_14)
    try:
        source = job.name if job.data is None else job.data
        report = validate(source, limits=job.limits, options=options)
    except InputError as error:
        named = [replace(found, file=found.file or job.name) for found in error.findings]
        return Checked(Report(job.name, named), settings, readable=False)
    except MemoryError:
        return _unchecked(job, "There is not enough memory for it.")
    if report.file is None:
        report = Report(job.name, [replace(f, file=f.file or job.name) for f in report])
    report, ignored = settings.apply(report)
    return Checked(report, settings, ignored=ignored)


def check_all(jobs: Sequence[Job], workers: int = 1) -> Iterator[Checked]:
    """Check documents in `workers` processes; the results come in the order of the jobs."""
    if workers <= 1 or len(jobs) < 2:
        yield from map(check, jobs)
        return
    from concurrent.futures import ProcessPoolExecutor
    from concurrent.futures.process import BrokenProcessPool
    from multiprocessing import get_context

    # Each process starts afresh: a copy of this one would share its locks.
    pool = ProcessPoolExecutor(min(workers, len(jobs)), mp_context=get_context("spawn"))
    done = 0
    try:
        with _uninterrupted():
            results = pool.map(check, jobs)
        for result in results:
            done += 1
            yield result
    except BrokenProcessPool:
        why = "The processes that check files have ended by themselves, perhaps for lack of memory."
        for job in jobs[done:]:
            yield _unchecked(job, why)
    finally:
        # Where the run is stopped by hand, each process ends the file that it is at.
        pool.shutdown(wait=False, cancel_futures=True)


@contextmanager
def _uninterrupted() -> Iterator[None]:
    """Processes that begin here leave Ctrl-C to this one: if they died of it, locks would stay."""
    import signal
    import threading

    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, signal.SIG_DFL if before is None else before)


def _unchecked(job: Job, why: str) -> Checked:
    from colladaphy.source import rules

    hint = "Check it by itself, one file at a time (-j 1), on a machine with more memory."
    finding = rules.UNREADABLE.at(
        message=f"The file was not checked. {why}", file=job.name, hint=hint
    )
    return Checked(Report(job.name, [finding]), job.settings, readable=False)
