"""What a physics scene says of the World: gravity, time step, and the pe profile's world.

Global values are on the level of the scene, of which COLLADA allows several and pe one (thesis
4.1): several scenes go into one World with the first one's values.
"""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.links.names import c
from colladaphy.links.resource import Resource
from colladaphy.mapper import rules
from colladaphy.mapper.loading.deciding import Prefer
from colladaphy.mapper.loading.materials import MaterialTable
from colladaphy.mapper.loading.profile import first_of
from colladaphy.mapper.loading.sameness import Sameness, tolerance_of
from colladaphy.mapper.loading.tables import Tables
from colladaphy.mapper.tokens import same_token
from colladaphy.meaning.physics_rules import SEVERAL_GRAVITIES
from colladaphy.meaning.profile_rules import ENGINE_STATE, OLD_VALUE
from colladaphy.world import EngineState, World
from colladaphy_schema.physics_columns import PhysicsSceneTypeRows

__all__ = ["SceneValues", "read_scene"]

Array = NDArray[Any]


class SceneValues:
    """The values of one physics scene."""

    def __init__(self, home: Resource, ordinal: int, rows: PhysicsSceneTypeRows) -> None:
        self.home = home
        self.ordinal = ordinal
        common = rows.technique_common
        gravity, steps = common.gravity, common.time_step.value
        self.name = rows.name[0]
        self.gravity: Array = gravity.value[0] if len(gravity) else np.zeros(3)
        self.time_step = float(steps[0]) if steps is not None and len(steps) else None
        assert common.ordinals is not None
        self._common = int(common.ordinals[0]) if len(common) else ordinal
        self.fields: list[int] = []
        """The elements of the force fields that act in it."""
        for fields in (rows.instance_force_field, rows.instance_physics_model.instance_force_field):
            self.fields += [] if fields.ordinals is None else fields.ordinals.tolist()
        worlds, _ = first_of(rows, rows.technique, "world")
        self._profile = worlds if len(worlds) else None

    def apply(self, world: World, report: Resource, prefer: Prefer) -> None:
        """Give the World these values."""
        world.gravity = self.gravity
        world.time_step = self.time_step
        world.name = self.name
        kept = self._profile
        if kept is None or prefer == "common":
            return
        name, unit = kept.name[0], kept.unit[0]
        if name is not None and same_token(name, world.name):
            world.name = name
        if unit is not None and world.unit_name == "unit":
            world.unit_name = unit
        world.time = _value(kept.time, 0.0)
        world.step_count = int(_value(kept.step_count, 0))
        self._exact(world, report, kept, prefer)
        state = kept.engine_state
        if len(state):
            data = _checked(state.value[0], state.sha256[0])
            if data is None:
                report.note(ENGINE_STATE, int(state.ordinals[0]), home=self.home)
            else:
                world.engine_state = EngineState(state.engine[0], state.version[0], data)

    def _exact(self, world: World, report: Resource, kept: Any, prefer: Prefer) -> None:
        """The profile's gravity and time step, unless the common ones were edited."""
        sameness = Sameness(1, lambda row: tolerance_of(self.home, self._common))
        row = np.zeros(1, np.int64)
        if kept.gravity.present[0]:
            exact = kept.gravity.values
            if prefer == "profile" or sameness.each(row, world.gravity[None], exact)[0]:
                world.gravity = exact[0]
            else:
                report.note(OLD_VALUE, self.ordinal, "The gravity was edited.", home=self.home)
        if kept.time_step.present[0]:
            step = kept.time_step.values
            stated = world.time_step
            if prefer == "profile" or (
                stated is not None and sameness.each(row, np.array([stated]), step)[0]
            ):
                world.time_step = float(step[0])
            else:
                report.note(OLD_VALUE, self.ordinal, "The time step was edited.", home=self.home)

    def apply_pairs(self, world: World, tables: Tables, materials: MaterialTable) -> None:
        """Set what the scene overrides for pairs of materials that are in use."""
        pairs = None if self._profile is None else self._profile.pair
        if pairs is None or not len(pairs):
            return
        homes = np.full(len(pairs), tables.pool.number(self.home))
        ends = []
        for references in (pairs.first, pairs.second):
            rows, errors = tables.pool.follow(
                tables.materials, list(references), homes, pairs.ordinals, "physics_material"
            )
            for place in sorted(errors):
                tables.resource.note_broken(errors[place])
            ends.append([None if row < 0 else materials.known_id(row) for row in rows.tolist()])
        for place, (first, second) in enumerate(zip(*ends, strict=True)):
            if first is None or second is None:
                continue
            values = {}
            for name in ("restitution", "static_friction", "dynamic_friction"):
                column = getattr(pairs, name)
                if column.present[place]:
                    values[name] = float(column.values[place])
            world.set_pair(first, second, **values)

    def restore_counters(self, world: World) -> None:
        """The counters of system ids, where the stored World's were past the largest in use."""
        kept = self._profile
        if kept is None:
            return
        world.next_body_sid = max(world.next_body_sid, int(_value(kept.next_body_sid, 0)))
        world.next_joint_sid = max(world.next_joint_sid, int(_value(kept.next_joint_sid, 0)))


def _value(column: Any, default: float) -> Any:
    return column.values[0].item() if column.present[0] else default


def read_scene(home: Resource, ordinal: int) -> SceneValues:
    """The values of the physics_scene of a number."""
    rows = home.columns.rows(PhysicsSceneTypeRows, c("physics_scene"))
    assert rows.ordinals is not None
    return SceneValues(home, ordinal, rows.select(rows.ordinals == ordinal))


def apply_scenes(
    scenes: Sequence[SceneValues], world: World, report: Resource, prefer: Prefer
) -> None:
    """Give the World the values of the scenes that are loaded into it: those of the first."""
    for place, scene in enumerate(scenes):
        if scene.fields:
            message = f"{len(scene.fields)} force fields of the scene are not in the World."
            report.note(rules.FORCE_FIELD, min(scene.fields), message, home=scene.home)
        if place == 0:
            scene.apply(world, report, prefer)
            continue
        first = scenes[0]
        same = scene.time_step == first.time_step
        if not (same and np.array_equal(scene.gravity, first.gravity)):
            report.note(SEVERAL_GRAVITIES, scene.ordinal, home=scene.home)


def _checked(text: str, checksum: str) -> bytes | None:
    try:
        data = base64.b64decode("".join(text.split()), validate=True)
    except ValueError:  # not Base64, or not even ASCII
        return None
    return data if hashlib.sha256(data).hexdigest() == checksum.lower() else None
