"""Order, wrappers, names, libraries, missing and misplaced things: the generic repairs."""

from __future__ import annotations

import pytest
from tests.conform.documents import (
    ASSET,
    BOX,
    MESH,
    C,
    codes,
    document,
    kept,
    mended,
    names,
    physics,
    words,
)


def test_a_valid_document_is_left_alone() -> None:
    _, findings = mended(physics(BOX))
    assert findings == []


@pytest.mark.parametrize(
    ("body", "order"),
    [
        (BOX + "<mass>1</mass><dynamic>true</dynamic>", ["dynamic", "mass", "shape"]),
        (
            "<inertia>1 1 1</inertia><mass_frame><translate>0 0 1</translate></mass_frame>" + BOX,
            ["mass_frame", "inertia", "shape"],
        ),
    ],
)
def test_children_of_a_body_come_in_order(body: str, order: list[str]) -> None:
    root, findings = mended(physics(body))
    assert names(root, "rigid_body/technique_common") == order
    assert codes(findings) == {"repair-child-order"}
    assert "are now" in findings[0].message


def test_transforms_keep_their_own_order() -> None:
    body = (
        "<shape><translate>1 0 0</translate><rotate>0 0 1 90</rotate><translate>2 0 0</translate>"
        "<sphere><radius>1</radius></sphere></shape>"
    )
    root, _ = mended(physics(body))
    assert names(root, "shape") == ["sphere", "translate", "rotate", "translate"]
    assert [t.text for t in root.iter(C + "translate")] == ["1 0 0", "2 0 0"]


def test_a_comment_stays_before_its_element() -> None:
    root, _ = mended(physics(BOX + "<!-- heavy --><mass>1</mass>"))
    mass = next(root.iter(C + "mass"))
    assert mass.getprevious().text == " heavy "


def test_the_limits_and_springs_of_a_constraint_come_in_order() -> None:
    joint = (
        '<rigid_constraint sid="j"><attachment rigid_body="pm/b1"/><ref_attachment rigid_body=""/>'
        "<technique_common><spring><linear/><angular/></spring><limits><linear/>"
        "<swing_cone_and_twist/></limits></technique_common></rigid_constraint>"
    )
    root, findings = mended(physics(BOX, more=joint))
    assert names(root, "limits") == ["swing_cone_and_twist", "linear"]
    assert names(root, "spring") == ["angular", "linear"]
    assert names(root, "rigid_constraint")[:2] == ["ref_attachment", "attachment"]
    assert codes(findings) == {"repair-child-order"}


def test_a_scene_without_technique_common_gets_one() -> None:
    root, findings = mended(physics(BOX, scene=""))
    assert names(root, "physics_scene") == ["instance_physics_model", "technique_common"]
    assert codes(findings) == {"repair-missing-element"}


def test_an_instance_of_a_body_gets_its_technique_common() -> None:
    bare = '<instance_rigid_body body="b1" target="#n1"/>'
    _, findings = mended(physics(BOX, instances=bare))
    assert codes(findings) == {"repair-missing-element"}


def test_values_outside_of_technique_common_move_into_it() -> None:
    bare = (
        '<instance_rigid_body body="b1" target="#n1"><velocity>1 2 3</velocity>'
        "</instance_rigid_body>"
    )
    root, findings = mended(physics(BOX, instances=bare, scene="<gravity>0 0 -1</gravity>"))
    assert words(root, "instance_rigid_body/technique_common/velocity") == ["1", "2", "3"]
    assert words(root, "physics_scene/technique_common/gravity") == ["0", "0", "-1"]
    assert codes(findings) == {"repair-wrapper"}


def test_an_extra_inside_technique_common_moves_out() -> None:
    extra = '<extra><technique profile="x"><y/></technique></extra>'
    root, findings = mended(physics(extra + BOX))
    assert names(root, "rigid_body") == ["technique_common", "extra"]
    assert codes(findings) == {"repair-wrapper"}


