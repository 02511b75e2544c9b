"""What decoded objects hold and how they are written, case by case."""

from __future__ import annotations

import copy
import gc
import math
import pickle
import re
import threading
from typing import Any

import pytest
from lxml import etree

from colladaphy.conform.grammar import ComplexType, Declaration, root_declaration
from colladaphy.testing import covering_documents
from colladaphy_schema import codec
from colladaphy_schema.codec import (
    AnyElement,
    CodecError,
    Comment,
    ProcessingInstruction,
    decode,
    decode_document,
    encode,
    encode_document,
)
from colladaphy_schema.core import (
    AssetTypeUnit,
    ExtraType,
    TargetableFloat3Type,
    TechniqueType,
    TranslateType,
)
from colladaphy_schema.images import ImageType
from colladaphy_schema.pe import Body
from colladaphy_schema.physics import (
    InstancePhysicsMaterialType,
    InstanceRigidBodyTypeTechniqueCommon,
    PhysicsSceneTypeTechniqueCommon,
    RigidBodyType,
    RigidConstraintTypeTechniqueCommon,
)
from colladaphy_schema.scene import NodeType

NAMESPACE = "http://www.collada.org/2008/03/COLLADASchema"


def element(text: str) -> etree._Element:
    """An element in COLLADA's namespace, with the usual prefixes bound around it."""
    source = (
        f'<root xmlns="{NAMESPACE}" xmlns:pe="urn:colladaphy:pe:1" '
        f'xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance">{text}</root>'
    )
    return etree.fromstring(source)[0]


def through(text: str, cls: type[Any]) -> Any:
    return decode(element(text), cls)


def inner(text: str) -> str:
    """Without namespace declarations."""
    return re.sub(r' xmlns(:\w+)?="[^"]*"', "", text)


# --- defaults ------------------------------------------------------------------------------


def test_empty_elements_hold_the_defaults_of_the_schema() -> None:
    motion = through(
        "<technique_common><angular_velocity/><velocity></velocity><dynamic/></technique_common>",
        InstanceRigidBodyTypeTechniqueCommon,
    )
    assert motion.velocity == [0.0, 0.0, 0.0]
    assert motion.angular_velocity == [0.0, 0.0, 0.0]
    assert motion.dynamic.value is True
    constraint = through(
        "<technique_common><enabled/><interpenetrate/><limits><linear><min/></linear></limits>"
        "<spring><angular><stiffness/></angular></spring></technique_common>",
        RigidConstraintTypeTechniqueCommon,
    )
    assert constraint.enabled.value is True
    assert constraint.interpenetrate.value is False
    assert constraint.limits.linear.min.value == [0.0, 0.0, 0.0]
    assert constraint.limits.linear.max is None
    assert constraint.spring.angular.stiffness.value == 1.0


def test_absent_elements_stay_absent() -> None:
    motion = through("<technique_common/>", InstanceRigidBodyTypeTechniqueCommon)
    assert (motion.velocity, motion.dynamic) == ([], None)
    assert inner(encode(motion, "technique_common")) == "<technique_common/>"


def test_every_default_of_an_element_is_applied() -> None:
    """By the class model of conform, which reads the schema by itself."""
    seen = set()
    for document in covering_documents():
        for path, default in defaulted(etree.fromstring(document)):
            if path in seen:
                continue
            seen.add(path)
            tree = etree.fromstring(document)
            place = tree.find(path)
            assert place is not None
            for child in place:
                place.remove(child)
            place.text = None
            empty = decode_document(tree)
            place.text = default
            assert decode_document(tree) == empty
    assert len({path.split("/")[-1] for path in seen}) >= 15


def defaulted(root: etree._Element) -> list[tuple[str, str]]:
    """Paths of the elements for which the schema has a default."""
    found: list[tuple[str, str]] = []
    tree = etree.ElementTree(root)

    def walk(node: etree._Element, declaration: Declaration) -> None:
        if declaration.default is not None:
            found.append((tree.getelementpath(node), declaration.default))
        if isinstance(declaration.type, ComplexType) and not declaration.type.anything:
            for child in node:
                walk(child, declaration.type.children[etree.QName(child).localname])

    walk(root, root_declaration())
    return found


@pytest.mark.parametrize("source", ["<unit/>", '<unit meter="1.0"/>', '<unit name="meter"/>'])
def test_stated_attribute_defaults_are_kept_and_no_others_added(source: str) -> None:
    unit = through(source, AssetTypeUnit)
    assert unit == AssetTypeUnit()
    assert inner(encode(unit, "unit")) == source
    assert inner(encode(copy.deepcopy(unit), "unit")) == source
    assert inner(encode(pickle.loads(pickle.dumps(unit)), "unit")) == source


def test_a_value_that_is_not_the_default_is_written() -> None:
    assert inner(encode(AssetTypeUnit(meter=0.01), "unit")) == '<unit meter="0.01"/>'
    unit = through('<unit meter="1"/>', AssetTypeUnit)
    unit.meter = 2.0
    assert inner(encode(unit, "unit")) == '<unit meter="2.0"/>'


