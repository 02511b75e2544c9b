"""A document as a World (thesis 5.3): bodies first, then the constraints between them."""

from __future__ import annotations

import logging
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from lxml import etree

from colladaphy.document import rules as link_rules
from colladaphy.document.names import c
from colladaphy.document.poses import IDENTITY
from colladaphy.document.references import split_reference
from colladaphy.errors import DocumentError
from colladaphy.findings import Severity
from colladaphy.mapper import rules
from colladaphy.mapper.batches import Batch, assign_ids
from colladaphy.mapper.bodies import BodyInstance, BodyReader
from colladaphy.mapper.columns import RegularBodies
from colladaphy.mapper.constraints import Attached, ConstraintReader
from colladaphy.mapper.creation import create_bodies, free_ids
from colladaphy.mapper.geometries import Geometries
from colladaphy.mapper.instances import Expansion, ModelInstance
from colladaphy.mapper.materials import MaterialTable
from colladaphy.mapper.plans import Plan
from colladaphy.mapper.scene_values import apply_pairs, apply_scenes, world_profile
from colladaphy_schema.codec import paused_collector

if TYPE_CHECKING:
    from colladaphy.document import Document, Model, Prefer, Scene
    from colladaphy.world import World

__all__ = ["load"]

_log = logging.getLogger(__name__)


def load(
    document: Document,
    world: World | None = None,
    *,
    scenes: Sequence[Scene] | None = None,
    models: Sequence[Model] | None = None,
    prefer: Prefer = "newer",
    si: bool = False,
    up_axis: str | None = None,
    columns: bool = True,
) -> World:
    """Load scenes (those in effect, unless chosen) or single models into a World.

    See Document.load. A `world` that is given keeps its gravity, unit and axes; what is loaded is
    converted to them, and keeps its system ids where they are free, its order always. Without
    `columns` every body takes the slower path, which gives the same World.
    """
    from colladaphy.mapper.conversion import conversion, convert
    from colladaphy.mapper.joining import join

    before = len(document.report)
    with paused_collector():
        loader = _Loader(document, prefer, columns=columns)
        fresh = loader.load(scenes, models)
        change = conversion(document, world, si=si, up_axis=up_axis)
        if change is not None:
            convert(fresh, change)
    errors = [
        finding
        for finding in document.report.findings[before:]
        if finding.severity is Severity.ERROR
    ]
    if errors and not document.tolerant:
        raise DocumentError(errors)
    _log.info("loaded %d bodies, %d joints, %d materials from %s", len(fresh.bodies),
              len(fresh.joints), len(fresh.materials), document.file)  # fmt: skip
    if world is None:
        return fresh
    join(world, fresh, document)
    return world


