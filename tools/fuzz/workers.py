"""Processes that run rounds, and what becomes of one that ends or hangs."""

from __future__ import annotations

import multiprocessing
import tempfile
import time
import traceback
import warnings
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path

from tools.fuzz.registry import all_properties
from tools.fuzz.rounds import Failure, Round, limit_memory, run

__all__ = ["Task", "Worker"]

_CONTEXT = multiprocessing.get_context("spawn")


@dataclass(frozen=True)
class Task:
    """A round that a worker is to run; `careful` where another did not outlive it."""

    name: str
    seed: int
    examples: int
    careful: bool = False


class Worker:
    """A process that runs one task after another."""

    def __init__(self, folder: Path, memory: int) -> None:
        self._folder, self._memory = folder, memory
        self.task: Task | None = None
        self._start()

    def _start(self) -> None:
        self.connection, other = _CONTEXT.Pipe()
        self.current = Path(tempfile.mkdtemp(prefix="fuzz-"))
        arguments = (other, self._folder, self.current, self._memory)
        self._process = _CONTEXT.Process(target=_work, args=arguments, daemon=True)
        self._process.start()
        other.close()

    def give(self, task: Task) -> None:
        """Start a task; its round will come through the connection."""
        self.task, self.since = task, time.monotonic()
        self.connection.send(task)

    def take(self) -> Round | None:
        """The round of the task that ended; None if the process ended with it."""
        try:
            found: Round | str = self.connection.recv()
        except EOFError:
            return None
        if isinstance(found, str):
            raise RuntimeError(found)
        return found

    def buried(self, why: str) -> tuple[Round, Task | None]:
        """End the process, start another, and say what to do about the task.

        A task that was run with care is a failure; another is to be run again with care.
        """
        task = self.task
        assert task is not None
        self._process.kill()
        self._process.join()
        code = self._process.exitcode
        found, again = Round(task.name), None
        kept = list(self.current.iterdir())
        if task.careful:
            newest = max(
                self.current.glob("*.json"), key=lambda path: path.stat().st_mtime, default=None
            )
            file = None
            if newest is not None:
                self._folder.mkdir(parents=True, exist_ok=True)
                file = self._folder / newest.name
                file.write_bytes(newest.read_bytes())
            text = f"{why}; exit code {code}"
            found.failures.append(Failure(task.name, why, text, file and str(file)))
        else:
            again = Task(task.name, task.seed, task.examples, careful=True)
        for path in kept:
            path.unlink()
        self.current.rmdir()
        self._start()
        return found, again

    def end(self) -> None:
        """End the process."""
        self._process.kill()
        self._process.join()
        for path in self.current.iterdir():
            path.unlink()
        self.current.rmdir()


def _work(connection: Connection, folder: Path, current: Path, memory: int) -> None:
    limit_memory(memory)
    warnings.simplefilter("error")
    properties = all_properties()
    while True:
        try:
            task: Task = connection.recv()
        except EOFError:
            return
        try:
            prop = properties[task.name]
            careful = current if task.careful else None
            connection.send(run(prop, task.seed, task.examples, folder, careful))
        except Exception:
            connection.send(traceback.format_exc())
