"""Emits the encode function of a class: a dataclass to XML text."""

from __future__ import annotations

from tools.bindings.common import (
    Branch,
    Field,
    Needs,
    Record,
    Value,
    attribute_of,
    indented,
    tag_of,
)

SCALARS = {
    "float": "number_text({0})", "integer": "integer_text({0})", "boolean": "boolean_text({0})",
    "string": "{1}({0})", "normalized": "{1}({0})", "token": "{1}({0})", "name": "{1}({0})",
    "datetime": "str({0})", "hex": "{0}.hex().upper()", "base64": "base64_text({0})",
    "enumeration": "{1}({0}.value)",
}  # fmt: skip
LISTS = {
    "float": "numbers_text({0})", "integer": "integers_text({0})",
    "boolean": "' '.join(map(boolean_text, {0}))", "string": "{1}(' '.join({0}))",
    "normalized": "{1}(' '.join({0}))", "token": "{1}(' '.join({0}))",
    "name": "{1}(' '.join({0}))", "enumeration": "{1}(' '.join([m.value for m in {0}]))",
    "hex": "' '.join([item.hex().upper() for item in {0}])",
}  # fmt: skip


def text_of(value: Value, source: str, *, attribute: bool) -> str:
    """An expression that turns a value into escaped text."""
    escape = "attribute_escaped" if attribute else "text_escaped"
    return (LISTS if value.tokens else SCALARS)[value.kind].format(source, escape)


def encode_function(record: Record, needs: Needs) -> list[str]:
    """The encode function of one class, and the tables it dispatches by."""
    lines: list[str] = []
    if record.derived:
        lines += [
            f"if o.__class__ is not {record.name}:",
            f"    encode_derived(o, w, tag, i, DERIVED_{record.name})",
            "    return",
        ]
    lines += attributes(record, needs)
    text = next((f for f in record.fields if f.form == "text"), None)
    content = [f for f in record.fields if f.form in ("element", "wildcard")]
    tables: list[str] = []
    if text is not None:
        assert text.value is not None
        shown = text_of(text.value, f"o.{text.name}", attribute=False)
        lines.append(f"w(f'{{a}}>{{{shown}}}</{{tag}}>')".replace("' '", '" "'))
    elif not content:
        lines.append("w(a + '/>')")
    else:
        lines.append("w(a + '>')")
        wild = content[0].form == "wildcard"
        if wild and content[0].mixed:
            lines.append(f"encode_wildcard(o.{content[0].name}, w, '')")
            lines.append("w(f'</{tag}>')")
        else:
            if all(f.many or f.factory or f.default == "None" for f in content):
                tests = [presence(f) for f in content]
                lines[-1:] = [f"if not ({' or '.join(tests)}):", "    w(a + '/>')", "    return"]
                lines.append("w(a + '>')")
            lines.append("j = i and i + '  '")
            for f in content:
                body, table = element(record, f, needs)
                lines += body
                tables += table
            lines.append("w(f'{i}</{tag}>')")
    needs.tables += tables
    return ["", "", f"def encode_{record.name}(o, w, tag, i):", *indented(lines)]


def attributes(record: Record, needs: Needs) -> list[str]:
    """Statements that build the start of the start tag in `a`."""
    lines = ["a = f'{i}<{tag}'"]
    for f in record.fields:
        if f.form == "attributes":
            lines.append(f"a += other_attributes(o.{f.name})")
        if f.form != "attribute":
            continue
        assert f.value is not None
        name = attribute_of(f.qname)
        if f.default is None:
            shown = text_of(f.value, f"o.{f.name}", attribute=True)
            lines.append(f"a += ' {name}=\"' + {shown} + '\"'")
            continue
        lines.append(f"x = o.{f.name}")
        shown = text_of(f.value, "x", attribute=True)
        if f.default == "None":
            lines += ["if x is not None:", f"    a += ' {name}=\"' + {shown} + '\"'"]
        else:
            said = differs(f, needs)
            lines += [
                f"if {said} or {f.name!r} in stated(o):",
                f"    a += ' {name}=\"' + {shown} + '\"'",
            ]
    return lines


