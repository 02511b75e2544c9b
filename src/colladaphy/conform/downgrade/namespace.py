"""The last step: the same tree in the namespace of COLLADA 1.4.1.

It is the default namespace of what is written: neither Bullet's converter nor collada-dom reads
elements with a prefix. Both drop the declarations of the root when they save, so that prefixes of
foreign content are declared where that begins.
"""

from __future__ import annotations

from typing import cast

from lxml import etree

from colladaphy.conform.downgrade import rules
from colladaphy.conform.downgrade.draft import KEPT_PROFILE, NS15, Draft, local

__all__ = ["NS14", "VERSION", "in_namespace_1_4"]

NS14 = "http://www.collada.org/2005/11/COLLADASchema"
VERSION = "1.4.1"
_XSD = "http://www.w3.org/2001/XMLSchema"
_XSI = "{http://www.w3.org/2001/XMLSchema-instance}"

# The element names that 1.4.1 declares globally: its schema checks them wherever they stand,
# in a technique too.
_GLOBAL_NAMES = """
    COLLADA IDREF_array Name_array bool_array float_array int_array accessor param source geometry
    mesh spline p lines linestrips polygons polylist triangles trifans tristrips vertices lookat
    matrix rotate scale skew translate image light material camera animation animation_clip channel
    sampler controller skin morph asset extra technique node visual_scene bind_material
    instance_camera instance_controller instance_effect instance_force_field instance_geometry
    instance_light instance_material instance_node instance_physics_material instance_physics_model
    instance_rigid_body instance_rigid_constraint library_animations library_animation_clips
    library_cameras library_controllers library_geometries library_effects library_force_fields
    library_images library_lights library_materials library_nodes library_physics_materials
    library_physics_models library_physics_scenes library_visual_scenes fx_profile_abstract effect
    gl_hook_abstract profile_GLSL profile_COMMON profile_CG profile_GLES box plane sphere ellipsoid
    cylinder tapered_cylinder capsule tapered_capsule convex_mesh force_field physics_material
    physics_scene rigid_body rigid_constraint physics_model
"""
_GLOBAL = frozenset(_GLOBAL_NAMES.split())


def in_namespace_1_4(draft: Draft) -> etree._Element:
    """A new tree, in the namespace and of the version 1.4.1; foreign content stays as it is."""
    old = draft.root
    new = etree.Element(_renamed(old.tag), nsmap=cast("dict[str, str]", {None: NS14}))
    _copy_values(draft, old, new, standard=True)
    new.set("version", VERSION)
    # Each entry: the new parent, the old child, how to treat its names.
    stack = [(new, child, _treatment(draft, old, child, True)) for child in reversed(old)]
    while stack:
        parent, element, standard = stack.pop()
        if not isinstance(element.tag, str):
            _copy_other(parent, element)
            continue
        if standard is True:
            twin = etree.SubElement(parent, _renamed(element.tag))
        else:
            twin = _foreign(parent, element, rename=standard is None)
        _copy_values(draft, element, twin, standard=standard is True)
        if twin.sourceline is None and element.sourceline is not None:
            twin.sourceline = element.sourceline
        stack.extend(
            (twin, child, _treatment(draft, element, child, standard))
            for child in reversed(element)
        )
    for node in reversed(list(old.itersiblings(preceding=True))):
        new.addprevious(_loose(node))
    for node in reversed(list(old.itersiblings())):
        new.addnext(_loose(node))
    return new


def _treatment(
    draft: Draft, parent: etree._Element, child: etree._Element, standard: bool | None
) -> bool | None:
    """True: an element of the standard; None: foreign, in the new namespace; False: as it is."""
    if standard is not True or local(parent) != "technique" or "profile" not in parent.attrib:
        return standard
    if parent.attrib["profile"] == KEPT_PROFILE or not isinstance(child.tag, str):
        return False
    if any(local(element) in _GLOBAL for element in child.iter(f"{{{NS15}}}*")):
        message = f"<{local(child)}> uses element names of 1.4.1; it stays in the namespace of 1.5."
        draft.note(rules.CONTENT_LEFT, child, message)
        return False
    return None


def _renamed(tag: str) -> str:
    return f"{{{NS14}}}{tag.rpartition('}')[2]}" if tag.startswith(f"{{{NS15}}}") else tag


def _foreign(parent: etree._Element, element: etree._Element, *, rename: bool) -> etree._Element:
    tag = _renamed(element.tag) if rename else element.tag
    prefixes = _prefixes(element, rename=rename)
    if not tag.startswith("{"):
        prefixes = {**prefixes, **cast("dict[str, str]", {None: ""})}  # not in the default one
    return etree.SubElement(parent, tag, nsmap=prefixes)


def _prefixes(element: etree._Element, *, rename: bool) -> dict[str, str]:
    """The prefixes in scope; the stubs of lxml do not know of the default namespace's None."""
    prefixes = cast("dict[str, str]", element.nsmap)
    if not rename:
        return prefixes
    return {prefix: NS14 if uri == NS15 else uri for prefix, uri in prefixes.items()}


def _copy_values(draft: Draft, old: etree._Element, new: etree._Element, *, standard: bool) -> None:
    new.text, new.tail = old.text, old.tail
    for name, value in ((str(name), str(value)) for name, value in old.attrib.items()):
        if name.startswith(_XSI) and not _may_stay(old, name, value, standard):
            draft.note(rules.SCHEMA_HINT, old, f"{name.rpartition('}')[2]}={value!r} is left out.")
        else:
            new.set(name, value)


def _may_stay(element: etree._Element, name: str, value: str, standard: bool) -> bool:
    if standard:
        return False
    if not name.endswith("}type"):
        return True
    prefix = value.strip().rpartition(":")[0] or None
    return element.nsmap.get(prefix) == _XSD


def _loose(node: etree._Element) -> etree._Element:
    if isinstance(node, etree._ProcessingInstruction):
        return etree.ProcessingInstruction(node.target, node.text or "")
    return etree.Comment(node.text)


def _copy_other(parent: etree._Element, node: etree._Element) -> None:
    twin = _loose(node)
    twin.tail = node.tail
    parent.append(twin)
