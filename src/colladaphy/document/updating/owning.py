"""Making what bodies are described by their own, so that changing it changes no other body.

A physics model that is instanced twice, or that stands in another document, describes bodies
together with others. One of them that changes gets a copy of the model (thesis 3.3: an instance is
what a scene says of a model).
"""

from __future__ import annotations

import posixpath
from collections import Counter
from copy import deepcopy

import numpy as np
from lxml import etree

from colladaphy.document.updating.elements import (
    child,
    local,
    name_after,
    put,
    retarget,
)
from colladaphy.links.names import c
from colladaphy.links.resource import Resource
from colladaphy.mapper import Loaded

__all__ = ["Owner"]


class Owner:
    """The elements of a new version of a document, by what they were in the old one."""

    def __init__(self, loaded: Loaded, root: etree._Element, taken: set[str]) -> None:
        self._loaded = loaded
        self._root = root
        self.taken = taken
        """The ids in use."""
        self._elements = list(root.iter(etree.Element))
        expansion = loaded.expansion
        self._uses = Counter(expansion.models.tolist())
        for row, count in _other_uses(loaded).items():
            self._uses[row] += count
        self._models: dict[int, etree._Element] = {}
        self._copies: dict[int, tuple[int, list[etree._Element]]] = {}
        """By the instance of the model: the number of its first element, and the copies."""
        found = loaded.bodies.found
        self._shares = Counter(zip(found.models.tolist(), found.bodies.tolist(), strict=True))
        self._bodies: dict[int, etree._Element] = {}
        joints = loaded.joints
        self._shared_joints = Counter(
            zip(joints.models.tolist(), joints.constraints.tolist(), strict=True)
        )
        self._constraints: dict[int, etree._Element] = {}
        self._instances: dict[int, etree._Element] = {}
        self._prefixes: dict[int, str] = {}
        self._scenes: dict[tuple[int, int], list[etree._Element]] = {}
        self.copied: list[str] = []
        """What was copied, for messages."""

    def element(self, number: int) -> etree._Element:
        """The element that has a number in the old version of this document."""
        return self._elements[number]

    # --- models

    def model_instance(self, instance: int) -> etree._Element:
        """The instance_physics_model of an instance of a model, that is no other's."""
        expansion, table = self._loaded.expansion, self._loaded.tables.model_instances
        row = expansion.rows[instance : instance + 1]
        number = int(table.ordinals[row[0]])
        around = int(expansion.around[instance])
        if around >= 0:
            return self._inside(around, number)
        return self._in_scene(instance, number)

    def _in_scene(self, instance: int, number: int) -> etree._Element:
        """An element of a scene, in an instance of a model that stands in no other."""
        table = self._loaded.tables.model_instances
        row = self._loaded.expansion.rows[instance : instance + 1]
        home = int(table.homes(row)[0])
        if home == 0:
            return self._elements[number]
        resource = self._loaded.tables.pool.resources[home]
        scene = resource.element(int(table.ordinals[row[0]])).getparent()
        assert scene is not None
        return self.scene_element(home, resource.number(scene), number)

    def scene_element(self, home: int, scene: int, number: int) -> etree._Element:
        """An element within a physics scene, by numbers in its document.

        A scene of another document is copied, and put into effect in the place of the other.
        """
        if home == 0:
            return self._elements[number]
        if (home, scene) not in self._scenes:
            pool = self._loaded.tables.pool.resources
            made = self._copied(pool[home].element(scene), home)
            put(self.library("library_physics_scenes"), made, ("asset", "physics_scene"))
            self._scenes[home, scene] = list(made.iter(etree.Element))
            for effect in self._root.iter(c("instance_physics_scene")):
                target, found = pool[0].follow(effect.get("url", ""), self._elements.index(effect))
                if target is pool[home] and found == scene:
                    effect.set("url", f"#{made.get('id')}")
            message = (
                f"The physics scene {made.get('id')!r} is a copy of that in {pool[home].file!r}."
            )
            self.copied.append(message)
        return self._scenes[home, scene][number - scene]

    def model(self, instance: int) -> etree._Element:
        """The physics_model of an instance, that is no other's: a copy where it was."""
        known = self._models.get(instance)
        if known is not None:
            return known
        tables, row = self._loaded.tables, int(self._loaded.expansion.models[instance])
        effect = self.model_instance(instance)
        home = int(tables.models.homes(self._loaded.expansion.models[instance : instance + 1])[0])
        number = int(tables.models.ordinals[row])
        if home == 0 and self._uses[row] == 1:
            made = self._elements[number]
        else:
            self._uses[row] -= 1
            made = self._copy(instance, tables.pool.resources[home], home, number, effect)
        self._models[instance] = made
        return made

    def _copy(
        self, instance: int, resource: Resource, home: int, number: int, effect: etree._Element
    ) -> etree._Element:
        original = resource.element(number) if home else self._elements[number]
        made = self._copied(original, home)
        self._copies[instance] = number, list(made.iter(etree.Element))
        put(self.library("library_physics_models"), made, ("asset", "physics_model"))
        effect.set("url", f"#{made.get('id')}")
        self.copied.append(
            f"The physics model {made.get('id')!r} is a copy for what became different."
        )
        return made

    def _copied(self, original: etree._Element, home: int) -> etree._Element:
        """A copy with ids of its own, whose references lead where those of the original do."""
        made = deepcopy(original)
        made.tail = None
        ids = {}
        for element in made.iter(etree.Element):
            old = element.get("id")
            if old is not None:
                ids[old] = name_after(old, self.taken)
                element.set("id", ids[old])
        retarget(made, ids, self.prefix(home))
        return made

    def library(self, name: str) -> etree._Element:
        """The first library of a name, which is made where there is none."""
        found = child(self._root, name)
        if found is None:
            found = etree.Element(c(name))
            names = {local(element) for element in self._root}
            put(self._root, found, ("asset", *(n for n in names if n.startswith("library_"))))
        return found

    def scene(self) -> etree._Element:
        """The scene element of the document, which is made where there is none."""
        found = child(self._root, "scene")
        if found is None:
            found = etree.Element(c("scene"))
            names = {local(element) for element in self._root}
            put(self._root, found, tuple(names - {"extra", ""}))
        return found

    def prefix(self, home: int) -> str:
        """How this document refers to another one: its file, relative to this one's."""
        if home == 0:
            return ""
        if home not in self._prefixes:
            pool = self._loaded.tables.pool.resources
            wanted, start = pool[home], pool[0]
            ways: dict[int, str] = {id(start): ""}
            waiting = [start]
            for resource in waiting:
                for key, other in resource.family.items():
                    file, _, reference = key.partition("\n")
                    if file == str(resource.file) and id(other) not in ways:
                        folder = posixpath.dirname(ways[id(resource)])
                        ways[id(other)] = posixpath.join(folder, reference)
                        waiting.append(other)
            self._prefixes[home] = ways.get(id(wanted), wanted.file or "")
        return self._prefixes[home]

    def _inside(self, instance: int, number: int) -> etree._Element:
        """An element of the model of an instance, by its number in its document."""
        self.model(instance)
        if instance in self._copies:
            first, elements = self._copies[instance]
            return elements[number - first]
        return self._elements[number]

    def has_its_own(self, instance: int) -> bool:
        """Whether the model of an instance is no other's already."""
        return not self._is_shared(instance)

    # --- bodies and joints

    def instance(self, body: int) -> etree._Element:
        """The instance_rigid_body of a body, that is no other's."""
        known = self._instances.get(body)
        if known is None:
            loaded = self._loaded
            found = loaded.bodies.found
            number = int(loaded.tables.body_instances.ordinals[found.rows[body]])
            known = self._instances[body] = self._in_effect(int(found.models[body]), number)
        return known

    def _in_effect(self, instance: int, number: int) -> etree._Element:
        """An element within an instance_physics_model, by its number."""
        around = int(self._loaded.expansion.around[instance])
        return self._in_scene(instance, number) if around < 0 else self._inside(around, number)

    def rigid_body(self, body: int) -> etree._Element:
        """The rigid_body of a body, that is no other's."""
        if body in self._bodies:
            return self._bodies[body]
        found, table = self._loaded.bodies.found, self._loaded.tables.bodies
        row, model = int(found.bodies[body]), int(found.models[body])
        home = self.model(model)
        made = self._inside(model, int(table.ordinals[row]))
        if self._shares[(model, row)] > 1:
            self._shares[(model, row)] -= 1
            sids = {element.get("sid", "") for element in home.iterchildren(c("rigid_body"))}
            made = deepcopy(made)
            made.tail = None
            made.attrib.pop("id", "")
            made.set("sid", name_after(made.get("sid", "Body"), sids))
            put(home, made, ("asset", "rigid_body"))
            self.instance(body).set("body", made.get("sid", ""))
        self._bodies[body] = made
        return made

    def shares_rigid_body(self, body: int) -> bool:
        """Whether other bodies are described by the same rigid_body."""
        found = self._loaded.bodies.found
        row, model = int(found.bodies[body]), int(found.models[body])
        return self._shares[(model, row)] > 1 or self._is_shared(model)

    def constraint_instance(self, joint: int) -> etree._Element:
        """The instance_rigid_constraint of a joint, that is no other's."""
        joints, tables = self._loaded.joints, self._loaded.tables
        number = int(tables.constraint_instances.ordinals[joints.instances[joint]])
        return self._in_effect(int(joints.models[joint]), number)

    def constraint(self, joint: int) -> etree._Element:
        """The rigid_constraint of a joint, that is no other's."""
        joints, tables = self._loaded.joints, self._loaded.tables
        if joint in self._constraints:
            return self._constraints[joint]
        model, row = int(joints.models[joint]), int(joints.constraints[joint])
        home = self.model(model)
        made = self._inside(model, int(tables.constraints.ordinals[row]))
        if self._shared_joints[(model, row)] > 1:
            self._shared_joints[(model, row)] -= 1
            sids = {element.get("sid", "") for element in home.iterchildren(c("rigid_constraint"))}
            made = deepcopy(made)
            made.tail = None
            made.set("sid", name_after(made.get("sid", "Joint"), sids))
            put(home, made, ("asset", "rigid_body", "rigid_constraint"))
            self.constraint_instance(joint).set("constraint", made.get("sid", ""))
        self._constraints[joint] = made
        return made

    def shares_constraint(self, joint: int) -> bool:
        """Whether other joints are described by the same rigid_constraint."""
        joints = self._loaded.joints
        model, row = int(joints.models[joint]), int(joints.constraints[joint])
        return self._shared_joints[(model, row)] > 1 or self._is_shared(model)

    def _is_shared(self, instance: int) -> bool:
        """Whether the model of an instance is another one's too, or another document's."""
        expansion = self._loaded.expansion
        if instance in self._models:
            return False
        row = expansion.models[instance : instance + 1]
        return self._uses[int(row[0])] > 1 or int(self._loaded.tables.models.homes(row)[0]) != 0


def _other_uses(loaded: Loaded) -> Counter[int]:
    """How often models are instanced by what is not loaded, by their rows."""
    table = loaded.tables.model_instances
    left = np.setdiff1d(np.flatnonzero(table.homes(np.arange(len(table))) == 0),
                        loaded.expansion.rows)  # fmt: skip
    if not len(left):
        return Counter()
    urls = table.texts("url")
    models, _ = loaded.tables.pool.follow(
        loaded.tables.models, [urls[row] for row in left.tolist()],
        np.zeros(len(left), np.int64), table.ordinals[left], "physics_model",
    )  # fmt: skip
    return Counter(row for row in models.tolist() if row >= 0)