def test_an_empty_list_that_is_stated_is_kept() -> None:
    assert inner(encode(through('<node layer=""/>', NodeType), "node")) == '<node layer=""/>'
    assert inner(encode(through("<node/>", NodeType), "node")) == "<node/>"


# --- values --------------------------------------------------------------------------------


def test_special_floats() -> None:
    value = through("<v> -INF\n NaN 0x </v>".replace("0x", "INF"), TargetableFloat3Type).value
    assert value[0] == -math.inf and math.isnan(value[1]) and value[2] == math.inf
    text = encode(TargetableFloat3Type(value=[math.inf, -0.0, 5e-324]), "v")
    assert inner(text) == "<v>INF -0.0 5e-324</v>"


def test_comments_inside_simple_content_do_not_cut_it() -> None:
    assert through("<v>1 <!-- x -->2<?y?> 3</v>", TargetableFloat3Type).value == [1.0, 2.0, 3.0]


@pytest.mark.parametrize("text", ["1 2", "1 2 3 4", "", "1 2 x", "1 2 1_0", "1 2 inf"])
def test_lists_of_the_wrong_length_or_of_no_numbers_are_rejected(text: str) -> None:
    with pytest.raises(CodecError, match="line 1: <v>"):
        through(f"<v>{text}</v>", TargetableFloat3Type)


def test_names_are_stripped_and_texts_are_not() -> None:
    body = through(
        '<rigid_body sid=" a " name="b  c"><technique_common><shape><sphere><radius>1</radius>'
        "</sphere></shape></technique_common></rigid_body>",
        RigidBodyType,
    )
    assert (body.sid, body.name) == ("a", "b c")


# --- what does not belong ------------------------------------------------------------------


@pytest.mark.parametrize(
    ("source", "cls", "message"),
    [
        ("<rigid_body/>", RigidBodyType, "sid is missing|technique_common is missing"),
        ("<unit foot='1'/>", AssetTypeUnit, "unexpected attribute foot"),
        ("<node><mass>1</mass></node>", NodeType, "unexpected .*mass in <node>"),
        ("<node><x xmlns='urn:x'/></node>", NodeType, "unexpected {urn:x}x"),
        ("<node type='LIMB'/>", NodeType, "'LIMB' is not one of JOINT, NODE"),
        ("<v>1<w/>2 3</v>", TargetableFloat3Type, "inside simple content"),
    ],
)
def test_unexpected_content_is_a_clear_error(source: str, cls: type[Any], message: str) -> None:
    with pytest.raises(CodecError, match=message):
        through(source, cls)


def test_wrong_values_are_clear_errors_on_writing() -> None:
    with pytest.raises(CodecError, match="AssetTypeUnit holds a value of a wrong type"):
        encode(AssetTypeUnit(meter="far"), "unit")  # type: ignore[arg-type]
    with pytest.raises(CodecError, match="cannot stand where"):
        encode(ImageType(choice=3), "image")  # type: ignore[arg-type]
    with pytest.raises(CodecError, match="not a class of the schema"):
        encode(3, "unit")
    with pytest.raises(CodecError, match=r"U\+0000"):
        encode(AssetTypeUnit(name="\0"), "unit")
    with pytest.raises(CodecError, match="not COLLADA"):
        decode_document(etree.fromstring("<COLLADA/>"))


# --- xsi:type ------------------------------------------------------------------------------


def test_a_derived_type_is_decoded_and_written_with_its_name() -> None:
    gravity = '<gravity xsi:type="translate_type" sid="g">0 0 1</gravity>'
    source = f"<technique_common>{gravity}</technique_common>"
    common = through(source, PhysicsSceneTypeTechniqueCommon)
    assert common.gravity == TranslateType(value=[0.0, 0.0, 1.0], sid="g")
    text = encode(common, "technique_common")
    assert '<gravity xsi:type="translate_type" sid="g">0.0 0.0 1.0</gravity>' in text
    assert decode(etree.fromstring(text), PhysicsSceneTypeTechniqueCommon) == common


def test_the_declared_type_may_be_named_and_an_unrelated_one_may_not() -> None:
    own = '<v xsi:type="targetable_float3_type">1 2 3</v>'
    assert type(through(own, TargetableFloat3Type)) is TargetableFloat3Type
    with pytest.raises(CodecError, match="not derived"):
        through('<v xsi:type="rotate_type">1 2 3 4</v>', TargetableFloat3Type)
    with pytest.raises(CodecError, match="not derived"):
        through('<v xmlns:n="urn:n" xsi:type="n:translate_type">1 2 3</v>', TargetableFloat3Type)


def test_attributes_of_the_instance_namespace_are_passed_over() -> None:
    assert through('<unit xsi:schemaLocation="a b"/>', AssetTypeUnit) == AssetTypeUnit()


def test_types_without_content_have_none() -> None:
    empty = through('<instance_physics_material url="#m"/>', InstancePhysicsMaterialType)
    assert inner(encode(empty, "m")) == '<m url="#m"/>'
    with pytest.raises(CodecError, match="unexpected"):
        through(
            '<instance_physics_material url="#m"><extra><technique profile="x"/></extra>'
            "</instance_physics_material>",
            InstancePhysicsMaterialType,
        )


