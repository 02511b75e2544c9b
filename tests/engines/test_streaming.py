"""Trajectories on disk: read by xarray, gone on with, and small in memory."""

from __future__ import annotations

import sys
import tracemalloc
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from colladaphy.engines import Engine, Simulation, Trajectory, ZarrTrajectory
from colladaphy.errors import EngineError, InputError
from colladaphy.world import BodyColumns, Kind, World

xarray = pytest.importorskip("xarray", reason="the extra zarr is tested with xarray")


def scene(count: int = 3) -> World:
    world = World((0, 0, -9.81), time_step=1 / 240)
    place = np.stack([np.arange(count) * 2.0, np.zeros(count), np.zeros(count)], axis=-1)
    world.extend(
        BodyColumns(
            kinds=np.full(count, Kind.SPHERE), positions=place,
            dimensions=np.tile([0.5, 0, 0, 0], (count, 1)),
        )
    )  # fmt: skip
    return world


def opened(folder: Path) -> Any:
    return xarray.open_zarr(folder, consolidated=False)


def test_xarray_reads_names_and_units(tmp_path: Path, engine: Engine) -> None:
    world = scene()
    world.bodies[1].name = "middle"
    kept = Trajectory()
    with ZarrTrajectory(tmp_path / "t.zarr") as stream:
        Simulation(world, engine).run(40, observers=[kept, stream], every=4)
        assert len(stream) == 11
    data = opened(tmp_path / "t.zarr")
    for name in ("positions", "orientations", "linear_velocities", "angular_velocities"):
        np.testing.assert_array_equal(data[name].values, kept.column(name))
    assert data["positions"].dims == ("time", "body", "axis")
    assert data["positions"].attrs["units"] == "m"
    assert data["angular_velocities"].attrs["units"] == "rad/s"
    np.testing.assert_array_equal(data["time"], kept.times)
    assert data["name"].values.tolist() == ["", "middle", ""]
    fallen = data["positions"].sel(axis="z", body=world.bodies[1].sid)
    assert float(fallen[-1]) == pytest.approx(-0.5 * 9.81 * (1 / 6) ** 2, rel=0.1)


def test_a_trajectory_is_gone_on_with(tmp_path: Path) -> None:
    world, folder = scene(), tmp_path / "t.zarr"
    with ZarrTrajectory(folder) as first:
        simulation = Simulation(world, "mujoco")
        simulation.run(20, observers=[first], every=5)
    with ZarrTrajectory(folder, append_until=12) as again:
        assert len(again) == 3
        simulation.run(10, observers=[again], every=5)
    assert opened(folder)["step"].values.tolist() == [0, 5, 10, 20, 25, 30]
    with pytest.raises(InputError):
        ZarrTrajectory(tmp_path / "none.zarr", append_until=3)


def test_memory_is_bounded(tmp_path: Path) -> None:
    """200 records of 5,000 bodies are 104 MB; a tenth of it is in memory at most."""
    world = scene(5000)
    with ZarrTrajectory(tmp_path / "t.zarr") as stream:
        tracemalloc.start()
        try:
            for step in range(200):
                world.step_count = step
                stream(world)
            peak = tracemalloc.get_traced_memory()[1]
        finally:
            tracemalloc.stop()
    assert peak < 25e6
    assert opened(tmp_path / "t.zarr")["positions"].shape == (200, 5000, 3)


def test_bodies_stay_the_same(tmp_path: Path) -> None:
    world = scene()
    stream = ZarrTrajectory(tmp_path / "t.zarr")
    stream(world)
    world.create_sphere(9, (9, 9, 9), 0.5, "iron")
    world.step_count = 1
    with pytest.raises(EngineError, match="engine-trajectory"):
        stream(world)


def test_without_its_library_it_says_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "zarr", None)
    with pytest.raises(EngineError, match="colladaphy\\[zarr\\]"):
        ZarrTrajectory(tmp_path / "t.zarr")
