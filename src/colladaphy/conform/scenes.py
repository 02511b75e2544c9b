"""The document's scene: it must put a physics scene into effect, or nothing is simulated."""

from __future__ import annotations

from lxml import etree

from colladaphy.conform import reference_rules
from colladaphy.conform.context import NS, Context, append, insert, local

__all__ = ["complete_scene", "mend_scenes"]


def mend_scenes(context: Context) -> None:
    """Where the instanced physics scene is not there, the only one that is there is meant."""
    found = context.all("physics_scene")
    for instance in context.all("instance_physics_scene"):
        url = instance.get("url", "")
        if not url.startswith("#") or context.by_url(url) is not None:
            continue
        if len(found) == 1 and context.wants(reference_rules.DANGLING_SCENE):
            new = _url_of(context, found[0])
            instance.set("url", new)
            message = f"there is no physics scene {url}; the only one, {new}, is taken"
            context.note(reference_rules.DANGLING_SCENE, instance, message)


def complete_scene(context: Context) -> None:
    """A document without a scene gets one; a scene without physics gets the only physics scene.

    Of several physics scenes the first is taken where there is no scene at all: each has its own
    gravity and time step, so that together they would not be what any of them says. A scene that
    is there and leaves several out may have its reasons.
    """
    found = _members(context, "physics_scene")
    scenes = list(context.root.iterchildren(NS + "scene"))
    if not found or not context.wants(reference_rules.MISSING_SCENE) or (scenes and len(found) > 1):
        return
    if any(next(scene.iter(NS + "instance_physics_scene"), None) is not None for scene in scenes):
        return
    url = _url_of(context, found[0])
    why = "it is the only one"
    if len(found) > 1:
        others = ", ".join(scene.get("id") or scene.get("name") or "?" for scene in found[1:])
        why = f"it is the first of {len(found)}; not in effect: {others}"
    instance = context.make("instance_physics_scene", url=url)
    if scenes:
        insert(scenes[0], 0, instance)
        message = f"<scene> instanced no physics scene; {url} is assumed: {why}"
        context.note(reference_rules.MISSING_SCENE, scenes[0], message)
        return
    scene = _add_scene(context)
    append(scene, instance)
    message = f"there was no <scene>; one with the physics scene {url} is assumed: {why}"
    visuals = _members(context, "visual_scene")
    if len(visuals) == 1:
        visual = _url_of(context, visuals[0])
        append(scene, context.make("instance_visual_scene", url=visual))
        message += f"; with the only visual scene, {visual}"
    context.note(reference_rules.MISSING_SCENE, scene, message)


def _members(context: Context, name: str) -> list[etree._Element]:
    """The elements of this name in their libraries."""
    libraries = context.root.iterchildren(f"{NS}library_{name}s")
    return [member for library in libraries for member in library.iterchildren(NS + name)]


def _add_scene(context: Context) -> etree._Element:
    scene = context.make("scene")
    places = (i for i, child in enumerate(context.root) if local(child) == "extra")
    insert(context.root, next(places, len(context.root)), scene)
    return scene


def _url_of(context: Context, element: etree._Element) -> str:
    if not element.get("id"):
        name = context.new_id(local(element))
        element.set("id", name)
        context.ids[name] = element
    return f"#{element.get('id')}"