def test_the_asset_is_put_in_order_and_its_contributor_gets_what_is_its() -> None:
    asset = (
        "<asset><subject>s</subject><comments>c</comments><copyright>r</copyright>"
        "<up_axis>z_up</up_axis><unit meter='0.01'/><created>2006-04-05T12:00:00+0100</created>"
        "</asset>"
    )
    root, findings = mended(document("", asset=asset))
    assert names(root, "asset") == [
        "contributor", "created", "modified", "subject", "unit", "up_axis",
    ]  # fmt: skip
    assert names(root, "contributor") == ["comments", "copyright"]
    assert words(root, "created") == words(root, "modified") == ["2006-04-05T12:00:00+01:00"]
    assert words(root, "up_axis") == ["Z_UP"]
    assert codes(findings) == {
        "repair-child-order", "repair-lexical-form", "repair-missing-element", "repair-wrapper",
    }  # fmt: skip


def test_a_document_without_an_asset_gets_one() -> None:
    root, findings = mended(document("", asset=""))
    assert names(root, "asset") == ["created", "modified"]
    assert codes(findings) == {"repair-missing-element"}


@pytest.mark.parametrize("inside", ["", "\n  ", "<!-- nothing yet -->"])
def test_empty_libraries_go_and_their_comments_stay(inside: str) -> None:
    root, findings = mended(document(f"<library_lights>{inside}</library_lights>"))
    assert root.find(C + "library_lights") is None
    assert ("nothing yet" in "".join(node.text or "" for node in root.iter())) == ("<!" in inside)
    assert codes(findings) == {"repair-empty-library"}


def test_misspelt_and_missing_libraries() -> None:
    root, findings = mended(
        document('<library_light/><library_node><node id="a"/></library_node><node id="b"/>')
    )
    assert [node.get("id") for node in root.iter(C + "node")] == ["a", "b"]
    assert codes(findings) == {
        "repair-empty-library", "repair-misspelt-element", "repair-outside-library",
    }  # fmt: skip


def test_scene_instances_come_in_order() -> None:
    tree = physics(BOX)
    scene = tree.getroot()[-1]
    scene.append(scene[0])
    root, findings = mended(tree)
    assert names(root, "scene") == ["instance_physics_scene", "instance_visual_scene"]
    assert codes(findings) == {"repair-child-order"}


def test_what_has_no_place_is_kept_in_an_extra() -> None:
    body = '<mass colour="red">1<b/></mass><wheel rim="17"><tyre/></wheel>loose ends' + BOX
    root, findings = mended(physics(body))
    assert names(root, "rigid_body/technique_common") == ["mass", "shape"]
    for word in ('rim="17"', "tyre", "loose ends", 'value="red"', "<b"):
        assert word in kept(root), word
    assert codes(findings) == {
        "repair-unexpected-element", "repair-unexpected-text", "repair-unknown-attribute",
    }  # fmt: skip


def test_foreign_elements_are_no_standard_ones() -> None:
    tree = physics('<x:mass xmlns:x="urn:x">3</x:mass>' + BOX)
    root, findings = mended(tree)
    assert "urn:x" in kept(root)
    assert codes(findings) == {"repair-unexpected-element"}


@pytest.mark.parametrize(
    ("body", "path", "new"),
    [
        ("<dynamic>True</dynamic>", "dynamic", "true"),
        ("<dynamic>NO</dynamic>", "dynamic", "false"),
        ("<mass>1.5f</mass>", "mass", "1.5"),
        ("<mass>1.#INF</mass>", "mass", "INF"),
        ("<mass>infinity</mass>", "mass", "INF"),
        ("<inertia>1, 2, 3</inertia>", "inertia", "1 2 3"),
        ("<inertia>1.0f;2.0f;3.0f</inertia>", "inertia", "1.0 2.0 3.0"),
    ],
)
def test_numbers_in_other_spellings(body: str, path: str, new: str) -> None:
    root, findings = mended(physics(body + BOX))
    assert " ".join(words(root, f"technique_common/{path}")) == new
    assert codes(findings) == {"repair-lexical-form"}
    assert new in findings[0].message


