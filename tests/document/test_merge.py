"""Saving edits without losing anything: exact changes, and exactness under any edits."""

from __future__ import annotations

import copy
import dataclasses
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lxml import etree

from colladaphy.document.merge import merge
from colladaphy.testing import documents
from colladaphy_schema.codec import AnyElement, Comment, decode_document, encode_document
from colladaphy_schema.core import TargetableFloatType, TranslateType
from colladaphy_schema.pe import Body
from colladaphy_schema.physics import RigidBodyType

SOURCE = """<?xml version="1.0" encoding="UTF-8"?>
<?keep before?>
<!-- written by hand -->
<c:COLLADA xmlns:c="http://www.collada.org/2008/03/COLLADASchema" xmlns:own="urn:own"
    xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmlns:p="urn:colladaphy:pe:1"
    xsi:schemaLocation="urn:a b.xsd" version="1.5.0">
  <c:asset>
    <c:created> 2024-01-31T12:00:00.50Z </c:created><c:modified>2024-01-31T12:00:00Z</c:modified>
  </c:asset>
  <c:library_physics_models>
    <!-- the models -->
    <c:physics_model id="model">
      <c:rigid_body   sid = 'first'  >
        <c:technique_common>
          <c:dynamic>1</c:dynamic><!-- as is -->
          <c:mass>1.<!-- kilogram -->50</c:mass>
          <c:mass_frame><c:translate>00.5 +1 1e0</c:translate></c:mass_frame>
          <c:shape><c:sphere><c:radius> 2 </c:radius></c:sphere></c:shape>
        </c:technique_common>
        <c:technique profile="pe">
          <p:body uid="07"><!-- profile --></p:body>
          <own:thing own:a="1" b="p:q">text<own:inner/>tail<?own data?></own:thing><!-- end -->
        </c:technique>
      </c:rigid_body>
      <c:rigid_body sid="second">
        <c:technique_common>
          <c:dynamic>0</c:dynamic>
          <c:shape><c:box><c:half_extents>1 1 1</c:half_extents></c:box></c:shape>
        </c:technique_common>
      </c:rigid_body>
      <!-- after the bodies -->
    </c:physics_model>
  </c:library_physics_models>
</c:COLLADA>
<!-- after the end -->
"""


def parsed(source: str = SOURCE) -> etree._ElementTree:
    return etree.ElementTree(etree.fromstring(source.encode()))


def canonical(tree: etree._ElementTree) -> str:
    return etree.tostring(tree, method="c14n").decode()


def bodies(root: Any) -> list[RigidBodyType]:
    model = root.choice[0].physics_model[0]
    return list(model.rigid_body)


def edited(tree: etree._ElementTree) -> Any:
    return decode_document(tree)


def check(tree: etree._ElementTree, root: Any) -> etree._ElementTree:
    """Merge, and hold what every merge owes."""
    before = canonical(tree)
    result = merge(tree, root)
    assert canonical(tree) == before  # the original is not touched
    reread = etree.ElementTree(etree.fromstring(etree.tostring(result)))
    assert same(decode_document(result), root)
    assert same(decode_document(reread), root)
    return result


def same(one: Any, other: Any) -> bool:
    """Whether two documents are equal, where a NaN equals a NaN."""
    return bool(one == other) or encode_document(one) == encode_document(other)


def test_nothing_edited_is_the_original() -> None:
    tree = parsed()
    assert merge(tree, edited(tree)) is tree


def test_one_mass_changes_and_nothing_else() -> None:
    tree = parsed()
    root = edited(tree)
    mass = bodies(root)[0].technique_common.mass
    assert mass is not None and mass.value == 1.5
    mass.value = 0.1
    result = check(tree, root)
    assert canonical(result) == canonical(tree).replace(
        "1.<!-- kilogram -->50", "0.1<!-- kilogram -->"
    )
    assert result.docinfo.encoding == tree.docinfo.encoding


