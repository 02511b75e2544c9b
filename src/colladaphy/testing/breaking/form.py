"""Faults of form: of the bytes, the markup, and what the schema declares."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from hypothesis import strategies as st
from lxml import etree

from colladaphy.conform.grammar import NAMESPACE

__all__ = ["FORM"]

C = f"{{{NAMESPACE}}}"
_OLD = "http://www.collada.org/2005/11/COLLADASchema"
Draw = st.DrawFn
Make = Callable[[Draw, bytes], bytes]
Edit = Callable[[Draw, etree._Element], Any]


def _before_root(text: bytes) -> Make:
    def make(draw: Draw, data: bytes) -> bytes:
        place = data.index(b"<COLLADA")
        return data[:place] + text + b"\n" + data[place:]

    return make


def _after(*texts: bytes) -> Make:
    return lambda draw, data: data + draw(st.sampled_from(texts))


def _instead(*texts: bytes) -> Make:
    return lambda draw, data: draw(st.sampled_from(texts))


def _inside(text: bytes) -> Make:
    """Put in behind the start tag of the root, which has no text."""

    def make(draw: Draw, data: bytes) -> bytes:
        place = data.index(b">", data.index(b"<COLLADA")) + 1
        return data[:place] + text + data[place:]

    return make


def _same(draw: Draw, data: bytes) -> bytes:
    return data


def _cut(draw: Draw, data: bytes) -> bytes:
    first = data.index(b"<asset")
    ends = [at + 1 for at in range(first, len(data) - 15) if data[at : at + 1] == b">"]
    return data[: draw(st.sampled_from(ends))]


def _crossed(draw: Draw, data: bytes) -> bytes:
    """An end tag of another element."""
    ends = [place for place in range(len(data)) if data.startswith(b"</", place)]
    place = draw(st.sampled_from(ends))
    return data[: place + 2] + b"x" + data[place + 2 :]


def _edited(edit: Edit) -> Make:
    def make(draw: Draw, data: bytes) -> bytes:
        root = etree.fromstring(data)
        edit(draw, root)
        return etree.tostring(root, encoding="UTF-8", xml_declaration=True)

    return make


def _one(draw: Draw, root: etree._Element, *names: str) -> etree._Element:
    found: etree._Element = draw(st.sampled_from([*root.iter(*(C + name for name in names))]))
    return found


def _renamed_root(draw: Draw, data: bytes) -> bytes:
    name = draw(st.sampled_from([b"Collada", b"collada", b"model", b"COLLADA2"]))
    return data.replace(b"<COLLADA", b"<" + name, 1).replace(b"</COLLADA>", b"</" + name + b">")


def _other_namespace(*uris: str) -> Make:
    def make(draw: Draw, data: bytes) -> bytes:
        return data.replace(NAMESPACE.encode(), draw(st.sampled_from(uris)).encode(), 1)

    return make


def _nested(depth: int) -> Make:
    def edit(draw: Draw, root: etree._Element) -> None:
        around = etree.SubElement(
            etree.SubElement(root, f"{C}extra"), f"{C}technique", profile="deep"
        )
        for _ in range(depth):
            around = etree.SubElement(around, "{urn:example:deep}level")

    return _edited(edit)


# --- the schema


def _duplicate(draw: Draw, root: etree._Element) -> None:
    holders = [each for each in root.iter(f"{C}*") if "id" in each.attrib]
    twin = draw(st.sampled_from(holders))
    root.append(etree.fromstring(f'<extra xmlns="{NAMESPACE}"><technique profile="x"/></extra>'))
    root[-1].set("id", str(twin.attrib["id"]))


def _new_id(draw: Draw, root: etree._Element) -> None:
    root.append(
        etree.fromstring(
            f'<extra xmlns="{NAMESPACE}" id="not-there-yet"><technique profile="x"/></extra>'
        )
    )


def _without(draw: Draw, root: etree._Element) -> None:
    element = _one(draw, root, "created", "modified")
    around = element.getparent()
    assert around is not None
    around.remove(element)


def _swapped(draw: Draw, root: etree._Element) -> None:
    """The asset of the document behind its libraries."""
    root.append(root[0])


def _within_a_technique(tag: str) -> Edit:
    def edit(draw: Draw, root: etree._Element) -> None:
        extra = etree.SubElement(root, f"{C}extra")
        technique = etree.SubElement(extra, f"{C}technique", profile="pe")
        etree.SubElement(technique, tag)

    return edit


def _unit(text: str) -> Edit:
    def edit(draw: Draw, root: etree._Element) -> None:
        asset = root[0]
        for unit in asset.findall(f"{C}unit"):
            asset.remove(unit)
        unit = etree.Element(f"{C}unit", meter=text)
        axis = asset.find(f"{C}up_axis")
        if axis is None:
            asset.append(unit)
        else:
            axis.addprevious(unit)

    return edit


def _gravity(text: str) -> Edit:
    def edit(draw: Draw, root: etree._Element) -> None:
        common = next(
            scene.find(f"{C}technique_common") for scene in root.iter(f"{C}physics_scene")
        )
        assert common is not None
        for old in common.findall(f"{C}gravity"):
            common.remove(old)
        common.insert(0, etree.Element(f"{C}gravity"))
        common[0].text = text

    return edit


def _attribute(name: str, value: str, *owners: str) -> Edit:
    def edit(draw: Draw, root: etree._Element) -> None:
        _one(draw, root, *owners).set(name, value)

    return edit


def _no_attribute(draw: Draw, root: etree._Element) -> None:
    del _one(draw, root, "instance_physics_scene").attrib["url"]


def _words_between(draw: Draw, root: etree._Element) -> None:
    _one(draw, root, "physics_scene", "visual_scene", "asset")[0].tail = "words"


_BLANK = b" " * 10_000_001

FORM: dict[str, tuple[Make, Make]] = {
    "xml-doctype": (_before_root(b"<!DOCTYPE COLLADA>"), _before_root(b"<!-- <!DOCTYPE a> -->")),
    "xml-empty": (_instead(b""), _same),
    "xml-encoding": (_inside(b"<!-- \xe9 -->"), _inside(b"<!-- \xc3\xa9 -->")),
    "xml-html": (
        _instead(b"<!DOCTYPE html><html><body>404</body></html>", b"<html><head/></html>"),
        _inside(b"<!-- <html> -->"),
    ),
    "xml-malformed": (_crossed, _inside(b"<?x </y> ?>")),
    "xml-not-xml": (
        _instead(b"\x89PNG\r\n\x1a\n\0\0", b"solid cube\n", b"{}", b"%PDF-1.7"),
        _before_root(b"<!-- %PDF-1.7 -->"),
    ),
    "xml-text-too-long": (
        _inside(b"<!--" + _BLANK + b"-->"),
        _inside(b"<!--" + _BLANK[:10_000] + b"-->"),
    ),
    "xml-too-deep": (_nested(300), _nested(100)),
    "xml-trailing": (_after(b"<more/>", b"words", b"<COLLADA/>"), _after(b"<!-- -->", b"\n\n")),
    "xml-truncated": (_cut, _same),
    "xml-wrong-namespace": (_other_namespace("urn:example:other", "x"), _same),
    "xml-wrong-root": (_renamed_root, _same),
    "schema-duplicate-id": (_edited(_duplicate), _edited(_new_id)),
    "schema-invalid-value": (_edited(_unit("one")), _edited(_unit("0.01"))),
    "schema-missing-attribute": (_edited(_no_attribute), _same),
    "schema-missing-element": (_edited(_without), _same),
    "schema-unexpected-content": (_edited(_words_between), _same),
    "schema-unexpected-element": (_edited(_swapped), _same),
    "schema-unknown-attribute": (
        _edited(_attribute("nonsense", "1", "physics_scene", "node")),
        _edited(_attribute("name", "1", "physics_scene", "node")),
    ),
    "schema-unknown-element": (
        _edited(_within_a_technique("{urn:colladaphy:pe:1}nonsense")),
        _edited(_within_a_technique("{urn:example:x}nonsense")),
    ),
    "schema-version-1-4": (
        lambda draw, data: data.replace(NAMESPACE.encode(), _OLD.encode(), 1).replace(
            b'version="1.5.0"', b'version="1.4.1"', 1
        ),
        _same,
    ),
    "schema-wrong-length": (_edited(_gravity("0 0")), _edited(_gravity("0 0 -1"))),
}
"""By rule: what breaks it, and what nearly does, each of a valid document in UTF-8."""
