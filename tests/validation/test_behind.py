"""Everything is found in one run: behind faults of form, and in documents of COLLADA 1.4."""

from __future__ import annotations

import random
import shutil
import sys
from copy import deepcopy
from pathlib import Path

import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from lxml import etree
from tests.columns.test_accepting import planted
from tests.meaning.test_cases import BASES, FAULTS, NEAR, Case

import colladaphy
from colladaphy.conform import conform
from colladaphy.conform.deviations import deviations
from colladaphy.findings import Finding, Severity
from colladaphy.gate import gate
from colladaphy.testing import documents
from colladaphy.validation import older
from colladaphy.validation.options import HUGE, LARGE, MANY, Options, is_large

some = settings(max_examples=20, deadline=None, suppress_health_check=list(HealthCheck))

DOCUMENT = """<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2008/03/COLLADASchema" version="1.5.0">
  <asset>
    <created>2010-01-01T00:00:00Z</created>
    <modified>2010-01-01T00:00:00Z</modified>
  </asset>
  <library_physics_models>
    <physics_model id="model">
      <rigid_body sid="one">
        <technique_common>
          <mass>1</mass>
          <shape>
            <box>
              <half_extents>1 1 1</half_extents>
            </box>
          </shape>
        </technique_common>
      </rigid_body>
      <rigid_body sid="two">
        <technique_common>
          <mass>2</mass>
          <inertia>1 1 1</inertia>
          <shape>
            <sphere>
              <radius>1</radius>
            </sphere>
          </shape>
        </technique_common>
      </rigid_body>
    </physics_model>
  </library_physics_models>
  <library_physics_scenes>
    <physics_scene id="scene">
      <instance_physics_model url="#model">
        <instance_rigid_body body="one" target="#a">
          <technique_common/>
        </instance_rigid_body>
        <instance_rigid_body body="two" target="#b">
          <technique_common/>
        </instance_rigid_body>
      </instance_physics_model>
      <technique_common>
        <gravity>0 -9.81 0</gravity>
      </technique_common>
    </physics_scene>
  </library_physics_scenes>
  <library_visual_scenes>
    <visual_scene id="view">
      <node id="a"/>
      <node id="b"/>
    </visual_scene>
  </library_visual_scenes>
  <scene>
    <instance_physics_scene url="#scene"/>
    <instance_visual_scene url="#view"/>
  </scene>
</COLLADA>
"""


LARGE_NODES = (
    b'<COLLADA xmlns="http://www.collada.org/2008/03/COLLADASchema" version="1.5.0"><asset>'
    b"<created>2010-01-01T00:00:00Z</created><modified>2010-01-01T00:00:00Z</modified></asset>"
    b"<library_nodes>",
    b"</library_nodes></COLLADA>",
)


def edited(*edits: tuple[str, str]) -> bytes:
    text = DOCUMENT
    for old, new in edits:
        assert old in text, old
        text = text.replace(old, new, 1)
    return text.encode()


def found(data: bytes, **options: Severity | None) -> list[Finding]:
    return list(colladaphy.validate(data, options=Options(**options)))


def line_of(data: bytes, mark: str) -> int:
    return data[: data.index(mark.encode())].count(b"\n") + 1


def test_nothing_is_wrong_before_it_is_edited() -> None:
    assert found(edited()) == []


