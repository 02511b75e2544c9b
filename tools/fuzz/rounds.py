"""One round: a number of examples of one property, in this process."""

from __future__ import annotations

import resource
import signal
import time
import traceback
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import hypothesis
from hypothesis import HealthCheck, Phase, Verbosity, given, settings
from hypothesis.errors import UnsatisfiedAssumption
from lxml import etree

from colladaphy.findings import Finding
from colladaphy.testing import Coverage
from tools.fuzz import keeping
from tools.fuzz.registry import Property, noted

__all__ = ["SECONDS", "Failure", "Round", "limit_memory", "run"]

SECONDS = 20.0
"""CPU time that one example may take: far more than any of this size should."""
_DOCUMENTS = 5
"""Documents of a round whose schema components are counted; then one of twenty."""


class OverTimeError(Exception):
    """An example took more CPU time than any may."""


@dataclass
class Failure:
    """What a property does not hold of."""

    name: str
    kind: str
    """The error and where it arose, to tell one fault from another."""
    text: str
    """The traceback."""
    file: str | None
    """Where the values are kept."""


@dataclass
class Round:
    """What a round gave."""

    name: str
    examples: int = 0
    rejected: int = 0
    seconds: float = 0.0
    """CPU time."""
    wall: float = 0.0
    codes: Counter[str] = field(default_factory=Counter)
    components: set[Any] = field(default_factory=set)
    documents: int = 0
    failures: list[Failure] = field(default_factory=list)
    failing: bool = False


def limit_memory(size: int) -> None:
    """Let this process have `size` bytes of address space at most."""
    resource.setrlimit(resource.RLIMIT_AS, (size, size))


@contextmanager
def counted(codes: Counter[str]) -> Iterator[None]:
    """Count the codes of all findings that are made."""
    original: Callable[..., None] = Finding.__init__

    def counting(self: Finding, *args: Any, **values: Any) -> None:
        original(self, *args, **values)
        codes[self.code] += 1

    Finding.__init__ = counting  # type: ignore[method-assign]
    try:
        yield
    finally:
        Finding.__init__ = original  # type: ignore[method-assign]


@contextmanager
def bounded(seconds: float) -> Iterator[None]:
    """Stop what takes more CPU time."""

    def stop(*_: object) -> None:
        raise OverTimeError(f"an example took more than {seconds:g} s of CPU time")

    before = signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)


def run(
    prop: Property, seed: int, examples: int, folder: Path, current: Path | None = None
) -> Round:
    """Hold a property to so many examples of its values; what fails is kept in `folder`.

    With `current`, the values of every example are written to that file before it runs, so that
    they are known if this process does not outlive it.
    """
    found = Round(prop.name)
    coverage = Coverage()
    last: list[tuple[Any, ...]] = []

    def attempt(values: tuple[Any, ...]) -> None:
        found.examples += 1
        if found.failing:  # it shrinks: the last that fails is the least
            last[:] = [keeping.copied(values)]
        if current:
            keeping.keep(current, prop.name, values, "the process ended, or did not end")
        noted()
        try:
            with bounded(SECONDS):
                prop.check(*values)
        except UnsatisfiedAssumption:
            found.rejected += 1
            raise
        except BaseException:
            found.failing = True
            raise
        finally:
            _cover(found, coverage)

    test = hypothesis.seed(seed)(
        settings(
            max_examples=examples, database=None, deadline=None, print_blob=False,
            phases=[Phase.generate, Phase.shrink], verbosity=Verbosity.quiet,
            suppress_health_check=list(HealthCheck), report_multiple_bugs=False,
        )(given(prop.values())(attempt))
    )  # fmt: skip
    started, begun = time.process_time(), time.monotonic()
    with counted(found.codes):
        try:
            test()
        except Exception as error:
            found.failures.append(_failure(prop.name, error, last, folder))
    found.seconds, found.wall = time.process_time() - started, time.monotonic() - begun
    found.components = coverage.reached
    return found


def _cover(found: Round, coverage: Coverage) -> None:
    """Take note of the schema's components in some of the documents."""
    for document in noted():
        found.documents += 1
        if found.documents <= _DOCUMENTS or found.documents % 20 == 0:
            with suppress(etree.XMLSyntaxError, ValueError):
                coverage.record(document)


def _failure(name: str, error: BaseException, last: list[tuple[Any, ...]], folder: Path) -> Failure:
    frames = [
        f"{Path(frame.filename).name}:{frame.name}"
        for frame in traceback.extract_tb(error.__traceback__)
        if "hypothesis" not in frame.filename and "rounds.py" not in frame.filename
    ]
    kind = f"{type(error).__name__} at {frames[-1] if frames else '?'}"
    text = "".join(traceback.format_exception(error))
    file = None
    if last:
        said = (str(error).strip().splitlines() or [""])[0]
        file = str(keeping.keep(folder, name, last[0], f"{kind}: {said}"[:400]))
    return Failure(name, kind, text, file)
