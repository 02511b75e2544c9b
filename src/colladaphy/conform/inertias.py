"""Frames and moments of mass: tensors of six or nine numbers, and frames without a place."""

from __future__ import annotations

import copy
from itertools import permutations

import numpy as np
from lxml import etree

from colladaphy.conform import body_rules
from colladaphy.conform.bullet.geometries import Geometries
from colladaphy.conform.bullet.weights import Weights
from colladaphy.conform.context import NS, Context, append, insert, local, remove
from colladaphy.conform.downgrade.draft import Draft
from colladaphy.conform.frames import Matrix, translation
from colladaphy.conform.placing import number_text, place_elements
from colladaphy.conform.solids import are_usable, numbers_of

__all__ = ["diagonalise_inertia", "drop_empty_mass_frames", "place_mass_frames"]

# The orders in which six numbers are written: as pe and most do, as Voigt, as URDF.
_ORDERS = (
    ("xx yy zz xy xz yz", (0, 3, 4, 3, 1, 5, 4, 5, 2)),
    ("xx yy zz yz xz xy", (0, 5, 4, 5, 1, 3, 4, 3, 2)),
    ("xx xy xz yy yz zz", (0, 1, 2, 1, 3, 4, 2, 4, 5)),
)


def drop_empty_mass_frames(context: Context) -> None:
    """A mass_frame without transforms is not allowed, and is the default one."""
    for frame in context.all("mass_frame"):
        empty = next(frame.iterchildren(tag=etree.Element), None) is None
        if empty and not (frame.text or "").strip() and context.wants(body_rules.EMPTY_MASS_FRAME):
            context.note(body_rules.EMPTY_MASS_FRAME, frame, "<mass_frame> was empty; removed")
            remove(frame)


def diagonalise_inertia(context: Context) -> None:
    """Inertia as a full tensor becomes its principal values and a turned mass_frame."""
    for inertia in context.all("inertia"):
        values = numbers_of(inertia)
        if (
            len(values) not in (6, 9)
            or not are_usable(values)
            or not context.wants(body_rules.INERTIA)
        ):
            continue
        tensor, order = _tensor(values)
        before = " ".join((inertia.text or "").split())
        if np.count_nonzero(tensor - np.diag(np.diag(tensor))) == 0:
            principal, where = np.diag(tensor), ""
        else:
            principal, axes = _principal(tensor)
            turn = np.eye(4)
            turn[:3, :3] = axes
            _turn_mass_frame(context, inertia, turn)
            where = " in a turned mass_frame"
        inertia.text = " ".join(number_text(value) for value in principal)
        message = f"inertia was the tensor {before} ({order}), is now {inertia.text}{where}"
        context.note(body_rules.INERTIA, inertia, message)


def _tensor(values: list[float]) -> tuple[Matrix, str]:
    """The symmetric tensor that nine or six numbers mean, and how they were read."""
    if len(values) == 9:
        full = np.asarray(values).reshape(3, 3)
        return (full + full.T) / 2, "row by row"
    read = [(np.asarray(values)[list(order)].reshape(3, 3), name) for name, order in _ORDERS]
    # The first in which a body can have these moments; with none, what most programs write.
    return next((pair for pair in read if _possible(pair[0])), read[0])


def _possible(tensor: Matrix) -> bool:
    moments = np.linalg.eigvalsh(tensor)
    return bool(moments[0] > 0.0 and moments[2] <= (moments[0] + moments[1]) * (1 + 1e-9))


def _principal(tensor: Matrix) -> tuple[Matrix, Matrix]:
    """Principal moments and axes (columns), turned as little from x, y and z as can be."""
    moments, axes = np.linalg.eigh(tensor)
    order = max(permutations(range(3)), key=lambda p: float(np.abs(axes[(0, 1, 2), p]).sum()))
    moments, axes = moments[list(order)], axes[:, list(order)]
    axes = axes * np.where(np.diag(axes) < 0.0, -1.0, 1.0)
    if np.linalg.det(axes) < 0.0:
        axes = axes * (1.0, 1.0, -1.0)
    return moments, axes


def _turn_mass_frame(context: Context, inertia: etree._Element, turn: Matrix) -> None:
    common = inertia.getparent()
    assert common is not None
    frame = common.find(NS + "mass_frame")
    if frame is None:
        frame = context.make("mass_frame")
        context.unplaced.add(frame)
        insert(common, common.index(inertia), frame)
    for element in place_elements(context, turn):
        append(frame, element)


def place_mass_frames(context: Context) -> None:
    """A mass_frame that only turns is about the origin of the body, and says so.

    Those that conform made itself, for a tensor in a body without a frame, are about the point
    that such a body has: the centre of mass of its shapes (thesis 3.3).
    """
    frames = [
        frame
        for frame in context.all("mass_frame")
        if frame.find(NS + "translate") is None and frame.find(NS + "rotate") is not None
    ]
    made = [frame for frame in frames if frame in context.unplaced]
    centres = dict(zip(made, _centres(context, made), strict=True)) if made else {}
    for frame in frames:
        centre = centres.get(frame, np.eye(4))
        first = place_elements(context, translation(centre[:3, 3].tolist()), whole=True)[0]
        if frame in centres:
            insert(frame, 0, first)
            message = f"the mass_frame of the tensor is at the shapes' centre of mass, {first.text}"
            context.note(body_rules.INERTIA, frame, message)
        elif context.wants(body_rules.MASS_FRAME_ORIGIN):
            insert(frame, 0, first)
            message = "the mass_frame only turned; it is at the origin of its body"
            context.note(body_rules.MASS_FRAME_ORIGIN, frame, message)


def _centres(context: Context, frames: list[etree._Element]) -> list[Matrix]:
    """The centres of mass of the shapes beside frames, as the standard and the profile have it."""
    wanted = set(frames)
    places = [i for i, f in enumerate(context.root.iter(NS + "mass_frame")) if f in wanted]
    draft = Draft(copy.deepcopy(context.root))
    twins = list(draft.root.iter(NS + "mass_frame"))
    weights = Weights(draft, Geometries(draft))
    centres = []
    for place in places:
        common = twins[place].getparent()
        assert common is not None
        common.remove(twins[place])
        has_shapes = any(local(child) == "shape" for child in common)
        centres.append(weights.center_of_mass(common) if has_shapes else np.eye(4))
    return centres
