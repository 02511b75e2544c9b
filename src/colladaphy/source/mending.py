"""Text that is not well-formed for a small reason: single bytes and prefixes nobody declared.

Programs that keep elements of other namespaces, but not the declarations of the root (Bullet's
converter and collada-dom among them), and names typed in another encoding make files that no XML
parser reads, though nothing in them is in doubt.
"""

from __future__ import annotations

import re
from typing import Any

from lxml import etree

from colladaphy.findings import Finding
from colladaphy.source import rules

__all__ = ["mend_text"]

_UNDECLARED = 201  # XML_NS_ERR_UNDEFINED_NAMESPACE
_PREFIX = re.compile(r"Namespace prefix (\S+) (?:on|for) ")
_KNOWN = {
    "pe": "urn:colladaphy:pe:1",
    "conform": "urn:colladaphy:conform:1",
    "xsi": "http://www.w3.org/2001/XMLSchema-instance",
    "xlink": "http://www.w3.org/1999/xlink",
    "math": "http://www.w3.org/1998/Math/MathML",
    "mml": "http://www.w3.org/1998/Math/MathML",
}
_DECLARED = re.compile(rb"""\A(?:\xef\xbb\xbf)?\s*<\?xml[^>]*?\bencoding\s*=\s*["']([^"']*)["']""")
_ESCAPED = re.compile("[\udc80-\udcff]")
# What a byte alone stands for: Windows' Latin alphabet, and Latin-1 where that has nothing.
_LATIN = {
    0xDC00 + byte: bytes([byte]).decode("cp1252", "ignore") or chr(byte)
    for byte in range(0x80, 0x100)
}


def mend_text(data: bytes, root: int, file: str | None) -> tuple[bytes, list[Finding]]:
    """The bytes of a document without these faults, and a finding for each kind.

    `root` is where the tag of the root element begins. Lines stay lines. The bytes are the same
    where there is nothing of this to mend.
    """
    data, findings = _as_utf8(data, file)
    data, more = _declare(data, root, file)
    return data, findings + more


def _as_utf8(data: bytes, file: str | None) -> tuple[bytes, list[Finding]]:
    """Bytes that are not UTF-8 in a text that says it is, taken from Latin-1."""
    stated = _DECLARED.match(data)
    if stated is not None and stated[1].lower() not in (b"utf-8", b"utf8", b"us-ascii", b"ascii"):
        return data, []
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        return data, []
    text = data.decode("utf-8", "surrogateescape")
    strays = list(_ESCAPED.finditer(text))
    if not strays:
        return data, []
    start = strays[0].start()
    line = text.count("\n", 0, start) + 1
    column = start - (text.rfind("\n", 0, start) + 1) + 1
    byte = ord(strays[0][0]) - 0xDC00
    message = f"The byte {byte:#04x} is not UTF-8; it is read as {_LATIN[ord(strays[0][0])]!r}."
    if len(strays) > 1:
        lines = {text.count("\n", 0, found.start()) + 1 for found in strays[1:9]}
        where = ", ".join(map(str, sorted(lines)))
        message += f" {len(strays) - 1} more follow (lines {where}{' …' * (len(strays) > 9)})."
    finding = rules.LATIN.at(message=message, file=file, line=line, column=column)
    return text.translate(_LATIN).encode("utf-8"), [finding]


def _declare(data: bytes, root: int, file: str | None) -> tuple[bytes, list[Finding]]:
    """Prefixes without a declaration, declared at the root."""
    parser = etree.XMLParser(
        recover=True, resolve_entities=False, no_network=True, load_dtd=False, huge_tree=True
    )
    try:
        etree.fromstring(data, parser)
    except (etree.XMLSyntaxError, ValueError, LookupError):
        return data, []
    log: Any = parser.error_log
    places: dict[str, tuple[int, int, int]] = {}
    for entry in log:
        found = _PREFIX.match(entry.message)
        if entry.type != _UNDECLARED or found is None:
            return data, []  # there is more than this to mend
        first = places.get(found[1], (entry.line, entry.column, 0))
        places[found[1]] = (first[0], first[1], first[2] + 1)
    end = re.compile(rb"<[^\s/>]+").match(data, root)
    if not places or end is None:
        return data, []
    findings, declared = [], ""
    for prefix, (line, column, count) in places.items():
        uri = _KNOWN.get(prefix, f"urn:colladaphy:undeclared:{prefix}")
        declared += f' xmlns:{prefix}="{uri}"'
        message = (
            f"The prefix {prefix!r} is not declared ({count} times); {uri!r} is taken for its "
            "namespace."
        )
        findings.append(rules.PREFIX.at(message=message, file=file, line=line, column=column))
    return data[: end.end()] + declared.encode() + data[end.end() :], findings
