"""A run over many documents: what is checked, by which configuration, against which baseline."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from colladaphy.errors import InputError
from colladaphy.findings import Finding, Report
from colladaphy.source.limits import Limits
from colladaphy.validation.checking import Checked, Job, check_all
from colladaphy.validation.configuration import (
    Configuration,
    Configurations,
    read_configuration,
)
from colladaphy.validation.gathering import gather
from colladaphy.validation.patterns import Patterns
from colladaphy.validation.settings import Settings

if TYPE_CHECKING:
    from colladaphy.validation.baseline import Baseline

__all__ = ["Request", "Session"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Request:
    """What is to be checked, and what overrides the configuration."""

    arguments: Sequence[str]
    """Files, folders and patterns; - is standard input."""
    overrides: Mapping[str, Any] = field(default_factory=dict)
    """Values of `Settings` that win over those of the configuration (`Settings.changed`)."""
    config: Path | None = None
    """The configuration of all files, in place of the one that each finds above it."""
    isolated: bool = False
    """Whether no configuration is looked for."""
    exclude: Patterns = field(default_factory=Patterns)
    force_exclude: bool = False
    """Whether files that are named themselves can be excluded, too."""
    baseline: Path | None = None
    """In place of the configuration's."""
    without_baseline: bool = False
    limits: Limits | None = None
    stdin: bytes | InputError | None = None
    """What standard input gives, or why it gives nothing, where it is an argument."""
    stdin_name: str | None = None
    """The name that standard input has in reports, and by which its settings are found."""


class Session:
    """The documents of a request, with the settings of each.

    ConfigurationError where a configuration or a baseline is faulty: before anything is checked.
    """

    def __init__(self, request: Request) -> None:
        self._request = request
        fixed = None
        if request.config is not None:
            fixed = read_configuration(request.config)
        elif request.isolated:
            fixed = Configuration()
        self._configurations = Configurations(fixed)
        self._baselines: dict[Path, Baseline] = {}
        gathered = gather(
            request.arguments,
            self._configurations,
            request.exclude,
            force_exclude=request.force_exclude,
        )
        self._faults: Sequence[Finding] = gathered.faults
        self._plan = [self._prepared(name) for name in gathered.files]

    @property
    def files(self) -> list[str]:
        """The names of the documents that are checked."""
        return [job.name if isinstance(job, Job) else job.report.file or "-"
                for job, _ in self._plan]  # fmt: skip

    @property
    def gone(self) -> int:
        """How many findings of baselines are there no more, of what was checked."""
        return sum(baseline.gone for baseline in self._baselines.values())

    def results(self, workers: int = 1) -> Iterator[Checked]:
        """Check all documents; the results come in their order."""
        jobs = [job for job, _ in self._plan if isinstance(job, Job)]
        done = check_all(jobs, workers)
        for job, baseline in self._plan:
            result = next(done) if isinstance(job, Job) else job
            yield result if baseline is None else baseline.apply(result)
        for finding in self._faults:
            yield Checked(Report(finding.file, [finding]), Settings(), readable=False)

    def _prepared(self, name: str) -> tuple[Job | Checked, Baseline | None]:
        request = self._request
        stdin = name == "-"
        known = request.stdin_name if stdin else name
        path = Path(known) if known is not None else None
        configuration = self._configurations.of(path.parent if path is not None else Path())
        settings = configuration.settings_of(path).changed(request.overrides)
        baseline = self._baseline(configuration)
        shown = known or name
        if not stdin:
            return Job(shown, settings, limits=request.limits), baseline
        if isinstance(request.stdin, InputError):
            report = Report(shown, list(request.stdin.findings))
            return Checked(report, settings, readable=False), None
        return Job(shown, settings, request.stdin, request.limits), baseline

    def _baseline(self, configuration: Configuration) -> Baseline | None:
        request = self._request
        file = request.baseline or configuration.baseline
        if file is None or request.without_baseline:
            return None
        if file not in self._baselines:
            from colladaphy.validation.baseline import Baseline

            self._baselines[file] = Baseline.read(file)
        return self._baselines[file]
