"""Documents as a World (thesis 5.3): bodies first, then the constraints between them."""

from __future__ import annotations

import logging
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from colladaphy.errors import DocumentError
from colladaphy.findings import Severity
from colladaphy.links.resource import Resource
from colladaphy.mapper import rules
from colladaphy.mapper.conversion import conversion, convert
from colladaphy.mapper.joining import join
from colladaphy.mapper.loading.bodies import load_bodies
from colladaphy.mapper.loading.creation import assign_ids, create_bodies
from colladaphy.mapper.loading.deciding import Prefer
from colladaphy.mapper.loading.found import find_bodies
from colladaphy.mapper.loading.instances import expand
from colladaphy.mapper.loading.joints import load_joints
from colladaphy.mapper.loading.materials import MaterialTable
from colladaphy.mapper.loading.meshes import Geometries
from colladaphy.mapper.loading.scenes import apply_scenes, read_scene
from colladaphy.mapper.loading.tables import Tables
from colladaphy.world import World
from colladaphy_schema.codec import paused_collector

__all__ = ["Chosen", "load"]

_log = logging.getLogger("colladaphy.mapper")


@dataclass(frozen=True, slots=True)
class Chosen:
    """What is loaded: scenes, and instances of models, by document and number of the element."""

    scenes: Sequence[tuple[Resource, int]]
    models: Sequence[tuple[Resource, int]]
    """The instance_physics_model elements, in the order in which they are loaded."""


def load(
    resource: Resource,
    chosen: Chosen,
    world: World | None = None,
    *,
    prefer: Prefer = "newer",
    si: bool = False,
    up_axis: str | None = None,
) -> World:
    """Load scenes or single models into a World; see `colladaphy.document.Document.load`.

    A `world` that is given keeps its gravity, unit and axes; what is loaded is converted to them,
    and keeps its system ids where they are free, its order always.
    """
    before = len(resource.report)
    # Numbers too large for arithmetic are told from what becomes of them.
    with paused_collector(), np.errstate(all="ignore"):
        fresh = _fresh(resource, chosen, prefer)
        change = conversion(resource, world, si=si, up_axis=up_axis)
        if change is not None:
            convert(fresh, change)
    errors = [
        finding
        for finding in resource.report.findings[before:]
        if finding.severity is Severity.ERROR
    ]
    if errors and not resource.tolerant:
        raise DocumentError(errors)
    _log.info("loaded %d bodies, %d joints, %d materials from %s", len(fresh.bodies),
              len(fresh.joints), len(fresh.materials), resource.file)  # fmt: skip
    if world is None:
        return fresh
    join(world, fresh, resource)
    return world


def _fresh(resource: Resource, chosen: Chosen, prefer: Prefer) -> World:
    if not chosen.scenes:
        resource.note(rules.NO_SCENE)
    world = World(unit=resource.unit, up_axis=resource.up_axis)
    scenes = [read_scene(home, ordinal) for home, ordinal in chosen.scenes]
    apply_scenes(scenes, world, resource, prefer)
    tables = Tables(resource)
    numbers = [tables.pool.number(home) for home, _ in chosen.models]
    roots = [
        tables.model_instances.row_of(number, ordinal)
        for number, (_, ordinal) in zip(numbers, chosen.models, strict=True)
    ]
    expansion = expand(tables, np.array(roots, np.int64))
    found = find_bodies(tables, expansion)
    _log.info("read %d bodies of %d models", len(found), len(roots))
    materials = MaterialTable(tables, world, prefer)
    geometries = Geometries(tables, world)
    loaded = load_bodies(tables, found, world, materials, geometries, prefer)
    assign_ids(loaded.parts)
    created = create_bodies(tables, loaded, world)
    load_joints(tables, expansion, loaded, created, world, prefer)
    if prefer != "common":
        for scene in scenes:
            scene.apply_pairs(world, tables, materials)
            scene.restore_counters(world)
    _drop_unused_meshes(world)
    return world


def _drop_unused_meshes(world: World) -> None:
    """Forget meshes that no body has: of skipped bodies, or in the place of primitives."""
    if not world.meshes:
        return
    used = set(np.unique(world.mesh_ids).tolist())
    used |= set(np.unique(world.member_columns.mesh_ids).tolist())
    for id in set(world.meshes) - used:
        del world.meshes[id]
