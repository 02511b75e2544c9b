"""Many documents at once: in order, and whatever becomes of one of them."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path

import pytest

from colladaphy.validation import stages
from colladaphy.validation.checking import Job, check, check_all
from colladaphy.validation.settings import Settings

VALID = b"""<COLLADA xmlns="http://www.collada.org/2008/03/COLLADASchema" version="1.5.0">
<asset><created>2010-01-01T00:00:00Z</created><modified>2010-01-01T00:00:00Z</modified></asset>
</COLLADA>"""


def jobs(count: int) -> list[Job]:
    return [Job(f"{number}.dae", Settings(), VALID) for number in range(count)]


@pytest.mark.parametrize("workers", [1, 2, 9])
def test_results_come_in_the_order_of_the_jobs(workers: int) -> None:
    mixed = [Job(f"{n}.dae", Settings(), VALID[: -n or None]) for n in (0, 3, 0, 50)]
    results = list(check_all(mixed, workers))
    assert [result.report.file for result in results] == ["0.dae", "3.dae", "0.dae", "50.dae"]
    assert [result.report.valid for result in results] == [True, False, True, False]
    assert all(
        finding.file == result.report.file for result in results for finding in result.report
    )


def test_a_file_that_takes_too_much_memory_stops_no_other(monkeypatch: pytest.MonkeyPatch) -> None:
    def hungry(source: bytes, **_: object) -> None:
        raise MemoryError

    with monkeypatch.context() as patch:
        patch.setattr(stages, "validate", hungry)
        (result,) = check_all(jobs(1))
    assert not result.readable
    assert [finding.code for finding in result.report] == ["io-unreadable"]
    assert check(jobs(1)[0]).report.valid


def test_processes_that_die_leave_no_file_unmentioned(monkeypatch: pytest.MonkeyPatch) -> None:
    class Dying:
        def __init__(self, *_: object, **__: object) -> None:
            self.stopped = False

        def map(self, work: object, todo: list[Job]) -> Iterator[object]:
            yield check(todo[0])
            raise BrokenProcessPool

        def shutdown(self, **_: object) -> None:
            self.stopped = True

    monkeypatch.setattr("concurrent.futures.ProcessPoolExecutor", Dying)
    results = list(check_all(jobs(3), 2))
    assert [result.report.file for result in results] == ["0.dae", "1.dae", "2.dae"]
    assert [result.readable for result in results] == [True, False, False]
    assert all("not checked" in result.report.findings[0].message for result in results[1:])


@pytest.mark.skipif(sys.platform == "win32", reason="signals of consoles are others there")
def test_stopped_by_hand(tmp_path: Path) -> None:
    nodes = b"<library_nodes>" + b'<node a="1"/>' * 3_000 + b"</library_nodes></COLLADA>"
    for number in range(10, 40):
        (tmp_path / f"{number}.dae").write_bytes(VALID.replace(b"</COLLADA>", nodes))
    process = subprocess.Popen(
        [sys.executable, "-m", "colladaphy", "validate", ".", "-j", "2", "--format", "concise"],
        cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True,
        # Where the tests run in the background, the signal may be ignored.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )  # fmt: skip
    assert process.stdout is not None
    assert process.stdout.readline().startswith(b"10.dae:3:")  # so all processes have begun
    os.killpg(process.pid, signal.SIGINT)
    out, err = process.communicate(timeout=120)
    assert process.returncode == 130 and b"39.dae" not in out
    assert b"Stopped." in err and b"Traceback" not in err
