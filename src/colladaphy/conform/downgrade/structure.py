"""What 1.4.1 does not have at all: kinematics, formulas, boundary representations, evaluation."""

from __future__ import annotations

from lxml import etree

from colladaphy.conform.downgrade import rules
from colladaphy.conform.downgrade.draft import Draft, local, tag15
from colladaphy.findings import Rule

__all__ = ["keep_libraries", "keep_structure"]

_LIBRARIES = (
    "library_joints",
    "library_kinematics_models",
    "library_articulated_systems",
    "library_kinematics_scenes",
    "library_formulas",
)
_PROFILES = ("profile_BRIDGE", "profile_GLES2", "profile_GLSL", "profile_CG", "profile_GLES")


def keep_libraries(draft: Draft) -> None:
    """Keep whole branches that no later rule needs to look into."""
    for child in list(draft.root):
        if local(child) in _LIBRARIES:
            _keep(draft, rules.LIBRARY_KEPT, child)
    for scene in draft.root.findall(tag15("scene")):
        for instance in scene.findall(tag15("instance_kinematics_scene")):
            _keep(draft, rules.ELEMENT_KEPT, instance)
    for effect in draft.root.findall(f"{tag15('library_effects')}/{tag15('effect')}"):
        for child in list(effect):
            if local(child) in _PROFILES:
                _keep(draft, rules.PROFILE_KEPT, child)
    for clip in draft.root.findall(f"{tag15('library_animation_clips')}/{tag15('animation_clip')}"):
        for formula in clip.findall(tag15("instance_formula")):
            _keep(draft, rules.ELEMENT_KEPT, formula)
    for geometry in draft.root.findall(f"{tag15('library_geometries')}/{tag15('geometry')}"):
        for brep in geometry.findall(tag15("brep")):
            # The geometry stays, so that what instances it still resolves.
            brep.addprevious(draft.make("convex_mesh"))
            _keep(draft, rules.BREP_KEPT, brep)


def keep_structure(draft: Draft) -> None:
    """Keep the smaller parts: of assets, scenes, nodes and animations."""
    for contributor in draft.all("contributor"):
        for name in ("author_email", "author_website"):
            for child in contributor.findall(tag15(name)):
                _keep(draft, rules.ELEMENT_KEPT, child)
    for asset in draft.all("asset"):
        for child in list(asset):
            if local(child) in ("coverage", "extra"):
                _keep(draft, rules.ELEMENT_KEPT, child)
    for evaluation in draft.all("evaluate_scene"):
        _evaluate_scene(draft, evaluation)
    for node in draft.all("instance_node"):
        _keep_attributes(draft, node, "proxy")
    for sampler in draft.all("sampler"):
        _keep_attributes(draft, sampler, "pre_behavior", "post_behavior")


def _keep(draft: Draft, rule: Rule, element: etree._Element) -> None:
    draft.note(rule, element, f"COLLADA 1.4.1 has no <{local(element)}> like this; it is kept.")
    draft.keep(element)


def _keep_attributes(draft: Draft, element: etree._Element, *names: str) -> None:
    found = [name for name in names if name in element.attrib]
    if found:
        what = " and ".join(f"{name}={element.get(name)!r}" for name in found)
        message = f"COLLADA 1.4.1 has no {what} on <{local(element)}>; it is kept."
        draft.note(rules.ATTRIBUTE_KEPT, element, message)
        draft.keep_attributes(element, *found)


def _evaluate_scene(draft: Draft, evaluation: etree._Element) -> None:
    enabled = evaluation.get("enable", "true").strip() in ("true", "1")
    if not enabled or not all(_is_layers(child) for child in evaluation) or not len(evaluation):
        message = "COLLADA 1.4.1 cannot say this evaluation of the scene; it is kept whole."
        draft.note(rules.EVALUATION_KEPT, evaluation, message)
        draft.keep(evaluation)
        return
    _keep_attributes(draft, evaluation, "id", "sid", "enable")
    for render in evaluation.findall(tag15("render")):
        _keep_attributes(draft, render, "sid", "name")


def _is_layers(render: etree._Element) -> bool:
    """Whether this is a render step of 1.4.1: a camera and layers."""
    if not isinstance(render.tag, str):
        return True
    steps = [local(child) for child in render if isinstance(child.tag, str)]
    return local(render) == "render" and "camera_node" in render.attrib and {*steps} <= {"layer"}
