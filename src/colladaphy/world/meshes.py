"""Meshes: closed triangle surfaces, shared between bodies, and their exact mass properties."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from colladaphy.world.rules import MESH, refuse

__all__ = ["Mesh", "MeshSource", "complete_shells", "inertia_about", "make_meshes"]

Floats = NDArray[np.float64]
MeshSource = tuple[ArrayLike, ArrayLike, bool]
"""Vertices (n, 3), faces (m, 3), and whether the surface is its own convex hull."""


class Mesh:
    """A closed surface of triangles.

    `vertices` (n, 3) are as given, in any frame that the caller likes, `faces` (m, 3) are indices
    into them, counter-clockwise seen from outside. `convex` says that the surface is its own
    convex hull and may be treated so in collisions. The arrays are read-only: meshes are shared.
    The mass properties of a solid are those of the enclosed volume, by the divergence theorem; a
    surface that is wound inside out counts as wound the other way. Those of a hollow body are
    those of the surface, evenly covered.
    """

    __slots__ = ("_shell", "_squares", "center", "convex", "faces", "id", "vertices", "volume")

    vertices: Floats
    faces: NDArray[np.int64]
    convex: bool
    id: int
    volume: float
    """Enclosed volume."""
    _squares: Floats
    _shell: tuple[Floats, Floats] | None
    center: Floats
    """Centre of volume (3,), in the frame of `vertices`: where the position of a solid lies."""

    def __init__(
        self, vertices: ArrayLike, faces: ArrayLike, *, convex: bool = False, id: int = -1
    ) -> None:
        _fill([self], [(vertices, faces, convex)], [id])

    def center_of(self, hollow: bool) -> Floats:
        """Centre of mass (3,) in the frame of `vertices`: of the surface if it is hollow."""
        return self._shell_moments()[0] if hollow else self.center

    @property
    def body_vertices(self) -> Floats:
        """The vertices (n, 3) relative to the centre of volume: the frame of a solid body."""
        return self.body_vertices_of(False)

    def body_vertices_of(self, hollow: bool) -> Floats:
        """The vertices (n, 3) relative to the centre of mass of a hollow or a solid body."""
        return np.asarray(self.vertices - self.center_of(hollow))

    def mean_squares(self, hollow: bool) -> Floats:
        """Mean of x·xᵀ (3, 3) about the centre of mass, over the surface or the volume."""
        return self._shell_moments()[1] if hollow else self._squares

    def inertia(self, mass: float, hollow: bool = False) -> Floats:
        """Inertia (3, 3) about the centre of mass, for a solid or a hollow body of `mass`."""
        return np.asarray(inertia_about(self.mean_squares(hollow)[None], np.array([mass]))[0])

    def _shell_moments(self) -> tuple[Floats, Floats]:
        if self._shell is None:
            self._shell = _shells([self])[0]
        return self._shell

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


def make_meshes(sources: Sequence[MeshSource], ids: Sequence[int]) -> list[Mesh]:
    """Many meshes at once, each to the bit as if made alone; all or, on WorldError, none."""
    meshes = [Mesh.__new__(Mesh) for _ in sources]
    if meshes:
        _fill(meshes, sources, ids)
    return meshes


def complete_shells(meshes: Iterable[Mesh]) -> None:
    """Work out the mass properties of the surfaces of many meshes at once."""
    missing = [mesh for mesh in meshes if mesh._shell is None]
    for mesh, shell in zip(missing, _shells(missing), strict=True):
        mesh._shell = shell


def _shells(meshes: Sequence[Mesh]) -> list[tuple[Floats, Floats]]:
    if not meshes:
        return []
    starts = _starts([len(mesh.faces) for mesh in meshes])
    corners = np.concatenate([mesh.vertices[mesh.faces] for mesh in meshes])
    with np.errstate(all="ignore"):
        local, middle, scale, _ = _localised(corners, starts)
        _, center, squares = _spread(_areas(local), local, starts, 3.0, 12.0)
        centers = (middle + scale * center).T.copy()
        squares = squares * (scale * scale)[:, None, None]
    _freeze(centers, squares)
    return list(zip(centers, squares, strict=True))


def inertia_about(squares: Floats, masses: Floats) -> Floats:
    """Inertias (n, 3, 3) of `masses` (n,) whose mean of x·xᵀ is `squares` (n, 3, 3)."""
    trace = squares[:, 0, 0] + squares[:, 1, 1] + squares[:, 2, 2]
    return np.asarray(masses[:, None, None] * (trace[:, None, None] * np.eye(3) - squares))


def _fill(meshes: Sequence[Mesh], sources: Sequence[MeshSource], ids: Sequence[int]) -> None:
    """Check the surfaces and set all that is known of them."""
    points, faces = _arrays(sources)
    sizes, counts = [len(part) for part in points], [len(part) for part in faces]
    vertices, corners = np.concatenate(points), np.concatenate(faces)
    if not np.all(np.isfinite(vertices)):
        raise refuse(MESH, "Vertices are an (n, 3) array of finite numbers.")
    starts = _starts(counts)
    beyond = np.repeat(np.array(sizes), counts)[:, None]
    if corners.min() < 0 or np.any(corners >= beyond):
        row = int(np.flatnonzero(((corners < 0) | (corners >= beyond)).any(axis=1))[0])
        raise refuse(MESH, f"A face names a vertex that is not among the {int(beyond[row, 0])}.")
    first = np.repeat(_starts(sizes), counts)[:, None]
    volumes, centers, squares = _solids(vertices[corners + first], starts)
    _freeze(vertices, corners, centers, squares)
    vertex, face = 0, 0
    for row, (mesh, source) in enumerate(zip(meshes, sources, strict=True)):
        mesh.vertices = vertices[vertex : (vertex := vertex + sizes[row])]
        mesh.faces = corners[face : (face := face + counts[row])]
        mesh.convex, mesh.id = bool(source[2]), ids[row]
        mesh.volume, mesh.center, mesh._squares = volumes[row], centers[row], squares[row]
        mesh._shell = None


def _arrays(sources: Sequence[MeshSource]) -> tuple[list[Floats], list[NDArray[np.int64]]]:
    points, faces = [], []
    for given in sources:
        try:
            vertices, corners = np.asarray(given[0]), np.asarray(given[1])
        except (TypeError, ValueError, IndexError, OverflowError) as error:
            raise refuse(MESH, "Vertices and faces are arrays of numbers.") from error
        if vertices.ndim != 2 or vertices.shape[1] != 3 or vertices.dtype.kind not in "fiu":
            raise refuse(MESH, "Vertices are an (n, 3) array of finite numbers.")
        if corners.ndim != 2 or corners.shape[1] != 3 or not len(corners) or (
            corners.dtype.kind not in "iu"
        ):  # fmt: skip
            raise refuse(MESH, "Faces are an (m, 3) array of indices with at least one row.")
        points.append(vertices.astype(np.float64, copy=False))
        faces.append(corners.astype(np.int64, copy=False))
    return points, faces


def _solids(corners: Floats, starts: NDArray[np.int64]) -> tuple[list[float], Floats, Floats]:
    """Volumes, centres (n, 3) and mean squares (n, 3, 3) within closed surfaces."""
    with np.errstate(all="ignore"):
        local, middle, scale, owner = _localised(corners, starts)
        if not np.all(np.isfinite(scale) & (scale > 0)):
            raise refuse(MESH, "The mesh has no volume.")
        one, two, three = local
        six = _dot(one, _cross(two, three))
        volume = np.add.reduceat(six, starts) / 6.0
        area = np.add.reduceat(_areas(local), starts)
        # Rounding alone gives a flat surface some volume.
        if not np.all((np.abs(volume) > 1e-12 * area) & np.isfinite(volume)):
            raise refuse(MESH, "The mesh has no volume.")
        six = np.where(volume < 0, -1.0, 1.0)[owner] * six
        total, center, squares = _spread(six, local, starts, 4.0, 20.0)
        sizes = total / 6.0 * scale**3
        if not np.all(np.isfinite(sizes) & (sizes > 0)):
            raise refuse(MESH, "The volume of the mesh is out of the range of numbers.")
        centers = (middle + scale * center).T.copy()
        return sizes.tolist(), centers, squares * (scale * scale)[:, None, None]


def _localised(
    corners: Floats, starts: NDArray[np.int64]
) -> tuple[Floats, Floats, Floats, NDArray[np.int64]]:
    """Corners (3, 3, m) by corner and axis about the middle of each surface, at size one.

    Near the middle of a surface its signed tetrahedra cancel least. Also the middles (3, n), the
    sizes (n,) and the surface that each triangle belongs to (m,).
    """
    points = np.ascontiguousarray(corners.transpose(1, 2, 0))
    low = np.minimum.reduceat(points.min(axis=0), starts, axis=1)
    high = np.maximum.reduceat(points.max(axis=0), starts, axis=1)
    middle, scale = 0.5 * low + 0.5 * high, (high - low).max(axis=0)
    counts = np.diff(starts, append=len(corners))
    owner = np.repeat(np.arange(len(starts)), counts)
    return (points - middle[:, owner]) / scale[owner], middle, scale, owner


def _spread(
    weights: Floats, local: Floats, starts: NDArray[np.int64], first: float, second: float
) -> tuple[Floats, Floats, Floats]:
    """Sums of weights (n,), and of what they weigh the centres (3, n) and mean squares (n, 3, 3).

    The weights (m,) are those of triangles, or of their tetrahedra to the origin: for these,
    ∫ x = weight/`first` · Σ v, and ∫ x·xᵀ = weight/`second` · (Σ v·vᵀ + (Σ v)(Σ v)ᵀ), Σ over the
    corners. Each sum runs over the triangles of one surface, whatever lies beside them.
    """
    one, two, three = local
    corner = one + two + three
    total = np.add.reduceat(weights, starts)
    center = np.empty((3, len(starts)))
    squares = np.empty((len(starts), 3, 3))
    for i in range(3):
        center[i] = np.add.reduceat(weights * corner[i], starts) / (first * total)
    for i in range(3):
        for j in range(i + 1):
            products = one[i] * one[j] + two[i] * two[j] + three[i] * three[j]
            products = weights * (products + corner[i] * corner[j])
            mean = np.add.reduceat(products, starts) / (second * total)
            squares[:, i, j] = squares[:, j, i] = mean - center[i] * center[j]
    return total, center, squares


def _cross(a: Floats, b: Floats) -> tuple[Floats, Floats, Floats]:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def _dot(a: Any, b: Any) -> Floats:
    return np.asarray(a[0] * b[0] + a[1] * b[1] + a[2] * b[2])


def _areas(local: Floats) -> Floats:
    one, two, three = local
    across = _cross(two - one, three - one)
    return np.asarray(0.5 * np.sqrt(_dot(across, across)))


def _starts(counts: list[int]) -> NDArray[np.int64]:
    return np.cumsum([0, *counts[:-1]], dtype=np.int64)


def _freeze(*arrays: NDArray[Any]) -> None:
    for array in arrays:
        array.flags.writeable = False
