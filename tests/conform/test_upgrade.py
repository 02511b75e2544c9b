"""COLLADA 1.4 read as 1.5."""

from __future__ import annotations

import pytest
from lxml import etree
from tests.conform.documents import (
    ASSET,
    BOX,
    NS_1_4,
    NS_1_5,
    C,
    codes,
    document,
    kept,
    mended,
    names,
    parse,
    physics,
)

from colladaphy.conform import conform, detect_version
from colladaphy.conform.downgrade import to_collada_1_4
from colladaphy.testing import covering_documents


@pytest.mark.parametrize(
    ("root", "version"),
    [
        (f'<COLLADA xmlns="{NS_1_4}" version="1.4.0"/>', "1.4.0"),
        (f'<COLLADA xmlns="{NS_1_4}" version="1.4.1"/>', "1.4.1"),
        (f'<COLLADA xmlns="{NS_1_4}"/>', "1.4.1"),
        (f'<COLLADA xmlns="{NS_1_5}" version="1.5.0"/>', "1.5.0"),
        (f'<COLLADA xmlns="{NS_1_5}" version="1.4.1"/>', "1.5.0"),
        ('<COLLADA version="1.5.0"/>', "1.5.0"),
        ("<COLLADA/>", "1.4.1"),
        ("<html/>", None),
    ],
)
def test_the_namespace_tells_the_version(root: str, version: str | None) -> None:
    assert detect_version(parse(root)) == version


@pytest.mark.parametrize("version", ["1.4.0", "1.4.1"])
def test_the_namespace_changes_and_nothing_else(version: str) -> None:
    root, findings = mended(physics(BOX, version=version))
    assert root.get("version") == "1.5.0"
    expected = etree.tostring(physics(BOX))
    assert etree.tostring(root.getroottree()) == expected
    assert codes(findings) == {"upgrade-version"}


def test_a_copy_keeps_prefixes_comments_instructions_and_lines() -> None:
    text = (
        '<?keep this?><!-- first -->\n<c:COLLADA xmlns:c="{ns}" version="1.4.1"\n'
        '  xmlns:x="urn:x">\n<c:asset>\n<!-- inner --><c:created>2020-01-02T03:04:05Z</c:created>\n'
        "<c:modified>2020-01-02T03:04:05Z</c:modified></c:asset>"
        '<c:extra><c:technique profile="p"><x:y x:z="1">t<?pi?>u</x:y>\n</c:technique></c:extra>'
        "</c:COLLADA><!-- last -->"
    )
    root, _ = mended(parse(text.format(ns=NS_1_4)))
    old, new = parse(text.format(ns=NS_1_4)), parse(text.format(ns=NS_1_5))
    assert etree.tostring(root.getroottree()).replace(b"1.5.0", b"1.4.1") == etree.tostring(new)
    lines = [e.sourceline for e in old.getroot().iter(etree.Element)]
    assert [e.sourceline for e in root.iter(etree.Element)] == lines


def test_lines_beyond_what_libxml2_keeps() -> None:
    text = (
        f'<COLLADA xmlns="{NS_1_4}" version="1.4.1">{ASSET}' + "\n" * 70000 + "<wheel/></COLLADA>"
    )
    _, findings = mended(parse(text))
    assert [f.line for f in findings if f.code == "repair-unexpected-element"] == [70001]


def test_a_document_without_a_namespace_gets_one() -> None:
    root, findings = mended(parse(f'<COLLADA version="1.5.0">{ASSET}</COLLADA>'))
    assert root.tag == C + "COLLADA"
    assert codes(findings) == {"repair-namespace"}


def test_the_schema_location_of_1_4_goes() -> None:
    text = (
        f'<COLLADA xmlns="{NS_1_4}" version="1.4.1" xmlns:xsi='
        '"http://www.w3.org/2001/XMLSchema-instance" xsi:schemaLocation='
        f'"{NS_1_4} http://www.khronos.org/files/collada_schema_1_4">{ASSET}</COLLADA>'
    )
    root, findings = mended(parse(text))
    assert [str(key) for key in root.attrib] == ["version"]
    assert "upgrade-schema-location" in codes(findings)


def test_what_is_not_collada_is_left_alone() -> None:
    tree = parse("<html><body/></html>")
    result, findings = conform(tree)
    assert etree.tostring(result) == etree.tostring(tree)
    assert [(f.code, str(f.severity)) for f in findings] == [("repair-not-collada", "error")]


