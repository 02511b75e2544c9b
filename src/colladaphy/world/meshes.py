"""Meshes: closed triangle surfaces, shared between bodies, and their exact mass properties."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from colladaphy.world.rules import MESH, refuse

__all__ = ["Mesh"]

Floats = NDArray[np.float64]


class Mesh:
    """A closed surface of triangles.

    `vertices` (n, 3) are as given, in any frame that the caller likes, `faces` (m, 3) are indices
    into them, counter-clockwise seen from outside. `convex` says that the surface is its own
    convex hull and may be treated so in collisions. The arrays are read-only: meshes are shared.
    The mass properties are those of the enclosed volume at density one, by the divergence
    theorem; a surface that is wound inside out counts as wound the other way.
    """

    __slots__ = ("center", "convex", "faces", "id", "second_moments", "vertices", "volume")

    def __init__(
        self, vertices: ArrayLike, faces: ArrayLike, *, convex: bool = False, id: int = -1
    ) -> None:
        points = np.array(vertices, dtype=np.float64)
        corners = np.array(faces, dtype=np.int64)
        _check(points, corners)
        points.flags.writeable = False
        corners.flags.writeable = False
        self.vertices: Floats = points
        self.faces: NDArray[np.int64] = corners
        self.convex = bool(convex)
        self.id = id
        volume, center, second = _moments(points[corners])
        self.volume: float = volume
        self.center: Floats = center
        """Centre of volume, in the frame of `vertices`: it lies at the body's position."""
        self.second_moments: Floats = second
        """∫ x·xᵀ dV about the centre, (3, 3)."""

    @property
    def body_vertices(self) -> Floats:
        """The vertices relative to the centre of mass: the body's own frame. (n, 3)."""
        return np.asarray(self.vertices - self.center)

    def inertia(self, mass: float) -> Floats:
        """Inertia (3, 3) about the centre of mass for a solid of `mass`."""
        return _inertia(self.second_moments * (mass / self.volume))

    def hollow_inertia(self, mass: float) -> Floats:
        """Inertia (3, 3) about the centre of volume with the mass spread over the surface."""
        corners = self.body_vertices[self.faces]
        edges = corners[:, 1:] - corners[:, :1]
        areas = 0.5 * np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1)
        total = corners.sum(axis=1)
        # ∫ x·xᵀ over a triangle = area/12 · (Σ v·vᵀ + (Σ v)(Σ v)ᵀ).
        second = np.einsum("f,fki,fkj->ij", areas, corners, corners)
        second += np.einsum("f,fi,fj->ij", areas, total, total)
        return _inertia(second / 12.0 * (mass / float(areas.sum())))

    def same_as(self, other: Mesh) -> bool:
        """True if both hold the same vertices, bit by bit, the same faces and the same flag."""
        return (
            self.convex == other.convex
            and self.vertices.tobytes() == other.vertices.tobytes()
            and self.vertices.shape == other.vertices.shape
            and np.array_equal(self.faces, other.faces)
        )

    def __repr__(self) -> str:
        what = "convex mesh" if self.convex else "mesh"
        return f"<{what} of {len(self.vertices)} vertices, {len(self.faces)} faces>"


def _inertia(second: NDArray[Any]) -> Floats:
    return np.asarray(np.trace(second) * np.eye(3) - second)


def _check(points: Floats, corners: NDArray[np.int64]) -> None:
    if points.ndim != 2 or points.shape[1:] != (3,) or not np.all(np.isfinite(points)):
        raise refuse(MESH, "Vertices are an (n, 3) array of finite numbers.")
    if corners.ndim != 2 or corners.shape[1:] != (3,) or not len(corners):
        raise refuse(MESH, "Faces are an (m, 3) array of indices with at least one row.")
    if corners.min() < 0 or corners.max() >= len(points):
        raise refuse(MESH, f"A face names a vertex that is not among the {len(points)}.")


def _moments(corners: Floats) -> tuple[float, Floats, Floats]:
    """Volume, centre and second moments about the centre of the closed surface `corners`."""
    # Near the middle of the surface the signed tetrahedra cancel least.
    low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    middle = 0.5 * low + 0.5 * high
    scale = float(np.max(high - low))
    if not (np.isfinite(scale) and scale > 0):
        raise refuse(MESH, "The mesh has no volume.")
    local = (corners - middle) / scale
    six = np.einsum("fi,fi->f", local[:, 0], np.cross(local[:, 1], local[:, 2]))
    volume = float(six.sum()) / 6.0
    area = 0.5 * float(
        np.linalg.norm(np.cross(local[:, 1] - local[:, 0], local[:, 2] - local[:, 0]), axis=1).sum()
    )
    # Rounding alone gives a flat surface some volume.
    if abs(volume) <= 1e-12 * area or not np.isfinite(volume):
        raise refuse(MESH, "The mesh has no volume.")
    if volume < 0:
        six, volume = -six, -volume
    total = local.sum(axis=1)
    center = np.einsum("f,fi->i", six, total) / (24.0 * volume)
    second = np.einsum("f,fki,fkj->ij", six, local, local)
    second += np.einsum("f,fi,fj->ij", six, total, total)
    second = second / 120.0 - volume * np.outer(center, center)
    size = volume * scale**3
    if not (np.isfinite(size) and size > 0):
        raise refuse(MESH, "The volume of the mesh is out of the range of numbers.")
    return size, middle + scale * center, second * scale**5
