"""Faults of whole graphs of instances."""

from __future__ import annotations

from collections.abc import Callable

from hypothesis import strategies as st
from lxml import etree

from colladaphy.conform.grammar import NAMESPACE

__all__ = ["GRAPHS", "exploding"]

Make = Callable[[st.DrawFn, bytes], bytes]


def exploding(depth: int) -> bytes:
    """Models that each instance the next one twice, so that there are 2 ** `depth` of the last."""
    models = "".join(
        f'<physics_model id="m{number}">'
        + 2 * f'<instance_physics_model url="#m{number + 1}"/>'
        + "</physics_model>"
        for number in range(depth)
    )
    body = (
        f'<physics_model id="m{depth}"><rigid_body sid="b"><technique_common><mass>1</mass><shape>'
        "<sphere><radius>1</radius></sphere></shape></technique_common></rigid_body>"
        "</physics_model>"
    )
    return (
        f'<COLLADA xmlns="{NAMESPACE}" version="1.5.0"><asset><created>2000-01-01T00:00:00Z'
        "</created><modified>2000-01-01T00:00:00Z</modified></asset><library_physics_models>"
        f"{models}{body}</library_physics_models><library_physics_scenes>"
        '<physics_scene id="s"><instance_physics_model url="#m0"/><technique_common/>'
        "</physics_scene></library_physics_scenes><scene><instance_physics_scene url='#s'/></scene>"
        "</COLLADA>"
    ).encode()


def _exploding(least: int, most: int) -> Make:
    def make(draw: st.DrawFn, data: bytes) -> bytes:
        root = etree.fromstring(exploding(draw(st.integers(least, most))))
        return etree.tostring(root, encoding="UTF-8", xml_declaration=True)

    return make


GRAPHS: dict[str, tuple[Make, Make]] = {
    "link-budget": (_exploding(28, 60), _exploding(0, 6)),
}
"""By rule: what breaks it, and what nearly does."""
