"""The instances of physics models that a scene expands to (thesis 3.3, 5.3).

Models stand in models; a model that is instanced twice is two sets of bodies. An instance can have
a parent node, whose transform all of its bodies share.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from lxml import etree

from colladaphy.document import rules as link_rules
from colladaphy.document.names import c
from colladaphy.document.poses import IDENTITY, Pose
from colladaphy.errors import DocumentError

if TYPE_CHECKING:
    from colladaphy.document import Document

__all__ = ["Expansion", "ModelInstance"]

_MOST_INSTANCES = 1_000_000


@dataclass(slots=True, eq=False)
class ModelInstance:
    """One instance_physics_model, and the physics_model that it instances."""

    element: etree._Element
    document: Document
    model: etree._Element
    model_document: Document
    parents: tuple[tuple[etree._Element, Pose], ...] = ()
    """The parent nodes of this instance and of those around it, with their world poses."""
    children: list[ModelInstance] = field(default_factory=list)

    def walk(self) -> Iterator[ModelInstance]:
        """This instance and all those within it."""
        yield self
        for child in self.children:
            yield from child.walk()

    def child(self, name: str) -> ModelInstance | None:
        """The instance within this one of a sid, or else of a model's id."""
        for child in self.children:
            if child.element.get("sid") == name:
                return child
        for child in self.children:
            if child.model.get("id") == name:
                return child
        return None


class Expansion:
    """Expands instances of models, and places the nodes that bodies target."""

    def __init__(self, document: Document) -> None:
        self._document = document
        self._count = 0
        self._bodies: dict[etree._Element, dict[str, etree._Element]] = {}
        self._constraints: dict[etree._Element, dict[str, etree._Element]] = {}

    def expand(self, elements: Iterable[tuple[etree._Element, Document]]) -> list[ModelInstance]:
        """The instances of the given instance_physics_model elements."""
        found = []
        for element, document in elements:
            instance = self._expand(element, document, (), ())
            if instance is not None:
                found.append(instance)
        return found

    def _expand(
        self,
        element: etree._Element,
        document: Document,
        parents: tuple[tuple[etree._Element, Pose], ...],
        path: tuple[etree._Element, ...],
    ) -> ModelInstance | None:
        try:
            target = document.resolve(element.get("url", ""), element, "physics_model")
            parent = (element.get("parent") or "").strip()
            if parent:
                node = document.resolve(parent, element, "node")
                pose = self._document.placement.pose(node.document, node.element)
                parents = (*parents, (node.element, pose))
        except DocumentError as error:
            self._document.report.extend(error.findings)
            return None
        if target.element in path:
            message = f"The physics model {target.element.get('id')!r} is instanced within itself."
            self._document.note(link_rules.CYCLE, element, message, file=document.file)
            return None
        self._count += 1
        if self._count > _MOST_INSTANCES:
            finding = link_rules.BUDGET.at(element, file=document.file)
            raise DocumentError(finding)
        instance = ModelInstance(element, document, target.element, target.document, parents)
        for child in target.element.iterchildren(c("instance_physics_model")):
            inner = self._expand(child, target.document, parents, (*path, target.element))
            if inner is not None:
                instance.children.append(inner)
        return instance

    def rigid_body(self, instance: ModelInstance, sid: str) -> etree._Element | None:
        """The rigid_body of a sid in the model of an instance."""
        known = self._bodies.get(instance.model)
        if known is None:
            known = self._bodies[instance.model] = _by_sid(instance.model, "rigid_body")
        # A path such as Model01/Body01 is not valid here, but the thesis writes it (listing 2).
        return known.get(sid, known.get(sid.rpartition("/")[2]))

    def constraint(self, instance: ModelInstance, sid: str) -> etree._Element | None:
        """The rigid_constraint of a sid in the model of an instance."""
        known = self._constraints.get(instance.model)
        if known is None:
            known = _by_sid(instance.model, "rigid_constraint")
            self._constraints[instance.model] = known
        return known.get(sid, known.get(sid.rpartition("/")[2]))

    def node_pose(self, instance: ModelInstance, body: etree._Element) -> Pose:
        """The world pose of the node that an instance_rigid_body targets.

        The instance's parents are applied, except where the node is below them in the scene, so
        that its own transform has them already. Raises DocumentError for a broken reference.
        """
        pose = IDENTITY
        reference = body.get("target", "").strip()
        node = None
        if reference:
            target = instance.document.resolve(reference, body, "node")
            node = target.element
            pose = self._document.placement.pose(target.document, node)
        for parent, outer in reversed(instance.parents):
            if node is not None and self._document.placement.is_within(node, parent):
                return pose
            pose = outer.then(pose)
        return pose


def _by_sid(model: etree._Element, name: str) -> dict[str, etree._Element]:
    found: dict[str, etree._Element] = {}
    for element in model.iterchildren(c(name)):
        found.setdefault(element.get("sid", ""), element)
    return found