def test_a_list_of_numbers_changes_alone() -> None:
    tree = parsed()
    root = edited(tree)
    frame = bodies(root)[0].technique_common.mass_frame
    assert frame is not None
    frame.translate_or_rotate[0].value = [0.5, 1.0, 2.0]
    result = check(tree, root)
    assert canonical(result) == canonical(tree).replace("00.5 +1 1e0", "0.5 1.0 2.0")


def test_negative_zero_is_a_change() -> None:
    tree = parsed(SOURCE.replace("00.5 +1 1e0", "0 1 1"))
    root = edited(tree)
    frame = bodies(root)[0].technique_common.mass_frame
    assert frame is not None
    frame.translate_or_rotate[0].value = [-0.0, 1.0, 1.0]
    assert "-0.0 1.0 1.0" in canonical(check(tree, root))


def test_an_inserted_element_is_indented_and_prefixed_like_its_siblings() -> None:
    tree = parsed()
    root = edited(tree)
    bodies(root)[1].technique_common.mass = TargetableFloatType(value=3)
    result = check(tree, root)
    assert canonical(result) == canonical(tree).replace(
        "<c:dynamic>0</c:dynamic>\n",
        "<c:dynamic>0</c:dynamic>\n          <c:mass>3.0</c:mass>\n",
    )


def test_an_inserted_subtree_is_indented_inside() -> None:
    tree = parsed()
    root = edited(tree)
    model = root.choice[0].physics_model[0]
    new = copy.deepcopy(bodies(root)[1])
    new.sid = "third"
    model.rigid_body.append(new)
    text = canonical(check(tree, root))
    assert (
        '\n      <c:rigid_body sid="third">\n        <c:technique_common>\n'
        "          <c:dynamic>false</c:dynamic>\n          <c:shape>\n            <c:box>\n"
    ) in text
    assert "      </c:rigid_body>\n      <!-- after the bodies -->\n    </c:physics_model>" in text


def test_a_removed_body_leaves_the_rest() -> None:
    tree = parsed()
    root = edited(tree)
    model = root.choice[0].physics_model[0]
    del model.rigid_body[0]
    text = canonical(check(tree, root))
    whole = canonical(tree)
    start, stop = whole.index("<c:rigid_body"), whole.index('<c:rigid_body sid="second"')
    assert text == whole[:start] + whole[stop:]


def test_moved_bodies_keep_their_spelling() -> None:
    tree = parsed()
    root = edited(tree)
    root.choice[0].physics_model[0].rigid_body.reverse()
    text = canonical(check(tree, root))
    assert text.index('sid="second"') < text.index('sid="first"')
    assert "1.<!-- kilogram -->50" in text
    assert "00.5 +1 1e0" in text


def test_wildcards_are_patched_inside() -> None:
    tree = parsed()
    root = edited(tree)
    technique = bodies(root)[0].technique[0]
    body, thing, comment = technique.any_element
    assert isinstance(body, Body) and isinstance(thing, AnyElement)
    assert isinstance(comment, Comment)
    body.uid = 8
    thing.attributes["b"] = "p:r"
    comment.text = " the end "
    result = check(tree, root)
    expected = canonical(tree).replace('uid="07"', 'uid="8"').replace("p:q", "p:r")
    assert canonical(result) == expected.replace("<!-- end -->", "<!-- the end -->")


def test_a_derived_type_is_named_with_the_prefix_of_the_original() -> None:
    source = SOURCE.replace(
        "<c:sphere><c:radius> 2 </c:radius></c:sphere>",
        "<c:sphere><c:radius>2</c:radius></c:sphere>",
    ).replace(
        "  <c:library_physics_models>",
        "  <c:library_physics_scenes><c:physics_scene><c:technique_common><c:gravity>0 0 1"
        "</c:gravity></c:technique_common></c:physics_scene></c:library_physics_scenes>\n"
        "  <c:library_physics_models>",
    )
    tree = parsed(source)
    root = edited(tree)
    root.choice[0].physics_scene[0].technique_common.gravity = TranslateType(value=[0, 0, 2])
    assert '<c:gravity xsi:type="c:translate_type">0.0 0.0 2.0</c:gravity>' in canonical(
        check(tree, root)
    )