def differs(source: Field, needs: Needs) -> str:
    """An expression for whether `x` is not the default; -0.0 is not 0.0."""
    default = needs.default(source)
    assert source.value is not None
    if source.value.kind == "float" and not source.factory:
        return f"number_text(x) != {default!r}"
    if source.value.kind == "enumeration" and not source.factory:
        return f"x is not {default}"
    return f"x != {default}"


def element(record: Record, source: Field, needs: Needs) -> tuple[list[str], list[str]]:
    """Statements that write a field of child elements, and its table."""
    if source.form == "wildcard":
        return [f"encode_wildcard(o.{source.name}, w, j)"], []
    if len(source.branches) > 1:
        return choice(record, source, needs)
    body = child(source.branches[0], "x", needs)
    if source.many:
        return [f"for x in o.{source.name}:", *indented(body)], []
    if source.default is None:
        return [f"x = o.{source.name}", *body], []
    if source.stated:
        test = f"x or {source.name!r} in stated(o)"
        return [f"x = o.{source.name}", f"if {test}:", *indented(body)], []
    if source.factory:  # a required list, which may be empty
        return [f"x = o.{source.name}", *body], []
    return [f"x = o.{source.name}", "if x is not None:", *indented(body)], []


def presence(source: Field) -> str:
    """An expression for whether an optional field holds anything to write."""
    if source.stated:
        return f"o.{source.name} or {source.name!r} in stated(o)"
    if source.many or source.form == "wildcard":
        return f"o.{source.name}"
    return "True" if source.factory else f"o.{source.name} is not None"


def child(branch: Branch, name: str, needs: Needs) -> list[str]:
    """Statements that write one child element."""
    content, tag = branch.content, tag_of(branch.qname)
    if isinstance(content, Record):
        needs.use_function(content)
        return [f"encode_{content.name}({name}, w, {tag!r}, j)"]
    if content.kind == "any":
        return ["w(j)", f"encode_generic({name}, w)"]
    return [f"w(j + '<{tag}>' + {text_of(content, name, attribute=False)} + '</{tag}>')"]


def choice(record: Record, source: Field, needs: Needs) -> tuple[list[str], list[str]]:
    """Statements that write a field of several types, by the class of the object."""
    name = f"{record.name}_{source.name}"
    here: list[str] = []
    places: list[str] = []
    for branch in source.branches:
        content, tag = branch.content, tag_of(branch.qname)
        if isinstance(content, Value):
            here.append(f"    {leaf(content, tag, needs)},")
            continue
        places.append(f"    {(content.module, content.name)!r}: {tag!r},")
        if content.module == needs.module:
            here.append(f"    {content.name}: (encode_{content.name}, {tag!r}),")
    table = ["", "", f"ENCODERS_{name} = {{", *here, "}", f"TAGS_{name} = {{", *places, "}"]
    body = [
        f"f = ENCODERS_{name}.get(x.__class__)",
        "if f is None:",
        f"    f = choose(ENCODERS_{name}, TAGS_{name}, x)",
        "f[0](x, w, f[1], j)",
    ]
    if source.many:
        return [f"for x in o.{source.name}:", *indented(body)], table
    lines = [f"x = o.{source.name}"]
    if source.default is None:
        return lines + body, table
    return [*lines, "if x is not None:", *indented(body)], table


# The Python type of a plain value.
PYTHON = {
    "float": "float", "integer": "int", "boolean": "bool", "string": "str", "normalized": "str",
    "token": "str", "name": "str", "datetime": "XmlDateTime", "hex": "bytes", "base64": "bytes",
    "any": "AnyElement",
}  # fmt: skip


def leaf(value: Value, tag: str, needs: Needs) -> str:
    """The entry of a plain value in the table of a choice."""
    if value.kind == "any":
        return f"AnyElement: (write_generic, {tag!r})"
    cls = needs.use_class(value.enumeration) if value.enumeration else PYTHON[value.kind]
    shown = text_of(value, "x", attribute=False)
    return f"{'list' if value.tokens else cls}: (leaf(lambda x: {shown}), {tag!r})"
