"""The XSD gate: every kind of deviation has its code, its place, and words that people read."""

from __future__ import annotations

from typing import Any

import pytest

from colladaphy.findings import Finding
from colladaphy.gate import faults, gate, is_valid_text, schema_folder
from colladaphy.source import COLLADA_1_5, parse

ASSET = (
    "<asset><created>2010-01-01T00:00:00Z</created>"
    "<modified>2010-01-01T00:00:00Z</modified></asset>"
)


def document(body: str, version: str = "1.5.0") -> bytes:
    return (
        f'<COLLADA xmlns="{COLLADA_1_5}" xmlns:pe="urn:colladaphy:pe:1" version="{version}">'
        f"{body}</COLLADA>"
    ).encode()


def model(body: str) -> str:
    library = "library_physics_models"
    return f"{ASSET}<{library}><physics_model>{body}</physics_model></{library}>"


def nodes(content: str) -> str:
    return f"{ASSET}<library_nodes>{content}</library_nodes>"


def technique(content: str) -> str:
    return f'{ASSET}<extra><technique profile="pe">{content}</technique></extra>'


def body(common: str, attributes: str = 'sid="a"') -> str:
    return f"<rigid_body {attributes}><technique_common>{common}</technique_common></rigid_body>"


SHAPE = "<shape><sphere><radius>1</radius></sphere></shape>"


def findings(body: str, version: str = "1.5.0") -> list[Finding]:
    return gate(parse(document(body, version)).tree)


def test_the_schema_files_are_there() -> None:
    assert (schema_folder() / "document.xsd").is_file()


def test_a_valid_document_passes() -> None:
    assert findings(ASSET) == []
    assert findings(model(body(SHAPE))) == []


@pytest.mark.parametrize(
    ("content", "code", "words", "path"),
    [
        ("", "schema-missing-element", ["<COLLADA>", "<asset>"], "/COLLADA"),
        (ASSET + "<foo/>", "schema-unexpected-element", ["<foo>"], "/COLLADA/foo"),
        (
            model(body("<mass>1</mass>" + SHAPE + "<dynamic>true</dynamic>")),
            "schema-unexpected-element",
            ["<dynamic>", "<shape>"],
            "/COLLADA/library_physics_models/physics_model/rigid_body/technique_common/dynamic",
        ),
        (model(body(SHAPE, "")), "schema-missing-attribute", ["<rigid_body>", "'sid'"], None),
        (
            model(body(SHAPE, 'sid="a" foo="1"')),
            "schema-unknown-attribute",
            ["<rigid_body>", "'foo'"],
            None,
        ),
        (
            model(body("<mass>abc</mass>" + SHAPE)),
            "schema-invalid-value",
            ["<mass>", "'abc'", "number"],
            None,
        ),
        (
            model(body("<dynamic>maybe</dynamic>" + SHAPE)),
            "schema-invalid-value",
            ["'maybe'", "true or false"],
            None,
        ),
        (model(body("<mass/>" + SHAPE)), "schema-invalid-value", ["<mass>", "empty"], None),
        (
            model(body("<inertia>1 2</inertia>" + SHAPE)),
            "schema-wrong-length",
            ["<inertia>", "2", "exactly 3"],
            None,
        ),
        (model(body("text" + SHAPE)), "schema-unexpected-content", ["<technique_common>"], None),
        (
            model(body("<mass>1<b/></mass>" + SHAPE)),
            "schema-unexpected-content",
            ["<mass>", "child elements"],
            None,
        ),
        (
            ASSET.replace("</asset>", "<up_axis>W</up_axis></asset>"),
            "schema-invalid-value",
            ["'W'", "X_UP, Y_UP, Z_UP"],
            "/COLLADA/asset/up_axis",
        ),
        (
            nodes('<node id="1"/>'),
            "schema-invalid-value",
            ["'id'", "<node>", "'1'"],
            None,
        ),
        (
            nodes('<node id="a"/><node id="a"/>'),
            "schema-duplicate-id",
            ["'a'", "<node>"],
            "/COLLADA/library_nodes/node[2]",
        ),
        (
            technique("<pe:nothing/>"),
            "schema-unknown-element",
            ["<pe:nothing>"],
            None,
        ),
        (
            technique("<pe:body><pe:no/></pe:body>"),
            "schema-unexpected-element",
            ["<pe:no>"],
            "/COLLADA/extra/technique/body/no",
        ),
    ],
)
def test_each_kind_of_deviation(
    content: str, code: str, words: list[str], path: str | None
) -> None:
    (finding,) = findings(content)
    assert finding.code == code
    assert finding.hint and finding.line == 1
    for word in words:
        assert word in finding.message
    assert "{" not in finding.message and "collada.org" not in finding.message
    if path:
        assert finding.path == path


