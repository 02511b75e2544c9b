"""Loops of links: both ends of a joint that closes one (COLLADA 1.5 §attachment_start)."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from colladaphy.meaning import kinematics_rules
from colladaphy.meaning.context import Context
from colladaphy.meaning.hits import Hit

__all__ = ["CHECKS"]

_ENDS = ("attachment_start", "attachment_end")


def loops(context: Context) -> Iterator[Hit]:
    """Joints that are attached at one end only."""
    ends = [context.references("joint", name) for name in _ENDS]
    if not any(ends):
        return
    held: list[dict[tuple[int, str], int]] = []
    for references in ends:
        elements = np.array([reference.element for reference in references], np.int64)
        models = context.ancestor(elements, "kinematics_model").tolist()
        held.append({
            (model, reference.text.strip().rpartition("/")[2]): reference.element
            for model, reference in zip(models, references, strict=True)
        })  # fmt: skip
    for side, mine in enumerate(held):
        for (model, joint), element in mine.items():
            if joint and (model, joint) not in held[1 - side]:
                message = f"The joint {joint!r} has no <{_ENDS[1 - side]}>."
                yield Hit(kinematics_rules.LOOP, element, message, (), "joint")


CHECKS = (loops,)