@pytest.mark.parametrize(
    ("old", "new", "mark", "message", "repair"),
    [
        (
            "<mass>2</mass>\n          <inertia>1 1 1</inertia>",
            "<inertia>1 1 1</inertia>\n          <mass>2</mass>",
            "<mass>2",
            "<mass> is out of order: it belongs before <inertia>.",
            "repair-child-order",
        ),
        (
            "<mass>2</mass>",
            "<mass>2</mass><mass>3</mass>",
            "<mass>3",
            "Only one <mass> may stand here in <technique_common>.",
            "repair-unexpected-element",
        ),
        (
            "<half_extents>1 1 1</half_extents>",
            "<half_extent>1 1 1</half_extent>",
            "<half_extent>",
            "There is no <half_extent> in <box>; did you mean <half_extents>?",
            "repair-misspelt-element",
        ),
        (
            '<rigid_body sid="two">',
            '<rigid_body sid="two"><dynamic>true</dynamic>',
            "<dynamic>",
            "<dynamic> may not stand in <rigid_body> itself; it belongs in its <technique_common>.",
            "repair-wrapper",
        ),
        (
            "<scene>",
            '<light id="l"><technique_common><ambient><color>1 1 1</color></ambient>'
            "</technique_common></light><scene>",
            "<light",
            "<light> may not stand in <COLLADA> itself; it belongs in <library_lights>.",
            "repair-outside-library",
        ),
        (
            "<mass>2</mass>",
            "<mass>2</mass><frobnicate/>",
            "<frobnicate",
            "<frobnicate> may not stand in <technique_common>: COLLADA has none. Allowed here: "
            "<dynamic>, <mass>, <mass_frame>, <inertia>, <instance_physics_material>, "
            "<physics_material> or <shape>.",
            "repair-unexpected-element",
        ),
        (
            "<mass>2</mass>",
            '<mass>2</mass><mine:thing xmlns:mine="urn:mine"/>',
            "<mine",
            "<thing> is of the namespace 'urn:mine', whose elements may stand in a <technique> "
            "only.",
            "repair-unexpected-element",
        ),
        (
            "<created>2010-01-01T00:00:00Z</created>\n",
            "\n",
            "<modified",
            "<asset> lacks <created>, which belongs before <modified>.",
            "repair-missing-element",
        ),
        (
            "<half_extents>1 1 1</half_extents>",
            "",
            "<box>",
            "<box> lacks <half_extents>.",
            "repair-incomplete-element",
        ),
        (
            "</box>",
            "</box><sphere><radius>1</radius></sphere>",
            "<sphere><",
            "<sphere> may not stand in <shape> beside <box>: one rules out the other.",
            "repair-shape-split",
        ),
    ],
)
def test_what_belongs_there(old: str, new: str, mark: str, message: str, repair: str) -> None:
    data = edited((old, new))
    (finding,) = found(data)
    assert finding.message == message
    assert (finding.stage, finding.line) == ("schema", line_of(data, mark))
    assert finding.repair == repair and finding.column


@pytest.mark.parametrize(
    ("old", "new", "code", "repair"),
    [
        ("<radius>1<", "<radius>1e<", "schema-invalid-value", "repair-lexical-form"),
        ("<radius>1<", "<radius>wide<", "schema-invalid-value", "repair-unreadable-value"),
        ("1 1 1</half", "1 1</half", "schema-wrong-length", "repair-unreadable-value"),
        ("1 1 1</half", "1 1 1 1</half", "schema-wrong-length", "repair-surplus-values"),
        ('<node id="b"/>', '<node id="b" x="1"/>', "schema-unknown-attribute",
         "repair-unknown-attribute"),
        ('<rigid_body sid="two">', "<rigid_body>", "schema-missing-attribute",
         "repair-missing-sid"),
        ('<node id="b"/>', '<node id="b"/><node id="b"/>', "schema-duplicate-id",
         "repair-duplicate-id"),
        ("<sphere>", "<sphere>round", "schema-unexpected-content", "repair-unexpected-text"),
        ('target="#b"', 'target="b"', "link-no-hash", "repair-url-hash"),
    ],
)  # fmt: skip
def test_findings_name_the_repair_that_mends_them(
    old: str, new: str, code: str, repair: str
) -> None:
    told = {finding.code: finding.repair for finding in found(edited((old, new)))}
    assert told[code] == repair


