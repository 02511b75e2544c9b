"""What the generated tables say of contents and simple types, against the schema itself."""

from __future__ import annotations

from typing import Any

import pytest
from tools.bindings.locality import is_local, with_other_content
from tools.schema_equivalence.loading import load

from colladaphy.gate import schema_folder
from colladaphy_schema.content import NOT_LOCAL
from colladaphy_schema.document_columns import ColladaRows
from colladaphy_schema.rows import Child, Column, Rows

SCHEMA = schema_folder() / "document.xsd"
_BUILT_IN = "{http://www.w3.org/2001/XMLSchema}"
_OPEN = {
    "float": {"double", "float"},
    "integer": {"integer", "long", "int", "nonNegativeInteger", "unsignedLong", "unsignedInt"},
    "boolean": {"boolean"},
    "string": {"string"},
    "normalized": {"normalizedString"},
    "token": {"token"},
    "name": {"NCName", "Name", "ID", "IDREF", "NMTOKEN"},
    "datetime": {"dateTime"},
    "hex": {"hexBinary"},
    "base64": {"base64Binary"},
}
"""Types of which any text that is spelled as their kind is valid."""


def facets(kind: Any) -> list[str]:
    """The facets of a simple type and those that it is derived from, but for white space."""
    found: list[str] = []
    while not str(kind.name).startswith(_BUILT_IN):
        found += [str(name).partition("}")[2] for name in kind.facets if name is not None]
        if hasattr(kind, "item_type"):
            break
        kind = simple(kind.base_type)
    return [name for name in found if name != "whiteSpace"]


def simple(kind: Any) -> Any:
    """The simple type of a type's content."""
    return kind if kind.is_simple() else kind.content


def item_of(kind: Any) -> Any:
    """The type of the items of a list."""
    while not hasattr(kind, "item_type"):
        kind = simple(kind.base_type)
    return kind.item_type


def is_open(kind: Any, column: Column[Any]) -> bool:
    """Whether every text of the column's kind, tokens and width is valid."""
    if kind.is_list():
        lengths = [name for name in facets(kind)
                   if column.width is None or "ength" not in name]  # fmt: skip
        return not lengths and is_open(item_of(kind), column)
    if facets(kind):
        return False
    while not str(kind.name).startswith(_BUILT_IN):
        kind = simple(kind.base_type)
    return str(kind.name).removeprefix(_BUILT_IN) in _OPEN[column.kind]


def walked() -> list[tuple[str, Any, Column[Any]]]:
    """Every column of simple content with its type, from the root of a document on."""
    maps = load(SCHEMA).maps
    root = maps.elements["{http://www.collada.org/2008/03/COLLADASchema}COLLADA"]
    todo: list[tuple[Any, type[Rows]]] = [(root.type, ColladaRows)]
    seen: set[tuple[int, type[Rows]]] = set()
    found: list[tuple[str, Any, Column[Any]]] = []
    while todo:
        kind, rows = todo.pop()
        if (id(kind), rows) in seen:
            continue
        seen.add((id(kind), rows))
        declared = {str(e.name): e for e in (kind.content.iter_elements()
                    if kind.has_complex_content() else ()) if hasattr(e, "type")}  # fmt: skip
        for field in rows.FIELDS:
            where = f"{rows.__name__}.{field.name}"
            if isinstance(field, Child):
                element = declared.get(field.tag)
                if element is None:  # the profile's, within a technique
                    element = maps.elements[field.tag]
                if not element.type.is_simple():
                    todo.append((element.type, field.type))
            elif field.form == "text":
                if kind.has_simple_content():  # else mixed, or open to everything
                    found.append((where, kind.content, field))
            elif field.form == "attribute":
                name = field.tag.replace("xml:", "{http://www.w3.org/XML/1998/namespace}")
                found.append((where, kind.attributes[name].type, field))
            else:
                found.append((where, declared[field.tag].type, field))
    return found


def test_columns_without_a_restriction_have_types_without_one() -> None:
    columns = walked()
    assert len(columns) > 1000
    closed = 0
    for where, kind, column in columns:
        if not column.restriction:
            assert is_open(simple(kind), column), where
        closed += bool(column.restriction)
    assert closed > 100


def test_restrictions_that_are_patterns_are_all_that_their_types_restrict() -> None:
    patterns = [(kind, column) for _, kind, column in walked()
                if column.restriction not in ("", "other", "anyURI")]  # fmt: skip
    assert patterns
    for kind, column in patterns:
        text = item_of(kind) if column.tokens else simple(kind)
        assert facets(text) == ["pattern"], column.name
        assert text.patterns.regexps == [column.restriction]


def test_contents_that_are_not_local() -> None:
    assert frozenset(with_other_content(SCHEMA)) == NOT_LOCAL
    assert "{http://www.collada.org/2008/03/COLLADASchema}orthographic" in NOT_LOCAL
    assert "{http://www.collada.org/2008/03/COLLADASchema}rigid_body" not in NOT_LOCAL


@pytest.mark.parametrize(
    ("content", "local"),
    [
        ('<xs:sequence><xs:element name="a"/><xs:element name="b"/></xs:sequence>', True),
        ('<xs:choice maxOccurs="unbounded"><xs:element name="a"/><xs:element name="b"/>'
         "</xs:choice>", True),
        ('<xs:sequence><xs:element name="a" maxOccurs="unbounded"/></xs:sequence>', True),
        ('<xs:sequence><xs:element name="a" maxOccurs="2"/></xs:sequence>', False),
        ('<xs:sequence><xs:element name="a" minOccurs="2" maxOccurs="unbounded"/></xs:sequence>',
         False),
        ('<xs:sequence><xs:element name="a"/><xs:element name="b"/><xs:element name="a"/>'
         "</xs:sequence>", False),
        ('<xs:sequence maxOccurs="unbounded"><xs:element name="a"/><xs:element name="b"/>'
         '</xs:sequence>', True),
        ('<xs:choice><xs:sequence><xs:element name="a"/><xs:element name="b"/></xs:sequence>'
         '<xs:sequence><xs:element name="c"/><xs:element name="b"/></xs:sequence></xs:choice>',
         True),
    ],
)  # fmt: skip
def test_locality_of_content_models(content: str, local: bool) -> None:
    import xmlschema

    schema = xmlschema.XMLSchema10(
        f'<xs:schema xmlns:xs="http://www.w3.org/2001/XMLSchema"><xs:element name="x">'
        f"<xs:complexType>{content}</xs:complexType></xs:element></xs:schema>"
    )
    assert is_local(schema.elements["x"].type.content) is local
