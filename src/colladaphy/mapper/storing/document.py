"""A World as the columns of a document: COLLADA 1.5, valid and deterministic (thesis 5.4)."""

from __future__ import annotations

import base64
import hashlib
import re
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.mapper.options import WriteOptions
from colladaphy.mapper.storing.arrangement import Arrangement, arrange, kept_names
from colladaphy.mapper.storing.bodies import rigid_bodies
from colladaphy.mapper.storing.instances import instances_of, nodes_of
from colladaphy.mapper.storing.joints import (
    Joints,
    arrange_joints,
    constraint_instances,
    constraints_of,
)
from colladaphy.mapper.storing.kinematics import add_kinematics
from colladaphy.mapper.storing.leaves import Leaves
from colladaphy.mapper.storing.materials import materials_of, pairs_of
from colladaphy.mapper.storing.meshes import geometries_of
from colladaphy.mapper.storing.rows import labelled, technique
from colladaphy.mapper.storing.shapes import NO_SHAPE, shapes_of, tessellated
from colladaphy.mapper.storing.tree import Tree
from colladaphy.world.columns import BODY_FIELDS
from colladaphy.world.kinds import Kind
from colladaphy.world.masses import distinct
from colladaphy_schema import document_columns as document
from colladaphy_schema import pe_columns as pe
from colladaphy_schema import physics_columns as physics
from colladaphy_schema import scene_columns as scene
from colladaphy_schema.core_columns import (
    AssetTypeContributorRows,
    AssetTypeRows,
    AssetTypeUnitRows,
    InstanceWithExtraTypeRows,
    TargetableFloat3TypeRows,
    TargetableFloatTypeRows,
    TechniqueTypeRows,
)
from colladaphy_schema.geometry_library_columns import LibraryGeometriesTypeRows

if TYPE_CHECKING:
    from colladaphy.world import Mesh, World

__all__ = ["columns_of", "motion_columns", "world_columns"]

Array = NDArray[Any]

_NMTOKEN = re.compile(r"[A-Za-z0-9._:-]+\Z")


def columns_of(world: World, options: WriteOptions | None = None) -> document.ColladaRows:
    """The World as the columns of a document that `colladaphy.columns.writing` turns into text."""
    options = options or WriteOptions()
    root = document.ColladaRows(1)
    root.version = ["1.5.0"]
    root.asset = _asset(world, options)
    arrangement = arrange(world, options)
    bodies = arrangement.bodies
    tree = Tree(world, bodies["sids"])
    leaves = Leaves(world, bodies, tree, options)
    stand_ins, meshes = tessellated(leaves) if options.tessellate else (None, [])
    _add_geometries(root, world, leaves, meshes)
    materials = _used(leaves.values["material_ids"])
    if options.materials == "all":
        materials = world.materials.ids
    if len(materials):
        library = physics.LibraryPhysicsMaterialsTypeRows(1)
        library.physics_material = materials_of(world, materials, options)
        root.library_physics_materials = library
    joints = arrange_joints(world, arrangement)
    labels = labelled("Body", bodies["sids"])
    models = _models(arrangement)
    shapes = shapes_of(world, leaves, stand_ins)
    models.rigid_body = rigid_bodies(arrangement, tree, leaves, shapes, labels, options)
    if joints.labels:
        models.rigid_constraint = constraints_of(joints, arrangement, options)
    root.library_physics_models = physics.LibraryPhysicsModelsTypeRows(1)
    root.library_physics_models.physics_model = models
    scenes = _physics_scene(world, arrangement, joints, labels, options)
    if options.profile != "none":
        scenes.technique = _world_profile(world, materials, options)
    root.library_physics_scenes = physics.LibraryPhysicsScenesTypeRows(1)
    root.library_physics_scenes.physics_scene = scenes
    _add_scene(root, world)
    if options.kinematics:
        add_kinematics(root, world)
    return root


def motion_columns(world: World, rows: Array, options: WriteOptions) -> document.ColladaRows:
    """No more than the instance_rigid_body of some rows of the bodies, in their order."""
    bodies = {name: getattr(world, name)[rows] for name in ("sids", *BODY_FIELDS)}
    arrangement = Arrangement(bodies, None, [""], np.zeros(len(rows), np.int64))
    effects = physics.InstancePhysicsModelTypeRows(1)
    effects.url = ["#Model1"]
    effects.instance_rigid_body = instances_of(
        arrangement, labelled("Body", bodies["sids"]), options
    )
    scenes = physics.PhysicsSceneTypeRows(1)
    scenes.instance_physics_model = effects
    scenes.technique_common = physics.PhysicsSceneTypeTechniqueCommonRows(1)
    return _with_scenes(world, scenes, options)


def world_columns(world: World, options: WriteOptions) -> document.ColladaRows:
    """No more than what a physics scene says itself: gravity, time step and the pe profile."""
    scenes = physics.PhysicsSceneTypeRows(1)
    scenes.name = [world.name]
    scenes.technique_common = _scene_values(world)
    materials = np.union1d(world.material_ids, world.member_columns.material_ids)
    scenes.technique = _world_profile(world, _used(materials), options)
    return _with_scenes(world, scenes, options)


def _with_scenes(
    world: World, scenes: physics.PhysicsSceneTypeRows, options: WriteOptions
) -> document.ColladaRows:
    root = document.ColladaRows(1)
    root.version = ["1.5.0"]
    root.asset = _asset(world, options)
    root.library_physics_scenes = physics.LibraryPhysicsScenesTypeRows(1)
    root.library_physics_scenes.physics_scene = scenes
    return root


