"""The fuzzer itself: it finds faults that were planted, keeps them, and outlives what ends it."""

from __future__ import annotations

import json
import math
import os
import signal
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lxml import etree
from tools.fuzz import __main__ as program
from tools.fuzz import keeping, registry
from tools.fuzz.registry import Property, note
from tools.fuzz.rounds import SECONDS, OverTimeError, bounded, run
from tools.fuzz.totals import Totals, merged
from tools.fuzz.workers import Task, Worker

from colladaphy.testing import covering_documents, worlds
from colladaphy.world import World, compare


@settings(max_examples=30)
@given(worlds())
def test_worlds_are_kept_to_the_bit(world: World) -> None:
    kept = json.loads(json.dumps(keeping.plain(world)))
    assert compare(world, keeping.value_of(kept), unused_materials=True) == []


def test_values_are_kept_with_their_types(tmp_path: Path) -> None:
    values = (1, -0.0, math.inf, None, True, b"\xff", b"text\n", ("a", [1]), {"k": (2,)},
              frozenset({"x"}), "\ud800")  # fmt: skip
    path = keeping.keep(tmp_path, "some-name", values, "why")
    name, read = keeping.read(path)
    assert (name, repr(read)) == ("some-name", repr(values))
    assert path.name.startswith("some-name-")
    with pytest.raises(TypeError, match="object cannot be kept"):
        keeping.plain(object())


def numbers(check: Callable[[int], None]) -> Property:
    return Property("planted", lambda: st.tuples(st.integers(0, 10**6)), check)


def test_a_planted_fault_is_found_shrunk_and_kept(tmp_path: Path) -> None:
    def check(value: int) -> None:
        """Numbers are small."""
        assert value < 1000

    prop = numbers(check)
    found = run(prop, 1, 200, tmp_path)
    (failure,) = found.failures
    assert failure.kind == "AssertionError at test_fuzzing.py:check"
    assert failure.file is not None and keeping.read(Path(failure.file)) == ("planted", (1000,))
    assert "assert value < 1000" in failure.text
    assert prop.about == "Numbers are small."
    assert run(numbers(lambda value: None), 1, 200, tmp_path).examples == 200


def test_the_values_are_kept_as_they_were_given(tmp_path: Path) -> None:
    def check(values: list[int]) -> None:
        values.clear()
        raise ZeroDivisionError

    prop = Property("planted", lambda: st.tuples(st.lists(st.integers(), min_size=2)), check)
    (failure,) = run(prop, 1, 20, tmp_path).failures
    assert failure.file is not None and keeping.read(Path(failure.file))[1] == ([0, 0],)


def test_what_takes_too_long_is_a_failure(tmp_path: Path) -> None:
    assert SECONDS >= 5
    with pytest.raises(OverTimeError), bounded(0.1):
        while True:
            pass
    assert signal.getitimer(signal.ITIMER_PROF) == (0.0, 0.0)


def test_documents_codes_and_rejections_are_counted(tmp_path: Path) -> None:
    from hypothesis import assume

    from colladaphy.links import rules

    document = next(iter(covering_documents()))

    def check(value: int) -> None:
        assume(value % 2)
        note(document)
        rules.MISSING.at(message="x")

    found = run(numbers(check), 1, 40, tmp_path)
    assert found.codes["link-missing"] == found.documents == found.examples - found.rejected > 0
    assert found.rejected and {str(each) for each in found.components} >= {"COLLADA/asset"}
    totals = Totals()
    assert totals.add(found) == []
    totals.save(tmp_path / "a.json")
    lines = "\n".join(merged([tmp_path / "a.json"] * 2).lines())
    assert f"{2 * found.examples}" in lines and f"{2 * found.rejected}" in lines


@pytest.fixture
def planted(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """A module of properties with faults, in place of ours; also in the processes."""
    monkeypatch.setenv("COLLADAPHY_FUZZ_MODULES", "tests.fuzz.planted")
    registry.all_properties.cache_clear()
    yield
    registry.all_properties.cache_clear()


def fuzz(tmp_path: Path, *more: str) -> int:
    return program.main(
        ["--processes", "2", "--regressions", str(tmp_path / "kept"), "--log",
         str(tmp_path / "log"), "--seed", "1", "--examples", "60", *more]
    )  # fmt: skip


def test_processes_share_the_work(
    planted: None, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert fuzz(tmp_path, "--only", "holds,holds-too") == 0
    said = capsys.readouterr().out
    assert "holds: 60 examples" in said and "holds-too: 60 examples" in said
    assert not (tmp_path / "kept").exists()
    (totals,) = (tmp_path / "log").glob("totals-*.json")
    assert program.main(["--sum", str(totals)]) == 0
    assert " 120 " in capsys.readouterr().out


@pytest.mark.parametrize(
    ("name", "why"),
    [("fails", "AssertionError"), ("ends", "the process ended"), ("fills-memory", "MemoryError")],
)
def test_what_fails_is_kept_and_told(
    planted: None, tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str, why: str
) -> None:
    assert fuzz(tmp_path, "--only", name, "--memory", "1.5") == 1
    assert f"FAILED {name}: {why}" in capsys.readouterr().out
    (path,) = (tmp_path / "kept").glob("*.json")  # one of a kind
    kept, values = keeping.read(path)
    assert kept == name and values[0] >= 3
    assert list((tmp_path / "log").glob(f"failure-{name}-*.txt"))


def test_time_can_be_up(planted: None, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert fuzz(tmp_path, "--minutes", "0", "--only", "holds") == 0
    assert "examples," not in capsys.readouterr().out


def test_a_hang_is_ended(planted: None, tmp_path: Path) -> None:
    worker = Worker(tmp_path, 2**31)
    worker.give(Task("hangs", 1, 5, careful=True))
    while not list(worker.current.glob("*.json")):
        os.sched_yield()
    found, again = worker.buried("it hung")
    worker.end()
    assert again is None
    (failure,) = found.failures
    assert failure.kind == "it hung" and failure.file is not None
    assert keeping.read(Path(failure.file))[0] == "hangs"


def test_unknown_names_are_refused(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        program.main(["--only", "nonsense"])
    assert "no property nonsense" in capsys.readouterr().err
    assert program.main(["--list"]) == 0
    assert "world-file: World" in capsys.readouterr().out


def test_every_property_says_what_holds() -> None:
    found = registry.all_properties()
    assert len(found) > 20
    assert all(prop.about for prop in found.values())


def test_properties_are_not_empty() -> None:
    """Each draws more than one value, and such as can be kept."""

    def draw(values: Any) -> list[Any]:
        seen: list[Any] = []

        @settings(max_examples=4, database=None, derandomize=True)
        @given(values)
        def collect(value: tuple[Any, ...]) -> None:
            seen.append(json.dumps([keeping.plain(each) for each in value]))

        collect()
        return seen

    for name, prop in registry.all_properties().items():
        assert len(set(draw(prop.values()))) > 1, name


def test_documents_that_are_no_xml_are_not_counted(tmp_path: Path) -> None:
    found = run(numbers(lambda value: note(b"<")), 1, 5, tmp_path)  # type: ignore[arg-type, return-value]
    assert found.documents == 5 and found.components == set()
    with pytest.raises(etree.XMLSyntaxError):
        etree.fromstring(b"<")
