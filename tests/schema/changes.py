"""Changes to base.xsd, as text replaced by text: mutations that a comparison of schemas must find,
and rewritings that it must accept. ``\\g<0>`` in the new text stands for the old."""

from pathlib import Path

BASE = (Path(__file__).parent / "base.xsd").read_text("utf-8")

SIZE = '<xs:element name="size" type="size_type" nillable="true"/>'
ITEM = '<xs:sequence><xs:element name="item" type="xs:string" minOccurs="0"/></xs:sequence>'
CHOICE = BASE[BASE.index("      <xs:choice") : BASE.index("      <xs:group ref")]
SECOND = '      <xs:element name="second" type="xs:int" default="1" minOccurs="0"/>\n'

IMPORT = '<xs:import namespace="urn:x" schemaLocation="nowhere.xsd"/>'

MUTATIONS = {
    "element dropped": (SECOND, ""),
    "element added": (SECOND, SECOND + '<xs:element name="third" type="xs:int" minOccurs="0"/>'),
    "element renamed": ('name="second"', 'name="zweites"'),
    "elements reordered": (SECOND + CHOICE, CHOICE + SECOND),
    "element made optional": ('name="first" type="vector_type"', "\\g<0> minOccurs='0'"),
    "element made required": (' default="1" minOccurs="0"', ' default="1"'),
    "element repeated": ('name="first" type="vector_type"', "\\g<0> maxOccurs='2'"),
    "upper bound lowered": ('maxOccurs="3"', 'maxOccurs="2"'),
    "upper bound lifted": ('maxOccurs="3"', 'maxOccurs="unbounded"'),
    "choice made to occur once": (
        '<xs:choice minOccurs="0" maxOccurs="unbounded">',
        '<xs:choice minOccurs="0">',
    ),
    "choice made a sequence": ("xs:choice", "xs:sequence"),
    "branch dropped": ('<xs:element name="right" type="special_type"/>', ""),
    "element of another type": ('name="second" type="xs:int"', 'name="second" type="xs:long"'),
    "element of a derived type": ('"left" type="base_type"', '"left" type="special_type"'),
    "element of the base of its type": (
        'name="first" type="vector_type"',
        'name="first" type="list_type"',
    ),
    "element of an anonymous copy of its type": (
        SIZE,
        SIZE.replace(' type="size_type"', "").replace("/>", ">")
        + '<xs:simpleType><xs:restriction base="size_type"/></xs:simpleType></xs:element>',
    ),
    "element default changed": ('default="1"', 'default="2"'),
    "element default dropped": (' default="1"', ""),
    "element default made fixed": ('default="1"', 'fixed="1"'),
    "element fixed changed": ('fixed="a-1"', 'fixed="a-2"'),
    "nillable dropped": (' nillable="true"', ""),
    "element blocked": (SIZE, SIZE.replace("/>", ' block="restriction"/>')),
    "element in no namespace": (SIZE, SIZE.replace("/>", ' form="unqualified"/>')),
    "group's content changed": (SIZE, SIZE.replace("/>", ' minOccurs="0"/>')),
    "attribute dropped": ('<xs:attribute name="mode" type="mode_enum"/>', ""),
    "attribute renamed": ('name="mode"', 'name="modus"'),
    "attribute of another type": ('name="mode" type="mode_enum"', 'name="mode" type="xs:string"'),
    "attribute made optional": (' use="required"', ""),
    "attribute made required": ('name="mode" type="mode_enum"', "\\g<0> use='required'"),
    "attribute default changed": ('default="1.0"', 'default="2.0"'),
    "attribute default dropped": (' default="1.0"', ""),
    "attribute fixed changed": ('fixed="1.5"', 'fixed="1.4"'),
    "attribute qualified": ('name="mode" type="mode_enum"', "\\g<0> form='qualified'"),
    "attribute wildcard dropped": (
        '<xs:anyAttribute namespace="##other" processContents="skip"/>',
        "",
    ),
    "attribute wildcard widened": ('namespace="##other"', 'namespace="##any"'),
    "attribute wildcard made strict": ('processContents="skip"', 'processContents="strict"'),
    "wildcard dropped": (
        '<xs:any namespace="##any" processContents="lax" minOccurs="0"/>',
        "",
    ),
    "wildcard narrowed": ('namespace="##any"', 'namespace="##other"'),
    "wildcard made strict": ('processContents="lax"', 'processContents="strict"'),
    "enumeration value dropped": ('<xs:enumeration value="B"/>', ""),
    "enumeration value added": ('<xs:enumeration value="B"/>', "\\g<0><xs:enumeration value='C'/>"),
    "enumeration value changed": ('<xs:enumeration value="B"/>', '<xs:enumeration value="b"/>'),
    "bound changed": ('minInclusive value="0"', 'minInclusive value="1"'),
    "bound made inclusive": ("maxExclusive", "maxInclusive"),
    "bound dropped": ('<xs:maxExclusive value="10"/>', ""),
    "list length changed": ('<xs:maxLength value="3"/>', '<xs:maxLength value="4"/>'),
    "list length dropped": ('<xs:minLength value="3"/>', ""),
    "list of other items": ('itemType="xs:double"', 'itemType="xs:float"'),
    "pattern changed": ("[a-z]-[0-9]", "[a-z]-[0-8]"),
    "pattern dropped": ('<xs:pattern value="[a-z]"/>', ""),
    "pattern made to apply as well": (
        '<xs:pattern value="[a-z]-[0-9]"/><xs:pattern value="[a-z]"/>',
        '<xs:pattern value="([a-z]-[0-9])|[a-z]"/>',
    ),
    "facet added": ('<xs:pattern value="[a-z]"/>', "\\g<0><xs:maxLength value='9'/>"),
    "white space changed": (
        '<xs:pattern value="[a-z]"/>',
        "\\g<0><xs:whiteSpace value='collapse'/>",
    ),
    "base of a simple type changed": ('base="xs:int"', 'base="xs:integer"'),
    "union reordered": ("size_type mode_enum", "mode_enum size_type"),
    "union member dropped": ("size_type mode_enum", "mode_enum"),
    "extension undone": (
        '<xs:complexContent><xs:extension base="base_type">\n'
        '      <xs:attribute name="extra" type="xs:token"/>\n'
        "    </xs:extension></xs:complexContent>",
        ITEM
        + '<xs:attribute name="sid" type="xs:NCName"/><xs:attribute name="extra" type="xs:token"/>',
    ),
    "restriction made an extension": (
        '<xs:complexContent><xs:restriction base="base_type"/></xs:complexContent>',
        '<xs:attribute name="sid" type="xs:NCName"/>',
    ),
    "base of a simple content changed": ('base="xs:token"', 'base="xs:string"'),
    "block dropped": (' block="restriction"', ""),
    "block changed": (' block="restriction"', ' block="#all"'),
    "final dropped": (' final="extension"', ""),
    "abstract dropped": (' abstract="true"', ""),
    "mixed dropped": (' mixed="true"', ""),
    "mixed added": ('name="root_type"', 'name="root_type" mixed="true"'),
    "identity constraint dropped": (
        '<xs:unique name="once"><xs:selector xpath="x"/><xs:field xpath="@y"/></xs:unique>',
        "",
    ),
    "identity constraint changed": ('xpath="@y"', 'xpath="@z"'),
    "global element added": (
        "</xs:schema>",
        '<xs:element name="other" type="xs:int"/></xs:schema>',
    ),
    "global attribute added": (
        "</xs:schema>",
        '<xs:attribute name="other" type="xs:int"/></xs:schema>',
    ),
    "global type dropped": ('<xs:complexType name="unused_type" abstract="true"/>', ""),
    "global type renamed": ('"unused_type"', '"spare_type"'),
    "target namespace changed": ("urn:t", "urn:u"),
}

