"""Rigid transforms as the standard writes them, and matrices where none may stand."""

from __future__ import annotations

import numpy as np
from lxml import etree

from colladaphy.conform import body_rules
from colladaphy.conform.context import Context, insert, local, remove
from colladaphy.conform.frames import TRANSFORMS, Matrix, axis_angle, nearest_rotation, of_element
from colladaphy.conform.solids import are_usable, numbers_of

__all__ = ["number_text", "place_elements", "put_place", "split_matrices"]


def place_elements(
    context: Context, matrix: Matrix, *, whole: bool = False
) -> list[etree._Element]:
    """A rigid transform as translate and rotate; parts that do nothing are left out.

    With `whole` the translate is written in any case: a frame of mass must say where it is.
    """
    made = []
    if whole or np.any(matrix[:3, 3] != 0.0):
        made.append(context.make("translate", " ".join(number_text(v) for v in matrix[:3, 3])))
    axis = axis_angle(matrix)
    if axis[3] != 0.0:
        made.append(context.make("rotate", " ".join(number_text(v) for v in axis)))
    return made


def number_text(value: float) -> str:
    """A float as XML Schema spells it; -0 and rounding dust near whole numbers are cleaned."""
    whole = round(float(value))
    if abs(value - whole) < 1e-14:
        return str(whole)
    return repr(float(value))


def split_matrices(context: Context) -> None:
    """A matrix where only translate and rotate may stand becomes these two."""
    for matrix in context.all("matrix"):
        parent = matrix.getparent()
        if parent is None or local(parent) not in (
            "shape", "mass_frame", "attachment", "ref_attachment", "link", "frame_origin",
            "frame_tip", "frame_tcp", "frame_object", "attachment_full", "attachment_start",
            "attachment_end",
        ):  # fmt: skip
            continue
        if (
            len(values := numbers_of(matrix)) != 16
            or not are_usable(values)
            or not context.wants(body_rules.MATRIX)
        ):
            continue
        rigid, exact = nearest_rotation(of_element(matrix))
        made = place_elements(context, rigid, whole=local(parent) == "mass_frame")
        for offset, new in enumerate(made):
            insert(parent, parent.index(matrix), new) if not offset else made[0].addnext(new)
        message = f"<matrix> in <{local(parent)}> is now " + (
            " and ".join(f"<{local(new)}>{new.text}" for new in made) or "nothing (identity)"
        )
        if exact:
            context.note(body_rules.MATRIX, matrix, message)
            remove(matrix)
        else:
            context.note(body_rules.MATRIX, matrix, message + "; its scale or skew is lost")
            context.stash(matrix)


def put_place(context: Context, holder: etree._Element, place: Matrix) -> None:
    """Write a rigid transform into a shape, a frame of mass or an attachment, for those there."""
    old = [child for child in holder if local(child) in TRANSFORMS]
    index = holder.index(old[0]) if old else len(holder)
    if not old:
        index = next((i for i, c in enumerate(holder) if local(c) == "extra"), len(holder))
    made = place_elements(context, place, whole=local(holder) == "mass_frame")
    tail = old[-1].tail if old else None
    for child in old:
        holder.remove(child)
    for offset, new in enumerate(made):
        insert(holder, index + offset, new)
    if made and old and index + len(made) == len(holder):
        made[-1].tail = tail