def test_a_value_that_nobody_can_read_is_kept() -> None:
    root, findings = mended(physics("<mass>heavy</mass>" + BOX))
    assert names(root, "rigid_body/technique_common") == ["shape"]
    assert "heavy" in kept(root)
    assert codes(findings) == {"repair-unreadable-value"}


def test_a_default_replaces_a_value_that_nobody_can_read() -> None:
    bare = (
        '<instance_rigid_body body="b1" target="#n1"><technique_common><velocity>fast</velocity>'
        "</technique_common></instance_rigid_body>"
    )
    root, findings = mended(physics(BOX, instances=bare))
    assert words(root, "velocity") == []
    assert "fast" in kept(root)
    assert "default" in findings[0].message


def test_digits_out_of_range_and_missing_counts() -> None:
    mesh = MESH.format("g").replace('count="12"', 'digits="2490384"')
    root, findings = mended(
        document(
            f'<library_geometries><geometry id="g"><mesh>{mesh}</mesh></geometry>'
            "</library_geometries>"
        )
    )
    array = next(root.iter(C + "float_array"))
    assert (array.get("digits"), array.get("count")) == ("17", "12")
    assert codes(findings) == {"repair-lexical-form", "repair-missing-attribute"}


def test_a_binding_of_nothing_goes() -> None:
    nodes = (
        '<node id="n1"><instance_geometry url="#g"><bind_material><technique_common/>'
        "</bind_material></instance_geometry></node>"
    )
    root, findings = mended(physics(BOX, nodes=nodes))
    assert names(root, "node") == ["instance_geometry"]
    assert codes(findings) == {"repair-empty-bind-material"}


def test_kinematics_without_frames_get_empty_ones() -> None:
    root, findings = mended(
        document(
            '<library_articulated_systems><articulated_system id="a"><kinematics>'
            '<instance_kinematics_model url="#k"/><technique_common/></kinematics>'
            "</articulated_system></library_articulated_systems>"
        )
    )
    assert names(root, "kinematics/technique_common") == ["frame_origin", "frame_tip"]
    assert codes(findings) == {"repair-missing-element"}


def test_an_incomplete_element_is_kept() -> None:
    root, findings = mended(
        document('<library_cameras><camera id="c"><optics/></camera></library_cameras>')
    )
    assert root.find(C + "library_cameras") is None
    assert 'id="c"' in kept(root)
    assert codes(findings) == {"repair-incomplete-element"}


def test_texture_without_coordinates() -> None:
    root, findings = mended(
        document(
            '<library_effects><effect id="e"><profile_COMMON><technique sid=""><lambert><diffuse>'
            '<texture texture="t"/></diffuse></lambert></technique></profile_COMMON></effect>'
            "</library_effects>"
        )
    )
    assert next(root.iter(C + "texture")).get("texcoord") == "UVSET0"
    assert codes(findings) == {"repair-missing-attribute", "repair-empty-sid"}


def test_only_the_wanted_rules_change_anything() -> None:
    tree = physics("<mass>1.5f</mass><dynamic>yes</dynamic>" + BOX)
    root, findings = mended(tree, only=("repair-child-order",))
    assert codes(findings) == {"repair-child-order"}
    assert names(root, "rigid_body/technique_common") == ["dynamic", "mass", "shape"]
    assert words(root, "technique_common/mass") == ["1.5f"]


def test_every_finding_says_where() -> None:
    text = "\n".join(["<mass>1</mass>", "<dynamic>true</dynamic>", BOX])
    _, findings = mended(physics("\n" + text, asset="\n" + ASSET + "\n"))
    assert [(f.line, f.path) for f in findings] == [
        (3, "/COLLADA/library_physics_models/physics_model/rigid_body/technique_common")
    ]
