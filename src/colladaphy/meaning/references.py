"""What references must lead to, and how much depends on them (COLLADA 1.5, chapters on elements).

The schema has only ``xs:anyURI`` there. An instance_* element refers to the element that its name
says, unless it is listed here.
"""

from __future__ import annotations

from typing import Final, NamedTuple

__all__ = ["ADDRESSES", "NEEDED", "PARAMETERS", "URIS", "Uri"]


class Uri(NamedTuple):
    """An attribute (or, if that is empty, a text) that holds a URI."""

    element: str
    attribute: str
    expected: tuple[str, ...]


_INSTANCES = (
    "animation", "articulated_system", "camera", "controller", "effect", "force_field", "formula",
    "geometry", "image", "joint", "kinematics_model", "kinematics_scene", "light", "node",
    "physics_material", "physics_model", "physics_scene", "visual_scene",
)  # fmt: skip
_ARRAYS = ("float_array", "int_array", "bool_array", "Name_array", "IDREF_array", "SIDREF_array",
           "token_array")  # fmt: skip

URIS: Final = (
    *(Uri(f"instance_{name}", "url", (name,)) for name in _INSTANCES),
    Uri("sampler_image", "url", ("image",)),
    Uri("instance_node", "proxy", ("node",)),
    Uri("instance_rigid_body", "target", ("node",)),
    Uri("instance_physics_model", "parent", ("node",)),
    Uri("instance_material", "target", ("material",)),
    Uri("instance_material", "url", ("material",)),
    Uri("convex_mesh", "convex_hull_of", ("geometry",)),
    Uri("skin", "source", ("geometry", "controller")),
    Uri("morph", "source", ("geometry", "controller")),
    Uri("skeleton", "", ("node",)),
    Uri("accessor", "source", _ARRAYS),
    Uri("channel", "source", ("sampler",)),
    Uri("render", "camera_node", ("node",)),
)  # fmt: skip
"""All but those of inputs and of attachments, which depend on where they stand."""

NEEDED: Final = frozenset(
    {
        "instance_physics_scene",
        "instance_physics_model",
        "instance_rigid_body",
        "instance_rigid_constraint",
        "attachment",
        "ref_attachment",
    }
)
"""The elements without whose references a scene cannot be loaded."""

ADDRESSES: Final = (
    ("attachment_full", "joint"),
    ("attachment_start", "joint"),
    ("attachment_end", "joint"),
    ("frame_origin", "link"),
    ("frame_tip", "link"),
    ("frame_tcp", "link"),
    ("frame_object", "link"),
    ("axis_info", "axis"),
    ("bind_kinematics_model", "node"),
    ("bind_joint_axis", "target"),
    ("bind", "target"),
    ("setparam", "ref"),
    ("connect_param", "ref"),
)
"""Attributes that hold SID addresses, through instances too (COLLADA 1.5 §Address syntax)."""

PARAMETERS: Final = ("newparam", "bind", "setparam", "modifier")
"""Elements that give a parameter its name."""