class _Loader:
    def __init__(self, document: Document, prefer: Prefer, *, columns: bool) -> None:
        from colladaphy.world import World

        self._document = document
        self._prefer = prefer
        self._world: World = World(unit=document.unit, up_axis=document.up_axis)
        self._expansion = Expansion(document)
        self._geometries = Geometries(document, self._world)
        self._materials = MaterialTable(document, self._world, prefer)
        self._bodies = BodyReader(document, self._world, self._geometries, self._materials, prefer)
        self._regular: RegularBodies | None = None
        if columns and document.is_as_read:
            self._regular = RegularBodies(document, self._materials, prefer)
        self._plans: dict[tuple[ModelInstance, etree._Element], list[Plan]] = {}
        self._by_body: dict[etree._Element, list[Plan]] = {}
        self._refused: set[int] = set()

    def load(self, scenes: Sequence[Scene] | None, models: Sequence[Model] | None) -> World:
        document = self._document
        if models is not None:
            chosen = list({id(model.scene): model.scene for model in models}.values())
            elements = [(model.element, model.scene.document) for model in models]
        else:
            chosen = list(scenes) if scenes is not None else document.scenes.instantiated
            if not chosen:
                document.note(rules.NO_SCENE)
            elements = [
                (model.element, scene.document) for scene in chosen for model in scene.models
            ]
        apply_scenes(self._world, chosen, document, self._prefer)
        roots = self._expansion.expand(elements)
        everything = [model for root in roots for model in root.walk()]
        batches = [self._model(model) for model in everything]
        _log.info("read %d bodies of %d models", sum(map(len, batches)), len(roots))
        assign_ids(batches)
        self._create(batches)
        self._constrain(everything, batches)
        if self._prefer != "common":
            apply_pairs(self._world, chosen, self._materials)
        restore_counters(self._world, chosen, self._prefer)
        self._drop_unused_meshes()
        return self._world

    def _drop_unused_meshes(self) -> None:
        """Forget meshes that no body has: of skipped bodies, or in the place of primitives."""
        world = self._world
        used = {
            id for table in (world.top, world.inner) for id in table.column("mesh_ids").tolist()
        }
        for id in set(world.meshes) - used:
            del world.meshes[id]

    # --- bodies

    def _model(self, model: ModelInstance) -> Batch:
        """The bodies of a model instance: regular ones as columns, the others as plans."""
        batch = Batch(model)
        others: Iterable[tuple[int, etree._Element]]
        if self._regular is not None:
            others = self._regular.read(batch)
        else:
            others = enumerate(model.element.iterchildren(c("instance_rigid_body")))
        for place, element in others:
            plan = self._body(model, element)
            if plan is not None:
                batch.plans.append((place, plan))
        return batch

    def _create(self, batches: Sequence[Batch]) -> None:
        """Create all bodies, and forget the plans that the World refused."""
        for batch in batches:
            if not batch.extend(self._world):
                # Something in the columns cannot be: one by one it shows what.
                rows = batch.rows
                for place, sid, element in zip(
                    rows.places, batch.sids.tolist(), rows.elements, strict=True
                ):
                    plan = self._body(batch.model, element)
                    if plan is not None:
                        plan.part.sid = sid
                        batch.plans.append((place, plan))
                batch.clear()
        plans = [plan for batch in batches for _, plan in batch.plans]
        created = {id(plan) for plan in create_bodies(self._world, plans, self._document)}
        self._refused = {id(plan) for plan in plans} - created

    def _body(self, model: ModelInstance, element: etree._Element) -> Plan | None:
        try:
            body = self._rigid_body(model, element)
            pose = self._expansion.node_pose(model, element)
        except DocumentError as error:
            self._document.report.extend(error.findings)
            return None
        instance = BodyInstance(element, model.document, body, model.model_document, pose)
        plan = self._bodies.read(instance)
        if plan is not None:
            self._remember(model, body, plan)
        return plan

    def _rigid_body(self, model: ModelInstance, element: etree._Element) -> etree._Element:
        sid = element.get("body", "")
        body = self._expansion.rigid_body(model, sid)
        if body is None:
            body = model.model_document.index.within(model.model, sid)
        if body is None or body.tag != c("rigid_body"):
            message = f"The model {model.model.get('id')!r} has no rigid body {sid!r}."
            raise DocumentError(link_rules.MISSING.at(element, message, file=model.document.file))
        return body

    def _remember(self, model: ModelInstance, body: etree._Element, plan: Plan) -> None:
        self._plans.setdefault((model, body), []).append(plan)
        self._by_body.setdefault(body, []).append(plan)

    # --- constraints

    def _constrain(self, models: Sequence[ModelInstance], batches: Sequence[Batch]) -> None:
        reader = ConstraintReader(self._document, self._prefer)
        wanted = [
            (model, instance)
            for model in models
            for instance in model.element.iterchildren(c("instance_rigid_constraint"))
        ]
        if not wanted:
            return
        for batch in batches:
            for body, plan in batch.stand_ins():
                self._remember(batch.model, body, plan)
        found = []
        for model, instance in wanted:
            sid = instance.get("constraint", "")
            element = self._expansion.constraint(model, sid)
            if element is None:
                message = f"The model {model.model.get('id')!r} has no rigid constraint {sid!r}."
                self._document.note(link_rules.MISSING, instance, message, file=model.document.file)
                continue
            attached = self._attachments(model, element)
            if attached is not None:
                found.append(reader.read(element, model.model_document, attached))
        ids = free_ids([joint.sid for joint in found], ())
        for joint, id in zip(found, ids, strict=True):
            joint.sid = id
        for joint in sorted(found, key=lambda joint: joint.sid or 0):
            reader.create(self._world, joint)

    def _attachments(
        self, model: ModelInstance, element: etree._Element
    ) -> tuple[Attached, Attached] | None:
        ends: list[Attached] = []
        for name in ("ref_attachment", "attachment"):
            attachment = element.find(c(name))
            reference = None if attachment is None else attachment.get("rigid_body")
            if attachment is None or not reference:
                ends.append((None, IDENTITY))
                continue
            try:
                end = self._attached(model, attachment, reference)
            except DocumentError as error:
                self._document.report.extend(error.findings)
                return None
            if end is None or id(end[0]) in self._refused:
                message = f"The body {reference!r} was not loaded; the constraint is skipped."
                self._document.note(
                    rules.CONSTRAINT_SKIPPED, element, message, file=model.model_document.file
                )
                return None
            ends.append(end)
        return ends[0], ends[1]

    def _attached(
        self, model: ModelInstance, attachment: etree._Element, reference: str
    ) -> Attached | None:
        """The body that an attachment means, or the pose of the node; None if not loaded."""
        file, head, sids = split_reference(reference)
        where: ModelInstance | None = model
        if not file:
            path = sids if head in (".", model.model.get("id")) else [head, *sids]
            for step in path[:-1]:
                where = None if where is None else where.child(step)
            if where is not None and path:
                body = self._expansion.rigid_body(where, path[-1])
                if body is not None:
                    return self._only(self._plans.get((where, body), ()), attachment, reference)
        target = model.model_document.resolve(reference, attachment, ("rigid_body", "node"))
        if target.element.tag == c("node"):
            return None, self._document.placement.pose(target.document, target.element)
        within = [
            plan for inner in model.walk() for plan in self._plans.get((inner, target.element), ())
        ]
        plans = within or self._by_body.get(target.element, [])
        return self._only(plans, attachment, reference)

    def _only(
        self, plans: Sequence[Plan], attachment: etree._Element, reference: str
    ) -> Attached | None:
        if not plans:
            return None
        if len(plans) > 1:
            message = (
                f"The body {reference!r} is instanced {len(plans)} times in one instance of its "
                "model, so a constraint cannot tell which one is meant."
            )
            raise DocumentError(rules.BODY_TWICE.at(attachment, message, file=self._document.file))
        return plans[0], IDENTITY


def restore_counters(world: World, scenes: Sequence[Scene], prefer: Prefer) -> None:
    """The counters of system ids, where the stored World's were past the largest id in use."""
    if prefer == "common":
        return
    for scene in scenes:
        kept = world_profile(scene.element)
        if kept is not None:
            world.next_body_sid = max(world.next_body_sid, int(kept.get("next_body_sid", "0")))
            world.next_joint_sid = max(world.next_joint_sid, int(kept.get("next_joint_sid", "0")))
