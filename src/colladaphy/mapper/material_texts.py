"""Materials as physics materials, with extra values of the pe profile (thesis 4.4, listing 5)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from colladaphy.mapper.body_texts import kept_name
from colladaphy.mapper.markup import attribute
from colladaphy.mapper.numbers import float_text

if TYPE_CHECKING:
    from collections.abc import Iterable

    from colladaphy.mapper.options import WriteOptions
    from colladaphy.world import Material, PairOverride

__all__ = ["material_text", "pair_texts"]

_COMMON = ("dynamic_friction", "restitution", "static_friction")
_EXTRA = (
    "density",
    "poisson_ratio",
    "young_modulus",
    "stiffness",
    "damping_normal",
    "damping_tangential",
)


def material_text(material: Material, options: WriteOptions) -> str:
    """The physics_material element of a material; its id is made of the material's."""
    common = "".join(_value(name, material) for name in _COMMON)
    extra = ""
    if options.profile != "none":
        names = _EXTRA + _COMMON if options.profile == "full" else _EXTRA
        values = "".join(_value(name, material, "pe:") for name in names)
        who = attribute("name", kept_name(material.name))
        extra = (
            f'<extra><technique profile="pe"><pe:material{who}>{values}</pe:material>'
            "</technique></extra>"
        )
    return (
        f'<physics_material id="Material{material.id}"{attribute("name", material.name)}>'
        f"<technique_common>{common}</technique_common>{extra}</physics_material>"
    )


def _value(name: str, material: Material, prefix: str = "") -> str:
    return f"<{prefix}{name}>{float_text(getattr(material, name))}</{prefix}{name}>"


def pair_texts(overrides: Iterable[PairOverride], written: set[int]) -> str:
    """What is set by hand for pairs of the materials that are written."""
    text = ""
    for pair in overrides:
        if pair.first not in written or pair.second not in written:
            continue
        values = "".join(
            attribute(name, None if value is None else float_text(value))
            for name, value in (
                ("restitution", pair.restitution),
                ("static_friction", pair.static_friction),
                ("dynamic_friction", pair.dynamic_friction),
            )
        )
        text += f'<pe:pair first="#Material{pair.first}" second="#Material{pair.second}"{values}/>'
    return text
