"""Real robots: the joints of their files, and that they rest."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from lxml import etree

import colladaphy
from colladaphy.cli import run
from colladaphy.engines import create_engine
from colladaphy.links.names import COLLADA
from colladaphy.world import JointKind, World, compare

CORPUS = Path(__file__).parents[4] / "shared" / "corpus"

pytestmark = pytest.mark.skipif(
    not CORPUS.is_dir() and "CI" not in os.environ, reason="the corpus of real files is not here"
)


def load(name: str) -> World:
    return colladaphy.read(CORPUS / name, repair=True).load()


# As the articulated system has them, where the joint itself says something else.
_BAXTER = {
    "left_s0": (-97.5, 97.5), "left_s1": (-123.0, 60.0), "left_e0": (-175.0, 175.0),
    "left_e1": (-2.865, 150.0), "left_w0": (-175.268, 175.268), "left_w1": (-90.0, 120.0),
    "left_w2": (-175.268, 175.268), "left_torso_arm_mount": (0.0, 0.0), "left_hand": (0.0, 0.0),
    "left_endpoint": (0.0, 0.0),
}  # fmt: skip
_KR10 = {
    "fixed": (0.0, 0.0), "joint_a1": (-170.0, 170.0), "joint_a2": (-190.0, 45.0),
    "joint_a3": (-120.0, 156.0), "joint_a4": (-185.0, 185.0), "joint_a5": (-120.0, 120.0),
    "joint_a6": (-350.0, 350.0),
}  # fmt: skip


@pytest.mark.parametrize(
    ("name", "limits", "bodies"),
    [("openrave-baxter-arm-left.dae", _BAXTER, 10), ("urdf-kr10.dae", _KR10, 7)],
)
def test_it_has_the_joints_and_limits_of_its_file(
    name: str, limits: dict[str, tuple[float, float]], bodies: int
) -> None:
    world = load(name)
    assert len(world.bodies) == bodies
    assert {joint.name for joint in world.joints} == set(limits)
    for joint in world.joints:
        ends = limits[joint.name or ""]
        found = np.degrees([joint.angular_min[2], joint.angular_max[2]])
        assert np.allclose(found, ends, atol=1e-9)
        assert joint.kind is (JointKind.HINGE if any(ends) else JointKind.FIXED)


def test_links_have_the_masses_inertias_and_poses_of_the_file() -> None:
    world = load("urdf-kr10.dae")
    masses = {body.name: body.mass for body in world.bodies}
    assert masses == {
        "base_link": 13.5, "link_1": 11.4, "link_2": 20.63, "link_3": 3.06, "link_4": 5.09,
        "link_5": 0.52, "link_6": 0.2,
    }  # fmt: skip
    link = world.bodies_by_name("link_2")[0]
    assert np.allclose(link.position, (0.025, 0, 0.4), atol=1e-12)
    assert np.allclose(
        np.linalg.eigvalsh(link.inertia), (0.1098425294476279, 2.650157470552372, 2.67), rtol=1e-12
    )


@pytest.mark.parametrize(
    "name", ["openrave-baxter-arm-left.dae", "openrave-baxter-arm-right.dae", "urdf-kr10.dae"]
)
def test_without_gravity_and_at_rest_it_rests(name: str) -> None:
    pytest.importorskip("mujoco")
    world = load(name)
    world.gravity, world.time_step = (0, 0, 0), 0.002
    before = world.positions.copy()
    engine = create_engine("mujoco")
    engine.load(world)
    engine.step(1000)
    engine.store(world)
    assert np.abs(world.linear_velocities).max() < 1e-9
    assert np.abs(world.angular_velocities).max() < 1e-9
    assert np.abs(world.positions - before).max() < 1e-9


def test_info_tells_robots_with_their_links_and_joints(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["info", str(CORPUS / "urdf-kr10.dae")]) == 0
    said = capsys.readouterr().out
    assert "robot kuka_kr10r1100sixx: links: 10, joints: 9" in said
    assert "joints: fixed 1, hinge 6" in said


def test_read_edited_and_saved_the_kinematics_stay(tmp_path: Path) -> None:
    document = colladaphy.read(CORPUS / "urdf-kr10.dae", repair=True)
    world = document.load()
    before = {name: _kept(document.tree, name) for name in _LIBRARIES}
    document.root.asset.title = "edited"
    document.write(tmp_path / "robot.dae")
    again = colladaphy.read(tmp_path / "robot.dae")
    assert {name: _kept(again.tree, name) for name in _LIBRARIES} == before
    assert compare(world, again.load()) == []


_LIBRARIES = ("kinematics_models", "articulated_systems", "kinematics_scenes", "visual_scenes")


def _kept(tree: Any, name: str) -> list[bytes]:
    found = tree.iter(f"{{{COLLADA}}}library_{name}")
    kept = [etree.tostring(library, method="c14n") for library in found]
    assert kept
    return kept
