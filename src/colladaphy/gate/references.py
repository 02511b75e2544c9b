"""What references of COLLADA 1.5 must lead to, which the schema itself cannot say.

The chapters on the elements name the kind of target; the schema has only ``xs:anyURI`` there.
"""

from __future__ import annotations

__all__ = ["EXPECTED"]

_INSTANCES = (
    "animation",
    "articulated_system",
    "camera",
    "controller",
    "effect",
    "force_field",
    "formula",
    "geometry",
    "joint",
    "kinematics_model",
    "kinematics_scene",
    "light",
    "node",
    "physics_material",
    "physics_model",
    "physics_scene",
    "visual_scene",
)
# An instance_* element refers to the element that its name says, unless it is listed here.
EXPECTED: dict[tuple[str, str], tuple[str, ...]] = {
    ("instance_rigid_body", "target"): ("node",),
    ("instance_physics_model", "parent"): ("node",),
    ("instance_material", "target"): ("material",),
    ("convex_mesh", "convex_hull_of"): ("geometry",),
    ("attachment", "rigid_body"): ("rigid_body", "node", "instance_rigid_body"),
    ("ref_attachment", "rigid_body"): ("rigid_body", "node", "instance_rigid_body"),
    ("skin", "source"): ("geometry",),
    ("morph", "source"): ("geometry",),
    ("input", "source"): ("source", "vertices"),
    ("channel", "source"): ("sampler",),
    **{(f"instance_{name}", "url"): (name,) for name in _INSTANCES},
}
"""Local names of the elements that an attribute may refer to, by (element, attribute)."""
