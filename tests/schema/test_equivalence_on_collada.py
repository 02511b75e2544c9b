"""The comparison finds one change anywhere in the real physics schema."""

import os
import random
import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest
from lxml import etree
from tools.schema_equivalence import compare, load
from tools.schema_equivalence.loading import OURS

XS = "{http://www.w3.org/2001/XMLSchema}"
AREA = "physics"
SAMPLE = None if os.environ.get("HYPOTHESIS_PROFILE") == "nightly" else 20
"""How many changes are tried; None is all of them."""


def set_or_drop(node: etree._Element, name: str, value: str) -> None:
    """Gives a node an attribute, or takes it away where the node has it."""
    if node.attrib.pop(name, None) is None:
        node.set(name, value)


def edit(node: etree._Element, change: str) -> None:
    if change == "drop":
        parent = node.getparent()
        assert parent is not None
        parent.remove(node)
    elif change == "rename":
        node.set("name", node.attrib["name"] + "s")
    elif change == "retype":
        node.set("type", "xs:language" if node.tag == f"{XS}attribute" else "asset_type")
    elif change == "default":
        node.set("default", {"true": "false", "false": "true"}.get(node.attrib["default"], "2 3 4"))
    else:
        set_or_drop(node, *change.split("="))


def changes(node: etree._Element) -> Iterator[str]:
    """What can be changed at a node, so that the schema stays valid but means something else."""
    if node.tag == f"{XS}attribute":
        yield from ("drop", "rename", "retype", "use=required")
    if node.tag == f"{XS}element":
        yield "rename"
        is_asset = node.get("type") == "asset_type"
        if node.get("type") and not is_asset and node.get("default") is None:
            yield "retype"
        parent = node.getparent()
        if parent is not None and parent.tag == f"{XS}sequence":
            yield from ("drop", "minOccurs=0", "maxOccurs=unbounded")
        if node.get("default") in ("true", "false", "0.0 0.0 0.0"):
            yield from ("default",)
    if node.tag == f"{XS}enumeration":
        yield "drop"


def places() -> list[tuple[str, str]]:
    """Every change, with the path of the node to change; a sample of them, always the same."""
    tree = etree.parse(OURS.with_stem(AREA))
    found = [
        (tree.getpath(node), change) for node in tree.iter(f"{XS}*") for change in changes(node)
    ]
    return found if SAMPLE is None else random.Random(0).sample(found, SAMPLE)


@pytest.fixture(scope="module")
def schema_copy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    copy = tmp_path_factory.mktemp("copy") / "schema"
    shutil.copytree(OURS.parents[1], copy)
    return copy / OURS.parent.name / f"{AREA}.xsd"


@pytest.mark.parametrize(("path", "change"), places())
def test_change_is_found(path: str, change: str, schema_copy: Path) -> None:
    original = OURS.with_stem(AREA)
    tree = etree.parse(original)
    (node,) = tree.xpath(path, namespaces={"xs": XS[1:-1]})
    edit(node, change)
    tree.write(schema_copy)
    assert compare(load(schema_copy), load(original), names=True).differences
