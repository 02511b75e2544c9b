"""The comparison of schemas finds every kind of mutation and accepts equivalent rewritings."""

from pathlib import Path

import pytest
from tests.schema.changes import BASE, IMPORT, ITEM, MUTATIONS, REWRITINGS, SECOND, changed
from tools.schema_equivalence import Comparison, SchemaError, compare, load
from tools.schema_equivalence.cli import DIFFERENT, EQUAL, UNUSABLE, main


def compared(folder: Path, ours: str, official: str, *, names: bool = True) -> Comparison:
    paths = folder / "ours.xsd", folder / "official.xsd"
    for path, text in zip(paths, (ours, official), strict=True):
        path.write_text(text, "utf-8")
    return compare(load(paths[0]), load(paths[1]), names=names)


@pytest.mark.parametrize("mutation", MUTATIONS)
def test_mutation_is_found(mutation: str, tmp_path: Path) -> None:
    mutant = changed(*MUTATIONS[mutation])
    assert compared(tmp_path, mutant, BASE).differences
    assert compared(tmp_path, BASE, mutant).differences


@pytest.mark.parametrize("rewriting", REWRITINGS)
def test_equivalent_rewriting_is_accepted(rewriting: str, tmp_path: Path) -> None:
    rewritten = changed(*REWRITINGS[rewriting])
    assert compared(tmp_path, rewritten, BASE).differences == []
    assert compared(tmp_path, BASE, rewritten).differences == []


def test_split_into_a_chameleon_include_is_accepted(tmp_path: Path) -> None:
    start = BASE.index('  <xs:simpleType name="list_type">')
    types = BASE[start : BASE.index("</xs:schema>")]
    part = tmp_path / "part.xsd"
    part.write_text(
        f'<xs:schema xmlns:xs="http://www.w3.org/2001/XMLSchema">{types}</xs:schema>', "utf-8"
    )
    whole = BASE.replace(types, "").replace(
        "<xs:element name=", '<xs:include schemaLocation="part.xsd"/><xs:element name=', 1
    )
    assert compared(tmp_path, whole, BASE).differences == []


def test_without_names_what_no_element_uses_is_not_compared(tmp_path: Path) -> None:
    renamed = changed('"unused_type"', '"spare_type"')
    assert compared(tmp_path, renamed, BASE, names=False).differences == []


def test_a_difference_says_where_and_what(tmp_path: Path) -> None:
    found = compared(tmp_path, changed(SECOND, ""), BASE, names=False)
    assert [str(difference) for difference in found.differences] == [
        "element root: after children [first] allowed next: "
        "ours {(element, {urn:t}left), (element, {urn:t}right), (element, {urn:t}size)}, official "
        "{(element, {urn:t}left), (element, {urn:t}right), (element, {urn:t}second), "
        "(element, {urn:t}size)}"
    ]


def test_a_difference_in_a_group_is_found_at_each_use(tmp_path: Path) -> None:
    mutant = changed(*MUTATIONS["element fixed changed"])
    paths = [difference.path for difference in compared(tmp_path, mutant, BASE).differences]
    assert paths == ["element root/code"]


def test_command_says_equal(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "a.xsd"
    path.write_text(BASE, "utf-8")
    assert main([str(path), str(path), "--names"]) == EQUAL
    assert capsys.readouterr().out.startswith("0 differences; compared ")


def test_command_prints_differences(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    ours, official = tmp_path / "a.xsd", tmp_path / "b.xsd"
    ours.write_text(changed('default="1.0"', 'default="2.0"'), "utf-8")
    official.write_text(BASE, "utf-8")
    assert main([str(ours), str(official)]) == DIFFERENT
    first, last = capsys.readouterr().out.splitlines()
    assert first == "element root/@scale: default: ours 2.0, official 1.0"
    assert last.startswith("1 differences; ")


def test_official_path_comes_from_the_environment(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("COLLADA_SCHEMA", str(tmp_path / "nowhere.xsd"))
    assert main([]) == UNUSABLE
    assert f"{tmp_path / 'nowhere.xsd'}: no such file" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("<html/>", "html"),
        ("<xs:schema", "unclosed token"),
        (BASE.replace('type="root_type"', 'type="no_type"'), "no_type"),
        (BASE.replace("<xs:element", IMPORT + "<xs:element", 1), "nowhere.xsd"),
    ],
)
def test_unusable_schema_is_an_error(text: str, reason: str, tmp_path: Path) -> None:
    path = tmp_path / "bad.xsd"
    path.write_text(text, "utf-8")
    with pytest.raises(SchemaError, match=reason):
        load(path)


def test_what_is_not_compared_is_refused(tmp_path: Path) -> None:
    text = changed(ITEM, "<xs:all><xs:element name='a'/><xs:element name='b'/></xs:all>")
    text = text.replace(MUTATIONS["extension undone"][0], "")
    with pytest.raises(SchemaError, match="xs:all is not compared"):
        compared(tmp_path, text, text)
