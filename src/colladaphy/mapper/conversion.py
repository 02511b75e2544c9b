"""Changing the unit of length and the up axis of what was loaded.

Masses stay kilograms and times seconds; a length of one document's unit is so many of the World's.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.errors import DocumentError
from colladaphy.links.resource import Resource
from colladaphy.mapper import rules
from colladaphy.world import Mesh, World, rotations
from colladaphy.world.kinds import Kind

Quaternion = tuple[float, float, float, float]

__all__ = ["Conversion", "conversion", "convert"]

Array = NDArray[Any]

_HALF = math.sqrt(0.5)
# Rotations that keep what the axes mean (right, up, in: §up_axis has -y, x, z for X_UP).
_TO_Z_UP: dict[str, Quaternion] = {
    "X_UP": (0.5, 0.5, -0.5, 0.5),
    "Y_UP": (_HALF, _HALF, 0.0, 0.0),
    "Z_UP": (1.0, 0.0, 0.0, 0.0),
}


@dataclass(frozen=True, slots=True)
class Conversion:
    """What to change: the factor for lengths, the turn of all axes, and what holds after."""

    scale: float
    turn: Quaternion
    unit: tuple[str, float]
    up_axis: str


def conversion(
    resource: Resource, world: World | None, *, si: bool, up_axis: str | None
) -> Conversion | None:
    """What has to be changed; None where nothing has."""
    name, meter = resource.unit
    target = (name, meter)
    axis = up_axis or resource.up_axis
    if world is not None:
        target, axis = (world.unit_name, world.unit_meter), world.up_axis
    elif si:
        target = ("meter", 1.0)
    if target[1] == meter and axis == resource.up_axis:
        return None
    for known in (axis, resource.up_axis):
        if known not in _TO_Z_UP:
            raise ValueError(f"an up axis is X_UP, Y_UP or Z_UP, not {known!r}")
    back = rotations.conjugate(_TO_Z_UP[axis])
    w, x, y, z = rotations.multiply(back, _TO_Z_UP[resource.up_axis]).tolist()
    turn = (w, x, y, z) if axis != resource.up_axis else (1.0, 0.0, 0.0, 0.0)
    return Conversion(meter / target[1], turn, target, axis)


def convert(world: World, change: Conversion) -> None:
    """Change everything in a World; DocumentError where numbers get too large for that."""
    try:
        with np.errstate(all="ignore", over="raise"):
            _convert(world, change)
    except ArithmeticError as error:
        message = f"The conversion from one unit of length to another fails: {error}."
        raise DocumentError(rules.CONVERSION.at(message=message)) from error


def _convert(world: World, change: Conversion) -> None:
    scale, turn = change.scale, np.array(change.turn)
    turns = change.turn != (1.0, 0.0, 0.0, 0.0)
    world.unit_name, world.unit_meter = change.unit
    world.up_axis = change.up_axis
    world.gravity = _turned(turn, world.gravity * scale, turns)
    top, inner = world.top, world.inner
    for name in ("positions", "linear_velocities", "forces", "angular_velocities", "torques"):
        column = top.column(name)
        factor = {"angular_velocities": 1.0, "torques": scale * scale}.get(name, scale)
        column[...] = _turned(turn, column * factor, turns)
    if turns:
        top.column("orientations")[...] = rotations.multiply(turn, top.column("orientations"))
    inner.column("positions")[...] *= scale
    for table in (top, inner):
        table.column("inertias")[...] *= scale * scale
        dimensions, kinds = table.column("dimensions"), table.column("kinds")
        planes = kinds == Kind.PLANE
        dimensions[~planes] *= scale
        dimensions[planes, 3] *= scale
        dimensions[planes, :3] = _turned(turn, dimensions[planes, :3], turns)
    joints = world.joint_table
    joints.column("positions")[...] *= scale
    joints.column("linear_limits")[...] *= scale
    joints.column("linear_springs")[:, 2] *= scale
    joints.column("angular_springs")[:, :2] *= scale * scale
    # A slider's speed is a length, and its force has one in it; a hinge's torque has two.
    slides = joints.column("angular_limits")[:, 0] == joints.column("angular_limits")[:, 1]
    slides = slides.all(axis=1)
    motors = joints.column("motors")
    motors[:, 0] *= np.where(slides, scale, 1.0)
    motors[:, 1] *= np.where(slides, scale, scale * scale)
    bodies = joints.column("bodies")
    for side in (0, 1):
        free = bodies[:, side] == 0  # frames of the world turn with the world
        joints.column("positions")[free, side] = _turned(
            turn, joints.column("positions")[free, side], turns
        )
        if turns:
            joints.column("orientations")[free, side] = rotations.multiply(
                turn, joints.column("orientations")[free, side]
            )
    if scale != 1.0:
        for id, mesh in list(world.meshes.items()):
            world.meshes[id] = Mesh(
                mesh.vertices * scale, mesh.faces, convex=mesh.convex, id=mesh.id
            )
        _scale_materials(world, scale)


def _turned(turn: Array, vectors: Array, turns: bool) -> Array:
    """Vectors (…, 3) turned: up axes change places, so that every digit of them stays."""
    if not turns:
        return vectors
    axes = np.rint(rotations.to_matrix(turn))
    return np.asarray(vectors[..., np.abs(axes).argmax(axis=1)] * axes.sum(axis=1) + 0.0)


def _scale_materials(world: World, scale: float) -> None:
    """Densities per new unit of volume, Young's moduli per new unit of area.

    Stiffness (force/length) and dampings (mass/time) have no length in them, and pe's own five
    materials follow the World's unit by themselves; their moduli are pe's numbers.
    """
    materials = world.materials
    custom = materials.ids[materials.ids >= materials.DEFAULT_COUNT]
    for name, power in (("density", 3), ("young_modulus", 1)):
        materials.change(name, custom, materials.values(name, custom) / scale**power)
