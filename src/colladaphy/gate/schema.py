"""The schema: where its files are, and what libxml2 makes of them."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from lxml import etree

__all__ = ["PE", "compiled", "profile_elements", "schema_folder"]

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
def profile_elements() -> frozenset[str]:
    """The global elements of the pe profile: what a technique may hold of it."""
    root = etree.parse(schema_folder() / "pe-profile.xsd").getroot()
    return frozenset(f"{{{PE}}}{child.get('name')}" for child in root.iterchildren(f"{_XS}element"))
