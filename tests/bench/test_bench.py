"""The measuring itself, on tiny sizes; nothing here depends on how fast anything is."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tools.bench import __main__ as command
from tools.bench.kinds import KINDS
from tools.bench.measuring import HEAPS, exponent, interleaved, peak_memory
from tools.bench.steps import STEPS, document, steps_of

import colladaphy


def test_the_file_is_what_it_claims_to_be() -> None:
    data = document(7)
    assert data == document(7)
    assert colladaphy.validate(data).valid
    world = colladaphy.read(data).load()
    assert len(world.bodies) == 7
    assert len({body.material.name for body in world.bodies}) == 1
    assert len({tuple(body.position) for body in world.bodies}) == 7
    assert all(any(body.linear_velocity) and any(body.angular_velocity) for body in world.bodies)


def test_every_step_is_measured_against_the_first(tmp_path: Path) -> None:
    file = tmp_path / "a.dae"
    file.write_bytes(document(3))
    timings = interleaved(file, STEPS, repeat=1)
    assert list(timings) == list(STEPS)
    assert timings["parse"].ratio == 1.0
    assert all(timing.seconds > 0 and timing.ratio > 0 for timing in timings.values())


@pytest.mark.parametrize("name", KINDS)
def test_every_kind_is_what_it_claims_to_be(name: str) -> None:
    data = document(6, name)
    assert data == document(6, name)
    assert list(colladaphy.validate(data)) == []
    world = colladaphy.read(data).load()
    assert len(world.bodies) == 6
    plain = colladaphy.read(document(6)).load()
    kinds = {body.kind.name.lower() for body in world.bodies}
    members = [member for body in world.bodies for member in body.members]
    expected = {
        "a material each": len(set(world.material_ids.tolist())) == 6,
        "an inertia each": all(np.count_nonzero(body.inertia) == 9 for body in world.bodies),
        "a shared mesh": kinds == {"mesh"} and len(world.meshes) == 1,
        "a mesh each": len(world.meshes) == 6,
        "a fixed joint each": {j.kind.name for j in world.joints} == {"FIXED"},
        "a hinge each": {joint.kind.name for joint in world.joints} == {"HINGE"},
        "unions of five": kinds == {"union"} and len(members) == 30,
        "nested unions": {body.kind.name for body in members} == {"BOX", "UNION"},
        "a model each": data.count(b"<physics_model ") == 6,
        "one comment": data.count(b"<!--") == 1,
        "one extra": data.count(b'<technique profile="x"') == 1,
        "one density": data.count(b"<density>") == 1 and data.count(b"<mass>") == 5,
        "one off centre": int(np.any(world.positions != plain.positions, axis=1).sum()) == 1,
    }
    if name in expected:
        assert expected[name]
    else:
        assert kinds == {name.removesuffix("es" if name == "boxes" else "s")}


@pytest.mark.parametrize("heap", HEAPS)
def test_kinds_are_stored_as_they_came(heap: str, tmp_path: Path) -> None:
    for name in ("a model each", "one extra"):
        file = tmp_path / "a.dae"
        file.write_bytes(document(3, name))
        timings = interleaved(file, steps_of(name), repeat=1, heap=heap, kind=name)
        steps = ["parse", "gate", "load", "schema", "validate", "store"]
        assert list(timings) == steps[: 6 if name[0] == "a" else 5]
        assert timings["parse"].ratio == 1.0


def test_the_table_of_kinds(capsys: pytest.CaptureFixture[str]) -> None:
    arguments = ["--kinds", "planes,one comment", "--bodies", "3", "--repeat", "1"]
    assert command.main(arguments) == 0
    printed = capsys.readouterr().out
    assert [line.split(" | ")[0] for line in printed.splitlines()[2:6]] == [
        "| planes", "| planes", "| one comment", "| one comment",
    ]  # fmt: skip
    assert printed.count("| – |") == 2
    with pytest.raises(SystemExit, match="no kind 'cubes', but spheres, boxes"):
        command.main(["--kinds", "cubes"])


def test_growth() -> None:
    assert exponent({10: 1.0}) is None
    assert exponent({10: 5.0, 100: 50.0, 1000: 500.0}) == pytest.approx(1.0)
    assert exponent({10: 5.0, 100: 500.0}) == pytest.approx(2.0)


def test_peak_memory_is_that_of_a_process_of_its_own(tmp_path: Path) -> None:
    file = tmp_path / "a.dae"
    file.write_bytes(document(3))
    assert 5 < peak_memory("parse", file) < 500


def test_the_table(capsys: pytest.CaptureFixture[str]) -> None:
    arguments = ["--bodies", "3,2", "--repeat", "1", "--stock-up-to", "2", "--no-memory"]
    assert command.main(arguments) == 0
    printed = capsys.readouterr().out
    assert printed.index("xsdata parse             2") < printed.index("parse                    3")
    assert "stock xsdata was measured up to 2 bodies only" in printed
    assert "exponent" in printed
