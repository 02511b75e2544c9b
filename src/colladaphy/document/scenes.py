"""The physics scenes and models of a document, to choose from before loading (thesis 5.2, 5.3).

A Scene is a physics_scene and the instance_physics_scene elements that put it into effect; a
Model is a physics_model together with one instance_physics_model of it.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
from lxml import etree

from colladaphy.errors import DocumentError
from colladaphy.links import rules
from colladaphy.links.names import c
from colladaphy.links.pool import Pool, is_unreachable
from colladaphy.links.resource import Resource
from colladaphy.world import World
from colladaphy_schema.document_columns import ColladaSceneRows
from colladaphy_schema.physics_columns import InstancePhysicsModelTypeRows, PhysicsSceneTypeRows

__all__ = ["Choosable", "Model", "Models", "Scene", "Scenes"]

SHOWN = 10
"""How many names a message lists."""


class Choosable:
    """What scenes and models are chosen from, and loaded by."""

    @abstractmethod
    def load_chosen(
        self, scenes: Iterable[Scene], models: Iterable[Model], world: World | None, **options: Any
    ) -> World:
        """Load models of scenes."""


class Model:
    """One instance of a physics model in a scene."""

    __slots__ = ("_row", "_rows", "number", "scene")

    def __init__(self, scene: Scene, rows: InstancePhysicsModelTypeRows, row: int) -> None:
        self.scene = scene
        self._rows = rows
        self._row = row
        assert rows.ordinals is not None
        self.number = int(rows.ordinals[row])
        """The number of the instance_physics_model among the elements of its document."""

    @property
    def element(self) -> etree._Element:
        """The instance_physics_model element."""
        return self.scene.resource.element(self.number)

    @property
    def url(self) -> str:
        """The reference to the physics_model."""
        return self._rows.url[self._row]

    @property
    def id(self) -> str:
        """The id of the physics_model: the last part of the reference to it."""
        return self.url.rpartition("#")[2].rpartition("/")[2]

    @property
    def sid(self) -> str | None:
        """The sid of the instance."""
        return self._rows.sid[self._row]

    @property
    def name(self) -> str | None:
        """The name of the instance."""
        return self._rows.name[self._row]

    @property
    def body_count(self) -> int:
        """How many rigid_bodies the instance instances itself."""
        return int(self._rows.instance_rigid_body.counts()[self._row])

    @property
    def constraint_count(self) -> int:
        """How many rigid_constraints the instance instances itself."""
        return int(self._rows.instance_rigid_constraint.counts()[self._row])

    def load(self, world: World | None = None, **options: Any) -> World:
        """Load only this model, into `world` where one is given; options as Document.load."""
        return self.scene.document.load_chosen([self.scene], [self], world, **options)

    def __repr__(self) -> str:
        return f"<Model {self.id!r} of scene {self.scene.id!r}: {self.body_count} instanced bodies>"


class Models:
    """The models of a scene in document order, by id, by the sid of the instance, or by number."""

    __slots__ = ("_models", "_scene")

    def __init__(self, scene: Scene, rows: InstancePhysicsModelTypeRows) -> None:
        self._scene = scene
        self._models = [Model(scene, rows, row) for row in range(len(rows))]

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
        raise DocumentError(rules.UNKNOWN_SCENE.at(message=message, file=self._scene.resource.file))


class Scene:
    """A physics scene: gravity, a time step, and instances of models."""

    __slots__ = ("_models", "_rows", "document", "instances", "number", "resource", "root")

    def __init__(
        self,
        document: Choosable,
        root: Resource,
        resource: Resource,
        rows: PhysicsSceneTypeRows,
        instances: list[int],
    ) -> None:
        self.document = document
        self.root = root
        """The document that instances the scene, as it was when the scene was looked for."""
        self.resource = resource
        """The document that holds the scene."""
        self._rows = rows
        assert rows.ordinals is not None
        self.number = int(rows.ordinals[0])
        """The number of the physics_scene among the elements of its document."""
        self.instances = instances
        """The numbers of the instance_physics_scene elements that refer to it."""
        self._models: Models | None = None

    @property
    def element(self) -> etree._Element:
        """The physics_scene element."""
        return self.resource.element(self.number)

    @property
    def id(self) -> str | None:
        """The id of the physics_scene."""
        return self._rows.id[0]

    @property
    def name(self) -> str | None:
        """The name of the physics_scene."""
        return self._rows.name[0]

    @property
    def gravity(self) -> list[float] | None:
        """The gravity that the scene states."""
        gravity = self._rows.technique_common.gravity
        return gravity.value[0].tolist() if len(gravity) else None

    @property
    def time_step(self) -> float | None:
        """The time step that the scene asks for."""
        step = self._rows.technique_common.time_step
        return float(step.value[0]) if len(step) else None

    @property
    def is_instantiated(self) -> bool:
        """Whether the document's scene instances it; otherwise it is merely potential."""
        return bool(self.instances)

    @property
    def models(self) -> Models:
        """The instances of models in this scene."""
        if self._models is None:
            self._models = Models(self, self._rows.instance_physics_model)
        return self._models

    def load(self, world: World | None = None, **options: Any) -> World:
        """Load this scene, into `world` where one is given; options as Document.load."""
        return self.document.load_chosen([self], self.models, world, **options)

    def __repr__(self) -> str:
        state = "instantiated" if self.is_instantiated else "not instantiated"
        return f"<Scene {self.id!r}: {len(self.models)} models, {state}>"


class Scenes:
    """The physics scenes that a document holds or instances, in document order; also by id."""

    __slots__ = ("_resource", "_scenes")

    def __init__(self, document: Choosable, resource: Resource) -> None:
        self._resource = resource
        pool = Pool(resource)
        table = pool.table(PhysicsSceneTypeRows, c("physics_scene"))
        effects = resource.columns.rows(ColladaSceneRows, c("scene")).instance_physics_scene
        ordinals = effects.ordinals
        assert ordinals is not None
        targets, errors = pool.follow(
            table, list(effects.url), np.zeros(len(effects), np.int64), ordinals, "physics_scene"
        )
        for place in sorted(errors):
            if not (resource.tolerant or is_unreachable(errors[place])):
                raise errors[place]
            resource.note_broken(errors[place])
        instances: dict[int, list[int]] = {row: [] for row in range(len(table.parts[0]))}
        for row, number in zip(targets.tolist(), ordinals.tolist(), strict=True):
            if row < 0:
                continue
            instances.setdefault(row, []).append(number)
        self._scenes = []
        for row, numbers in instances.items():
            home = int(table.homes(np.array([row]))[0])
            part = table.parts[home].select(np.array([row - table.start(home)]))
            self._scenes.append(Scene(document, resource, pool.resources[home], part, numbers))

    @property
    def instantiated(self) -> list[Scene]:
        """The scenes in effect, in the order in which the document's scene instances them."""
        found = [scene for scene in self._scenes if scene.is_instantiated]
        return sorted(found, key=lambda scene: scene.instances[0])

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
        raise DocumentError(rules.UNKNOWN_SCENE.at(message=message, file=self._resource.file))


def _listing(found: Iterable[str | None]) -> str:
    """Names for a message; no more than a few."""
    names = [repr(name) for name in found]
    shown = names[:SHOWN] + ["…"] * (len(names) > SHOWN)
    return ", ".join(shown) or "none"