def test_all_faults_of_an_element_and_of_what_is_in_it() -> None:
    data = edited(
        ("<mass>2</mass>", "<wrong/><mass>2</mass><odd/><inertia>1 1 1</inertia>"),
        ("<sphere>\n              <radius>1</radius>", "<sphere><radius>r</radius>"),
        ('<node id="b"/>', '<node id="b" colour="red"/>'),
        ("<half_extents>1 1 1<", "<half_extents>1 -1 1<"),
        ('url="#view"', 'url="#none"'),
    )
    lines = {finding.code: finding.line for finding in found(data)}
    assert len(found(data)) == 7
    assert lines == {
        # The last of three is the second inertia.
        "schema-unexpected-element": line_of(data, "<wrong/>") + 1,
        "schema-invalid-value": line_of(data, "<radius>r"),
        "schema-unknown-attribute": line_of(data, 'colour="red"'),
        "physics-shape-size": line_of(data, "<half_extents>1 -1"),
        "link-missing": line_of(data, "#none"),
    }


@pytest.mark.parametrize(
    "edit",
    [
        ("<mass>2</mass>", "<mass>two</mass>"),  # and not: it has no mass
        ("<radius>1</radius>", "<radius>one</radius>"),
        ('<rigid_body sid="two">', '<rigid_body sid="t w o">'),  # and not: there is no such body
        ('<node id="b"/>', '<node id="b"><translate>1 2</translate></node>'),
        ("<gravity>0 -9.81 0</gravity>", "<gravity>0 -9.81</gravity>"),
        ('<instance_rigid_body body="two" target="#b">', '<instance_rigid_body body="two">'),
        ("<sphere>\n              <radius>1</radius>\n            </sphere>", "<orb/>"),
    ],
)
def test_what_follows_from_a_fault_is_not_told(edit: tuple[str, str]) -> None:
    assert {finding.stage for finding in found(edited(edit))} <= {"schema", "link"}
    links = [finding for finding in found(edited(edit)) if finding.stage == "link"]
    assert len(links) <= ("t w o" in edit[1])


JOINED = (
    DOCUMENT.replace(
        "      </rigid_body>\n    </physics_model>",
        """      </rigid_body>
      <rigid_constraint sid="bound">
        <ref_attachment/>
        <attachment rigid_body="./two"/>
        <technique_common/>
      </rigid_constraint>
    </physics_model>""",
    )
    .replace(
        "      </instance_physics_model>",
        '<instance_rigid_constraint constraint="bound"/></instance_physics_model>',
    )
    .replace("<box>", "<plane>")
    .replace("</box>", "</plane>")
    .replace("<half_extents>1 1 1</half_extents>", "<equation>0 1 0 0</equation>")
    .replace("<mass>1</mass>", "<dynamic>false</dynamic>")
)
"""A body that is bound to the world at its own place, above a plane."""


@pytest.mark.parametrize(
    "edit",
    [
        # What nothing can be called is missed by what calls it.
        ('<rigid_body sid="two">', "<rigid_body>"),
        ('<rigid_constraint sid="bound">', "<rigid_constraint>"),
        # What may not stand there is missed, too.
        ('<node id="b"/>', '<nod id="b"/>'),
        # Without a value that can be read nothing is said of what it would do.
        ("<dynamic>false</dynamic>", "<dynamic>no</dynamic>"),
        # Nor of where a joint is that has one end.
        ("<ref_attachment/>", ""),
    ],
)
def test_a_fault_of_form_is_one_finding(edit: tuple[str, str]) -> None:
    moved = JOINED.replace('<node id="b"/>', '<node id="b"><translate>0 5 0</translate></node>')
    text = moved if edit[0] == "<ref_attachment/>" else JOINED
    assert found(JOINED.encode()) == []
    assert edit[0] in text
    told = found(text.replace(*edit).encode())
    assert [finding.stage for finding in told] == ["schema"], told


def test_a_source_without_an_id_is_one_finding() -> None:
    text = BASES["visual"].read_text("utf-8").replace("wood.png", "")
    before = [finding.code for finding in found(text.encode())]
    told = found(text.replace('<source id="sheet-pos">', "<source>").encode())
    assert [finding.code for finding in told if finding.code not in before] == [
        "schema-missing-attribute"
    ]


