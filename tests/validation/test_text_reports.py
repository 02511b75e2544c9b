"""The reports that people read: excerpts with a mark, groups, what was left out, the sums."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rich.cells import cell_len
from tests.validation.results import checked, finding

from colladaphy.findings import Severity
from colladaphy.source import pack
from colladaphy.validation import all_rules
from colladaphy.validation.checking import Checked, Job, check
from colladaphy.validation.reporters import Presentation, reporter
from colladaphy.validation.reporters.excerpts import excerpt, wanted_lines
from colladaphy.validation.reporters.sources import Sources
from colladaphy.validation.settings import Settings

DOCUMENT = """<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2008/03/COLLADASchema" version="1.5.0">
  <asset><created>2010-01-01T00:00:00Z</created><modified>2010-01-01T00:00:00Z</modified></asset>
\t<library_nodes><node id="ä" wrong="1"/><node
     id="b"
     wrong="x &gt; > y"/>
  </library_nodes>
</COLLADA>
"""


def shown(form: str, results: list[Checked], **values: object) -> list[str]:
    lines = reporter(form)(results, Presentation(**values))  # type: ignore[arg-type]
    return "\n".join(lines).split("\n")


def test_the_full_report(tmp_path: Path) -> None:
    path = tmp_path / "a.dae"
    path.write_text(DOCUMENT, "utf-8")
    lines = shown("full", [check(Job(str(path), Settings()))])
    at = lines.index('4 |     <library_nodes><node id="ä" wrong="1"/><node')
    assert lines[at - 2].startswith(f"{path}:4:17: error: ")
    assert lines[at - 2].endswith("[schema-unknown-attribute, mendable]") or lines[at - 2].endswith(
        "[schema-unknown-attribute]"
    )
    assert lines[at - 1] == "  |"
    assert lines[at + 1] == "  | " + " " * 32 + "^" * len('wrong="1"')
    assert lines[at + 2].startswith("  = at: /COLLADA/library_nodes/node[1]")
    # The attribute of the second stands two lines below its element.
    at = lines.index('6 |      wrong="x &gt; > y"/>')
    assert lines[at - 2].startswith("4 | ") and lines[at - 1] == '5 |      id="b"'
    assert lines[at + 1] == "  |      " + "^" * len('wrong="x &gt; > y"')
    assert lines[-1] == f"{path}: not valid (2 errors)"


def test_excerpts_of_archives_and_of_standard_input(tmp_path: Path) -> None:
    path = tmp_path / "a.zae"
    path.write_bytes(pack(DOCUMENT.encode(), name="in/b.dae"))
    lines = shown("full", [check(Job(str(path), Settings()))])
    assert lines[0].startswith(f"{path}!in/b.dae:4:17: error: ")
    assert any("^^^" in line for line in lines)
    data = DOCUMENT.encode()
    sources = Sources({"piped.dae": data})
    lines = shown("full", [check(Job("piped.dae", Settings(), data))], sources=sources)
    assert lines[0].startswith("piped.dae:4:17: ") and any("^^^" in line for line in lines)


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "latin-1"])
def test_lines_are_read_in_the_encoding_of_the_document(tmp_path: Path, encoding: str) -> None:
    path = tmp_path / "a.dae"
    name = encoding.removesuffix("-sig")
    path.write_bytes(DOCUMENT.replace('encoding="utf-8"', f'encoding="{name}"').encode(encoding))
    lines = Sources().lines(str(path), [1, 4, 99])
    assert lines[4] == '\t<library_nodes><node id="ä" wrong="1"/><node'
    assert lines[1].startswith("<?xml") and 99 not in lines


def test_files_that_are_gone_have_no_excerpt(tmp_path: Path) -> None:
    assert Sources().lines(str(tmp_path / "none.dae"), [1]) == {}
    assert Sources().lines(str(tmp_path / "none.zae!a.dae"), [1]) == {}
    assert excerpt(finding(line=3, column=1), {}) == []
    assert excerpt(finding(), {1: "x"}) == []
    assert list(wanted_lines(finding())) == []


@given(
    st.lists(st.text(st.characters(exclude_characters="\r\n"), max_size=300), min_size=8,
             max_size=8),
    st.integers(1, 3),
    st.none() | st.integers(1, 350),
    st.none() | st.sampled_from(["id", "x", "{urn:x}y"]),
)  # fmt: skip
def test_the_mark_is_below_the_place(
    texts: list[str], line: int, column: int | None, attribute: str | None
) -> None:
    found = finding(line=line, column=column, attribute=attribute)
    lines = dict(enumerate(texts, 1))
    *before, (number, text), (none, mark) = excerpt(found, lines)
    assert number is not None and none is None
    assert [row for row, _ in before] == list(range(line, number))
    assert mark.strip(" ") == "^" * (len(mark) - len(mark.rstrip("^"))) != ""
    assert (text + " ").isprintable() and cell_len(text) < 1000
    if attribute is None and column is not None and column <= len(texts[line - 1]):
        # What is above the mark is what stands at that column.
        above = texts[line - 1][column - 1]
        at = len(mark) - len(mark.lstrip(" "))
        cells = [char for char in text for _ in range(cell_len(char))]
        if above.isprintable() and above != " " and cell_len(above) == 1 and len(cells) > at:
            assert cells[at] == above


@pytest.mark.parametrize(
    ("text", "mark"),
    [
        ("""<node name="x id='y'" id="b"/>""", 'id="b"'),
        ("""<node pe:id = 'b' a=">"/>""", "pe:id = 'b'"),
        ("""<node sid="a" name=">" id='b'>""", "id='b'"),
        ("""<node/><node id="b"/>""", "<node"),
        ("<node\u00e4 id=''/>", "id=''"),
    ],
)
def test_the_attribute_is_found_in_its_tag(text: str, mark: str) -> None:
    (_, row), (_, below) = excerpt(finding(line=1, column=1, attribute="id"), {1: text})
    assert row[below.index("^") : len(below)] == mark


def test_attributes_on_lines_of_their_own() -> None:
    lines = {1: "<node", 2: 'name="two', 3: "id='no'", 4: 'lines"', 5: 'id="b">', 6: 'id="c"'}
    *_, (number, _), (_, mark) = excerpt(finding(line=1, column=1, attribute="name"), lines)
    assert (number, mark) == (2, "^" * len('name="two'))
    *_, (number, _), (_, mark) = excerpt(finding(line=1, column=1, attribute="sid"), lines)
    assert (number, mark) == (1, "^" * len("<node"))


def test_long_lines_are_cut_around_the_mark() -> None:
    text = "<a/>" * 500 + '<node id="here"/>' + "<b/>" * 500
    (_, row), (_, mark) = excerpt(finding(line=1, column=2001, attribute="id"), {1: text})
    assert len(row) < 110 and row.startswith("…") and row.endswith("…")
    assert row[mark.index("^") :].startswith('id="here"/>')
    assert mark.strip() == "^" * len('id="here"')


@pytest.mark.parametrize("form", ["full", "concise"])
def test_equal_findings_are_grouped_and_capped(form: str) -> None:
    many = [finding(line=line, message=f"Fault {line}.") for line in range(1, 27)]
    other = finding("physics-mass-value", severity=Severity.WARNING, line=2)
    result = checked(*many[:1], other, *many[1:])
    lines = shown(form, [result], most=3)
    heads = [line for line in lines if line.startswith("a.dae:")]
    assert [head.partition(": ")[0] for head in heads[:3]] == ["a.dae:1", "a.dae:2", "a.dae:3"]
    (more,) = [line for line in lines if "more like it" in line]
    assert "… and 23 more like it (lines 4, 5, 6, 7, 8, …) [link-missing]" in more
    assert lines.index(more) < lines.index(next(line for line in lines if "physics-mass" in line))
    everything = shown(form, [result], most=None)
    assert sum("Fault" in line for line in everything) == 26
    assert not any("more like it" in line for line in everything)


def test_what_is_alike_in_a_group_is_said_once() -> None:
    found = [finding(hint="Do this.", why="It breaks.", line=line) for line in (1, 2)]
    other = finding(hint="Do that.", why="It breaks.", line=3)
    lines = shown("full", [checked(*found, other)])
    assert [line.strip() for line in lines if "help:" in line] == [
        "= help: Do this.",
        "= help: Do that.",
    ]
    assert sum("why:" in line for line in lines) == 1


def test_the_sums() -> None:
    faults = [finding(repair="repair-url-hash"), finding(repair="repair-url-hash"),
              finding("physics-mass-value", severity=Severity.WARNING)]  # fmt: skip
    results = [checked(*faults), checked(file="b.dae"), checked(finding("io-missing"), file="c",
               readable=False), checked(file="d.dae", ignored=4, known=5)]  # fmt: skip
    *_, verdict, said, unread, clean, sums = shown("concise", results)
    assert said == "c: error: It is wrong. [io-missing]"
    assert verdict == "b.dae: valid"
    assert unread == "c: cannot be read (1 error)"
    assert clean == "d.dae: valid (4 left out by the configuration, 5 known from the baseline)"
    assert sums == (
        "4 files: 2 valid, 1 not, 1 unreadable; 4 findings of 3 kinds, 2 mendable; "
        "4 left out by the configuration; 5 known from the baseline"
    )


@pytest.mark.parametrize("form", ["full", "concise"])
def test_statistics_take_the_place_of_findings(form: str) -> None:
    faults = [finding("physics-mass-value"), *[finding(repair="repair-url-hash")] * 12]
    summaries = {rule.code: rule.summary for rule in all_rules()}
    assert shown(form, [checked(*faults), checked(file="b.dae")], statistics=True) == [
        f"12  link-missing        [*] {summaries['link-missing']}",
        f" 1  physics-mass-value      {summaries['physics-mass-value']}",
        "[*] 'colladaphy repair IN OUT' mends 12 of them.",
        "2 files: 1 valid, 1 not; 13 findings of 2 kinds, 12 mendable",
    ]


@pytest.mark.parametrize("form", ["full", "concise"])
def test_quiet_reports_have_findings_only(form: str) -> None:
    results = [checked(finding()), checked(file="b.dae")]
    lines = [line for line in shown(form, results, quiet=True) if line]
    assert lines == ["a.dae: error: It is wrong. [link-missing]"]
