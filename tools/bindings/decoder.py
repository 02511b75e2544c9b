"""Emits the decode function of a class: an lxml element to a dataclass."""

from __future__ import annotations

from tools.bindings.common import (
    Branch,
    Field,
    Needs,
    Record,
    Value,
    ancestry,
    indented,
    takes_empty,
    text_field,
)

SCALARS = {
    "float": "number({0}, {1})", "integer": "integer({0}, {1})", "boolean": "boolean({0}, {1})",
    "string": "{0}", "normalized": "normalized({0})", "token": "collapsed({0})",
    "name": "{0}.strip()", "datetime": "moment({0}, {1})", "hex": "hexadecimal({0}, {1})",
    "base64": "base64_bytes({0}, {1})", "enumeration": "member({2}, {0}, {1})",
}  # fmt: skip
LISTS = {
    "float": "numbers({0}, {1})", "integer": "integers({0}, {1})", "boolean": "booleans({0}, {1})",
    "string": "words({0})", "normalized": "words({0})", "token": "words({0})",
    "name": "words({0})", "enumeration": "members({2}, {0}, {1})",
    "hex": "[hexadecimal(word, {1}) for word in words({0})]",
}  # fmt: skip
# Up to so many alternatives a chain of comparisons is faster than a table.
CHAIN = 8


def value_of(value: Value, text: str, element: str, needs: Needs) -> str:
    """An expression that turns a text into a value."""
    table = needs.use_enumeration(value.enumeration) if value.enumeration else ""
    return (LISTS if value.tokens else SCALARS)[value.kind].format(text, element, table)


def check_length(value: Value, name: str, element: str) -> list[str]:
    """Statements that reject a list of the wrong length."""
    if value.lengths is None:
        return []
    low, high = value.lengths
    if low == high:
        test = f"len({name}) != {low}"
    else:
        tests = [f"len({name}) < {low}"] if low else []
        tests += [f"len({name}) > {high}"] if high is not None else []
        test = " or ".join(tests)
    return [f"if {test}:", f"    length({element}, {name}, {low}, {high})"] if test else []


def decode_function(record: Record, needs: Needs) -> list[str]:
    """The decode function of one class, and the table it dispatches by."""
    needs.use_class(record)
    text = text_field(record)
    lines = ["o = new(" + record.name + ")"]
    if record.derived:
        call = "f(e, empty)" if text else "f(e)"
        lines += [
            "x = e.get(XSI_TYPE)",
            "if x is not None:",
            f"    f = derivation(e, x, DERIVED_{record.name})",
            "    if f is not None:",
            f"        return {call}",
        ]
    keeps = keeps_stated(record)
    lines += [f"{local(f)} = {initial(f, needs)}" for f in record.fields if f.form != "text"]
    if keeps:
        lines.append("stated = ()")
    lines += attributes(record, needs)
    if text is not None:
        assert text.value is not None
        lines += ["x = joined(e) if len(e) else e.text", "if not x:", "    x = empty"]
        lines.append(f"{local(text)} = {value_of(text.value, 'x', 'e', needs)}")
        lines += check_length(text.value, local(text), "e")
    table: list[str] = []
    wild = [f for f in record.fields if f.form == "wildcard"]
    elements = [f for f in record.fields if f.form == "element"]
    if wild:
        if elements or len(wild) > 1:
            raise ValueError(f"{record.name}: a wildcard beside elements is not supported")
        lines.append(f"{local(wild[0])} = {'mixed' if wild[0].mixed else 'wildcard'}(e)")
    elif elements:
        loop, table = children(record, elements, needs)
        lines += loop
    elif text is None:
        lines += ["if len(e):", "    for c in e:", "        unexpected(e, c)"]
    for f in record.fields:
        if initial(f, needs) == "REQUIRED":
            lines += [f"if {local(f)} is REQUIRED:", f"    missing(e, {f.name!r})"]
        lines.append(f"o.{f.name} = {local(f)}")
    if keeps:
        lines.append("o._stated = stated")
    lines.append("return o")
    head = f"def decode_{record.name}(e{', empty=' + repr('') if text else ''}):"
    needs.tables += table
    return ["", "", head, *indented(lines)]


def keeps_stated(record: Record) -> bool:
    """Whether objects of this class have to remember stated defaults."""
    return any(f.stated for f in record.fields)


def local(source: Field) -> str:
    """The local variable of a field."""
    return f"v_{source.name}"