# --- wildcards -----------------------------------------------------------------------------

FOREIGN = (
    '<technique profile="x"><!-- a --><o:thing xmlns:o="urn:o" o:k="o:v" l="m">text<o:inner/>'
    'tail<?do it?><!-- b --><plain xmlns="">p</plain></o:thing><?last?></technique>'
)


def test_foreign_content_is_kept_node_by_node() -> None:
    technique = through(FOREIGN, TechniqueType)
    comment, thing, last = technique.any_element
    assert comment == Comment(text=" a ")
    assert isinstance(thing, AnyElement)
    assert (thing.qname, thing.prefix, thing.text) == ("{urn:o}thing", "o", "text")
    assert thing.attributes == {"{urn:o}k": "o:v", "l": "m"}
    assert [type(node) for node in thing.children] == [
        AnyElement, ProcessingInstruction, Comment, AnyElement
    ]  # fmt: skip
    assert last == ProcessingInstruction(target="last")
    text = encode(technique, "technique")
    expected = etree.tostring(element(FOREIGN), method="c14n", exclusive=True)
    assert etree.tostring(etree.fromstring(text), method="c14n", exclusive=True) == expected


def test_declared_elements_of_the_profile_become_their_classes() -> None:
    content = '<pe:body uid="7" name="a  b"/><pe:unknown>1</pe:unknown>'
    technique = through(f'<technique profile="pe">{content}</technique>', TechniqueType)
    body, unknown = technique.any_element
    assert isinstance(body, Body) and (body.uid, body.name) == (7, "a  b")
    assert isinstance(unknown, AnyElement)
    text = encode(technique, "technique")
    assert 'xmlns:pe="urn:colladaphy:pe:1"' in text
    assert content in text


def test_foreign_nodes_made_by_hand_get_the_declarations_they_need() -> None:
    node = AnyElement(
        qname="{urn:a}x",
        attributes={"{urn:b}y": "1", "{http://www.w3.org/XML/1998/namespace}lang": "en"},
        children=[AnyElement(qname="z"), AnyElement(qname=f"{{{NAMESPACE}}}w")],
    )
    extra = ExtraType(technique=[TechniqueType(profile="x", any_element=[node])])
    again = decode(etree.fromstring(encode(extra, "extra")), ExtraType)
    assert again == extra


@pytest.mark.parametrize(
    "node", [Comment(text="a--b"), Comment(text="a-"), ProcessingInstruction(target="t", text="?>")]
)
def test_impossible_nodes_are_refused(node: object) -> None:
    with pytest.raises(CodecError, match="cannot hold"):
        encode(TechniqueType(profile="x", any_element=[node]), "technique")


# --- documents -----------------------------------------------------------------------------

DOCUMENT = f"""<COLLADA xmlns="{NAMESPACE}" version="1.5.0" xml:base="http://example.org/">
<asset><created>2024-01-01T00:00:00Z</created><modified>2024-01-01T00:00:00Z</modified></asset>
</COLLADA>"""


def test_a_document_with_its_base() -> None:
    root = decode_document(etree.fromstring(DOCUMENT))
    assert root.base == "http://example.org/"
    text = encode_document(root)
    assert text.startswith(
        '<?xml version="1.0" encoding="UTF-8"?>\n<COLLADA xmlns="http://www.coll'
    )
    assert "xmlns:pe" not in text and "xmlns:xsi" not in text
    assert decode_document(etree.ElementTree(etree.fromstring(text.encode()))) == root


def test_declarations_around_a_fragment_are_not_repeated() -> None:
    unit = AssetTypeUnit(meter=2.0)
    assert encode(unit, "unit", {None: NAMESPACE}) == '<unit meter="2.0"/>'
    assert encode(unit, f"{{{NAMESPACE}}}unit") == f'<unit xmlns="{NAMESPACE}" meter="2.0"/>'
    assert encode(Body(uid=1), "body", {None: NAMESPACE, "pe": "urn:colladaphy:pe:1"}) == (
        '<pe:body uid="1"/>'
    )
    with pytest.raises(CodecError, match="not a namespace"):
        encode(unit, "{urn:x}unit")


def test_the_collector_rests_while_decoding_and_is_as_before_afterwards() -> None:
    seen: list[bool] = []
    assert gc.isenabled()
    with codec.paused_collector():
        with codec.paused_collector():
            seen.append(gc.isenabled())
        thread = threading.Thread(target=decode_document, args=(etree.fromstring(DOCUMENT),))
        thread.start()
        thread.join()
        seen.append(gc.isenabled())
    assert seen == [False, False]
    assert gc.isenabled()
    with pytest.raises(CodecError):
        decode_document(etree.fromstring(DOCUMENT.replace('"1.5.0"', '"2"')))
    assert gc.isenabled()
    gc.disable()
    try:
        decode_document(etree.fromstring(DOCUMENT))
        assert not gc.isenabled()
    finally:
        gc.enable()
