"""What a physics scene says itself, and the place in it for what is new."""

from __future__ import annotations

import re

from lxml import etree

from colladaphy.document.updating.bodies import set_name
from colladaphy.document.updating.elements import (
    child,
    name_after,
    numbers,
    profile_element,
    put,
    replace_profile,
)
from colladaphy.document.updating.owning import Owner
from colladaphy.document.updating.sources import Sources
from colladaphy.links.names import PE, c
from colladaphy.world import World

__all__ = ["Scene"]

_PAIR = re.compile(r"#Material(\d+)\Z")
_NMTOKEN = re.compile(r"[A-Za-z0-9._:-]+\Z")


class Scene:
    """The physics scene that a World is written into."""

    def __init__(self, root: etree._Element, owner: Owner, element: etree._Element | None) -> None:
        self._root, self._owner = root, owner
        self.element = self._new() if element is None else element

    def _new(self) -> etree._Element:
        """A scene for a document that puts none into effect."""
        made = etree.Element(c("physics_scene"))
        made.set("id", name_after("Scene1", self._owner.taken))
        etree.SubElement(made, c("technique_common"))
        put(self._owner.library("library_physics_scenes"), made, ("asset", "physics_scene"))
        effect = etree.Element(c("instance_physics_scene"))
        effect.set("url", f"#{made.get('id')}")
        put(self._owner.scene(), effect, ())
        return made

    def set_values(self, stored: etree._Element, world: World, sources: Sources) -> None:
        """Gravity and time step, and all that the pe profile says of the World."""
        set_name(self.element, stored)
        common = child(self.element, "technique_common")
        assert common is not None
        self._set_value(common, "gravity", numbers(world.gravity), ())
        step = None if world.time_step is None else numbers([world.time_step])
        self._set_value(common, "time_step", step, ("gravity",))
        made = profile_element(stored, "world")
        for pair in [] if made is None else list(made.iterchildren(f"{{{PE}}}pair")):
            for end in ("first", "second"):
                match = _PAIR.match(pair.get(end, ""))
                url = None if match is None else sources.material(int(match[1]))
                if url is not None:
                    pair.set(end, url)
        replace_profile(self.element, "world", made)
        self._set_unit(world)

    def _set_value(
        self, common: etree._Element, name: str, text: str | None, before: tuple[str, ...]
    ) -> None:
        old = child(common, name)
        if old is None and text is not None:
            old = etree.Element(c(name))
            put(common, old, before)
        elif old is not None and text is None:
            common.remove(old)
        if old is not None and text is not None:
            for inner in list(old):
                old.remove(inner)
            old.text = text

    def _set_unit(self, world: World) -> None:
        name = world.unit_name if _NMTOKEN.match(world.unit_name) else "unit"
        asset = child(self._root, "asset")
        unit = None if asset is None else child(asset, "unit")
        if unit is not None and unit.get("name", "meter") != name:
            unit.set("name", name)

    def add_model(self) -> tuple[etree._Element, etree._Element]:
        """A new model for what is new, and its instance in the scene."""
        model = etree.Element(c("physics_model"))
        model.set("id", name_after("Model1", self._owner.taken))
        put(self._owner.library("library_physics_models"), model, ("asset", "physics_model"))
        effect = etree.Element(c("instance_physics_model"))
        effect.set("url", f"#{model.get('id')}")
        put(self.element, effect, ("asset", "instance_force_field"))
        return model, effect
