"""Inputs that attack whoever reads them: bytes, archives, depth, width, numbers."""

from __future__ import annotations

from collections.abc import Iterable

from hypothesis import strategies as st

from colladaphy.testing.breaking.archives import zipped
from colladaphy.testing.breaking.graphs import exploding
from colladaphy.testing.mutations import mutants
from colladaphy.testing.physics import physics_documents

__all__ = ["HOSTILE_KINDS", "hostile_inputs"]

_ROOT = (
    b'<COLLADA xmlns="http://www.collada.org/2008/03/COLLADASchema" version="1.5.0"><asset>'
    b"<created>2000-01-01T00:00:00Z</created><modified>2000-01-01T00:00:00Z</modified></asset>"
)
_PIECES = (
    b"<COLLADA", b' xmlns="http://www.collada.org/2008/03/COLLADASchema"', b">", b"</", b"/>",
    b"<", b"<!--", b"-->", b"<![CDATA[", b"]]>", b"<?xml version='1.0'?>", b"&", b"&#0;", b"&amp;",
    b"<!DOCTYPE a [", b"<!ENTITY e 'x'>", b"]>", b"&e;", b"\xff\xfe", b"\xef\xbb\xbf", b"\x00",
    b"PK\x03\x04", b' version="1.5.0"', b"asset", b"created", b"1", b"\xe2\x80\xa8", b" ", b"\xc3",
    b"</COLLADA>", _ROOT,
)  # fmt: skip
_ODD = (
    b"NaN", b"INF", b"-INF", b"1e999", b"1e-320", b"1.7976931348623157e308", b"5e-324", b"-0",
    b"1e", b"1_0", b"0x1F", b"\xd9\xa1", b"1,5", b"", b" ", b"9" * 20, b"9223372036854775808",
    b"4611686018427387904", b"-1", b"1" * 400, b"0." + b"0" * 400 + b"1", b"1 2", b"true",
)  # fmt: skip
_REFERENCES = (
    b"http://example.invalid/a.dae#a", b"file:///etc/passwd", b"../../a.dae#a", b"//host/a.dae#a",
    b"C:\\a.dae#a", b"#", b"##", b"#%00", b"#a/b/c(0)(0)(0)(0)(0)", b"%2e%2e/a.dae", b"a.dae\n#a",
)  # fmt: skip


def hostile_inputs(kinds: str | Iterable[str] | None = None) -> st.SearchStrategy[bytes]:
    """Anything at all: what an importer must take or refuse, in bounded time and memory.

    `kinds` are some of HOSTILE_KINDS (None: all): `bytes` of any kind, `markup` torn to pieces,
    `archives` that are damaged, unsafe or packed many times over, `depth` and `width` of elements,
    attributes and instances, `numbers` and `references` that no author would write, documents that
    are `damaged` or `mutated`, and `entities`. They are small, from nothing to some hundred
    kilobytes: what they ask for is not.

    Raises ValueError for an unknown kind.
    """
    names = HOSTILE_KINDS if kinds is None else [kinds] if isinstance(kinds, str) else [*kinds]
    for name in names:
        if name not in _KINDS:
            raise ValueError(f"no kind {name!r}; there are {', '.join(HOSTILE_KINDS)}")
    return st.one_of([_KINDS[name]() for name in names])


def _bytes() -> st.SearchStrategy[bytes]:
    return st.binary(max_size=200) | st.text(max_size=100).map(str.encode)


def _markup() -> st.SearchStrategy[bytes]:
    return st.lists(st.sampled_from(_PIECES), max_size=40).map(b"".join)


@st.composite
def _archives(draw: st.DrawFn) -> bytes:
    document = draw(physics_documents(oddities=False))
    kind = draw(st.sampled_from(["damaged", "names", "twice", "nested", "full", "blank"]))
    if kind == "damaged":
        data = bytearray(zipped(("a.dae", document), ("b.png", b"\0" * 30)))
        for _ in range(draw(st.integers(1, 4))):
            data[draw(st.integers(0, len(data) - 1))] = draw(st.integers(0, 255))
        return bytes(data[: draw(st.integers(0, len(data)))] if draw(st.booleans()) else data)
    names = st.sampled_from(["../a", "/a", "a/../../b", "C:a", "a\\b", "a/", "\0", "é", "x" * 300])
    if kind == "names":
        return zipped(("a.dae", document), (draw(names), b"x"))
    if kind == "twice":
        return zipped(("a.dae", document)) + zipped(("a.dae", document))
    if kind == "nested":
        for _ in range(draw(st.integers(1, 3))):
            document = zipped(("a.dae", document))
        return document
    if kind == "full":
        return zipped(("a.dae", document), *((f"{number}", b"") for number in range(300)))
    return zipped(("a.dae", document + b" " * draw(st.integers(10**5, 10**7))))