@pytest.mark.parametrize("case", FAULTS + NEAR)
def test_a_fault_of_form_hides_nothing(case: Case, tmp_path: Path) -> None:
    """With a fault of form elsewhere, everything is found that is found without it."""
    alone = [(finding.code, finding.line) for finding in case.report(tmp_path)]
    text = case.text().replace("</asset>", "<bogus/></asset>", 1)
    (tmp_path / "case.dae").write_text(text, "utf-8")
    both = [(f.code, f.line) for f in colladaphy.validate(tmp_path / "case.dae")]
    line = text[: text.index("<bogus/>")].count("\n") + 1
    assert sorted(both) == sorted([*alone, ("schema-unexpected-element", line)])


@some
@given(documents())
def test_valid_documents_have_no_deviations(document: bytes) -> None:
    root = etree.fromstring(document)
    if not gate(root.getroottree()):
        assert list(deviations(root, ())) == []


def test_mended_documents_have_no_deviations(corpus_dir: Path) -> None:
    for path in sorted(corpus_dir.glob("*.dae")):
        if path.name != "colladatools-simple-arm-hostile.dae":
            tree, _ = conform(etree.parse(path))
            assert list(deviations(tree.getroot(), ())) == [], path.name


def one_edit(tree: etree._ElementTree, kind: str, chance: random.Random) -> None:
    """Make one fault of form, or none."""
    element = chance.choice(list(tree.iter(etree.Element))[1:])
    parent, after = element.getparent(), element.getnext()
    assert parent is not None
    if kind == "removed":
        parent.remove(element)
    elif kind == "swapped" and after is not None:
        after.addnext(element)
    elif kind == "doubled":
        element.addnext(deepcopy(element))
    elif kind == "renamed":
        element.tag = f"{element.tag}q"
    elif kind == "stranger":
        element.append(etree.Element("{http://www.collada.org/2008/03/COLLADASchema}bogus"))
    elif kind == "attribute":
        element.set("bogus", "1")
    elif kind == "bare":
        element.attrib.clear()
    elif kind == "text":
        element.text = "x y"


@pytest.mark.parametrize(
    "kind",
    ["removed", "swapped", "doubled", "renamed", "stranger", "attribute", "bare", "text"],
)
@some
@given(st.sampled_from(sorted(BASES)), st.integers(0, 2**32))
def test_one_fault_of_form_is_one_finding_where_libxml2_sees_it(
    kind: str, base: str, seed: int
) -> None:
    tree = etree.parse(BASES[base])
    one_edit(tree, kind, random.Random(seed))
    data = etree.tostring(tree)
    seen = [finding.line for finding in gate(etree.fromstring(data).getroottree())]
    told = colladaphy.validate(data)
    assert [finding.line for finding in told if finding.stage == "schema"] == seen


# --- COLLADA 1.4


OLD = (
    DOCUMENT.replace("2008/03", "2005/11").replace("1.5.0", "1.4.1")
    .replace("<radius>1<", "<radius>-1<")
)  # fmt: skip


@pytest.mark.parametrize("severity", [Severity.ERROR, Severity.WARNING, None])
@pytest.mark.parametrize("version", ["1.4.0", "1.4.1"])
def test_how_much_1_4_matters(severity: Severity | None, version: str) -> None:
    data = OLD.replace('"1.4.1"', f'"{version}"').encode()
    report = found(data, collada_14=severity)
    told = {finding.code: finding for finding in report}
    assert set(told) - {"schema-version-1-4"} == {"physics-shape-size"}
    assert told["physics-shape-size"].line == line_of(data, "<radius>-1")
    if severity is None:
        assert "schema-version-1-4" not in told
    else:
        finding = told["schema-version-1-4"]
        assert (finding.severity, finding.line, finding.repair) == (severity, 2, "upgrade-version")
        assert version in finding.message


