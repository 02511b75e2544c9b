"""The schema: where its files are, and what libxml2 makes of them."""

from __future__ import annotations

from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any

from lxml import etree

__all__ = ["PE", "compiled", "profile_elements", "schema_1_4", "schema_folder", "wrapped"]

PE = "urn:colladaphy:pe:1"
_XS = "{http://www.w3.org/2001/XMLSchema}"


def schema_folder() -> Path:
    """Where the schema files are: beside the package when installed, else in the checkout."""
    here = Path(__file__).resolve().parents[1]
    for folder in (here / "schema", here.parents[1] / "schema"):
        if (folder / "document.xsd").is_file():
            return folder
    raise FileNotFoundError(f"the schema files of colladaphy are missing beside {here}")


@cache
def compiled() -> etree.XMLSchema:
    """The schema as libxml2 holds it; the gate only, as a run leaves its log there."""
    parser = etree.XMLParser(no_network=True, load_dtd=False, resolve_entities=False)
    return etree.XMLSchema(etree.parse(schema_folder() / "document.xsd", parser))


@cache
def wrapped(open_content: str) -> etree.XMLSchema:
    """The schema of a document within an element `document` of COLLADA's namespace.

    The content of techniques is ``lax``, or ``strict``: they may hold known elements only. What
    passes that has no element of the pe profile that there is not (content of MathML stays open).
    COLLADA's files are made one, as libxml2 can include only files.
    """
    parser = etree.XMLParser(no_network=True, load_dtd=False, resolve_entities=False)
    main = schema_folder() / "collada-1.5" / "collada.xsd"
    areas = [etree.parse(path, parser).getroot() for path in sorted(main.parent.glob("*.xsd"))]
    names: dict[Any, str] = {}
    for area in areas:
        names |= area.nsmap
    root = etree.Element(f"{_XS}schema", dict(areas[0].attrib), nsmap=names)
    root.getroottree().docinfo.URL = str(main)
    imports = {PE: root.makeelement(f"{_XS}import", namespace=PE)}
    imports[PE].set("schemaLocation", "../pe-profile.xsd")
    for area in areas:
        for child in area.iterchildren(etree.Element):
            if child.tag == f"{_XS}import":
                imports.setdefault(child.get("namespace", ""), child)
            elif child.tag != f"{_XS}include":
                root.append(child)
    for imported in imports.values():
        root.insert(0, imported)
    for wildcard in root.iter(f"{_XS}any"):
        wildcard.set("processContents", open_content)
    wrapper = etree.SubElement(root, f"{_XS}element", name="document")
    content = etree.SubElement(etree.SubElement(wrapper, f"{_XS}complexType"), f"{_XS}sequence")
    etree.SubElement(content, f"{_XS}element", ref="COLLADA")
    return etree.XMLSchema(root)


@cache
def schema_1_4() -> etree.XMLSchema | None:
    """The schema of 1.4.1 that pycollada ships; None where that is not installed."""
    try:
        pycollada = import_module("collada.schema")
    except ImportError:
        return None
    schema: etree.XMLSchema = pycollada.ColladaValidator().COLLADA_SCHEMA_1_4_1_INSTANCE
    return schema


@cache
def profile_elements() -> frozenset[str]:
    """The global elements of the pe profile: what a technique may hold of it."""
    root = etree.parse(schema_folder() / "pe-profile.xsd").getroot()
    return frozenset(f"{{{PE}}}{child.get('name')}" for child in root.iterchildren(f"{_XS}element"))