IMAGES = (
    '<library_images><image id="i" height="4" format="PNG"><init_from>./a b.png</init_from></image>'
    '<image id="j" format="RAW"><data>00ff</data></image></library_images>'
)


def test_images_say_where_from_in_a_child() -> None:
    root, findings = mended(document(IMAGES, version="1.4.1"))
    assert root.findtext(f".//{C}image/{C}init_from/{C}ref") == "./a b.png"
    hexes = next(root.iter(C + "hex"))
    assert (hexes.text, hexes.get("format")) == ("00ff", "RAW")
    assert 'name="height" value="4"' in kept(root)
    assert {"upgrade-image", "repair-unknown-attribute"} <= codes(findings)


EFFECT = (
    '<library_effects><effect id="e"><profile_COMMON>'
    '<image id="i"><init_from>a.png</init_from></image>'
    '<newparam sid="s"><surface type="2D"><init_from>i</init_from></surface></newparam>'
    '<newparam sid="t"><sampler2D><source>s</source><wrap_s>WRAP</wrap_s></sampler2D></newparam>'
    '<technique sid="common"><phong><diffuse><texture texture="t" texcoord="UV"/></diffuse></phong>'
    "</technique></profile_COMMON></effect></library_effects>"
)


def test_a_sampler_keeps_its_image_beside_it() -> None:
    root, findings = mended(document(EFFECT, version="1.4.1"))
    assert names(root, "library_images/image") == ["init_from"]
    sampler = next(root.iter(C + "sampler2D"))
    assert (len(sampler), sampler.getparent().get("sid")) == (0, "t")
    aside = next(t for t in root.iter(C + "technique") if t.get("profile") == "colladaphy-1.4")
    assert aside.find(f".//{C}instance_image").get("url") == "#i"
    assert aside.findtext(f".//{C}surface/{C}init_from") == "i"
    assert {"upgrade-effect-image", "upgrade-sampler", "upgrade-surface"} <= codes(findings)


def test_shader_profiles_of_1_4_are_kept_whole() -> None:
    effect = (
        '<library_effects><effect id="e"><profile_GLSL><include sid="a" url="a.glsl"/>'
        '<technique sid="t"><pass/></technique></profile_GLSL></effect></library_effects>'
    )
    root, findings = mended(document(effect, version="1.4.1"))
    assert names(root, "effect") == ["profile_COMMON", "extra"]
    assert "a.glsl" in kept(root)
    assert codes(findings) == {"upgrade-version", "upgrade-shader-profile"}


def test_what_1_4_allowed_and_1_5_does_not_is_kept() -> None:
    scene = (
        '<library_visual_scenes><visual_scene id="v"><node id="n"/><evaluate_scene>'
        '<render camera_node="#n"><instance_effect url="#e"/></render></evaluate_scene>'
        "</visual_scene></library_visual_scenes>"
    )
    root, findings = mended(document(scene, version="1.4.1"))
    assert names(root, "render") == ["extra"]
    assert 'url="#e"' in kept(root)
    assert codes(findings) == {"upgrade-version", "repair-unexpected-element"}


def test_the_namespace_decides_against_the_version_attribute() -> None:
    root, findings = mended(parse(f'<COLLADA xmlns="{NS_1_5}" version="1.4.1">{ASSET}</COLLADA>'))
    assert root.get("version") == "1.5.0"
    assert codes(findings) == {"repair-version"}


def test_the_whole_schema_comes_back_from_1_4() -> None:
    for text in list(covering_documents())[::15]:
        there, _ = to_collada_1_4(etree.ElementTree(etree.fromstring(text)))
        mended(there)


def test_a_stated_type_within_a_profile_that_is_set_aside_does_not_count() -> None:
    xsi = "http://www.w3.org/2001/XMLSchema-instance"
    effect = (
        f'<effect id="e"><profile_GLSL><technique sid="t"><pass xmlns:xsi="{xsi}" '
        'xsi:type="translate_type"><program/></pass></technique></profile_GLSL></effect>'
    )
    root, findings = mended(
        document(f"<library_effects>{effect}</library_effects>", version="1.4.1")
    )
    assert "translate_type" in kept(root)
    assert "repair-unknown-attribute" in codes(findings)