def initial(source: Field, needs: Needs) -> str:
    """What a field holds where the element says nothing of it."""
    if source.form == "text":
        return ""
    if source.many:
        return "[]"
    return "REQUIRED" if source.default is None else needs.default(source)


def attributes(record: Record, needs: Needs) -> list[str]:
    """The loop over the attributes."""
    known = [f for f in record.fields if f.form == "attribute"]
    rest = [f for f in record.fields if f.form == "attributes"]
    if rest:
        return [f"{local(rest[0])} = dict(e.items())"]
    if not known:
        return []
    lines = ["for k, x in e.items():"]
    word = "if"
    for f in known:
        assert f.value is not None
        body = [f"{local(f)} = {value_of(f.value, 'x', 'e', needs)}"]
        body += check_length(f.value, local(f), "e")
        if f.stated:
            body += remember(f, needs)
        lines += indented([f"{word} k == {f.qname!r}:", *indented(body)])
        word = "elif"
    return [*lines, "    else:", "        attribute(e, k)"]


def remember(source: Field, needs: Needs) -> list[str]:
    """Statements that note a default the XML states."""
    return [
        f"if {local(source)} == {needs.default(source)}:",
        f"    stated += ({source.name!r},)",
    ]


def children(record: Record, elements: list[Field], needs: Needs) -> tuple[list[str], list[str]]:
    """The loop over the child elements, and the table for those of many alternatives."""
    chain: list[tuple[Branch, Field]] = []
    tabled: Field | None = None
    for f in elements:
        records = [branch for branch in f.branches if isinstance(branch.content, Record)]
        if len(records) > CHAIN and tabled is None:
            tabled = f
            chain += [(branch, f) for branch in f.branches if branch not in records]
        else:
            chain += [(branch, f) for branch in f.branches]
    lines = ["for c in e:"]
    body: list[str] = ["t = c.tag"]
    word = "if"
    for branch, f in chain:
        body += [f"{word} t == {branch.qname!r}:", *indented(assign(branch, f, needs))]
        word = "elif"
    table: list[str] = []
    if tabled is None:
        body += ["else:", "    unexpected(e, c)"]
    else:
        name = f"DECODERS_{record.name}"
        table = ["", "", f"{name} = {{"]
        for branch in tabled.branches:
            if not isinstance(branch.content, Record):
                continue
            needs.use_function(branch.content)
            function = f"decode_{branch.content.name}"
            if branch.empty is not None and takes_empty(branch.content):
                function = f"lambda c: decode_{branch.content.name}(c, {branch.empty!r})"
            table.append(f"    {branch.qname!r}: {function},")
        table.append("}")
        needs.decode_tables.append(name)
        look = [
            f"f = {name}.get(t)",
            "if f is None:",
            "    unexpected(e, c)",
            "else:",
            f"    {local(tabled)}.append(f(c))" if tabled.many else f"    {local(tabled)} = f(c)",
        ]
        body += ["else:", *indented(look)] if chain else look
    return lines + indented(body), table


def assign(branch: Branch, source: Field, needs: Needs) -> list[str]:
    """Statements that put the child element `c` into its field."""
    content, name = branch.content, local(source)
    if isinstance(content, Record):
        needs.use_function(content)
        empty = branch.empty is not None and takes_empty(content)
        call = f"decode_{content.name}(c{', ' + repr(branch.empty) if empty else ''})"
        return [f"{name}.append({call})" if source.many else f"{name} = {call}"]
    if content.kind == "any":
        return [f"{name}.append(generic(c))" if source.many else f"{name} = generic(c)"]
    default = branch.empty or ""
    lines = [f"x = (joined(c) if len(c) else c.text) or {default!r}"]
    target = "x" if source.many else name
    lines.append(f"{target} = {value_of(content, 'x', 'c', needs)}")
    lines += check_length(content, target, "c")
    if source.many:
        lines.append(f"{name}.append(x)")
    elif source.stated:
        lines += remember(source, needs)
    return lines


def derived_table(record: Record) -> list[str]:
    """What xsi:type may name where this type is declared."""
    lines = ["", "", f"DERIVED_{record.name} = {{"]
    if record.is_type:
        lines.append(f"    {record.qname!r}: ('', ''),")
    lines += [f"    {d.qname!r}: ({d.module!r}, {d.name!r})," for d in record.derived]
    return [*lines, "}"]


__all__ = ["ancestry", "decode_function", "derived_table", "keeps_stated"]
