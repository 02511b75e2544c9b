"""Checkpoints hold all of the document that a World came from, and resumed runs go on with it."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.document.test_updating import body, find, instance, scene

import colladaphy
from colladaphy.document import Document
from colladaphy.engines import Checkpoints, Simulation
from colladaphy.world import compare


def falling() -> Document:
    """A body at a node that shows something, in a frame that is turned."""
    cameras = """<library_cameras><camera id="eye"><optics><technique_common><perspective>
      <xfov>45</xfov><znear>1</znear><zfar>9</zfar></perspective></technique_common></optics>
      </camera></library_cameras>"""
    nodes = """<node id="r"><rotate>1 0 0 30</rotate><node id="a"><translate>1 2 3</translate>
      <instance_camera url="#eye"/></node></node>"""
    return scene(nodes, body("one"), instance("one", "a"), libraries=cameras)


def test_checkpoints_hold_the_document(tmp_path: Path) -> None:
    document = falling()
    world = document.load()
    world.gravity = (0, 0, -9.81)
    run = Simulation(world, "mujoco", document=document)
    run.run(4, checkpoints=Checkpoints(tmp_path / "many"), checkpoint_every=2)
    single = run.checkpoint(tmp_path / "one.dae")
    for file in (*Checkpoints(tmp_path / "many").paths(), single):
        held = colladaphy.read(file)
        assert len(find(held, "//c:instance_camera")) == len(find(held, "//c:camera")) == 1
    assert compare(colladaphy.read(single).load(), run.world) == []


def test_resumed_runs_go_on_with_the_document(tmp_path: Path) -> None:
    document = falling()
    world = document.load()
    world.gravity = (0, 0, -9.81)
    run = Simulation(world, "mujoco", document=document)
    run.run(3)
    file = run.checkpoint(tmp_path / "one.dae")
    run.run(3)
    resumed = Simulation.resume(file)
    resumed.run(3)
    assert compare(run.world, resumed.world) == []
    held = colladaphy.read(resumed.checkpoint(tmp_path / "two.dae"))
    assert len(find(held, "//c:camera")) == 1


@pytest.mark.parametrize("folder", ["", "elsewhere"])
def test_what_refers_to_other_documents_can_be_read_from_anywhere(
    tmp_path: Path, folder: str
) -> None:
    falling().write(tmp_path / "part.dae")
    master = falling()
    tree = master.tree
    models = find(master, "//c:library_physics_models")[0]
    tree.getroot().remove(models)
    find(master, "//c:instance_physics_model")[0].set("url", "part.dae#model")
    master.write(tmp_path / "master.dae")
    document = colladaphy.read(tmp_path / "master.dae")
    run = Simulation(document.load(), "mujoco", document=document)
    assert document.related == [str(tmp_path / "part.dae")]
    run.run(2)
    checkpoints = Checkpoints(tmp_path / folder / "many")
    run.checkpoint(checkpoints)
    assert compare(checkpoints.newest().world, run.world) == []
