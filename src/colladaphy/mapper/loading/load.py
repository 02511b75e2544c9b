"""Documents as a World (thesis 5.3): bodies first, then the constraints between them."""

from __future__ import annotations

import logging
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from colladaphy.errors import DocumentError
from colladaphy.findings import Finding, Severity
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
from colladaphy.mapper.loading.kinematics.joints import load_kinematics
from colladaphy.mapper.loading.loaded import Loaded
from colladaphy.mapper.loading.materials import MaterialTable
from colladaphy.mapper.loading.meshes import Geometries
from colladaphy.mapper.loading.scenes import apply_scenes, read_scene
from colladaphy.mapper.loading.sofar import Late, Sofar, are_waiting, key_of
from colladaphy.mapper.loading.tables import Tables
from colladaphy.world import World
from colladaphy_schema.codec import paused_collector

__all__ = ["Chosen", "Loaded", "load", "trace"]

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
    sofar: Sofar | None = None,
    before: Sequence[tuple[Resource, int]] = (),
) -> World:
    """Load scenes or single models into a World; see `colladaphy.document.Document.load`.

    A `world` that is given keeps its gravity, unit and axes; what is loaded is converted to them,
    and keeps its system ids where they are free, its order always. `sofar` says what it has of the
    document, and is told what it gets; `before` are the models that it has.
    """
    noted = len(resource.report)
    # Numbers too large for arithmetic are told from what becomes of them.
    with paused_collector(), np.errstate(all="ignore"):
        loaded, again = _loaded(resource, chosen, prefer), False
        if sofar is not None:
            whole = _with_those_before(resource, chosen, prefer, sofar, before, noted)
            loaded, again = (loaded, False) if whole is None else (whole, True)
        fresh = loaded.world
        change = conversion(resource, world, si=si, up_axis=up_axis)
        if change is not None:
            convert(fresh, change)
    errors = [
        finding
        for finding in resource.report.findings[noted:]
        if finding.severity is Severity.ERROR
    ]
    if errors and not resource.tolerant:
        raise DocumentError(errors)
    _log.info("loaded %d bodies, %d joints, %d materials from %s", len(fresh.bodies),
              len(fresh.joints), len(fresh.materials), resource.file)  # fmt: skip
    models = [key_of(model) for model in chosen.models]
    late = None
    if again and sofar is not None:
        earlier = [key_of(model) for model in before]
        late, models = Late(loaded, earlier, sofar), [*earlier, *models]
        _drop_unused_meshes(fresh)
    ids = None if world is None else join(world, fresh, resource)
    if late is not None and world is not None and ids is not None:
        late.add(world, ids, resource)
    if sofar is not None:
        sofar.add(loaded, models, ids)
    return fresh if world is None else world


def _with_those_before(
    resource: Resource, chosen: Chosen, prefer: Prefer, sofar: Sofar,
    before: Sequence[tuple[Resource, int]], noted: int,
) -> Loaded | None:  # fmt: skip
    """Models together with those of before, where joints wait for bodies; None where none do.

    What is noticed of them takes the place of all after the first `noted`, but is not said twice.
    """
    findings = resource.report.findings
    sofar.is_waiting |= are_waiting(findings[noted:])
    if not (before and sofar.is_waiting):
        return None
    del findings[noted:]
    loaded = _loaded(resource, Chosen(chosen.scenes, [*before, *chosen.models]), prefer)
    fresh = findings[noted:]
    sofar.is_waiting = are_waiting(fresh)
    known = {_said(finding) for finding in findings[:noted]}
    findings[noted:] = [finding for finding in fresh if _said(finding) not in known]
    return loaded


def _said(finding: Finding) -> tuple[str, str, str | None, int | None]:
    return finding.code, finding.message, finding.file, finding.line


def trace(resource: Resource, chosen: Chosen, prefer: Prefer = "newer") -> Loaded:
    """The World of a document in its own unit and axes, and where everything in it stands.

    What is noticed is in the resource's report; nothing is refused.
    """
    with paused_collector(), np.errstate(all="ignore"):
        return _loaded(resource, chosen, prefer)


def _loaded(resource: Resource, chosen: Chosen, prefer: Prefer) -> Loaded:
    if not chosen.scenes:
        resource.note(rules.NO_SCENE)
    world = World(unit=resource.unit, up_axis=resource.up_axis)
    scenes = [read_scene(home, ordinal) for home, ordinal in chosen.scenes]
    apply_scenes(scenes, world, resource, prefer)
    tables = Tables(resource)
    numbers = [tables.pool.number(home) for home, _ in chosen.models]
    homes = np.array(numbers, np.int64)
    ordinals = np.array([ordinal for _, ordinal in chosen.models], np.int64)
    roots = np.full(len(homes), -1)
    for home in np.unique(homes).tolist():
        mine = homes == home
        roots[mine] = tables.model_instances.rows_of(home, ordinals[mine])
    expansion = expand(tables, roots)
    found = find_bodies(tables, expansion)
    _log.info("read %d bodies of %d models", len(found), len(roots))
    materials = MaterialTable(tables, world, prefer)
    geometries = Geometries(tables, world)
    loaded = load_bodies(tables, found, world, materials, geometries, prefer)
    assign_ids(loaded.parts)
    created = create_bodies(tables, loaded, world)
    joints = load_joints(tables, expansion, loaded, created, world, prefer)
    driven = load_kinematics(tables, found, loaded, created, world)
    if prefer != "common":
        for scene in scenes:
            scene.apply_pairs(world, tables, materials)
            scene.restore_counters(world)
    _drop_unused_meshes(world)
    return Loaded(world, tables, expansion, loaded, created, joints, driven, materials, geometries,
                  roots)  # fmt: skip


def _drop_unused_meshes(world: World) -> None:
    """Forget meshes that no body has: of skipped bodies, or in the place of primitives."""
    if not world.meshes:
        return
    used = set(np.unique(world.mesh_ids).tolist())
    used |= set(np.unique(world.member_columns.mesh_ids).tolist())
    for id in set(world.meshes) - used:
        del world.meshes[id]
