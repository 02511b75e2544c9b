"""A document: what a user holds of a COLLADA file, and the ways into it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any
from weakref import WeakKeyDictionary

from lxml import etree

from colladaphy.document.adding import with_scene
from colladaphy.document.finding import find
from colladaphy.document.merge import merge
from colladaphy.document.scenes import Choosable, Model, Scene, Scenes
from colladaphy.document.values import schema_errors
from colladaphy.document.writing import Output, write_document
from colladaphy.errors import DocumentError
from colladaphy.findings import Report
from colladaphy.links import rules
from colladaphy.links.names import c
from colladaphy.links.resource import Opener, Resource
from colladaphy.mapper import Chosen, Prefer, Sofar, WriteOptions, key_of, load
from colladaphy.source import Archive
from colladaphy.world import World
from colladaphy_schema.codec import decode, encode_document, paused_collector
from colladaphy_schema.document import Collada
from colladaphy_schema.physics_columns import PhysicsSceneTypeRows

__all__ = ["Document", "Target"]

PARSER = etree.XMLParser(resolve_entities=False, no_network=True, huge_tree=True)
Content = Collada | etree._ElementTree | Resource


@dataclass(frozen=True, slots=True)
class Target:
    """What a reference leads to, and the document that holds it."""

    document: Document
    element: etree._Element


class Document(Choosable):
    """A schema-valid COLLADA 1.5 document.

    `colladaphy.read` makes one from a file; `Document(root)` makes one from the generated
    dataclasses, and `Document(tree)` from an lxml tree.
    """

    def __init__(
        self,
        content: Content,
        *,
        file: str | None = None,
        report: Report | None = None,
        opener: Opener | None = None,
        tolerant: bool = False,
        archive: Archive | None = None,
        member: str | None = None,
    ) -> None:
        self._root: Collada | None = None
        self._others: dict[int, Document] = {}
        self._sofar: WeakKeyDictionary[World, Sofar] = WeakKeyDictionary()
        if isinstance(content, Resource):
            self._resource = content
            self._is_shown = False
        elif isinstance(content, Collada):
            tree = etree.ElementTree(etree.fromstring(encode_document(content).encode(), PARSER))
            self._resource = Resource(tree, file=file, report=report, opener=opener,
                                      tolerant=tolerant)  # fmt: skip
            self._root, self._is_shown = content, False
        elif isinstance(content, etree._ElementTree):
            self._resource = Resource(content, file=file, report=report, opener=opener,
                                      tolerant=tolerant)  # fmt: skip
            self._is_shown = True
        else:
            kind = type(content).__name__
            message = f"A document is made of a Collada, an lxml tree or by read(), not of {kind}."
            raise DocumentError(rules.CONTENT.at(message=message))
        self.archive = archive
        """The archive that the document comes from, whose other files are kept on writing one."""
        self.member = member
        """The name of the document in its archive."""

    @property
    def file(self) -> str | None:
        """The name of the file, for messages."""
        return self._resource.file

    @property
    def related(self) -> list[str]:
        """The files of other documents that references in this one were followed to."""
        family = self._resource.family  # in which "" is a state of this document itself
        others = (other for key, other in family.items() if key and other is not self._resource)
        return sorted({other.file or "?" for other in others} - {self.file or ""})

    @property
    def tolerant(self) -> bool:
        """Whether references that lead nowhere are only reported, not refused."""
        return self._resource.tolerant

    @property
    def report(self) -> Report:
        """Everything that was found, changed or assumed about this document so far."""
        return self._resource.report

    # --- its content

    @property
    def tree(self) -> etree._ElementTree:
        """The document as an lxml tree, with the edits made to `root`; it may be edited too.

        Raises SchemaError where `root` has values that XML or the schema cannot hold.
        """
        tree = self._merged().tree
        self._is_shown = True
        return tree

    @property
    def root(self) -> Collada:
        """The document as generated dataclasses; what is edited there is written.

        Raises SchemaError where a number lacks the digits of its exponent (``1e``).
        """
        if self._root is None:
            with schema_errors(self._resource), paused_collector():
                self._root = decode(self._resource.tree.getroot(), Collada)
        return self._root

    def _merged(self) -> Resource:
        """The resource with the edits made to `root`."""
        if self._root is not None:
            with schema_errors(self._resource):
                tree = merge(self._resource.tree, self._root)
            if tree is not self._resource.tree:
                self._resource = self._resource.with_tree(tree)
        return self._resource

    def _current(self) -> Resource:
        """The resource as it is now, also after edits of the tree."""
        resource = self._merged()
        return resource.with_tree(resource.tree) if self._is_shown else resource

    def _replace(self, tree: etree._ElementTree) -> None:
        self._resource = self._resource.with_tree(tree)
        self._root, self._is_shown = None, False

    @property
    def unit(self) -> tuple[str, float]:
        """Name and length in metres of the document's unit of length."""
        with schema_errors(self._resource):
            return self._current().unit

    @property
    def up_axis(self) -> str:
        """X_UP, Y_UP (the default) or Z_UP."""
        return self._current().up_axis

    @property
    def scenes(self) -> Scenes:
        """The physics scenes, to be chosen from."""
        return Scenes(self, self._current())

    def find(self, reference: str) -> Any:
        """The dataclass in `root` that a reference such as ``#id`` or ``#id/sid`` leads to.

        Raises DocumentError where there is none.
        """
        return find(self.root, reference, self.file)

    def resolve(
        self, reference: str, origin: etree._Element, expected: str | tuple[str, ...] = ()
    ) -> Target:
        """The element that a reference at an element of `tree` leads to, here or elsewhere.

        Raises DocumentError where it leads nowhere or to an element that is not `expected`.
        """
        resource = self._current()
        target, number = resource.follow(reference, resource.number(origin), expected)
        if target is resource:
            return Target(self, target.element(number))
        if id(target) not in self._others:
            self._others[id(target)] = Document(target, archive=self.archive, member=target.member)
        return Target(self._others[id(target)], target.element(number))

    # --- Worlds

    def load(
        self,
        world: World | None = None,
        *,
        scenes: Iterable[Scene | str] | None = None,
        prefer: Prefer = "newer",
        si: bool = False,
        up_axis: str | None = None,
    ) -> World:
        """Load the instantiated scenes, or the chosen ones, into a World.

        Values stay in the document's unit and axes, unless `si` asks for metres or `up_axis` for
        another one; a `world` that is given keeps its own. `prefer` decides where the pe profile
        and the common profile differ: the newer of the two (thesis 6.2.1), or always
        one of them. What was skipped or assumed is added to `report`. Raises DocumentError where
        references make no sense; a document that was read with repair leaves out what they
        concern, and reports it. Raises SchemaError where a number lacks the digits of its exponent.
        """
        known = self.scenes
        chosen = known.instantiated
        if scenes is not None:
            chosen = [known[scene] if isinstance(scene, str) else scene for scene in scenes]
        models = [model for scene in chosen for model in scene.models]
        return self.load_chosen(chosen, models, world, prefer=prefer, si=si, up_axis=up_axis)

    def load_chosen(
        self, scenes: Iterable[Scene], models: Iterable[Model], world: World | None, **options: Any
    ) -> World:
        """Load models of scenes; what `Scene.load` and `Model.load` do."""
        scenes, models = list(scenes), list(models)
        resource = scenes[0].root if scenes else self._current()
        chosen = _chosen(scenes, models)
        sofar, before = Sofar(), []
        if world is not None and world in self._sofar:
            known = self._sofar[world]
            # A model that is loaded again has nothing to do with what was loaded before.
            if known.bodies.keys().isdisjoint(map(key_of, chosen.models)):
                sofar = known
                every = [(model.scene.resource, model.number)
                         for scene in Scenes(self, resource) for model in scene.models]  # fmt: skip
                before = [model for model in every if key_of(model) in known.bodies]
        with schema_errors(resource):
            made = load(resource, chosen, world, sofar=sofar, before=before, **options)
        self._sofar[made] = sofar
        return made

    def add_scene(self, world: World, id: str, *, options: WriteOptions | None = None) -> Scene:
        """Store a World as one more physics scene, which is instantiated; all else is kept.

        `root` has to be taken anew afterwards. Raises DocumentError where the id is in use, or
        the World's unit or up axis is not the document's.
        """
        tree = self._merged().tree
        self._same_unit(world)
        self._replace(with_scene(tree, world, id, options))
        return self.scenes[id]

    def update(self, world: World, *, scenes: Iterable[Scene | str] | None = None) -> None:
        """Write a World that was loaded from this document back into it; all else is kept.

        Poses, velocities and changed values of bodies and joints are set where they stand, bodies
        and joints that are gone are taken out, new ones are added, and gravity, time step, clock
        and an engine's state go to the first of the scenes; `scenes` are those that the World was
        loaded from, where these are not the instantiated ones. Nodes that a body is bound to are
        moved with all that is in them. What is read back equals the World to the last bit; where
        it cannot, and where a body needed a node or a model of its own, `report` says so.

        `root` has to be taken anew afterwards. Raises DocumentError where the World is not of this
        document: its unit or up axis is another one.
        """
        from colladaphy.document.updating import updated  # much that only this needs

        self._same_unit(world)
        resource = self._current()
        known = Scenes(self, resource)
        chosen = known.instantiated
        if scenes is not None:
            chosen = [known[scene] if isinstance(scene, str) else scene for scene in scenes]
        order = {(scene.resource.file, scene.number): place for place, scene in enumerate(known)}
        keys = [(scene.resource.file, scene.number) for scene in chosen]
        places = [order[key] for key in keys if key in order]

        def choose(version: Resource) -> Chosen:
            found = Scenes(self, version)
            taken = [found[place] for place in places] if places else found.instantiated
            return _chosen(taken, [model for scene in taken for model in scene.models])

        with schema_errors(resource):
            tree = updated(resource, choose, world)
        if tree is not None:
            self._replace(tree)

    def _same_unit(self, world: World) -> None:
        mine, given = (self.unit[1], self.up_axis), (world.unit_meter, world.up_axis)
        if mine != given:
            message = f"The World has unit and up axis {given}, the document {mine}."
            raise DocumentError(rules.UNIT.at(message=message, file=self.file))

    def write(self, target: Output, *, check: bool = True) -> None:
        """Write the document, checked and atomically, to a .dae, a .zae or a binary file object.

        Raises SchemaError where it is not valid, DocumentError where `validate` finds that what it
        means is wrong, and OutputError. Documents read with repair are written with what could not
        be mended; without `check`, others are too.
        """
        write_document(
            self._current(), target, self.archive, self.member, check and not self.tolerant
        )

    def __repr__(self) -> str:
        scenes = self._resource.columns.rows(PhysicsSceneTypeRows, c("physics_scene"))
        ids = [id or "without id" for id in scenes.id]
        found = f"physics scenes {', '.join(ids)}" if ids else "no physics scenes"
        return f"<Document {self.file or 'in memory'}: {found}; {len(self.report)} findings>"


def _chosen(scenes: Iterable[Scene], models: Iterable[Model]) -> Chosen:
    return Chosen(
        [(scene.resource, scene.number) for scene in scenes],
        [(model.scene.resource, model.number) for model in models],
    )