REWRITINGS = {
    "identical": ("xs:schema", "xs:schema"),
    "sequence regrouped": (
        SECOND + CHOICE,
        "<xs:sequence>" + SECOND + "<xs:sequence>" + CHOICE + "</xs:sequence></xs:sequence>",
    ),
    "group inlined": (
        '<xs:group ref="tail"/>',
        SIZE + '<xs:element name="code" type="code_type" fixed="a-1" minOccurs="0"/>'
        '<xs:element name="either" type="either_type" minOccurs="0"/>',
    ),
    "group renamed": ('"tail"', '"end"'),
    "choice's branches reordered": (
        CHOICE,
        '<xs:choice minOccurs="0" maxOccurs="unbounded"><xs:element name="right" '
        'type="special_type"/><xs:element name="left" type="base_type"/></xs:choice>',
    ),
    "optional element as an optional group": (
        SECOND,
        '<xs:sequence minOccurs="0"><xs:element name="second" type="xs:int" default="1"/>'
        "</xs:sequence>",
    ),
    "repetition written out": (
        '<xs:element name="note" type="note_type" minOccurs="0" maxOccurs="3"/>',
        '<xs:sequence minOccurs="0"><xs:element name="note" type="note_type"/><xs:element '
        'name="note" type="note_type" minOccurs="0" maxOccurs="2"/></xs:sequence>',
    ),
    "occurrence spelled out": (SIZE, SIZE.replace("/>", ' minOccurs="1" maxOccurs="1"/>')),
    "default written differently": ('default="1.0"', 'default="1e0"'),
    "element default written differently": ('default="1"', 'default="01"'),
    "facets reordered": (
        '<xs:minInclusive value="0"/><xs:maxExclusive value="10"/>',
        '<xs:maxExclusive value="10"/><xs:minInclusive value="0"/>',
    ),
    "bound written differently": ('maxExclusive value="10"', 'maxExclusive value="010"'),
    "both lengths as one": (
        '<xs:minLength value="3"/><xs:maxLength value="3"/>',
        '<xs:length value="3"/>',
    ),
    "enumeration reordered": (
        '<xs:enumeration value="A"/><xs:enumeration value="B"/>',
        '<xs:enumeration value="B"/><xs:enumeration value="A"/>',
    ),
    "patterns reordered": (
        '<xs:pattern value="[a-z]-[0-9]"/><xs:pattern value="[a-z]"/>',
        '<xs:pattern value="[a-z]"/><xs:pattern value="[a-z]-[0-9]"/>',
    ),
    "attributes reordered": (
        '<xs:attribute name="id" type="xs:ID" use="required"/>\n'
        '    <xs:attribute name="scale" type="xs:double" default="1.0"/>',
        '<xs:attribute name="scale" type="xs:double" default="1.0"/>'
        '<xs:attribute name="id" type="xs:ID" use="required"/>',
    ),
    "attribute use spelled out": ('name="mode" type="mode_enum"', "\\g<0> use='optional'"),
    "attributes in a group": (
        '<xs:attribute name="mode" type="mode_enum"/>\n  </xs:complexType>',
        '<xs:attributeGroup ref="modes"/></xs:complexType><xs:attributeGroup name="modes">'
        '<xs:attribute name="mode" type="mode_enum"/></xs:attributeGroup>',
    ),
    "attribute's type written in place": (
        '<xs:attribute name="mode" type="mode_enum"/>',
        '<xs:attribute name="mode"><xs:simpleType><xs:restriction base="mode_enum"/>'
        "</xs:simpleType></xs:attribute>",
    ),
    "list item through a type without facets": (
        'name="list_type"><xs:list itemType="xs:double"/></xs:simpleType>',
        'name="list_type"><xs:list><xs:simpleType><xs:restriction base="xs:double"/>'
        "</xs:simpleType></xs:list></xs:simpleType>",
    ),
    "wildcard namespace left out": (' namespace="##any"', ""),
    "documentation added": (
        '<xs:complexType name="base_type" block="restriction">',
        "\\g<0><xs:annotation><xs:documentation>d</xs:documentation></xs:annotation>",
    ),
    "block by default": (
        'elementFormDefault="qualified"',
        'elementFormDefault="qualified" finalDefault=""',
    ),
}


def changed(old: str, new: str) -> str:
    """BASE with every ``old`` replaced; ``\\g<0>`` in ``new`` stands for ``old``."""
    assert old in BASE
    return BASE.replace(old, new.replace("\\g<0>", old))