@pytest.mark.parametrize("installed", [True, False])
def test_1_4_is_checked_as_1_4(installed: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where its own schema is not installed, what can be upgraded is right."""
    if installed:
        pytest.importorskip("collada")
    else:
        monkeypatch.setattr(older, "schema_1_4", lambda: None)
    capsule = "<capsule><height>1</height><radius>1 1</radius></capsule>"  # three in 1.5
    data = (
        OLD.replace("<radius>-1<", "<radius>1<")
        .replace("<sphere>\n              <radius>1</radius>\n            </sphere>", capsule)
        .replace("<mass>2</mass>", "<mass>2</mass><colour/>")
        .encode()
    )
    (finding,) = found(data, collada_14=None)
    assert finding.code == "schema-unexpected-element"
    assert finding.line == line_of(data, "<colour/>")


@pytest.mark.parametrize(
    ("name", "code", "line"),
    [
        ("opencollada-unique-ids-error.dae", "schema-duplicate-id", 162),
        ("opencollada-unique-sids-error.dae", "link-duplicate-sid", 125),
        ("opencollada-physx.dae", "schema-invalid-value", 596),
    ],
)
def test_files_have_what_their_names_promise(
    name: str, code: str, line: int, corpus_dir: Path
) -> None:
    told = [(f.code, f.line) for f in colladaphy.validate(corpus_dir / name)]
    others = colladaphy.validate(corpus_dir / "opencollada-validator-file.dae")
    assert (code, line) in told
    assert code not in {finding.code for finding in others}


def test_files_that_are_right_but_for_their_version(corpus_dir: Path) -> None:
    path = corpus_dir / "opencollada-check-schema.dae"
    report = colladaphy.validate(path, options=Options(collada_14=None))
    assert report.valid


OLD_EFFECT = (
    OLD.replace(
        "  <library_physics_models>",
        """  <library_images>
    <image id="oak"><init_from>https://example.org/oak.png</init_from></image>
  </library_images>
  <library_effects>
    <effect id="fx">
      <profile_COMMON>
        <newparam sid="face">
          <surface type="2D">
            <init_from>oak</init_from>
          </surface>
        </newparam>
        <newparam sid="sampler">
          <sampler2D>
            <source>face</source>
          </sampler2D>
        </newparam>
        <technique sid="common"><lambert/></technique>
      </profile_COMMON>
    </effect>
  </library_effects>
  <library_physics_models>""",
        1,
    )
    .replace("<sphere>", "<tapered_cylinder>")
    .replace("</sphere>", "</tapered_cylinder>")
    .replace(
        "<radius>-1</radius>",
        "<height>1</height>\n<radius1>1 1</radius1>\n<radius2>0 0</radius2>",
    )
)


@pytest.mark.parametrize(
    ("old", "new", "code"),
    [
        ("<init_from>oak<", "<init_from>ash<", "link-missing"),
        ("<init_from>oak<", "<init_from>fx<", "link-wrong-type"),
        ("<source>face<", "<source>fece<", "link-missing"),
        ("<height>1<", "<height>0<", "physics-shape-size"),
        ("<radius1>1 1<", "<radius1>1 -1<", "physics-shape-size"),
        ("<radius2>0 0<", "<radius2>0 INF<", "physics-shape-size"),
    ],
)
def test_what_1_5_has_no_place_for_is_checked_too(old: str, new: str, code: str) -> None:
    assert found(OLD_EFFECT.encode(), collada_14=None) == []
    data = OLD_EFFECT.replace(old, new, 1).encode()
    told = found(data, collada_14=None)
    assert [(finding.code, finding.line) for finding in told] == [(code, line_of(data, new))]


def test_no_namespace_at_all() -> None:
    data = edited(
        (' xmlns="http://www.collada.org/2008/03/COLLADASchema"', ""),
        ("<radius>1<", "<radius>-1<"),
    )
    told = {finding.code: finding.line for finding in found(data)}
    assert told == {
        "schema-wrong-namespace": 2,
        "physics-shape-size": line_of(data, "<radius>-1"),
    }


def test_a_prefix_that_nobody_declared() -> None:
    data = edited(
        ('<rigid_body sid="two">', '<rigid_body sid="two"><pe:note/>'),
        ("<half_extents>1 1 1<", "<half_extents>1 -1 1<"),
    )
    told = found(data)
    assert [(f.code, f.repair) for f in told if f.stage == "xml"] == [
        ("xml-malformed", "repair-undeclared-prefix")
    ]
    assert {f.code: f.line for f in told}["physics-shape-size"] == line_of(data, "1 -1 1")


def test_images_are_looked_for_beside_old_documents(tmp_path: Path) -> None:
    image = '<library_images><image id="i"><init_from>a.png</init_from></image></library_images>'
    path = tmp_path / "a.dae"
    text = OLD.replace("<radius>-1<", "<radius>1<")
    path.write_text(text.replace("<library_physics_models>", image + "<library_physics_models>", 1))
    (finding,) = colladaphy.validate(path, options=Options(collada_14=None))
    assert (finding.code, finding.line) == ("link-image-missing", 7)
    shutil.copy(path, tmp_path / "a.png")
    assert list(colladaphy.validate(path, options=Options(collada_14=None))) == []


def test_valid_documents_are_checked_without_what_mends_others() -> None:
    """A small file is checked in a fraction of the time that these imports take."""
    import subprocess

    code = (
        "import sys; from colladaphy.validation.stages import validate; "
        f"r = validate({DOCUMENT.encode()!r}); "
        "print(len(r), 'colladaphy.conform.pipeline' in sys.modules)"
    )
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert out.stdout.split() == ["0", "False"]


def test_of_large_documents_faults_of_form_are_told_first(monkeypatch: pytest.MonkeyPatch) -> None:
    start, end = LARGE_NODES
    data = start + b'<node id="a"><instance_node url="#none"/><wrong/></node>' + end
    told = {finding.code for finding in colladaphy.validate(data)}
    assert {"schema-unexpected-element", "link-missing"} <= told
    monkeypatch.setattr("colladaphy.validation.behind.is_large", lambda _: True)
    findings = list(colladaphy.validate(data))
    # The node itself is left out, for what is wrong in it.
    assert [finding.code for finding in findings] == ["schema-large", "schema-unexpected-element"]
    assert findings[1].line == 1
    beside = data.replace(b'<node id="a">', b'<node><instance_node url="#a"/></node>'
                          b'<node><instance_node url="#lost"/></node><node id="a">')  # fmt: skip
    findings = list(colladaphy.validate(beside))
    assert sorted(finding.code for finding in findings) == [
        "link-missing", "schema-large", "schema-unexpected-element",
    ]  # fmt: skip
    assert next(f for f in findings if f.code == "link-missing").path == (
        "/COLLADA/library_nodes/node[2]/instance_node"
    )
    monkeypatch.setattr("colladaphy.validation.behind.HUGE", len(beside))
    codes = [finding.code for finding in colladaphy.validate(beside)]
    assert codes == ["schema-large", "schema-unexpected-element"]
    monkeypatch.setattr("colladaphy.validation.stages.is_large", lambda _: True)
    valid = data.replace(b"<wrong/>", b"")
    missing = next(f for f in colladaphy.validate(valid) if f.code == "link-missing")
    assert missing.repair is None


@given(st.integers(0, 10**9))
def test_of_large_documents_the_same_faults_of_form_are_told(number: int) -> None:
    data = planted(number)

    def told() -> list[tuple[object, ...]]:
        return [
            (finding.code, finding.line, finding.path, finding.message, finding.repair)
            for finding in colladaphy.validate(data)
            if finding.stage == "schema" and finding.code != "schema-large"
        ]

    small = told()
    assume(all(path != "/COLLADA" for _, _, path, _, _ in small))  # no record is around that
    with pytest.MonkeyPatch.context() as patch:
        for module in ("behind", "stages"):
            patch.setattr(f"colladaphy.validation.{module}.is_large", lambda _: True)
        assert told() == small


def test_what_is_long_but_has_few_elements_is_no_large_document() -> None:
    assert is_large(b"<a></a>" * (LARGE // 7 + 1))
    assert not is_large(b"<a>" + b"1 " * LARGE + b"</a>")
    assert is_large(b"<a>" + b"1 " * HUGE + b"</a>")
    assert not is_large(b"<a></a>" * MANY)
