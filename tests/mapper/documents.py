"""Documents that our writer never makes, put together from their parts."""

from __future__ import annotations

from colladaphy.links.names import COLLADA, PE

__all__ = ["body", "collada", "instance", "model", "scene"]

SPHERE = "<sphere><radius>1</radius></sphere>"


def body(
    sid: str = "b",
    shapes: str = f"<shape><mass>1</mass>{SPHERE}</shape>",
    values: str = "",
    after: str = "",
) -> str:
    return (
        f'<rigid_body sid="{sid}"><technique_common>{values}{shapes}</technique_common>{after}'
        "</rigid_body>"
    )


def instance(
    sid: str = "b", target: str = "#n", values: str = "", after: str = "", attributes: str = ""
) -> str:
    return (
        f'<instance_rigid_body body="{sid}" target="{target}"{attributes}>'
        f"<technique_common>{values}</technique_common>{after}</instance_rigid_body>"
    )


def model(*content: str, id: str = "m") -> str:
    return f'<physics_model id="{id}">{"".join(content)}</physics_model>'


def scene(*content: str, id: str = "s", values: str = "", url: str = "#m") -> str:
    """A scene; content that is no instance_physics_model stands in one of `url`."""
    inner = "".join(content)
    if not inner.startswith("<instance_physics_model"):
        inner = f'<instance_physics_model url="{url}">{inner}</instance_physics_model>'
    common = f"<technique_common>{values}</technique_common>"
    return f'<physics_scene id="{id}">{inner}{common}</physics_scene>'


def collada(
    models: str,
    scenes: str,
    nodes: str = '<node id="n"/>',
    *,
    materials: str = "",
    geometries: str = "",
    library_nodes: str = "",
    unit: str = "",
    up_axis: str = "Z_UP",
    effects: tuple[str, ...] = ("s",),
) -> bytes:
    """A whole document; libraries without content are left out."""

    def library(name: str, content: str) -> str:
        return f"<library_{name}>{content}</library_{name}>" if content else ""

    visual = f'<visual_scene id="visual">{nodes}</visual_scene>' if nodes else ""
    started = "".join(f'<instance_physics_scene url="#{id}"/>' for id in effects)
    effect = '<instance_visual_scene url="#visual"/>' if nodes else ""
    return (
        f'<COLLADA xmlns="{COLLADA}" xmlns:pe="{PE}" version="1.5.0"><asset>'
        "<created>2011-01-01T00:00:00Z</created><modified>2011-01-01T00:00:00Z</modified>"
        f"{unit}<up_axis>{up_axis}</up_axis></asset>"
        + library("geometries", geometries)
        + library("nodes", library_nodes)
        + library("physics_materials", materials)
        + library("physics_models", models)
        + library("physics_scenes", scenes)
        + library("visual_scenes", visual)
        + f"<scene>{started}{effect}</scene></COLLADA>"
    ).encode()


def simple(
    shapes: str = f"<shape><mass>1</mass>{SPHERE}</shape>",
    *,
    values: str = "",
    moves: str = "",
    nodes: str = '<node id="n"/>',
    after: str = "",
    **libraries: str,
) -> bytes:
    """A document of one body."""
    return collada(
        model(body(shapes=shapes, values=values, after=after)),
        scene(instance(values=moves)),
        nodes,
        **libraries,  # type: ignore[arg-type]
    )
