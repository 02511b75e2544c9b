"""Meshes as geometries: one source of positions, one list of triangles."""

from __future__ import annotations

from typing import TYPE_CHECKING

from colladaphy.mapper.numbers import row_texts

if TYPE_CHECKING:
    from colladaphy.world import Mesh

__all__ = ["mesh_text"]


def mesh_text(mesh: Mesh, id: str) -> str:
    """The geometry element of a mesh, its vertices and faces as they are stored."""
    name = "convex_mesh" if mesh.convex else "mesh"
    count = len(mesh.vertices)
    positions = " ".join(row_texts(mesh.vertices))
    corners = " ".join(map(str, mesh.faces.reshape(-1).tolist()))
    return (
        f'<geometry id="{id}"><{name}>'
        f'<source id="{id}Positions">'
        f'<float_array id="{id}PositionsArray" count="{3 * count}">{positions}</float_array>'
        f'<technique_common><accessor source="#{id}PositionsArray" count="{count}" stride="3">'
        '<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>'
        "</accessor></technique_common></source>"
        f'<vertices id="{id}Vertices"><input semantic="POSITION" source="#{id}Positions"/>'
        "</vertices>"
        f'<triangles count="{len(mesh.faces)}">'
        f'<input semantic="VERTEX" source="#{id}Vertices" offset="0"/><p>{corners}</p></triangles>'
        f"</{name}></geometry>"
    )
