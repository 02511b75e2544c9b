"""Validation reports everything about bad content, and raises only where nothing can be read."""

from __future__ import annotations

import io
import json
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

import colladaphy
from colladaphy import Limits, Severity, validate
from colladaphy.errors import ColladaError, InputError
from colladaphy.source import pack
from colladaphy.validation.reporters import as_json, as_text, changes

VALID = b"""<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2008/03/COLLADASchema" version="1.5.0">
  <asset><created>2010-01-01T00:00:00Z</created><modified>2010-01-01T00:00:00Z</modified></asset>
  <library_physics_models>
    <physics_model id="model">
      <rigid_body sid="ball"><technique_common>
        <shape><density>1</density><sphere><radius>1</radius></sphere></shape>
      </technique_common></rigid_body>
      <rigid_constraint sid="joint">
        <ref_attachment rigid_body="model/ball"/><attachment rigid_body=""/>
        <technique_common/>
      </rigid_constraint>
    </physics_model>
  </library_physics_models>
  <library_physics_scenes>
    <physics_scene id="scene">
      <instance_physics_model url="#model" parent="#node">
        <instance_rigid_body body="ball" target="#node"><technique_common/></instance_rigid_body>
        <instance_rigid_constraint constraint="joint"/>
      </instance_physics_model>
      <technique_common/>
    </physics_scene>
  </library_physics_scenes>
  <library_visual_scenes><visual_scene id="view"><node id="node"/></visual_scene>
  </library_visual_scenes>
  <scene><instance_physics_scene url="#scene"/><instance_visual_scene url="#view"/></scene>
</COLLADA>
"""


def codes(data: bytes) -> list[str]:
    return [finding.code for finding in validate(data)]


def test_a_valid_document() -> None:
    assert [str(finding) for finding in validate(VALID)] == []
    assert validate(VALID).valid
    assert validate(io.BytesIO(VALID)).valid
    assert validate(pack(VALID)).valid


@pytest.mark.parametrize(
    ("old", "new", "code", "words"),
    [
        (b'url="#model"', b'url="#none"', "link-missing", "none"),
        (b'url="#model"', b'url="#node"', "link-wrong-type", "<node>"),
        (b'parent="#node"', b'parent="#none"', "link-missing", "none"),
        (b'target="#node"', b'target="#model"', "link-wrong-type", "<physics_model>"),
        (b'url="#model"', b'url=""', "link-missing", "empty"),
        (b'body="ball"', b'body="none"', "link-missing", "none"),
        (b'constraint="joint"', b'constraint="ball"', "link-missing", "rigid_constraint"),
        (b'rigid_body="model/ball"', b'rigid_body="model/none"', "link-missing", "none"),
        (b'rigid_body="model/ball"', b'rigid_body="#model"', "link-wrong-type", "model"),
        (b'url="#scene"', b'url="#none"', "link-missing", "none"),
        (b'<node id="node"/>', b'<node id="node"/><node id="node"/>', "schema-duplicate-id", ""),
        (b"<radius>1<", b"<radius>x<", "schema-invalid-value", "radius"),
        (b"</COLLADA>", b"", "xml-truncated", ""),
    ],
)
def test_what_is_wrong_is_found(old: bytes, new: bytes, code: str, words: str) -> None:
    assert old in VALID
    report = validate(VALID.replace(old, new))
    assert {finding.code for finding in report.errors} == {code}
    assert words in report.errors[0].message
    assert not report.valid
    with pytest.raises(ColladaError):  # what is an error here is refused by strict loading
        colladaphy.read(VALID.replace(old, new)).load()


@pytest.mark.parametrize("number", ["1e", "2.5E+", "-3.e-", " 1e "])
def test_numbers_with_half_an_exponent(number: str) -> None:
    """libxml2 lets them pass; the standard's lexical form does not."""
    report = validate(VALID.replace(b"<radius>1<", f"<radius>{number}<".encode()))
    (finding,) = report.errors
    assert (finding.code, finding.line) == ("schema-invalid-value", 7)
    assert f"'{number}'" in finding.message


@pytest.mark.parametrize(
    "harmless", [b'<node id="node" name="1e"/>', b'<node id="node" name="a 2e+ b"/><!-- 1e -->']
)
def test_names_may_look_like_half_a_number(harmless: bytes) -> None:
    assert codes(VALID.replace(b'<node id="node"/>', harmless)) == []


