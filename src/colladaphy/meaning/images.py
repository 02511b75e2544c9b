"""Files of images (COLLADA 1.5 §image, §init_from)."""

from __future__ import annotations

import re
from collections.abc import Iterator

import numpy as np

from colladaphy.findings import Severity
from colladaphy.meaning import link_rules
from colladaphy.meaning.context import Context, TextRows
from colladaphy.meaning.hits import Hit
from colladaphy.source.rules import REFERENCE_REFUSED

__all__ = ["CHECKS"]


_WINDOWS = re.compile(r"(file:)?/*[A-Za-z]:[\\/]|\\\\")
_LOCAL = re.compile(r"file:/|/(?!/)")


def files(context: Context) -> Iterator[Hit]:
    """Images without a file, or whose file is not there or is on one computer only."""
    rows = context.rows(TextRows, "ref")
    if not len(rows):
        return
    assert rows.ordinals is not None
    # Where names are relative to another place, files are not looked for.
    exists = None if len(context.columns.with_attribute("xml:base")[0]) else context.exists
    mine = rows.ordinals[np.flatnonzero(context.is_within(rows.ordinals, "init_from"))]
    for element, text in zip(mine.tolist(), context.at(TextRows, mine).value, strict=True):
        name = text.strip()
        if not name:
            yield Hit(link_rules.IMAGE_EMPTY, element, "The name of the image's file is empty.")
        elif _WINDOWS.match(name) or _LOCAL.match(name):
            yield Hit(link_rules.IMAGE_ABSOLUTE, element, f"The image is {name!r}.")
        elif exists is not None and ":" not in name.split("/")[0]:
            why = exists(name)
            if why == "outside":
                message = f"The reference {name!r} leads out of the document's folder."
                yield Hit(REFERENCE_REFUSED, element, message, severity=Severity.WARNING)
            elif why is not None:
                yield Hit(link_rules.IMAGE_MISSING, element, f"There is no file {name!r}.")


CHECKS = (files,)
