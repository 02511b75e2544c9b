"""The shapes of bodies as MuJoCo's geoms."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import mujoco
import numpy as np
from numpy.typing import NDArray

from colladaphy.engines.frames import ORIGIN, Pose
from colladaphy.world import Kind, rotations

if TYPE_CHECKING:
    from colladaphy.world import World

__all__ = ["Shape", "Shapes", "is_round", "shapes_of"]

Floats = NDArray[np.float64]
Row = NDArray[Any]

_SEGMENTS: Final = 32
_TURN_TO_X: Final = rotations.from_axis_angle((0.0, 1.0, 0.0), np.pi / 2)  # z onto x


@dataclass(frozen=True, slots=True)
class Shape:
    """One primitive or mesh of a top-level body."""

    kind: Kind
    pose: Pose
    """In the frame of the top-level body."""
    dimensions: Row
    material: int
    mesh: int
    hollow: bool


def shapes_of(world: World, sid: int) -> Iterator[Shape]:
    """The shapes of a body, through nested unions, in their order."""
    yield from _shapes(world, sid, ORIGIN, top=True)


def _shapes(world: World, sid: int, pose: Pose, *, top: bool) -> Iterator[Shape]:
    table, row = world.locate(sid)
    if not top:
        pose = pose @ Pose.of(table.raw("positions")[row], table.raw("orientations")[row])
    kind = Kind(int(table.raw("kinds")[row]))
    if kind is Kind.UNION:
        for member in world.children[sid]:
            yield from _shapes(world, member, pose, top=False)
        return
    if kind is Kind.EMPTY:
        return
    yield Shape(
        kind,
        pose,
        np.array(table.raw("dimensions")[row]),
        int(table.raw("material_ids")[row]),
        int(table.raw("mesh_ids")[row]),
        bool(table.raw("hollow")[row]),
    )


def is_round(shape: Shape) -> bool:
    """True unless it is a capsule or cylinder with an elliptic section, which MuJoCo lacks."""
    x, y, z, _ = shape.dimensions.tolist()
    if shape.kind is Kind.CAPSULE:
        return bool(x == y == z)
    return shape.kind is not Kind.CYLINDER or bool(y == z)


class Shapes:
    """Adds shapes to a MuJoCo specification, meshes only once."""

    def __init__(self, spec: Any, world: World) -> None:
        self._spec = spec
        self._world = world
        self._meshes: set[str] = set()

    def add(self, body: Any, shape: Shape, pose: Pose) -> Any:
        """A geom of `shape` at `pose` in a body of the specification."""
        geom = body.add_geom()
        geom.mass = 0.0
        orientation = pose.orientation
        x, y, z, length = shape.dimensions.tolist()
        types = mujoco.mjtGeom
        if shape.kind is Kind.SPHERE:
            geom.type, geom.size = types.mjGEOM_SPHERE, [x, 0.0, 0.0]
        elif shape.kind is Kind.BOX:
            geom.type, geom.size = types.mjGEOM_BOX, [x / 2, y / 2, z / 2]
        elif shape.kind is Kind.ELLIPSOID:
            geom.type, geom.size = types.mjGEOM_ELLIPSOID, [x, y, z]
        elif shape.kind is Kind.PLANE:
            geom.type, geom.size = types.mjGEOM_PLANE, [0.0, 0.0, 1.0]
        elif shape.kind is Kind.MESH:
            mesh = self._world.meshes[shape.mesh]
            key = f"hollow mesh{shape.mesh}" if shape.hollow else f"mesh{shape.mesh}"
            self._use(geom, key, mesh.body_vertices_of(shape.hollow), mesh.faces)
        elif not is_round(shape):
            points = _rod(shape)
            self._use(geom, f"rod {shape.kind.name} {shape.dimensions.tolist()}", points, None)
        else:
            capsule = shape.kind is Kind.CAPSULE
            geom.type = types.mjGEOM_CAPSULE if capsule else types.mjGEOM_CYLINDER
            geom.size = [y, length / 2, 0.0]
            orientation = rotations.multiply(orientation, _TURN_TO_X)
        geom.pos = pose.position
        geom.quat = orientation
        return geom

    def _use(self, geom: Any, name: str, points: Floats, faces: NDArray[np.int64] | None) -> None:
        if name not in self._meshes:
            self._meshes.add(name)
            mesh = self._spec.add_mesh()
            mesh.name = name
            mesh.uservert = points.ravel()
            if faces is not None:
                mesh.userface = faces.astype(np.int32).ravel()
            mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_CONVEX
        geom.type = mujoco.mjtGeom.mjGEOM_MESH
        geom.meshname = name


def _rod(shape: Shape) -> Floats:
    """Points (n, 3) on an elliptic capsule or cylinder along x."""
    x, y, z, length = shape.dimensions.tolist()
    around = np.linspace(0.0, 2 * np.pi, _SEGMENTS, endpoint=False)
    capsule = shape.kind is Kind.CAPSULE
    up = np.linspace(0.0, np.pi / 2, _SEGMENTS // 4 + 1) if capsule else np.zeros(1)
    circle = np.stack([np.zeros_like(around), y * np.cos(around), z * np.sin(around)], axis=-1)
    cap = np.cos(up)[:, None, None] * circle
    cap[..., 0] += length / 2 + (x * np.sin(up)[:, None] if capsule else 0.0)
    cap = cap.reshape(-1, 3)
    return np.concatenate([cap, cap * np.array([-1.0, 1.0, 1.0])])