@pytest.mark.parametrize(
    "number",
    ["1_0", "١", "+INF", "nan", "Infinity", "0x10", ".", "1,5", "1d5", "--1", "\u00a01", "", "e5"],
)
def test_only_the_standards_spelling_of_numbers(number: str) -> None:
    assert codes(VALID.replace(b"<radius>1<", f"<radius>{number}<".encode())) == [
        "schema-invalid-value"
    ]


@pytest.mark.parametrize("number", ["INF", "-INF", "NaN", "1.", ".5", "+1", "1e999", " 1E-5\n"])
def test_all_of_the_standards_spelling_of_numbers(number: str) -> None:
    found = codes(VALID.replace(b"<radius>1<", f"<radius>{number}<".encode()))
    assert [code for code in found if code.startswith("schema-")] == []


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (b'url="#view"', b'url="#none"'),
        (b'target="#node"', b'target=""'),
        (
            b"<density>1</density><sphere><radius>1</radius></sphere>",
            b'<density>1</density><instance_geometry url="#none"/>',
        ),
    ],
)
def test_references_that_loading_can_do_without_are_warnings(old: bytes, new: bytes) -> None:
    report = validate(VALID.replace(old, new))
    assert report.valid
    assert [(finding.code, finding.severity) for finding in report] == [
        ("link-missing", Severity.WARNING)
    ]
    colladaphy.read(VALID.replace(old, new)).load()


def test_nested_models_in_a_circle_and_in_a_tower() -> None:
    """Models that instance each other must neither hang the check nor blow it up."""
    models = "".join(
        f'<physics_model id="m{i}">'
        + f'<instance_physics_model url="#m{(i + 1) % 60}"/>' * 2
        + "</physics_model>"
        for i in range(60)
    )
    data = VALID.replace(
        b"</library_physics_models>", models.encode() + b"</library_physics_models>"
    )
    assert validate(data.replace(b'url="#model"', b'url="#m0"')).errors
    assert codes(data) == ["link-cycle"]


@given(
    st.integers(0, len(VALID) - 1),
    st.integers(0, 40),
    st.one_of(st.binary(max_size=3), st.sampled_from([b'"', b"<", b"#", b"/", b" ", b"&#0;"])),
)
def test_damage_is_reported_and_never_raised(at: int, length: int, junk: bytes) -> None:
    report = validate(VALID[:at] + junk + VALID[at + length :])
    assert report.valid or all(finding.hint for finding in report.errors)


def test_references_in_techniques_are_left_alone() -> None:
    extra = (
        b'<extra><technique profile="X"><instance_geometry url="#none"/></technique></extra>'
        b"</COLLADA>"
    )
    assert codes(VALID.replace(b"</COLLADA>", extra)) == []


def test_references_to_other_files(tmp_path: Path) -> None:
    (tmp_path / "other.dae").write_bytes(VALID)
    path = tmp_path / "main.dae"

    def errors(reference: bytes) -> list[str]:
        path.write_bytes(VALID.replace(b'url="#model"', b'url="' + reference + b'"'))
        return [finding.code for finding in validate(path).errors]

    assert errors(b"other.dae#model") == []
    assert errors(b"other.dae#none") == ["link-missing"]
    assert errors(b"none.dae#model") == []
    (finding,) = validate(path).findings
    assert finding.code == "io-reference-missing" and finding.line
    assert errors(b"http://example.org/other.dae#model") == []
    (finding,) = validate(path).findings
    assert finding.code == "io-reference-refused" and finding.line


def test_the_file_of_an_image_is_no_folder(tmp_path: Path) -> None:
    library = (
        b"<library_images><image><init_from><ref>wood</ref></init_from></image></library_images>"
    )
    path = tmp_path / "a.dae"
    path.write_bytes(VALID.replace(b"</asset>", b"</asset>" + library, 1))
    (tmp_path / "wood").mkdir()
    assert [finding.code for finding in colladaphy.validate(path)] == ["link-image-missing"]
    (tmp_path / "wood").rmdir()
    (tmp_path / "wood").touch()
    assert not list(colladaphy.validate(path))


