"""Baselines know findings by their elements, whatever happens to lines and siblings."""

from __future__ import annotations

import json
import tempfile
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.validation.results import checked, checks, finding

from colladaphy.errors import ConfigurationError
from colladaphy.validation.baseline import Baseline, baseline_text
from colladaphy.validation.checking import Checked, Job, check
from colladaphy.validation.settings import Settings

HEAD = """<COLLADA xmlns="http://www.collada.org/2008/03/COLLADASchema" version="1.5.0">
<asset><created>2010-01-01T00:00:00Z</created><modified>2010-01-01T00:00:00Z</modified></asset>
<library_nodes>
"""
TAIL = "</library_nodes></COLLADA>"


def document(*nodes: str) -> str:
    return HEAD + "\n".join(nodes) + TAIL


def run(path: Path, text: str) -> Checked:
    path.write_text(text, "utf-8")
    return check(Job(str(path), Settings()))


@given(st.lists(checks(), max_size=4))
def test_what_was_written_is_known(results: list[Checked]) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "known.json"
        path.write_text(baseline_text(results, path), "utf-8")
        known = Baseline.read(path)
        for result in results:
            left = known.apply(result)
            assert len(left.report) == (0 if result.readable else len(result.report))
            assert not result.readable or left.known == len(result.report)
        assert known.gone == 0
        # Once more is more often than it was there.
        for result in results:
            assert known.apply(result).report == result.report


def test_lines_and_siblings_may_move(tmp_path: Path) -> None:
    path, known = tmp_path / "a.dae", tmp_path / "known.json"
    faulty = '<node id="x" wrong="1"/>'
    before = run(path, document(faulty))
    assert len(before.report) == 1
    known.write_text(baseline_text([before], known), "utf-8")
    for text in (
        document("<!-- one -->", "<!-- two -->", faulty),
        document('<node id="first"/>', faulty),
        document('<node id="first"/>', faulty, '<node id="last"/>'),
    ):
        after = run(path, text)
        assert after.report.findings[0].line != before.report.findings[0].line or "last" in text
        baseline = Baseline.read(known)
        assert baseline.apply(after).report.findings == []
        assert baseline.gone == 0


def test_the_new_one_among_siblings_is_told(tmp_path: Path) -> None:
    path, known = tmp_path / "a.dae", tmp_path / "known.json"
    fault = '<node id="{}" wrong="1"/>'
    known.write_text(
        baseline_text([run(path, document(fault.format("a"), '<node id="b"/>'))], known), "utf-8"
    )
    after = run(path, document(fault.format("a"), fault.format("b")))
    left = Baseline.read(known).apply(after)
    assert [found.path for found in left.report] == ["/COLLADA/library_nodes/node[2]"]
    assert (left.known, left.failed) == (1, True)


@pytest.mark.parametrize(
    "other",
    [
        finding("link-wrong-type", path="/COLLADA/a", attribute="url"),
        finding(path="/COLLADA/b", attribute="url"),
        finding(path="/COLLADA/a", attribute="id"),
        finding(path="/COLLADA/a", attribute="url", message="Another."),
        finding(path="/COLLADA/a", attribute="url", file="b.dae"),
    ],
)
def test_what_differs_is_not_known(tmp_path: Path, other: object) -> None:
    path = tmp_path / "known.json"
    known = finding(path="/COLLADA/a", attribute="url", message="It leads to line 7.")
    path.write_text(baseline_text([checked(known)], path), "utf-8")
    baseline = Baseline.read(path)
    assert len(baseline.apply(checked(other)).report) == 1  # type: ignore[arg-type]
    assert baseline.gone == 1
    again = finding(path="/COLLADA/a", attribute="url", message="It leads to line 90.", line=3)
    assert len(baseline.apply(checked(again)).report) == 0


def test_the_file_is_sorted_and_named_from_its_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "sub" / "known.json"
    results = [checked(finding(), finding(), file="b.dae"), checked(finding(), file="a.dae")]
    text = baseline_text(results, path)
    assert text == baseline_text(results[::-1], path)
    entries = json.loads(text)["findings"]
    assert [(entry["file"], entry["count"]) for entry in entries] == [
        ("../a.dae", 1),
        ("../b.dae", 2),
    ]
    assert len(text.splitlines()) == len(entries) + 5


def test_findings_that_are_gone_are_counted_for_files_that_were_checked(tmp_path: Path) -> None:
    path = tmp_path / "known.json"
    results = [checked(finding(), finding(), file="a.dae"), checked(finding(), file="b.dae")]
    path.write_text(baseline_text(results, path), "utf-8")
    baseline = Baseline.read(path)
    baseline.apply(checked(finding(), file="a.dae"))
    assert baseline.gone == 1


@pytest.mark.parametrize(
    "text",
    ["", "[]", "{}", '{"version": 2, "findings": []}', '{"version": 1}',
     '{"version": 1, "findings": [{"code": "x"}]}', '{"version": 1, "findings": [3]}',
     '{"version": 1, "findings": [{"code": 1, "file": "", "path": "", "attribute": "", '
     '"message": "", "count": 1}]}', "[" * 100_000],
)  # fmt: skip
def test_what_is_no_baseline(tmp_path: Path, text: str) -> None:
    path = tmp_path / "known.json"
    path.write_text(text, "utf-8")
    with pytest.raises(ConfigurationError) as caught:
        Baseline.read(path)
    (found,) = caught.value.findings
    assert (found.code, found.file) == ("config-baseline-broken", str(path))


def test_a_baseline_that_is_missing(tmp_path: Path) -> None:
    with pytest.raises(ConfigurationError, match="config-baseline-unreadable"):
        Baseline.read(tmp_path / "none.json")
