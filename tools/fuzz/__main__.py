"""`python -m tools.fuzz [--examples 100000] [--minutes M] [--processes N] [--only NAME,…]`."""

from __future__ import annotations

import argparse
import os
import random
import signal
import sys
import time
from multiprocessing.connection import wait
from pathlib import Path

from tools.fuzz.registry import Property, all_properties
from tools.fuzz.rounds import Round
from tools.fuzz.totals import Totals, merged
from tools.fuzz.workers import Task, Worker

ROOT = Path(__file__).resolve().parents[2]
REGRESSIONS = ROOT / "tests" / "regressions"

_ROUND = 20.0
"""CPU seconds that a round should take, as far as the rate is known."""
_HUNG = 900.0
"""Seconds after which a round is taken to hang."""
_ENOUGH = 3
"""Failures of one property after which it is left alone."""


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="python -m tools.fuzz", description=__doc__)
    parser.add_argument("--examples", type=int, default=100_000, metavar="N",
                        help="examples of each property (default 100,000)")  # fmt: skip
    parser.add_argument("--minutes", type=float, metavar="M", help="stop after this time")
    parser.add_argument("--processes", type=int, default=os.cpu_count() or 1, metavar="N")
    parser.add_argument("--only", metavar="NAME,…", help="some of the properties")
    parser.add_argument("--seed", type=int, help="where to begin (default: anywhere)")
    parser.add_argument("--memory", type=float, default=4.0, metavar="GB",
                        help="address space of a process (default 4)")  # fmt: skip
    parser.add_argument("--log", type=Path, metavar="FOLDER",
                        help="keep totals, tracebacks and a log there")  # fmt: skip
    parser.add_argument("--regressions", type=Path, default=REGRESSIONS, metavar="FOLDER",
                        help="where to keep what fails (default tests/regressions)")  # fmt: skip
    parser.add_argument("--list", action="store_true", help="name the properties")
    parser.add_argument("--sum", nargs="+", type=Path, metavar="FILE",
                        help="report on totals that were kept in the folder of --log")  # fmt: skip
    options = parser.parse_args(arguments)
    if options.sum:
        print("\n".join(merged(options.sum).lines()))
        return 0
    properties = all_properties()
    if options.list:
        for name, prop in sorted(properties.items()):
            print(f"{name}: {prop.about}")
        return 0
    if options.only:
        unknown = set(options.only.split(",")) - properties.keys()
        if unknown:
            parser.error(f"no property {', '.join(sorted(unknown))}; --list names them")
        properties = {name: properties[name] for name in options.only.split(",")}
    run = Run(properties, options)
    run.all()
    print("\n".join(run.totals.lines()))
    return 1 if run.totals.failures else 0


class Run:
    """All properties, shared out among workers until each has its examples or time is up."""

    def __init__(self, properties: dict[str, Property], options: argparse.Namespace) -> None:
        self._properties, self._options = properties, options
        self._chance = random.Random(options.seed)
        self._again: list[Task] = []
        self._given: dict[str, int] = dict.fromkeys(properties, 0)
        self._started = time.monotonic()
        self.totals = Totals()
        stamp = time.strftime("%Y%m%dT%H%M%S")
        self._file = options.log and options.log / f"totals-{stamp}-{os.getpid()}.json"

    def all(self) -> None:
        """Run to the end; an interrupt ends it early, with what was found."""
        signal.signal(signal.SIGTERM, signal.default_int_handler)
        workers = [
            Worker(self._options.regressions, int(self._options.memory * 2**30))
            for _ in range(self._options.processes)
        ]
        try:
            busy: list[Worker] = []
            while True:
                for worker in workers:
                    if worker not in busy and (task := self._next()) is not None:
                        worker.give(task)
                        busy.append(worker)
                if not busy:
                    return
                self._collect(busy)
        except KeyboardInterrupt:
            print("interrupted", file=sys.stderr)
        finally:
            for worker in workers:
                worker.end()
            self._save()

    def _next(self) -> Task | None:
        """The property that had least of its time is next."""
        minutes = self._options.minutes
        if minutes is not None and time.monotonic() - self._started > 60 * minutes:
            return None
        if self._again:
            return self._again.pop()
        open_ones = {
            name: prop for name, prop in self._properties.items() if self._is_open(name)
        }  # fmt: skip
        if not open_ones:
            return None
        tallies = self.totals.tallies
        name = min(
            open_ones,
            key=lambda name: (
                tallies[name].seconds / open_ones[name].weight if name in tallies else -1.0,
                self._given[name],
            ),
        )
        rate = tallies[name].rate if name in tallies else 0.0
        most = min(2000, max(20, int(rate * _ROUND)))
        examples = min(most, self._options.examples - self._given[name])
        self._given[name] += examples
        return Task(name, self._chance.getrandbits(62), examples)

    def _is_open(self, name: str) -> bool:
        tally = self.totals.tallies.get(name)
        return self._given[name] < self._options.examples and (
            tally is None or tally.failures < _ENOUGH
        )

    def _collect(self, busy: list[Worker]) -> None:
        """Wait for a round to end, or for one to take too long."""
        ready = wait([worker.connection for worker in busy], timeout=5)
        for worker in list(busy):
            hung = time.monotonic() - worker.since > _HUNG
            if worker.connection not in ready and not hung:
                continue
            found = worker.take() if worker.connection in ready else None
            if found is None:
                found, again = worker.buried("it hung" if hung else "the process ended")
                self._again += [again] if again else []
            busy.remove(worker)
            self._note(found)

    def _note(self, found: Round) -> None:
        self.totals.wall += found.wall
        new = self.totals.add(found)
        kept = {failure.file for failure in self.totals.failures.values()}
        for failure in found.failures:
            if failure.file and failure.file not in kept:  # one of a kind is enough
                Path(failure.file).unlink(missing_ok=True)
        for failure in new:
            print(f"FAILED {failure.name}: {failure.kind}\n  kept in {failure.file}", flush=True)
            if self._options.log:
                path = self._options.log / f"failure-{failure.name}-{time.time_ns()}.txt"
                self._options.log.mkdir(parents=True, exist_ok=True)
                path.write_text(f"{failure.file}\n\n{failure.text}", "utf-8", "replace")
        tally = self.totals.tallies[found.name]
        print(
            f"{time.strftime('%H:%M:%S')} {found.name}: {tally.examples:,} examples, "
            f"{tally.rate:.1f} a second",
            flush=True,
        )
        self._save()

    def _save(self) -> None:
        if self._file:
            self._file.parent.mkdir(parents=True, exist_ok=True)
            self.totals.save(self._file)


if __name__ == "__main__":
    raise SystemExit(main())