def _asset(world: World, options: WriteOptions) -> AssetTypeRows:
    rows = AssetTypeRows(1)
    rows.contributor = AssetTypeContributorRows(1)
    rows.contributor.authoring_tool = ["colladaphy"]
    rows.created = rows.modified = [options.created]
    rows.title = [options.title]
    rows.unit = unit = AssetTypeUnitRows(1, origin=_Stated())
    unit.name = [world.unit_name if _NMTOKEN.match(world.unit_name) else "unit"]
    unit.meter = np.array([world.unit_meter])
    rows.up_axis = [world.up_axis]
    return rows


class _Stated:
    """Says that attributes are written though they are the default: not all readers know it."""

    def column(self, rows: Any, column: Any) -> Any:
        """Nothing beside what was assigned."""
        return None

    def children(self, rows: Any, child: Any) -> Any:
        """Nothing beside what was assigned."""
        return child.type(0, owners=len(rows))

    def stated(self, rows: Any, column: Any) -> Array:
        """Everywhere."""
        return np.ones(len(rows), np.bool_)


def _used(ids: Array) -> Array:
    """The different ids, but for -1, which is none."""
    used = distinct(ids)[0]
    return used[used >= 0]


def _add_geometries(
    root: document.ColladaRows, world: World, leaves: Leaves, meshes: list[tuple[str, Mesh]]
) -> None:
    used = _used(leaves.values["mesh_ids"]).tolist() if len(leaves) else []
    known = world.meshes
    everything = [(f"Mesh{id}", known[id]) for id in used] + meshes
    empty = bool(np.any(leaves.values["kinds"] == int(Kind.EMPTY)))
    if everything or empty:
        library = LibraryGeometriesTypeRows(1)
        library.geometry = geometries_of(everything, NO_SHAPE if empty else None)
        root.library_geometries = library


def _models(arrangement: Arrangement) -> physics.PhysicsModelTypeRows:
    count = len(arrangement.models)
    rows = physics.PhysicsModelTypeRows(count, np.zeros(count, np.int64))
    rows.id = [f"Model{number}" for number in range(1, count + 1)]
    rows.name = [name or None for name in arrangement.models]
    return rows


def _physics_scene(
    world: World,
    arrangement: Arrangement,
    joints: Joints,
    labels: list[str],
    options: WriteOptions,
) -> physics.PhysicsSceneTypeRows:
    rows = physics.PhysicsSceneTypeRows(1)
    rows.id, rows.name = ["Scene1"], [world.name]
    count = len(arrangement.models)
    effects = physics.InstancePhysicsModelTypeRows(count, np.zeros(count, np.int64))
    effects.url = [f"#Model{number}" for number in range(1, count + 1)]
    effects.instance_rigid_body = instances_of(arrangement, labels, options)
    effects.instance_rigid_constraint = constraint_instances(joints)
    rows.instance_physics_model = effects
    rows.technique_common = _scene_values(world)
    return rows


def _scene_values(world: World) -> physics.PhysicsSceneTypeTechniqueCommonRows:
    common = physics.PhysicsSceneTypeTechniqueCommonRows(1)
    common.gravity = gravity = TargetableFloat3TypeRows(1)
    gravity.value = world.gravity[None]
    if world.time_step is not None:
        common.time_step = step = TargetableFloatTypeRows(1)
        step.value = np.array([world.time_step])
    return common


def _world_profile(world: World, materials: Array, options: WriteOptions) -> TechniqueTypeRows:
    """What belongs to the whole World."""
    rows = pe.WorldRows(1)
    rows.name = kept_names([world.name])
    rows.unit = [None if _NMTOKEN.match(world.unit_name) else world.unit_name]
    if world.time.hex() != "0x0.0p+0":
        rows.time = np.array([world.time])
    if world.step_count:
        rows.step_count = np.array([world.step_count])
    tables = (world.top, world.inner), (world.joint_table,)
    next_body, next_joint = (
        max((int(table.column("sids")[-1]) for table in some if len(table)), default=0) + 1
        for some in tables
    )
    if world.next_body_sid != next_body:
        rows.next_body_sid = np.array([world.next_body_sid])
    if world.next_joint_sid != next_joint:
        rows.next_joint_sid = np.array([world.next_joint_sid])
    if options.profile == "full":
        rows.gravity = world.gravity[None]
        if world.time_step is not None:
            rows.time_step = np.array([world.time_step])
    rows.pair = pairs_of(world, materials)
    state = world.engine_state
    if state is not None:
        rows.engine_state = engine = pe.EngineStateTypeRows(1)
        engine.engine, engine.version = [state.engine], [state.version]
        engine.sha256 = [hashlib.sha256(state.data).hexdigest()]
        engine.value = [base64.b64encode(state.data).decode()]
    techniques = technique(1)
    techniques.world = rows
    return techniques


def _add_scene(root: document.ColladaRows, world: World) -> None:
    """The nodes, and the scene that puts everything into effect."""
    root.scene = effect = document.ColladaSceneRows(1)
    effect.instance_physics_scene = _instance("#Scene1")
    if len(world.sids):
        effect.instance_visual_scene = _instance("#VisualScene1")
        visual = scene.VisualSceneTypeRows(1)
        visual.id = ["VisualScene1"]
        visual.node = nodes_of(world)
        root.library_visual_scenes = scene.LibraryVisualScenesTypeRows(1)
        root.library_visual_scenes.visual_scene = visual


def _instance(url: str) -> InstanceWithExtraTypeRows:
    rows = InstanceWithExtraTypeRows(1)
    rows.url = [url]
    return rows
