"""What type checkers know of a World, in a file of a user."""

from __future__ import annotations

from pathlib import Path

from mypy import api

USER = """
from typing import assert_type

import numpy as np
from numpy.typing import NDArray

from colladaphy import World
from colladaphy.world import (
    Body, BodyColumns, EngineState, Joint, JointColumns, Material, MemberColumns, Mesh
)

Floats = NDArray[np.float64]

world = World((0, 0, -9.81), unit=("foot", 0.3048), name="scene")
sphere = world.create_sphere(1, (0, 0, 1), 0.5, "iron", fixed=True, linear_velocity=[1, 2, 3])
box = world.create_box(2, np.zeros(3), (1, 2, 3), world.materials["oak"], hollow=False)
assert_type(sphere, Body)
assert_type(world.bodies[0], Body)
assert_type(world.bodies[:2], list[Body])
assert_type(list(world.bodies), list[Body])
assert_type(world.bodies_by_name("box"), list[Body])
assert_type(box.position, Floats)
assert_type(box.material, Material | None)
box.position = (1, 2, 3)
box.position = [1.5, 2, 3]
box.orientation = np.array([1.0, 0, 0, 0])
box.name = None
box.mass = 3
box.material = "oak"
box.apply_force((1, 2, 3), at=[0, 0, 0])
assert_type(box.velocity_at((1, 2, 3)), Floats)

union = world.create_union(3, [sphere, box], fixed=False, position=(0, 0, 0))
assert_type(union.members, tuple[Body, ...])
joint = world.attach_hinge_joint(union, None, axis=(0, 0, 1), limits=(-1, 1), name="hinge")
assert_type(joint, Joint)
assert_type(world.joints[0], Joint)
assert_type(world.joints[:], list[Joint])
assert_type(joint.frame1, tuple[Floats, Floats])
assert_type(joint.coordinates, Floats)
assert_type(world.joints_by_name("hinge"), list[Joint])
joint.angular_max = (0, 0, 2)
joint.angular_spring = None

assert_type(world.positions, Floats)
assert_type(world.uids, NDArray[np.int64])
assert_type(world.fixed, NDArray[np.bool_])
assert_type(world.kinds, NDArray[np.int8])
world.positions += (1, 0, 0)
world.positions = [[1, 2, 3]]
world.fixed = [True]
assert_type(world.time_step, float | None)
assert_type(world.name, str | None)
assert_type(world.step_count, int)
assert_type(world.engine_state, EngineState | None)
world.time_step = 0.01

assert_type(world.columns(), BodyColumns)
assert_type(world.member_columns, MemberColumns)
assert_type(world.joint_columns, JointColumns)
sids = world.extend(BodyColumns(kinds=np.zeros(3, dtype=np.int8), dimensions=np.ones((3, 4))))
assert_type(sids, NDArray[np.int64])
assert_type(world.meshes[0], Mesh)
assert_type(world.materials.ids, NDArray[np.int64])
assert_type(world.materials.values("density", sids), Floats)
"""

WRONG = {
    'world.create_sphere(1, (0, 0, 0), 1, "iron", radios=2)': "call-arg",
    'world.create_sphere("one", (0, 0, 0), 1, "iron")': "arg-type",
    "world.create_union(1, [1, 2])": "list-item",
    "world.attach_hinge_joint(None, None)": "call-arg",
    "world.destroy(3)": "arg-type",
    "world.bodies[0].position = None": "assignment",
    "world.bodies[0].volume = 3": "misc",
    "world.bodies[0].mass = '3'": "assignment",
    "world.bodies[0].apply_force((1, 0, 0), (0, 0, 0))": "call-arg",
    "world.positions = None": "assignment",
    "world.time = '3'": "assignment",
    "world.sids = [1]": "misc",
    "world.bodies[0].colour": "attr-defined",
}


def test_a_file_of_a_user(tmp_path: Path) -> None:
    right, wrong = tmp_path / "right.py", tmp_path / "wrong.py"
    right.write_text(USER)
    wrong.write_text("\n".join(["from colladaphy import World", "world = World()", *WRONG]))
    cache = f"--cache-dir={tmp_path / 'cache'}"
    output, errors, _ = api.run(["--strict", cache, str(right), str(wrong)])
    assert errors == ""
    found: dict[int, str] = {}  # the first of each line
    for line in output.splitlines():
        assert "right.py" not in line, line
        if ": error: " in line:
            found.setdefault(int(line.split(":")[1]), line.rpartition("[")[2].rstrip("]"))
    assert found == dict(enumerate(WRONG.values(), start=3)), output