def test_other_versions_are_told_apart() -> None:
    def root(attributes: str) -> Finding:
        (finding,) = gate(parse(f"<COLLADA {attributes}/>".encode()).tree)
        return finding

    old = root('xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"')
    assert old.code == "schema-version-1-4"
    assert "convert" in str(old.hint)
    assert root("").code == "schema-wrong-namespace"
    assert (
        root('xmlns="http://www.collada.org/2005/COLLADASchema"').code == "schema-wrong-namespace"
    )
    assert [finding.code for finding in findings(ASSET, "1.4.1")] == ["schema-invalid-value"]


def test_findings_come_in_the_order_of_the_document() -> None:
    content = "\n".join(
        ['<library_nodes><node id="n" x="1"/>', '<node id="n"/>', '<node y="1"/></library_nodes>']
    )
    found = findings(ASSET + content)
    assert [finding.line for finding in found] == [1, 2, 3]
    assert found == findings(ASSET + content)


def test_a_second_run_says_the_same() -> None:
    tree = parse(document(nodes('<node id="a"/><node id="a"/>'))).tree
    assert [finding.code for finding in gate(tree)] == ["schema-duplicate-id"]
    assert [finding.code for finding in gate(tree)] == ["schema-duplicate-id"]


def test_edits_between_runs_are_seen() -> None:
    """libxml2 keeps a table of ids in the tree that edits make wrong."""
    tree = parse(document(nodes('<node id="a"/><node id="b"/><node id="c"/>'))).tree
    assert gate(tree) == []
    one, two, three = tree.getroot()[1]
    one.set("id", "b")
    assert [finding.code for finding in gate(tree)] == ["schema-duplicate-id"]
    two.set("id", "a")
    assert gate(tree) == []
    three.getparent().remove(three)
    two.set("id", "c")
    assert gate(tree) == []
    del one.attrib["id"]
    two.set("id", "b")
    assert gate(tree) == []


def test_ids_in_techniques_are_not_ours() -> None:
    content = (
        nodes('<node id="a"/>')
        + '<extra><technique profile="X"><x xmlns="" id="a"/><thing id="a"/></technique></extra>'
    )
    assert findings(content) == []


def test_long_values_are_cut_short() -> None:
    (finding,) = findings(model(body(f"<mass>{'x' * 100_000}</mass>" + SHAPE)))
    assert len(finding.message) < 300


def wide(faulty: str, correct: str, count: int, every: int) -> bytes:
    """A document with very many bodies, of which one in `every` is faulty."""
    good, bad = body(correct, 'sid="a"'), body(faulty, 'sid="a"')
    bodies = "\n".join(bad if index % every == every - 1 else good for index in range(count))
    return document(model(bodies + "\n<rigid_body/><extra/>"))


@pytest.mark.parametrize("every", [1, 7, 2500])
def test_very_many_siblings_are_validated_in_blocks_with_the_same_result(
    monkeypatch: pytest.MonkeyPatch, every: int
) -> None:
    tree = parse(wide("<mass>x</mass>" + SHAPE, "<mass>1</mass>" + SHAPE, 5000, every)).tree
    whole = gate(tree)
    monkeypatch.setattr("colladaphy.gate.faults.wide_parents", lambda _: [])
    assert gate(tree) == whole
    assert len(whole) == 5000 // every + 3  # and the last body, which lacks all