HIDDEN = (
    '<c:extra><c:technique profile="x"><plain xmlns="urn:f"><c:inner c:k="1"/></plain>'
    '<f:a xmlns:f="urn:f" xmlns:own="urn:g"><own:b/><g:c xmlns:g="urn:own"/></f:a>'
    '<plain xmlns:n="urn:f"><plain xmlns="urn:f" n:c=""/></plain>'
    "</c:technique></c:extra>"
)


@pytest.mark.parametrize("default", [False, True])
def test_foreign_namespaces_survive_being_inserted_and_moved(default: bool) -> None:
    source = SOURCE
    if default:
        source = source.replace("<c:", "<").replace("</c:", "</").replace("xmlns:c", "xmlns")
    tree = parsed(source)
    root = edited(tree)
    whole = SOURCE.replace("</c:library_physics_models>", f"</c:library_physics_models>{HIDDEN}")
    root.extra = edited(parsed(whole)).extra
    bodies(root)[1].extra = copy.deepcopy(root.extra)
    result = check(tree, root)
    again = edited(result)
    again.choice[0].physics_model[0].rigid_body.reverse()
    check(result, again)


@pytest.mark.parametrize("count", [3, 400])
def test_one_of_many_bodies_changes(count: int) -> None:
    body = SOURCE[SOURCE.index('<c:rigid_body sid="second"') : SOURCE.index("      <!-- after the")]
    many = "".join(body.replace("second", f"body{i}") for i in range(count))
    tree = parsed(SOURCE.replace(body, body + many))
    root = edited(tree)
    for each in bodies(root)[2::2]:
        each.name = "even"
    del root.choice[0].physics_model[0].rigid_body[count // 2]
    check(tree, root)


@settings(max_examples=settings().max_examples // 2)
@given(documents(size=30), documents(size=30))
def test_one_document_becomes_any_other(first: bytes, second: bytes) -> None:
    tree = etree.ElementTree(etree.fromstring(first))
    check(tree, decode_document(etree.fromstring(second)))


def parts(value: Any) -> list[Any]:
    """All dataclasses below a value."""
    found = []
    if dataclasses.is_dataclass(value):
        found.append(value)
        for field in dataclasses.fields(value):
            found += parts(getattr(value, field.name))
    elif isinstance(value, list):
        for item in value:
            found += parts(item)
    return found


@settings(max_examples=settings().max_examples // 2)
@given(documents(size=40), st.data())
def test_any_edits_are_saved_exactly(document: bytes, data: st.DataObject) -> None:
    tree = etree.ElementTree(etree.fromstring(document))
    root = decode_document(tree)
    for _ in range(data.draw(st.integers(1, 4))):
        part = data.draw(st.sampled_from(parts(root)))
        edit(part, data)
    check(tree, root)


def edit(part: Any, data: st.DataObject) -> None:
    """Change one thing of a dataclass that leaves it writable."""
    names = [field.name for field in dataclasses.fields(part)]
    name = data.draw(st.sampled_from(names))
    value = getattr(part, name)
    if isinstance(value, float):
        setattr(part, name, data.draw(st.floats(allow_nan=False)))
    elif isinstance(value, list) and value:
        action = data.draw(st.sampled_from(["double", "drop", "reverse", "rotate"]))
        if isinstance(value[0], float | int | bool | str | bytes):
            value[0] = value[-1]  # such lists have a length of their own
        elif action == "double":
            value.append(copy.deepcopy(value[0]))
        elif action == "drop":
            del value[data.draw(st.integers(0, len(value) - 1))]
        elif action == "reverse":
            value.reverse()
        else:
            value.append(value.pop(0))
