"""Bytes to tree, with a parser that fetches nothing, expands nothing and knows its limits."""

from __future__ import annotations

import re

from lxml import etree

from colladaphy.errors import XmlError
from colladaphy.findings import Finding, Rule
from colladaphy.source import rules
from colladaphy.source.limits import LIBXML2_DEPTH, LIBXML2_DEPTH_MAX, LIBXML2_TEXT, Limits

__all__ = ["COLLADA_1_4", "COLLADA_1_5", "element_count", "parse_bytes", "root_start"]

COLLADA_1_4 = "http://www.collada.org/2005/11/COLLADASchema"
COLLADA_1_5 = "http://www.collada.org/2008/03/COLLADASchema"

_ANY_COLLADA = "http://www.collada.org/"
_UTF16 = (b"\xff\xfe", b"\xfe\xff")
_PLAIN_ENCODINGS = {"utf-8", "us-ascii", "ascii"}
_COMPRESSED = ((b"\x1f\x8b", "gzip"), (b"BZh", "bzip2"), (b"\xfd7zXZ", "xz"), (b"7z\xbc", "7-Zip"))

_SHORTEST = len(b"<a/>")
"""The bytes that an element takes at least."""

# libxml2's error codes (xmlParserErrors).
_DOCUMENT_EMPTY = 4
_DOCUMENT_END = 5
_TAG_NOT_FINISHED = 77
_ENCODING_CODES = frozenset({31, 32, 79, 81})
_RESOURCE_LIMIT = 114
_UNDECLARED = 201
_TOO_LONG = re.compile(r"too (?:big|long)|size limit|length limit", re.IGNORECASE)
_TOO_DEEP = re.compile(r"excessive depth", re.IGNORECASE)
# What libxml2 says about markup that simply stops: an unfinished tag, attribute, comment, ...
_UNFINISHED = frozenset({35, 37, 39, 40, 41, 43, 45, 47, 57, 63, 65, 66, 68, 73, 74, 75, 79, 81})


class _Refusal(etree.Resolver):
    """Nothing but the document itself is ever opened."""

    def resolve(self, system_url: str, public_id: str, *context: object) -> object:
        raise XmlError(rules.DOCTYPE.at(message=f"The document asks for {system_url!r}."))


def parse_bytes(data: bytes, file: str | None, limits: Limits) -> etree._ElementTree:
    """Parse one COLLADA document of any version; XmlError where it is none."""
    _check_head(data, file, limits)
    huge = limits.text > LIBXML2_TEXT or limits.depth > LIBXML2_DEPTH
    parser = etree.XMLParser(
        resolve_entities=False,
        no_network=True,
        load_dtd=False,
        dtd_validation=False,
        attribute_defaults=False,
        recover=False,
        strip_cdata=False,
        huge_tree=huge,
    )
    parser.resolvers.add(_Refusal())
    try:
        root = etree.fromstring(data, parser)
    except etree.XMLSyntaxError as error:
        raise XmlError(_translate(error, data, file, limits)) from None
    except (ValueError, LookupError) as error:
        raise XmlError(rules.MALFORMED.at(message=f"{error}.", file=file)) from None
    tree = root.getroottree()
    if tree.docinfo.internalDTD is not None:
        raise XmlError(rules.DOCTYPE.at(file=file, line=1))
    _check_limits(tree, data, file, limits, huge=huge)
    _check_root(root, file)
    return tree


def _check_head(data: bytes, file: str | None, limits: Limits) -> None:
    """What can be told, and must be refused, before a parser sees the bytes."""
    if not data.strip(b"\xef\xbb\xbf\xff\xfe \t\r\n\0"):
        raise XmlError(rules.EMPTY.at(file=file))
    head = _prolog(data)
    start = head.lstrip("\ufeff \t\r\n")[:4096].lower()
    if start.startswith(("<!doctype html", "<html")):
        raise XmlError(rules.HTML.at(file=file, line=1))
    if not start.startswith("<"):
        seen = head.lstrip("\ufeff \t\r\n")[:24].split("\n")[0]
        message, hint = f"The file is not XML: it begins with {seen!r}.", None
        for magic, program in _COMPRESSED:
            if data.startswith(magic):
                message = f"The file is not XML: it is compressed with {program}."
                hint = "Unpack it first; of archives only .zae (zip) is read."
        raise XmlError(rules.NOT_XML.at(message=message, file=file, line=1, hint=hint))
    doctype = _doctype(head)
    if doctype is not None:
        if re.match(r"<!doctype\s+html", head[doctype : doctype + 64], re.IGNORECASE):
            raise XmlError(rules.HTML.at(file=file, line=head.count("\n", 0, doctype) + 1))
        line = head.count("\n", 0, doctype) + 1
        column = doctype - (head.rfind("\n", 0, doctype) + 1) + 1
        raise XmlError(rules.DOCTYPE.at(file=file, line=line, column=column))
    count = element_count(data, limits)
    if count > limits.elements:
        raise XmlError(
            rules.TOO_MANY_ELEMENTS.at(
                message=f"The document has about {count} elements; the limit is {limits.elements}.",
                file=file,
            )
        )


def element_count(data: bytes, limits: Limits) -> int:
    """About how many elements, comments and instructions there are; 0 if surely few enough."""
    if len(data) <= limits.elements * _SHORTEST:
        return 0
    count = data.count(b"<") - data.count(b"</")
    if data.startswith(_UTF16):
        count -= data.count(b"<\0/") if data[0] == 0xFF else data.count(b"<\0/\0")
    return count