def test_a_flood_of_errors_takes_time_in_proportion(monkeypatch: pytest.MonkeyPatch) -> None:
    """No run of the validator sees more siblings than a block has."""
    seen: list[int] = []
    validate = faults._validate

    def watched(tree: object) -> object:
        seen.append(len(tree.getroot()[1][0]))  # type: ignore[index,attr-defined]
        return validate(tree)  # type: ignore[arg-type]

    monkeypatch.setattr(faults, "_validate", watched)
    tree = parse(wide("<mass>x</mass>" + SHAPE, SHAPE, 20_000, 1)).tree
    assert len(gate(tree)) == 20_003
    assert max(seen) < 5000


def test_a_flood_of_ids_takes_time_in_proportion(monkeypatch: pytest.MonkeyPatch) -> None:
    """A sample of the children shows nothing of ids that are there twice."""
    seen: list[int] = []
    validate = faults._validate

    def watched(tree: object) -> object:
        seen.append(len(tree.getroot()[1][0]))  # type: ignore[index,attr-defined]
        return validate(tree)  # type: ignore[arg-type]

    monkeypatch.setattr(faults, "_validate", watched)
    bodies = "".join(
        f'<rigid_body sid="b{i}" id="i{i % 10_000}"><technique_common>{SHAPE}'
        "</technique_common></rigid_body>"
        for i in range(20_000)
    )
    found = gate(parse(document(model(bodies))).tree)
    assert {finding.code for finding in found} == {"schema-duplicate-id"}
    assert len(found) == 10_000
    assert max(seen) < 5000


@pytest.mark.parametrize("faulty", [None, 0, 2, 9998])
def test_a_large_document_is_validated_at_once_for_a_fault(
    monkeypatch: pytest.MonkeyPatch, faulty: int | None
) -> None:
    """Wherever the fault is: in the sample, too."""
    bodies = [body(SHAPE)] * 10_000
    if faulty is not None:
        bodies[faulty] = body("<mass>x</mass>" + SHAPE)
    tree = parse(document(model("\n".join(bodies)))).tree
    runs: list[int] = []
    validate = faults._validate

    def watched(tree: Any) -> Any:
        runs.append(len(tree.getroot()[1][0]))
        return validate(tree)

    monkeypatch.setattr(faults, "_validate", watched)
    assert len(gate(tree)) == (faulty is not None)
    assert runs[1:] == [10_000] and runs[0] < 500


@pytest.mark.parametrize("blank", ["", " ", "\n\t"])
def test_a_fresh_tree_need_not_be_searched_for_ids(blank: str) -> None:
    content = "".join(f'<node id="{blank}n{number}{blank}"/>' for number in (1, 2, 3, 2, 2))
    data = document(nodes(content))
    found = gate(parse(data).tree, fresh=True)
    assert [finding.code for finding in found].count("schema-duplicate-id") == 2
    assert found == gate(parse(data).tree)


@pytest.mark.parametrize(
    ("text", "valid"),
    [
        (nodes('<node id="a"/>'), True),
        (nodes('<node id="a"><translate>1 2 3</translate></node>'), True),
        (nodes('<node id="a"><translate>1 2</translate></node>'), False),
        (nodes('<node id="a"><nonsense/></node>'), False),
        (nodes('<node id="a">'), False),
        (technique("<pe:body uid='1' xmlns:pe='urn:colladaphy:pe:1'/>"), True),
        (technique("<pe:body uid='x' xmlns:pe='urn:colladaphy:pe:1'/>"), False),
    ],
)
def test_validity_can_be_told_without_a_tree(text: str, valid: bool) -> None:
    data = document(text)
    assert is_valid_text(data) is valid
    assert is_valid_text(data) is valid


def test_validity_is_told_of_one_text_at_a_time() -> None:
    assert not is_valid_text(document(nodes('<node id="a"><nonsense/></node>')))
    assert is_valid_text(document(nodes('<node id="a"/>')))


@pytest.mark.parametrize("letter", ["x", "é", "漢"])
def test_long_names_are_told_wherever_libxml2_cuts_them(letter: str) -> None:
    for length in range(30, 190):
        (found,) = findings(nodes(f'\n<a:{"a" * (length % 2)}{letter * length} xmlns:a="urn:a"/>'))
        assert found.code == "schema-unexpected-element" and found.line in (1, 2)
