"""Layers that renderings show (COLLADA 1.5 §render, §node)."""

from __future__ import annotations

from collections.abc import Iterator

from colladaphy.meaning import scene_rules
from colladaphy.meaning.context import Context, TextRows
from colladaphy.meaning.hits import Hit, listed
from colladaphy_schema.rows import Rows

__all__ = ["CHECKS"]


def layers(context: Context) -> Iterator[Hit]:
    """Renderings of layers that no node is in."""
    rows = context.rows(TextRows, "layer")
    if not len(rows):
        return
    urls = context.references("url", "instance_node")
    if any(not url.text.startswith("#") for url in urls):
        return  # the nodes of other documents have layers of their own
    known = {
        word
        for text in context.texts(context.rows(Rows, "node"), "layer")
        for word in (text or "").split()
    }
    more = f" There are: {listed(sorted(known))}." if known else ""
    assert rows.ordinals is not None
    for element, text in zip(rows.ordinals.tolist(), rows.value, strict=True):
        name = text.strip()
        if name not in known:
            yield Hit(scene_rules.LAYER, element, f"No node is in the layer {name!r}.{more}")


CHECKS = (layers,)
