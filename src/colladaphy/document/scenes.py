"""The physics scenes and models of a document, to choose from before loading (thesis 5.2, 5.3).

A Scene is a physics_scene and the instance_physics_scene elements that put it into effect; a
Model is a physics_model together with one instance_physics_model of it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any

from lxml import etree

from colladaphy.document import rules
from colladaphy.document.names import c
from colladaphy.document.values import schema_errors
from colladaphy.errors import DocumentError

if TYPE_CHECKING:
    from colladaphy.document.document import Document
    from colladaphy.world import World

__all__ = ["Model", "Models", "Scene", "Scenes"]

SHOWN = 10
"""How many names a message lists."""


class Model:
    """One instance of a physics model in a scene."""

    __slots__ = ("element", "scene")

    def __init__(self, scene: Scene, element: etree._Element) -> None:
        self.scene = scene
        self.element = element
        """The instance_physics_model element."""

    @property
    def url(self) -> str:
        """The reference to the physics_model."""
        return self.element.get("url", "")

    @property
    def id(self) -> str:
        """The id of the physics_model: the last part of the reference to it."""
        return self.url.rpartition("#")[2].rpartition("/")[2]

    @property
    def sid(self) -> str | None:
        """The sid of the instance."""
        return self.element.get("sid")

    @property
    def name(self) -> str | None:
        """The name of the instance."""
        return self.element.get("name")

    def load(self, world: World | None = None, **options: Any) -> World:
        """Load only this model, into `world` where one is given; options as Document.load."""
        from colladaphy.mapper import load

        with schema_errors(self.scene.document):
            return load(self.scene.document, world, models=[self], **options)

    def __repr__(self) -> str:
        bodies = sum(1 for _ in self.element.iterchildren(c("instance_rigid_body")))
        return f"<Model {self.id!r} of scene {self.scene.id!r}: {bodies} instanced bodies>"


class Models:
    """The models of a scene in document order, by id, by the sid of the instance, or by number."""

    __slots__ = ("_models", "_scene")

    def __init__(self, scene: Scene) -> None:
        self._scene = scene
        self._models = [
            Model(scene, element)
            for element in scene.element.iterchildren(c("instance_physics_model"))
        ]

    def __iter__(self) -> Iterator[Model]:
        return iter(self._models)

    def __len__(self) -> int:
        return len(self._models)

    def __contains__(self, key: object) -> bool:
        return any(key in (model, model.sid, model.id) for model in self._models)

    def __repr__(self) -> str:
        return f"<Models {_listing(model.id for model in self._models)}>"

    def __getitem__(self, key: str | int) -> Model:
        """The model; DocumentError where there is none of that name."""
        if isinstance(key, int):
            return self._models[key]
        for model in self._models:
            if key in (model.sid, model.id):
                return model
        known = _listing(model.id for model in self._models)
        message = f"The scene {self._scene.id!r} has no model {key!r}; it has {known}."
        raise DocumentError(rules.UNKNOWN_SCENE.at(message=message, file=self._scene.document.file))


class Scene:
    """A physics scene: gravity, a time step, and instances of models."""

    __slots__ = ("_models", "document", "element", "instances")

    def __init__(
        self, document: Document, element: etree._Element, instances: list[etree._Element]
    ) -> None:
        self.document = document
        self.element = element
        """The physics_scene element."""
        self.instances = instances
        """The instance_physics_scene elements that refer to it."""
        self._models: Models | None = None

    @property
    def id(self) -> str | None:
        """The id of the physics_scene."""
        return self.element.get("id")

    @property
    def name(self) -> str | None:
        """The name of the physics_scene."""
        return self.element.get("name")

    @property
    def is_instantiated(self) -> bool:
        """Whether the document's scene instances it; otherwise it is merely potential."""
        return bool(self.instances)

    @property
    def models(self) -> Models:
        """The instances of models in this scene."""
        if self._models is None:
            self._models = Models(self)
        return self._models

    def load(self, world: World | None = None, **options: Any) -> World:
        """Load this scene, into `world` where one is given; options as Document.load."""
        from colladaphy.mapper import load

        with schema_errors(self.document):
            return load(self.document, world, scenes=[self], **options)

    def __repr__(self) -> str:
        state = "instantiated" if self.is_instantiated else "not instantiated"
        return f"<Scene {self.id!r}: {len(self.models)} models, {state}>"


class Scenes:
    """The physics scenes that a document holds or instances, in document order; also by id."""

    __slots__ = ("_document", "_scenes")

    def __init__(self, document: Document) -> None:
        self._document = document
        root = document.tree.getroot()
        scenes: dict[etree._Element, Scene] = {}
        for library in root.iterchildren(c("library_physics_scenes")):
            for element in library.iterchildren(c("physics_scene")):
                scenes[element] = Scene(document, element, [])
        for effect in root.iterchildren(c("scene")):
            for instance in effect.iterchildren(c("instance_physics_scene")):
                target = document.resolve(instance.get("url", ""), instance, "physics_scene")
                scene = scenes.get(target.element)
                if scene is None:
                    scene = scenes[target.element] = Scene(target.document, target.element, [])
                scene.instances.append(instance)
        self._scenes = list(scenes.values())

    @property
    def instantiated(self) -> list[Scene]:
        """The scenes in effect."""
        return [scene for scene in self._scenes if scene.is_instantiated]

    def __iter__(self) -> Iterator[Scene]:
        return iter(self._scenes)

    def __len__(self) -> int:
        return len(self._scenes)

    def __contains__(self, key: object) -> bool:
        return any(key in (scene, scene.id) for scene in self._scenes)

    def __repr__(self) -> str:
        return f"<Scenes {_listing(scene.id for scene in self._scenes)}>"

    def __getitem__(self, key: str | int) -> Scene:
        """The scene of an id, or of a place in the order; DocumentError for an unknown id."""
        if isinstance(key, int):
            return self._scenes[key]
        for scene in self._scenes:
            if scene.id == key:
                return scene
        known = _listing(scene.id for scene in self._scenes)
        message = f"The document has no physics scene {key!r}; it has {known}."
        raise DocumentError(rules.UNKNOWN_SCENE.at(message=message, file=self._document.file))


def _listing(found: Iterable[str | None]) -> str:
    """Names for a message; no more than a few."""
    names = [repr(name) for name in found]
    shown = names[:SHOWN] + ["…"] * (len(names) > SHOWN)
    return ", ".join(shown) or "none"