def test_documents_that_references_lead_to_must_be_loadable(tmp_path: Path) -> None:
    path, other = tmp_path / "main.dae", tmp_path / "other.dae"
    path.write_bytes(VALID.replace(b'url="#model"', b'url="other.dae#model"'))
    other.write_bytes(VALID)
    assert [str(finding) for finding in validate(path)] == []
    other.write_bytes(
        VALID.replace(b"<technique_common/>\n      </rigid_con", b"<wrong/></rigid_con")
    )
    (finding,) = validate(path).findings
    assert (finding.code, finding.file) == ("link-missing", str(path))
    assert "other.dae" in finding.message and finding.line == 17
    other.write_bytes(VALID.replace(b'rigid_body="model/ball"', b'rigid_body="model/none"'))
    (finding,) = validate(path).findings
    assert (finding.code, finding.file, finding.line) == ("link-missing", str(other), 10)
    # A value that keeps nothing from being loaded is the other document's own affair.
    other.write_bytes(VALID.replace(b"<density>1<", b"<density>0<"))
    assert validate(path).findings == []


def test_only_unreadable_input_raises(tmp_path: Path) -> None:
    for source in (tmp_path, tmp_path / "none.dae", io.StringIO("text")):
        with pytest.raises(InputError):
            validate(source)  # type: ignore[arg-type]
    assert codes(b"") == ["xml-empty"]
    assert codes(b"PK\x03\x04") == ["io-archive-broken"]
    report = validate(VALID, limits=Limits(bytes=10))
    assert [finding.code for finding in report] == ["io-too-large"]


def test_the_json_report() -> None:
    data = json.loads(as_json([validate(VALID.replace(b"<radius>1<", b"<radius>\xc3\xa4<"))]))
    (file,) = data["files"]
    assert list(file) == [
        "path", "readable", "valid", "counts", "ignored", "in_baseline", "findings",
    ]  # fmt: skip
    assert file["valid"] is False
    assert file["counts"] == {"error": 1, "warning": 0, "info": 0, "hint": 0}
    (finding,) = file["findings"]
    assert list(finding) == [
        "code", "severity", "stage", "message", "line", "column", "path", "hint", "why",
        "attribute", "sid", "related", "fixable", "repair",
        "file",
    ]  # fmt: skip
    assert (finding["code"], finding["severity"], finding["stage"], finding["line"]) == (
        "schema-invalid-value",
        "error",
        "schema",
        7,
    )
    assert "ä" in finding["message"]


def test_the_text_report_and_its_cap() -> None:
    broken = VALID.replace(b"<node ", b'<node x="1" ').replace(
        b'<node x="1" id="node"/>', b'<node x="1" id="node"/>' + b'<node x="1"/>' * 9
    )
    report = validate(broken)
    lines = list(as_text(report))
    assert lines[-1] == "document: not valid (10 errors)"
    assert sum("schema-unknown-attribute" in line for line in lines) == 10
    short = list(changes(report, most=3))
    assert len(short) == 5
    assert short[3:] == ["... and 7 more of schema-unknown-attribute", "document: 10 errors"]


def test_the_corpus_is_reported_without_errors_of_ours(corpus_dir: Path) -> None:
    for path in sorted(corpus_dir.glob("*.dae")):
        report = colladaphy.validate(path)
        assert report.errors, path.name
        assert all(finding.file == str(path) for finding in report)
        assert all(finding.hint for finding in report.errors)


def test_many_findings_take_time_in_proportion(monkeypatch: pytest.MonkeyPatch) -> None:
    """Siblings are not counted anew for every finding."""

    def counted(*_: object) -> None:
        raise AssertionError("siblings are counted for one element")

    monkeypatch.setattr("colladaphy.findings._alike", counted)
    instance = b'<instance_rigid_body body="ball" target="#none"><technique_common/>'
    instances = (instance + b"</instance_rigid_body>\n") * 1000
    data = VALID.replace(b"<instance_rigid_constraint", instances + b"<instance_rigid_constraint")
    found = [finding for finding in validate(data) if "#none" in finding.message]
    assert len({finding.path for finding in found}) == 1000
    assert [finding.line for finding in found] == sorted(finding.line or 0 for finding in found)
