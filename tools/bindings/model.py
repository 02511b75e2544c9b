"""What the emitters need to know of xsdata's class model, resolved and flattened.

xsdata analyses the schema; from its one class model the dataclasses are rendered by xsdata's own
templates and the codecs by ours. This module turns that model into records with plain fields.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum
from typing import Any

from xsdata.codegen.models import Attr, AttrType, Class
from xsdata.formats.dataclass.filters import Filters
from xsdata.models.enums import DataType, Tag

# How the element default of the schema travels through xsdata's analysis, which drops it where
# the type of the element is complex. Documentation text is never rendered (docstrings are blank).
DEFAULT_MARK = "element default:"

KINDS = {
    DataType.DOUBLE: "float", DataType.FLOAT: "float", DataType.BOOLEAN: "boolean",
    DataType.INTEGER: "integer", DataType.LONG: "integer", DataType.INT: "integer",
    DataType.SHORT: "integer", DataType.BYTE: "integer",
    DataType.NON_NEGATIVE_INTEGER: "integer", DataType.POSITIVE_INTEGER: "integer",
    DataType.UNSIGNED_LONG: "integer", DataType.UNSIGNED_INT: "integer",
    DataType.UNSIGNED_SHORT: "integer", DataType.UNSIGNED_BYTE: "integer",
    DataType.STRING: "string", DataType.NORMALIZED_STRING: "normalized",
    DataType.TOKEN: "token", DataType.ANY_URI: "token", DataType.LANGUAGE: "token",
    DataType.NCNAME: "name", DataType.NAME: "name", DataType.ID: "name", DataType.IDREF: "name",
    DataType.NMTOKEN: "name", DataType.IDREFS: "name",
    DataType.ANY_TYPE: "any", DataType.DATE_TIME: "datetime", DataType.HEX_BINARY: "hex",
    DataType.BASE64_BINARY: "base64",
}  # fmt: skip

# Types that restrict the texts of their kind, as facets do.
NARROW = {
    DataType.SHORT, DataType.BYTE, DataType.POSITIVE_INTEGER, DataType.UNSIGNED_SHORT,
    DataType.UNSIGNED_BYTE, DataType.LANGUAGE, DataType.IDREFS,
}  # fmt: skip
FACETS = (
    "pattern", "min_inclusive", "max_inclusive", "min_exclusive", "max_exclusive",
    "fraction_digits", "total_digits",
)  # fmt: skip


@dataclass
class Value:
    """The text of an attribute or element: its kind, and whether it is a list of such."""

    kind: str
    tokens: bool = False
    lengths: tuple[int | None, int | None] | None = None
    enumeration: Record | None = None
    restriction: str = ""  # a pattern, anyURI, or "other" where its type restricts texts


@dataclass
class Branch:
    """An element that may stand in a field: what it is called and what it holds."""

    qname: str
    content: Record | Value
    empty: str | None = None  # the schema's default for the element without text


@dataclass
class Field:
    """A field of a dataclass; `form` says where it stands in the XML."""

    name: str
    form: str  # attribute, attributes, element, wildcard, text, ignored
    many: bool = False
    optional: bool = False
    mixed: bool = False
    default: str | None = None  # source of the default value; None where there is none
    factory: bool = False  # the default is a new list or dictionary each time
    value: Value | None = None
    qname: str = ""
    branches: list[Branch] = field(default_factory=list)

    @property
    def stated(self) -> bool:
        """Whether the XML can state a value that equals the default of an absent one."""
        if self.form == "attribute":
            return self.default is not None and self.default != "None"
        return (
            self.form == "element"
            and not self.many
            and self.factory
            and self.optional
            and any(isinstance(branch.content, Value) for branch in self.branches)
        )


@dataclass
class Record:
    """A class of the model: a dataclass or an enumeration."""

    name: str
    qname: str
    module: str
    base: Record | None = None
    fields: list[Field] = field(default_factory=list)
    members: list[tuple[str, str]] = field(default_factory=list)  # lexical value, constant
    is_enumeration: bool = False
    is_element: bool = False  # a global element of the schema
    is_type: bool = False  # a named type of the schema
    derived: list[Record] = field(default_factory=list)

    @property
    def namespace(self) -> str:
        return self.qname[1:].partition("}")[0]

    @property
    def has_stated(self) -> bool:
        """Whether this class itself keeps track of stated defaults (its base may do so already)."""
        return any(f.stated for f in self.fields)


class Model:
    """All records by qualified name and tag, with references resolved."""

    def __init__(self, classes: list[Class], filters: Filters) -> None:
        self.filters = filters
        self.classes = {obj.qname: obj for obj in classes}
        self.records = {qname: self._record(obj) for qname, obj in self.classes.items()}
        self._filled: set[str] = set()
        for qname in self.records:
            self._fill(qname)
        for record in self.records.values():
            ancestor = record.base if record.is_type else None
            while ancestor is not None:
                ancestor.derived.append(record)
                ancestor = ancestor.base

    def _record(self, obj: Class) -> Record:
        named = not obj.local_type
        return Record(
            name=self.filters.class_name(obj.name),
            qname=f"{{{obj.target_namespace or ''}}}{obj.meta_name or obj.name}",
            module=obj.module or "",
            is_enumeration=obj.is_enumeration,
            is_element=named and obj.tag == Tag.ELEMENT,
            is_type=named and obj.tag == Tag.COMPLEX_TYPE and not obj.is_enumeration,
        )

    def _fill(self, qname: str) -> Record:
        """Fill the fields of a class, its base first."""
        record, obj = self.records[qname], self.classes[qname]
        if qname in self._filled:
            return record
        self._filled.add(qname)
        if obj.is_enumeration:
            record.members = [
                (self._lexical(a), self.filters.constant_name(a.name, obj.name)) for a in obj.attrs
            ]
            return record
        fields: dict[str, Field] = {}
        if len(obj.extensions) > 1:
            raise ValueError(f"{record.name} has more than one base class")
        for extension in obj.extensions:
            record.base = self._fill(extension.type.qname)
            fields.update((f.name, f) for f in record.base.fields)
        for attr in obj.attrs:
            made = self._field(obj, attr)
            fields[made.name] = made
        record.fields = list(fields.values())
        return record

    @staticmethod
    def _lexical(attr: Attr) -> str:
        value = attr.default
        if not isinstance(value, str) or value.startswith("@enum@"):
            raise ValueError(f"enumeration value {value!r} is not a text")
        return " ".join(value.split())

    def _field(self, obj: Class, attr: Attr) -> Field:
        name = self.filters.field_name(attr.name, obj.name)
        if attr.is_prohibited:
            return Field(name=name, form="ignored", default="None")
        result = Field(
            name=name,
            form=_form(attr),
            many=attr.is_list,
            optional=attr.is_optional,
            mixed=attr.mixed,
            factory=attr.is_factory,
            qname=attr.qname,
            default=self._default(obj, attr),
        )
        if attr.fixed:
            raise ValueError(f"{obj.name}.{name}: fixed values are not supported")
        if result.form == "element":
            choices = attr.choices or [attr]
            result.branches = [self._branch(choice) for choice in choices]
            if not attr.choices and result.optional and result.default is None:
                result.default = "None"
        elif result.form in ("attribute", "text"):
            result.value = self._value(attr)
        return result

    def _default(self, obj: Class, attr: Attr) -> str | None:
        default: Any = self.filters.field_default_value(attr, obj.ns_map)
        if default is False:
            return None
        text = str(default)
        if text in ("list", "dict"):
            return {"list": "[]", "dict": "{}"}[text]
        if text.startswith("lambda:"):
            return text.removeprefix("lambda:").strip()
        if isinstance(default, str) and attr.default and attr.default.startswith("@enum@"):
            return f"enum:{text}"
        return text

    def _branch(self, attr: Attr) -> Branch:
        if attr.tag != Tag.ELEMENT or attr.is_nillable:
            raise ValueError(f"{attr.name}: a choice of {attr.tag} is not supported")
        empty = None
        if attr.help and DEFAULT_MARK in attr.help:
            empty = attr.help.partition(DEFAULT_MARK)[2]
        kind = self._single(attr)
        content: Record | Value
        if kind.native or self.records[kind.qname].is_enumeration:
            content = self._value(attr)
        else:
            content = self.records[kind.qname]
        return Branch(qname=attr.qname, content=content, empty=empty)

    @staticmethod
    def _single(attr: Attr) -> AttrType:
        if len(attr.types) != 1:
            raise ValueError(f"{attr.name}: a union of types is not supported")
        return attr.types[0]

    def _value(self, attr: Attr) -> Value:
        kind = self._single(attr)
        limits = attr.restrictions
        low = limits.length if limits.length is not None else limits.min_length
        high = limits.length if limits.length is not None else limits.max_length
        tokens = attr.is_tokens
        lengths = (low, high) if tokens and (low, high) != (None, None) else None
        datatype = kind.datatype
        if datatype is None:
            return Value("enumeration", tokens, lengths, self.records[kind.qname], "other")
        if datatype not in KINDS:
            raise ValueError(f"{attr.name}: {datatype} is not supported")
        name = KINDS[datatype]
        if name == "string" and limits.white_space in ("collapse", "replace"):
            name = {"collapse": "token", "replace": "normalized"}[limits.white_space]
        restricted = datatype in NARROW or (not tokens and (low, high) != (None, None))
        facets = [facet for facet in FACETS if getattr(limits, facet) is not None]
        restriction = "other" if restricted or facets else ""
        if facets == ["pattern"] and not restricted:
            restriction = str(limits.pattern)
        elif datatype == DataType.ANY_URI and not restriction:
            restriction = "anyURI"
        return Value(name, tokens, lengths, restriction=restriction)


def _form(attr: Attr) -> str:
    tag: str | Enum = attr.tag
    forms = {
        Tag.ATTRIBUTE: "attribute",
        Tag.ANY_ATTRIBUTE: "attributes",
        Tag.ELEMENT: "element",
        Tag.CHOICE: "element",
        Tag.ANY: "wildcard",
    }
    return forms.get(str(tag), "text")
