"""The scene: Bullet loads all physics scenes of a file, and guesses a gravity where none is."""

from __future__ import annotations

from lxml import etree

from colladaphy.conform.bullet import rules
from colladaphy.conform.bullet.markup import children, first
from colladaphy.conform.downgrade.draft import Draft, detach, local

__all__ = ["choose_scene", "note_ignored", "write_scene"]


def choose_scene(draft: Draft) -> etree._Element | None:
    """The physics scene that is instanced first, or else the first; the others are removed."""
    scenes = list(draft.all("physics_scene"))
    if not scenes:
        draft.note(rules.NO_SCENE, draft.root, "There is no physics scene for Bullet to load.")
        return None
    instances = children(first(draft.root, "scene"), "instance_physics_scene")
    by_id = {scene.get("id", ""): scene for scene in reversed(scenes)}
    urls = [instance.get("url", "").strip().removeprefix("#") for instance in instances]
    chosen = next((by_id[url] for url in urls if url in by_id), scenes[0])
    for scene in scenes:
        if scene is not chosen:
            message = f"The physics scene {scene.get('id')!r} is left out; Bullet would load it."
            draft.note(rules.SCENE_REMOVED, scene, message)
    for scene in scenes:
        library = scene.getparent()
        if scene is not chosen and library is not None:
            detach(scene)
            if not children(library, "physics_scene"):
                detach(library)
    for instance, url in zip(instances, urls, strict=True):
        if url in by_id and by_id[url] is not chosen:
            detach(instance)
    return chosen


def write_scene(draft: Draft, scene: etree._Element) -> None:
    """Say the gravity, and which way is up."""
    common = first(scene, "technique_common")
    if common is not None and first(common, "gravity") is None:
        common.insert(0, draft.make("gravity", "0.0 0.0 0.0"))
        message = f"The physics scene {scene.get('id')!r} has no gravity; zero is written."
        draft.note(rules.GRAVITY, scene, message)
    asset = first(draft.root, "asset")
    if asset is not None and first(asset, "up_axis") is None:
        extras = children(asset, "extra")
        asset.insert(
            asset.index(extras[0]) if extras else len(asset), draft.make("up_axis", "Y_UP")
        )
    unit = first(asset, "unit")
    if unit is not None and float(unit.get("meter", "1.0")) != 1.0:
        message = f"Bullet takes lengths in {unit.get('name', 'meter')} as they are."
        draft.note(rules.UNIT, unit, message)


_IGNORED = {
    "time_step": "the time step",
    "instance_force_field": "force fields",
    "inertia": "inertias; it computes them from the shapes",
    "hollow": "hollow shapes",
    "instance_physics_material": "materials: friction is 0.5 and restitution 0",
    "physics_material": "materials: friction is 0.5 and restitution 0",
}


def note_ignored(draft: Draft, scene: etree._Element, models: list[etree._Element]) -> None:
    """One finding for each kind of thing that Bullet does not read."""
    found: dict[str, list[etree._Element]] = {}
    for part in (scene, *models):
        for element in part.iter(etree.Element):
            what = _IGNORED.get(local(element))
            if what is not None and _counts(element):
                found.setdefault(what, []).append(element)
    for what, elements in found.items():
        message = f"Bullet ignores {what} ({len(elements)} in this file)."
        draft.note(rules.IGNORED, elements[0], message)


def _counts(element: etree._Element) -> bool:
    return local(element) != "hollow" or (element.text or "").strip() in ("true", "1")
