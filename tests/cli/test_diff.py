"""``colladaphy diff``: Worlds compared body by body, with numbers and exit codes."""

from __future__ import annotations

import io
import json
from pathlib import Path
from typing import Any

import pytest
from tests.engines.scenes import SCENES

import colladaphy
from colladaphy.cli import run
from colladaphy.world import World


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    file = tmp_path / "a.dae"
    colladaphy.write(SCENES["general"](), file)
    return file


def diff(*arguments: object) -> int:
    return run(["diff", *(str(argument) for argument in arguments)])


def changed(scene: Path, change: Any) -> Path:
    world = colladaphy.read(scene).load()
    change(world)
    file = scene.with_name("b.dae")
    colladaphy.write(world, file)
    return file


def test_equal_worlds(scene: Path, capsys: pytest.CaptureFixture[str]) -> None:
    other = changed(scene, lambda world: None)
    assert diff(scene, other) == 0
    assert capsys.readouterr().out == "Equal: 13 bodies and 7 joints.\n"
    assert diff(scene, other, "--format", "json") == 0
    assert json.loads(capsys.readouterr().out)["equal"] is True


def test_each_body_that_differs_is_shown(scene: Path, capsys: pytest.CaptureFixture[str]) -> None:
    def change(world: World) -> None:
        world.bodies[2].name = "egg"
        world.bodies[2].position = world.bodies[2].position + 0.5  # type: ignore[operator]
        world.joints[0].enabled = False
        world.materials.change("restitution", [5], [0.25])
        world.create_sphere(1, (9, 9, 9), 1, "iron")

    other = changed(scene, change)
    assert diff(scene, other) == 1
    lines = capsys.readouterr().out.splitlines()
    sid = colladaphy.read(scene).load().bodies[2].sid
    at = lines.index(f"body {sid} 'egg'")
    assert lines[at + 1].startswith("  positions: [0.4, 0.1, 2.0] | [0.9, 0.6, 2.5] (apart by 0.5")
    assert "  name: None | 'egg'" in lines
    assert "  only in B" in lines and "  enabled: True | False" in lines
    assert "material 5 'rubber'" in lines
    assert any(
        line.startswith("  restitution: 0.0 | 0.25 (apart by 0.25, 1 of it)") for line in lines
    )
    assert lines[-1].startswith(
        "Different: 2 bodies and 1 joints of 13 bodies and 7 joints, and 14"
    )
    assert diff(scene, other, "--most", 1) == 1
    out = capsys.readouterr().out
    assert "more (--most N" in out and "positions" not in out
    assert diff(scene, other, "--format", "json") == 1
    found = json.loads(capsys.readouterr().out)
    assert found["equal"] is False and found["first"] == str(scene)
    one = next(row for row in found["differences"] if row["what"] == "positions")
    assert one["kind"] == "body" and one["id"] == sid and one["apart"] == pytest.approx(0.5)
    assert one["relative"] == pytest.approx(0.2) and one["first"] == [0.4, 0.1, 2.0]


def test_what_is_not_in_the_worlds_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    world = World((0, 0, -9.81))
    world.create_sphere(1, (0, 0, 0), 1, "oak")
    one, two = tmp_path / "a.dae", tmp_path / "b.dae"
    colladaphy.write(world, one)
    field = (
        '<library_force_fields><force_field id="wind"><technique profile="x"/></force_field>'
        "</library_force_fields><library_physics_scenes>"
    )
    text = one.read_text().replace("<library_physics_scenes>", field)
    use = '<instance_force_field url="#wind"/><instance_physics_model'
    two.write_text(text.replace("<instance_physics_model", use, 1))
    assert diff(one, two) == 0
    seen = capsys.readouterr()
    assert "load-force-field" in seen.err and "b.dae" in seen.err and "Equal" in seen.out


def test_tolerances(scene: Path, capsys: pytest.CaptureFixture[str]) -> None:
    def change(world: World) -> None:
        world.positions += 1e-6
        world.orientations *= -1

    other = changed(scene, change)
    assert diff(scene, other) == 1
    assert diff(scene, other, "--atol", "1e-7") == 1
    assert diff(scene, other, "--atol", "2e-6") == 0
    assert capsys.readouterr().out.splitlines()[-1].startswith("Equal")
    assert diff(scene, other, "--rtol", "1e-9") == 1


def test_what_cannot_be_compared(
    scene: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:  # fmt: skip
    broken = tmp_path / "broken.dae"
    broken.write_text("<COLLADA/>")
    assert diff(scene, broken) == 2
    assert "broken.dae" in capsys.readouterr().err
    assert diff(scene, tmp_path / "none.dae") == 2
    assert diff(scene) == 2
    assert diff("-", "-") == 2
    assert diff(scene, scene, "--atol", "-1") == 2
    assert diff(scene, scene, "--rtol", "inf") == 2

    class Input:
        buffer = io.BytesIO(scene.read_bytes())

    monkeypatch.setattr("sys.stdin", Input())
    capsys.readouterr()
    assert diff("-", scene) == 0


def test_units_and_numbers_that_are_not_finite(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    files = []
    for number, (unit, size) in enumerate(((("meter", 1.0), 1.0), (("centimeter", 0.01), 100.0))):
        world = World(unit=unit, up_axis="Z_UP")
        body = world.create_sphere(1, (size, 0, 0), size, "iron", mass=3)
        world.attach_slider_joint(None, body, axis=(1, 0, 0))
        files.append(tmp_path / f"{number}.dae")
        colladaphy.write(world, files[-1])
    assert diff(*files) == 1
    capsys.readouterr()
    assert diff(*files, "--si", "--rtol", "1e-12") == 0
    world.joints[0].linear_max = (0, 0, 5)
    colladaphy.write(world, files[0])
    capsys.readouterr()
    assert diff(files[1], files[0], "--format", "json") == 1
    rows = json.loads(capsys.readouterr().out)["differences"]
    assert rows[0]["what"] == "linear_limits" and rows[0]["first"][1][2] == "inf"