@st.composite
def _depth(draw: st.DrawFn) -> bytes:
    """Elements in elements, nodes in nodes, or models in models."""
    depth = draw(st.sampled_from([100, 255, 256, 257, 1000, 20_000]))
    kind = draw(st.sampled_from(["foreign", "nodes", "models", "open"]))
    if kind == "models":
        return exploding(min(depth, 300))
    if kind == "nodes":
        nodes = b"<node>" * depth + b"</node>" * depth
        return _ROOT + b"<library_nodes>" + nodes + b"</library_nodes></COLLADA>"
    inner = b"<a>" * depth + (b"" if kind == "open" else b"</a>" * depth)
    return _ROOT + b'<extra><technique profile="x">' + inner + b"</technique></extra></COLLADA>"


@st.composite
def _width(draw: st.DrawFn) -> bytes:
    """Very many attributes, namespaces, siblings, ids that are equal, or references."""
    count = draw(st.sampled_from([1, 100, 5000]))
    numbers = range(count)
    match draw(st.sampled_from(["attributes", "namespaces", "nodes", "ids", "instances", "words"])):
        case "attributes":
            inside = b"<node " + b"".join(b'a%d="" ' % number for number in numbers) + b"/>"
        case "namespaces":
            inside = b"<node " + b"".join(b'xmlns:a%d="x%d" ' % (n, n) for n in numbers) + b"/>"
        case "nodes":
            inside = b"<node/>" * count
        case "ids":
            inside = b'<node id="a"/>' * count
        case "instances":
            inside = b'<node id="a">' + b'<instance_node url="#a"/>' * count + b"</node>"
        case _:
            inside = b"<node><translate>" + b"1 " * count + b"</translate></node>"
    return _ROOT + b"<library_nodes>" + inside + b"</library_nodes></COLLADA>"


def _with(values: tuple[bytes, ...], begin: bytes, end: bytes) -> st.SearchStrategy[bytes]:
    """Documents in which a few values between two marks are replaced."""

    @st.composite
    def document(draw: st.DrawFn) -> bytes:
        data = draw(physics_documents(oddities=False))
        for _ in range(draw(st.integers(1, 3))):
            places = [at + 1 for at in range(len(data)) if data.startswith(begin, at)]
            if not places:
                break
            start = draw(st.sampled_from(places)) + len(begin) - 1
            stop = data.index(end, start)
            data = data[:start] + draw(st.sampled_from(values)) + data[stop:]
        return data

    return document()


@st.composite
def _numbers(draw: st.DrawFn) -> bytes:
    digits = b"0123456789"
    data = draw(physics_documents(oddities=False))
    for _ in range(draw(st.integers(1, 3))):
        places = [at for at in range(1, len(data)) if data[at : at + 1] in _set(digits)
                  and data[at - 1 : at] in _set(b' >"')]  # fmt: skip
        if not places:
            break
        start = draw(st.sampled_from(places))
        stop = start
        while data[stop : stop + 1] in _set(digits + b".e+-"):
            stop += 1
        data = data[:start] + draw(st.sampled_from(_ODD)) + data[stop:]
    return data


def _set(characters: bytes) -> frozenset[bytes]:
    return frozenset(bytes([each]) for each in characters)


@st.composite
def _damaged(draw: st.DrawFn) -> bytes:
    data = bytearray(draw(physics_documents()))
    for _ in range(draw(st.integers(1, 4))):
        place = draw(st.integers(0, len(data)))
        span = draw(st.sampled_from([1, 2, 8, 64, 500]))
        match draw(st.sampled_from(["cut", "drop", "repeat", "change"])):
            case "cut":
                del data[place:]
            case "drop":
                del data[place : place + span]
            case "repeat":
                data[place:place] = data[place : place + span]
            case _:
                data[place : place + 1] = bytes([draw(st.integers(0, 255))])
    return bytes(data)


@st.composite
def _entities(draw: st.DrawFn) -> bytes:
    """Entities that multiply, come from elsewhere, or contain themselves."""
    depth = draw(st.integers(1, 12))
    inner = "".join(f'<!ENTITY e{n + 1} "{f"&e{n};" * 10}">' for n in range(depth))
    first = draw(st.sampled_from(['"x"', 'SYSTEM "file:///etc/passwd"', '"&e0;"',
                                  'SYSTEM "http://example.invalid/"']))  # fmt: skip
    doctype = f"<!DOCTYPE COLLADA [<!ENTITY e0 {first}>{inner}]>".encode()
    return doctype + _ROOT + f"<extra>&e{depth};</extra></COLLADA>".encode()


_KINDS = {
    "bytes": _bytes,
    "markup": _markup,
    "archives": _archives,
    "depth": _depth,
    "width": _width,
    "numbers": _numbers,
    "references": lambda: _with(_REFERENCES, b'="#', b'"'),
    "damaged": _damaged,
    "mutated": lambda: mutants(areas=["physics"]),
    "entities": _entities,
}
HOSTILE_KINDS: tuple[str, ...] = tuple(_KINDS)
"""The kinds of inputs that `hostile_inputs` draws."""