def _prolog(data: bytes) -> str:
    """The text up to the root element's start tag (a view for looking, not for parsing)."""
    if data.startswith(_UTF16):
        return data[: 1 << 20].decode("utf-16", "replace")
    position = 3 if data.startswith(b"\xef\xbb\xbf") else 0
    end = root_start(data, position)
    return data[position : end + 256].decode("utf-8", "replace")


def root_start(data: bytes, position: int = 0) -> int:
    """The offset of the first markup that is neither instruction, comment nor DOCTYPE."""
    while True:
        position = data.find(b"<", position)
        if position < 0:
            return len(data)
        if data.startswith(b"<?", position):
            position = data.find(b"?>", position + 2)
        elif data.startswith(b"<!--", position):
            position = data.find(b"-->", position + 4)
        else:
            return position
        if position < 0:
            return len(data)


def _doctype(prolog: str) -> int | None:
    """Where the DOCTYPE declaration is in the text before the root element."""
    position = 0
    while (position := prolog.find("<", position)) >= 0:
        if prolog.startswith("<?", position):
            position = prolog.find("?>", position)
        elif prolog.startswith("<!--", position):
            position = prolog.find("-->", position + 4)
        elif prolog[position : position + 9].upper() == "<!DOCTYPE":
            return position
        else:
            return None
        if position < 0:
            return None
    return None


def _translate(
    error: etree.XMLSyntaxError, data: bytes, file: str | None, limits: Limits
) -> Finding:
    """One finding of ours for libxml2's first complaint."""
    line, column = error.position
    text = re.sub(r",? ?(?:use|try) XML_PARSE_HUGE.*", "", (error.msg or "").split(", line ")[0])
    text = " ".join(text.split()).rstrip(".")
    if text == "Unregistered error message":
        text = "a CDATA section is not closed"
    code = getattr(error, "code", 0)
    rule: Rule = rules.MALFORMED
    hint: str | None = None
    message = f"The document is not well-formed: {text}."
    if _TOO_DEEP.search(text):
        rule = rules.TOO_DEEP
        message = f"Elements are nested deeper than the limit of {limits.depth} levels."
    elif code == _RESOURCE_LIMIT or _TOO_LONG.search(text):
        rule = rules.TEXT_TOO_LONG
        message = f"A text, a name or an attribute is longer than the limit ({text})."
    elif code == _DOCUMENT_END:
        rule, message = rules.TRAILING, rules.TRAILING.summary
    elif code == _TAG_NOT_FINISHED or (
        (code in _UNFINISHED or text.startswith("Incomplete")) and _at_end(data, line, column)
    ):
        rule = rules.TRUNCATED
        message = f"The document ends too early, in line {line}: {text}."
    elif code in _ENCODING_CODES:
        rule = rules.ENCODING
        message = f"The document's encoding is wrong: {text}."
    elif code == _UNDECLARED:
        hint = "Declare it with xmlns:prefix=... where it begins, or read the file with repair."
    elif code == _DOCUMENT_EMPTY:
        rule = rules.TRUNCATED
        message = "The document ends before its root element."
    return rule.at(message=message, file=file, line=line or None, column=column or None, hint=hint)


def _at_end(data: bytes, line: int, column: int) -> bool:
    body = data.rstrip(b" \t\r\n")
    last = body.count(b"\n") + 1
    return line > last or (line == last and column >= len(body) - (body.rfind(b"\n") + 1))


def _check_limits(
    tree: etree._ElementTree, data: bytes, file: str | None, limits: Limits, *, huge: bool
) -> None:
    """Limits that libxml2 does not check by itself; costs nothing where the file is small."""
    parser_depth = LIBXML2_DEPTH_MAX if huge else LIBXML2_DEPTH
    if limits.depth < parser_depth:
        for element in _first(tree, "/*" * (limits.depth + 1)):
            message = f"Elements are nested deeper than the limit of {limits.depth} levels."
            line = getattr(element, "sourceline", None)
            raise XmlError(rules.TOO_DEEP.at(message=message, file=file, line=line))
    parser_text = None if huge else LIBXML2_TEXT
    plain = (tree.docinfo.encoding or "utf-8").lower() in _PLAIN_ENCODINGS
    if limits.text != parser_text and (len(data) > limits.text or not plain):
        long = f"string-length() > {limits.text}"
        query = f"//text()[{long}]/.. | //@*[{long}]/.. | //comment()[{long}]"
        for element in _first(tree, query):
            message = (
                f"A text or an attribute is longer than the limit of {limits.text} characters."
            )
            raise XmlError(rules.TEXT_TOO_LONG.at(element, message, file=file))


def _first(tree: etree._ElementTree, query: str) -> list[etree._Element]:
    found = tree.xpath(f"({query})[1]")
    nodes = found if isinstance(found, list) else []
    return [node for node in nodes if isinstance(node, etree._Element)]


def _check_root(root: etree._Element, file: str | None) -> None:
    name = etree.QName(root)
    namespace = name.namespace or ""
    if name.localname.lower() == "html":
        raise XmlError(rules.HTML.at(root, file=file))
    if name.localname != "COLLADA":
        found = f"<{name.localname}>" + (f" of namespace {namespace!r}" if namespace else "")
        message = f"The root element is {found}, not <COLLADA>."
        raise XmlError(rules.WRONG_ROOT.at(root, message, file=file))
    if namespace and not namespace.startswith(_ANY_COLLADA):
        message = f"The root element <COLLADA> is in the namespace {namespace!r}."
        raise XmlError(rules.WRONG_NAMESPACE.at(root, message, file=file))
