"""What rigid_bodies and their instances say of the whole body (thesis 3.3, 5.3)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.links.poses import DEGREE, Poses
from colladaphy.links.steps import poses_of
from colladaphy.mapper.loading.shapes import MaterialRefs, ShapeColumns, material_refs, read_shapes

__all__ = ["BodyValues", "InstanceColumns", "overridden", "read_bodies", "read_instances"]

Array = NDArray[Any]


@dataclass(slots=True)
class BodyValues:
    """Values of whole bodies, one a row; what is not said is masked out."""

    dynamic: Array
    has_dynamic: Array
    mass: Array
    has_mass: Array
    frames: Poses
    """Mass frames in the rigid_body."""
    has_frame: Array
    inertia: Array
    """(n, 3) principal moments."""
    has_inertia: Array
    material: MaterialRefs


@dataclass(slots=True)
class BodyColumns:
    """The rigid_bodies of a document."""

    values: BodyValues
    shapes: ShapeColumns


@dataclass(slots=True)
class InstanceColumns:
    """The instances of rigid_bodies in a document."""

    values: BodyValues
    shapes: ShapeColumns
    linear: Array
    angular: Array
    """(n, 3) in radians."""


def read_bodies(bodies: Any, home: int, start: int) -> BodyColumns:
    """The rigid_bodies of a document."""
    common = bodies.technique_common
    return BodyColumns(_values(bodies, common), _shapes(common, start))


def read_instances(instances: Any, home: int, start: int) -> InstanceColumns:
    """The instances of rigid_bodies in a document."""
    common = instances.technique_common
    return InstanceColumns(
        _values(instances, common),
        _shapes(common, start),
        _vectors(common, common.velocity),
        _vectors(common, common.angular_velocity) * DEGREE,
    )


def _vectors(common: Any, column: Any) -> Array:
    values = np.where(column.present[:, None], column.values, 0.0)
    return np.asarray(common.per_owner(values, 0.0))


def _shapes(common: Any, start: int) -> ShapeColumns:
    shapes = common.shape
    return read_shapes(shapes, common.owner[shapes.owner] + start)


def _values(elements: Any, common: Any) -> BodyValues:
    count = len(elements)
    frame = common.mass_frame
    frames = Poses.none(count)
    has_frame = np.zeros(count, np.bool_)
    if len(frame):
        rows = common.owner[frame.owner]
        frames.put(rows, poses_of(frame))
        has_frame[rows] = True
    dynamic, has_dynamic = _spread(common, common.dynamic, True, ())
    mass, has_mass = _spread(common, common.mass, np.nan, ())
    inertia, has_inertia = _spread(common, common.inertia, np.nan, (3,))
    refs = material_refs(common)
    if not common.is_whole:
        refs = _spread_refs(common, refs, count)
    return BodyValues(dynamic, has_dynamic, mass, has_mass, frames, has_frame, inertia,
                      has_inertia, refs)  # fmt: skip


def _spread(common: Any, child: Any, default: Any, shape: tuple[int, ...]) -> tuple[Array, Array]:
    """A value of the whole body for each element, and where it is given."""
    count = common.owners
    values = np.full((count, *shape), default)
    present = np.zeros(count, np.bool_)
    if len(child):
        rows = common.owner[child.owner]
        values[rows] = child.value
        present[rows] = True
    return values, present


def _spread_refs(common: Any, refs: MaterialRefs, count: int) -> MaterialRefs:
    ordinals = np.full(count, -1, np.int64)
    inline = np.zeros(count, np.bool_)
    ordinals[common.owner] = refs.ordinals
    inline[common.owner] = refs.inline
    return MaterialRefs(ordinals, inline, common.texts_per_owner(refs.urls, ""))


def overridden(bodies: BodyValues, instances: BodyValues) -> BodyValues:
    """Instance data beats rigid_body data (thesis 3.3). All of the same n rows.

    Materials are left out: they stand in different documents.
    """
    frames = bodies.frames
    if instances.has_frame.any():
        frames = bodies.frames.take(np.arange(len(bodies.mass)))
        frames.put(instances.has_frame, instances.frames.take(instances.has_frame))
    return BodyValues(
        np.where(instances.has_dynamic, instances.dynamic, bodies.dynamic),
        bodies.has_dynamic | instances.has_dynamic,
        np.where(instances.has_mass, instances.mass, bodies.mass),
        bodies.has_mass | instances.has_mass,
        frames,
        bodies.has_frame | instances.has_frame,
        np.where(instances.has_inertia[:, None], instances.inertia, bodies.inertia),
        bodies.has_inertia | instances.has_inertia,
        bodies.material,
    )
