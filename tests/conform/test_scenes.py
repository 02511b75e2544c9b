"""The scene that puts physics into effect."""

from __future__ import annotations

import pytest
from lxml import etree
from tests.conform.documents import BOX, C, codes, mended, names, physics

SECOND = '<physics_scene id="ps2"><technique_common/></physics_scene>'


def without_scene(*, second: bool = False) -> etree._ElementTree:
    tree = physics(BOX)
    root = tree.getroot()
    root.remove(root.find(C + "scene"))
    if second:
        root.find(C + "library_physics_scenes").append(scene_element())
    return tree


def scene_element() -> etree._Element:
    holder = etree.fromstring(f'<x xmlns="{C[1:-1]}">{SECOND}</x>')
    return holder[0]


def in_effect(root: etree._Element) -> list[str | None]:
    return [instance.get("url") for instance in root.iter(C + "instance_physics_scene")]


def test_a_document_without_a_scene_gets_one_before_its_extras() -> None:
    tree = without_scene()
    etree.SubElement(etree.SubElement(tree.getroot(), C + "extra"), C + "technique", profile="x")
    root, findings = mended(tree)
    assert [etree.QName(child).localname for child in root][-2:] == ["scene", "extra"]
    assert names(root, "scene") == ["instance_physics_scene", "instance_visual_scene"]
    assert in_effect(root) == ["#ps"]
    assert root.find(f"{C}scene/{C}instance_visual_scene").get("url") == "#vs"
    assert codes(findings) == {"repair-missing-scene"}


def test_scenes_without_ids_get_them() -> None:
    tree = without_scene()
    for name in ("physics_scene", "visual_scene"):
        del next(tree.getroot().iter(C + name)).attrib["id"]
    root, _ = mended(tree)
    assert in_effect(root) == [f"#{next(root.iter(C + 'physics_scene')).get('id')}"]


def test_several_visual_scenes_leave_open_which_is_shown() -> None:
    tree = without_scene()
    visual = etree.SubElement(next(tree.getroot().iter(C + "library_visual_scenes")), C + "x")
    visual.tag = C + "visual_scene"
    etree.SubElement(visual, C + "node")
    root, _ = mended(tree)
    assert names(root, "scene") == ["instance_physics_scene"]


def test_the_first_of_several_is_taken_and_the_others_are_named() -> None:
    root, findings = mended(without_scene(second=True))
    assert in_effect(root) == ["#ps"]
    assert [finding.code for finding in findings] == ["repair-missing-scene"]
    assert "ps2" in findings[0].message


@pytest.mark.parametrize("second", [False, True])
def test_a_scene_without_physics_gets_the_only_one(second: bool) -> None:
    tree = physics(BOX)
    scene = tree.getroot().find(C + "scene")
    scene.remove(scene[0])
    if second:
        tree.getroot().find(C + "library_physics_scenes").append(scene_element())
    root, findings = mended(tree)
    assert in_effect(root) == ([] if second else ["#ps"])
    assert codes(findings) == (set() if second else {"repair-missing-scene"})


def test_nothing_to_instance() -> None:
    tree = without_scene()
    tree.getroot().remove(tree.getroot().find(C + "library_physics_scenes"))
    root, findings = mended(tree)
    assert root.find(C + "scene") is None
    assert findings == []
