"""Transforms, cameras and lights (COLLADA 1.5 §lookat … §translate, §camera, §light)."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.meaning import scene_rules
from colladaphy.meaning.context import Context, FloatRows
from colladaphy.meaning.hits import Hit
from colladaphy.meaning.radians import written_as_radians
from colladaphy_schema.scene_columns import (
    LightTypeTechniqueCommonPointRows,
    LightTypeTechniqueCommonSpotRows,
)

__all__ = ["CHECKS", "degenerate_matrices"]

Array = NDArray[Any]


_TRANSFORMS = ("lookat", "matrix", "rotate", "scale", "skew", "translate", "bind_shape_matrix")


def numbers(context: Context) -> Iterator[Hit]:
    """Transforms that are not finite."""
    for name in _TRANSFORMS:
        rows = context.rows(FloatRows, name)
        values = rows.value.values
        if not len(rows) or bool(np.isfinite(values).all()):
            continue
        assert rows.ordinals is not None
        for row, element in enumerate(rows.ordinals.tolist()):
            if not np.isfinite(rows.value[row]).all():
                yield Hit(
                    scene_rules.TRANSFORM_NUMBER,
                    element,
                    f"A <{name}> has a number that is not finite.",
                )


def _table(context: Context, name: str, width: int) -> tuple[Array, Array]:
    """The finite values (n, width) of elements of a name, and the elements."""
    rows = context.rows(FloatRows, name)
    assert rows.ordinals is not None
    values = rows.value.values.reshape(-1, width)
    good = np.isfinite(values).all(axis=1)
    return values[good], rows.ordinals[good]


def rotations(context: Context) -> Iterator[Hit]:
    """Rotations about nothing."""
    values, elements = _table(context, "rotate", 4)
    still = ~values[:, :3].any(axis=1) & (values[:, 3] != 0.0)
    for element, angle in zip(elements[still].tolist(), values[still, 3].tolist(), strict=True):
        yield Hit(
            scene_rules.ROTATE_AXIS, element, f"A rotation by {angle} degrees has the axis 0 0 0."
        )


def radians(context: Context) -> Iterator[Hit]:
    """Angles that are known parts of a circle in radians."""
    values, elements = _table(context, "rotate", 4)
    angles = [(values[:, 3], elements)]
    for name in ("xfov", "yfov", "falloff_angle"):
        each, places = _table(context, name, 1)
        angles.append((each[:, 0], places))
    for column, places in angles:
        for row in np.flatnonzero(written_as_radians(column)).tolist():
            turned = math.degrees(column[row])
            message = f"The angle is {column[row]:g} degrees; as radians, it would be {turned:.4g}."
            yield Hit(scene_rules.RADIANS, int(places[row]), message)


def scales(context: Context) -> Iterator[Hit]:
    """Scales by zero."""
    values, elements = _table(context, "scale", 3)
    flat = ~values.all(axis=1)
    for element, value in zip(elements[flat].tolist(), values[flat].tolist(), strict=True):
        yield Hit(
            scene_rules.SCALE_ZERO,
            element,
            f"A scale by {' '.join(f'{each:g}' for each in value)} is flat.",
        )


def degenerate_matrices(matrices: Array) -> tuple[Array, Array]:
    """Which matrices (n, 4, 4) have another last row than 0 0 0 1, and which others are flat."""
    wrong = np.any(np.abs(matrices[:, 3] - (0.0, 0.0, 0.0, 1.0)) > 1e-6, axis=1)
    inner = matrices[:, :3, :3]
    with np.errstate(all="ignore"):
        lengths = np.prod(np.linalg.norm(inner, axis=1), axis=1)
        flat = ~wrong & ~(np.abs(np.linalg.det(inner)) > 1e-12 * lengths)
    return wrong, flat


def matrices(context: Context) -> Iterator[Hit]:
    """Matrices that are transposed, or flat."""
    for name in ("matrix", "bind_shape_matrix"):
        values, elements = _table(context, name, 16)
        if not len(values):
            continue
        wrong, flat = degenerate_matrices(values.reshape(-1, 4, 4))
        for row in np.flatnonzero(wrong).tolist():
            last = " ".join(f"{value:g}" for value in values[row, 12:])
            message = f"The last row of the matrix is {last}."
            if values[row, 15] == 1.0 and not values[row, [3, 7, 11]].any():
                message += " It is written column by column, as it seems."
            yield Hit(scene_rules.MATRIX_COLUMNS, int(elements[row]), message)
        for element in elements[flat].tolist():
            yield Hit(
                scene_rules.SCALE_ZERO,
                element,
                "The matrix makes everything flat: its determinant is zero.",
            )


def lookats(context: Context) -> Iterator[Hit]:
    """Lookats along nothing."""
    values, elements = _table(context, "lookat", 9)
    for value, element in zip(values, elements.tolist(), strict=True):
        eye, interest, up = value[:3], value[3:6], value[6:]
        way = interest - eye
        if not way.any():
            yield Hit(scene_rules.LOOKAT, element, "The eye is where the point of interest is.")
        elif not up.any():
            yield Hit(scene_rules.LOOKAT, element, "The direction up is 0 0 0.")
        elif _parallel(way, up):
            yield Hit(scene_rules.LOOKAT, element, "The direction up is the direction of the view.")


def skews(context: Context) -> Iterator[Hit]:
    """Skews along nothing."""
    values, elements = _table(context, "skew", 7)
    for value, element in zip(values, elements.tolist(), strict=True):
        angle, turned, along = value[0], value[1:4], value[4:]
        if not turned.any() or not along.any():
            yield Hit(scene_rules.SKEW, element, "An axis of the skew is 0 0 0.")
        elif angle and _parallel(turned, along):
            yield Hit(scene_rules.SKEW, element, "The axes of the skew are parallel.")
        elif abs(angle) >= 90.0:
            yield Hit(scene_rules.SKEW, element, f"The angle of the skew is {angle:g} degrees.")


def _parallel(one: Array, other: Array) -> bool:
    size = float(np.linalg.norm(one) * np.linalg.norm(other))
    return float(np.linalg.norm(np.cross(one, other))) <= 1e-9 * size


def cameras(context: Context) -> Iterator[Hit]:
    """Cameras that see nothing."""
    for kind in ("perspective", "orthographic"):
        cameras = context.rows(FloatRows, kind)
        if not len(cameras):
            continue
        values: dict[str, dict[int, tuple[int, float]]] = {}
        for name in ("znear", "zfar", "xfov", "yfov", "xmag", "ymag", "aspect_ratio"):
            found = context.children(cameras, name, FloatRows)
            assert found.ordinals is not None
            each = zip(found.ordinals.tolist(), found.value.values.tolist(), strict=True)
            values[name] = dict(zip(found.owner.tolist(), each, strict=True))
        for row in range(len(cameras)):
            near, far = values["znear"].get(row), values["zfar"].get(row)
            if near is not None and far is not None:
                if kind == "perspective" and not near[1] > 0.0:
                    yield Hit(
                        scene_rules.CAMERA_CLIP,
                        near[0],
                        f"The near plane of a perspective is at {near[1]:g}.",
                    )
                elif not near[1] < far[1]:
                    message = f"The near plane is at {near[1]:g}, the far plane at {far[1]:g}."
                    at, other = (far, near) if math.isnan(far[1]) else (near, far)
                    yield Hit(scene_rules.CAMERA_CLIP, at[0], message, (other[0],))
            for name, known in values.items():
                if row not in known or name in ("znear", "zfar"):
                    continue
                element, value = known[row]
                most = 180.0 if name.endswith("fov") else math.inf
                if not 0.0 < value < most:
                    yield Hit(scene_rules.CAMERA_VIEW, element, f"The {name} is {value:g}.")


def viewpoints(context: Context) -> Iterator[Hit]:
    """Renderings from nodes that have no camera, nor instances that may have one."""
    references = context.references("camera_node", "render")
    if not references:
        return
    seeing: set[int] = set()
    for element in context.ordinals("instance_camera", "instance_node").tolist():
        node = int(context.parent[element])
        while node >= 0 and node not in seeing:
            seeing.add(node)
            node = int(context.parent[node])
    for reference in references:
        node = context.target(reference.text.strip())
        if node >= 0 and context.name(node) == "node" and node not in seeing:
            message = f"{context.label(node)} has no camera."
            yield Hit(scene_rules.CAMERA_NODE, reference.element, message, (node,), "camera_node")


def lights(context: Context) -> Iterator[Hit]:
    """Lights with values out of range."""
    spots = context.rows(LightTypeTechniqueCommonSpotRows, "spot")
    for lights in (context.rows(LightTypeTechniqueCommonPointRows, "point"), spots):
        factors = np.tile([1.0, 0.0, 0.0], (len(lights), 1))
        for place, name in enumerate(("constant", "linear", "quadratic")):
            found = getattr(lights, f"{name}_attenuation")
            factors[found.owner, place] = found.value
            for element, value in zip(found.ordinals.tolist(), found.value.tolist(), strict=True):
                if not value >= 0.0:
                    yield Hit(scene_rules.LIGHT, element, f"The {name} attenuation is {value:g}.")
        assert lights.ordinals is not None
        for element in lights.ordinals[~factors.any(axis=1)].tolist():
            yield Hit(
                scene_rules.LIGHT,
                element,
                "All attenuations are zero, so that it is infinitely bright.",
            )
    angles = spots.falloff_angle
    assert angles.ordinals is not None
    for element, value in zip(angles.ordinals.tolist(), angles.value.tolist(), strict=True):
        if not 0.0 < value <= 180.0:
            yield Hit(scene_rules.LIGHT, element, f"The falloff angle is {value:g} degrees.")
    exponents = spots.falloff_exponent
    assert exponents.ordinals is not None
    for element, value in zip(exponents.ordinals.tolist(), exponents.value.tolist(), strict=True):
        if not value >= 0.0:
            yield Hit(scene_rules.LIGHT, element, f"The falloff exponent is {value:g}.")


CHECKS = (
    numbers,
    rotations,
    radians,
    viewpoints,
    scales,
    matrices,
    lookats,
    skews,
    cameras,
    lights,
)
