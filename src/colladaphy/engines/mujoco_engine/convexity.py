"""Whether a mesh is convex, in a time that grows with its size alone."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from colladaphy.world import Mesh

__all__ = ["is_convex"]

Floats = NDArray[np.float64]

_SLACK: Final = 1e-6  # of a mesh's size, by which a convex one may be dented
_WHOLE: Final = 20_000_000  # vertices times faces up to which each is held against each
_SAMPLE: Final = 256


def is_convex(mesh: Mesh) -> bool:
    """True if no vertex lies outside the plane of a face.

    In large meshes each face is held against its neighbours, and a sample of faces against all
    vertices: a closed surface that bends outward at every edge is convex, unless it goes round
    several times, which the sample sees.
    """
    points, faces = mesh.body_vertices, mesh.faces
    size = float(np.abs(points).max())
    corners = points[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    good = lengths > 1e-12 * size * size
    faces, corners = faces[good], corners[good]
    normals = normals[good] / lengths[good, None]
    anchors = np.einsum("fi,fi->f", normals, corners[:, 0])
    if float(np.median(anchors)) < 0:  # wound inside out
        normals, anchors = -normals, -anchors
    planes = np.arange(len(faces))
    if len(points) * len(faces) > _WHOLE:
        if not _bends_outward(points, faces, normals, anchors, _SLACK * size):
            return False
        planes = planes[:: max(1, len(planes) // _SAMPLE)]
    for start in range(0, len(planes), _SAMPLE):
        some = planes[start : start + _SAMPLE]
        heights = points @ normals[some].T - anchors[some]
        if np.any(heights > _SLACK * size):
            return False
    return True


def _bends_outward(
    points: Floats, faces: NDArray[np.int64], normals: Floats, anchors: Floats, slack: float
) -> bool:
    """True if across every edge the neighbour's third corner is not outside."""
    own = np.tile(np.arange(len(faces)), 3)
    starts = np.concatenate([faces[:, 0], faces[:, 1], faces[:, 2]])
    ends = np.concatenate([faces[:, 1], faces[:, 2], faces[:, 0]])
    thirds = np.concatenate([faces[:, 2], faces[:, 0], faces[:, 1]])
    low, high = np.minimum(starts, ends), np.maximum(starts, ends)
    order = np.lexsort((high, low))
    same: NDArray[Any] = (low[order][1:] == low[order][:-1]) & (high[order][1:] == high[order][:-1])
    one, two = order[:-1][same], order[1:][same]
    for first, second in ((one, two), (two, one)):
        face = own[first]
        tips = points[thirds[second]]
        heights = np.einsum("ei,ei->e", tips, normals[face]) - anchors[face]
        if np.any(heights > slack):
            return False
    return True
