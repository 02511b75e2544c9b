"""What engines cost: ``python -m tools.bench.engines [contacts setup steering trajectory]``.

A table for each: a step of a heap of spheres by MuJoCo's solvers; setting up scenes of many bodies
and of many materials; a step that is steered against a free one; records on disk and in memory.
(`tools.bench.checkpoint` measures checkpoints.) Times vary with the machine.
"""

from __future__ import annotations

import sys
import tempfile
import tracemalloc
from collections.abc import Callable
from pathlib import Path
from time import perf_counter, process_time

import numpy as np

from colladaphy.engines import Simulation, Trajectory, ZarrTrajectory, create_engine
from colladaphy.world import BodyColumns, Kind, World
from tools.bench.checkpoint import pile


def heap(count: int, materials: int = 1) -> World:
    """Spheres that fall onto the ground between four walls."""
    world = World((0, 0, -9.81), time_step=1 / 240)
    ids = []
    for i in range(materials):
        made = world.create_material(
            f"m{i}", density=1000, restitution=0.3, static_friction=0.1 + 0.4 * i / materials,
            dynamic_friction=0.1 + 0.4 * i / materials, poisson_ratio=0.3, young_modulus=1,
            stiffness=1, damping_normal=0, damping_tangential=0,
        )  # fmt: skip
        ids.append(made.id)
    side = round(count ** (1 / 3) + 0.4999)
    reach = 1.02 * side + 0.2
    world.create_plane(1, (0, 0, 1), 0, "m0")
    for normal, off in (
        ((1, 0, 0), -0.2), ((-1, 0, 0), -reach), ((0, 1, 0), -0.2), ((0, -1, 0), -reach),
    ):  # fmt: skip
        world.create_plane(1, normal, off, "m0")
    grid = np.stack(np.meshgrid(*[np.arange(side)] * 3), axis=-1).reshape(-1, 3)[:count]
    place = 1.02 * grid + 0.5 + np.random.default_rng(1).uniform(-0.01, 0.01, (count, 3))
    world.extend(
        BodyColumns(
            kinds=np.full(count, Kind.SPHERE), positions=place,
            dimensions=np.tile([0.5, 0, 0, 0], (count, 1)),
            material_ids=np.array(ids)[np.arange(count) % materials],
        )
    )  # fmt: skip
    return world


def spent(action: Callable[[], object]) -> float:
    """Seconds of the processor that one call takes."""
    start = process_time()
    action()
    return process_time() - start


def contacts() -> None:
    """Heaps of spheres, after a second of falling together."""
    print("| spheres | solver | ms a step | contacts | largest overlap |\n|-|-|-|-|-|")
    for count, solver in ((216, "newton"), (216, "cg"), (512, "cg"), (1000, "cg")):
        simulation = Simulation(heap(count), create_engine("mujoco", solver=solver))
        simulation.run(240)
        steps = 20 if solver == "newton" else 60
        seconds = spent(lambda run=simulation.run, steps=steps: run(steps)) / steps
        found = simulation.contacts()
        deepest = -min(contact.distance for contact in found)
        print(f"| {count} | {solver} | {1e3 * seconds:.1f} | {len(found)} | {deepest:.4f} |")


def setup() -> None:
    """Until the first step can be done."""
    print("| engine | bodies | materials | s |\n|-|-|-|-|")
    for name, count, materials in (
        ("mujoco", 1000, 1), ("mujoco", 2000, 2000), ("mujoco", 4000, 1), ("mujoco", 10_000, 1),
        ("pymunk", 1000, 1), ("pymunk", 10_000, 1),
    ):  # fmt: skip
        world = pile(count) if name == "pymunk" else heap(count, materials)
        seconds = spent(lambda world=world, name=name: Simulation(world, name))
        print(f"| {name} | {count} | {materials} | {seconds:.2f} |")


def steering() -> None:
    """Falling bodies, so that forces change nothing in what a step has to solve."""
    print("| engine | bodies | free step, ms | with forces=… | run(1) with forces |\n|-|-|-|-|-|")
    for name in ("pymunk", "mujoco"):
        for count in (10, 100, 1000):
            world = World((0, 0, -9.81), time_step=1 / 240)
            for i in range(count):
                world.create_sphere(i, (2.0 * i, 0, 0), 0.5, "oak")
            engine = create_engine(name)

            def push(seen: World, _: float = 0.0) -> None:
                seen.forces[:, 0] = 1e-6

            free = Simulation(world, engine)
            free.run(5)
            times = [spent(lambda run=free.run: run(100)) / 100]
            steered = Simulation(world, engine, forces=push)
            steered.run(5)
            times.append(spent(lambda run=steered.run: run(100)) / 100)
            single = Simulation(world, engine)

            def singly(single: Simulation = single, world: World = world) -> None:
                for _ in range(100):
                    push(world)
                    single.run(1)

            times.append(spent(singly) / 100)
            print(f"| {name} | {count} | " + " | ".join(f"{1e3 * t:.3f}" for t in times) + " |")


def trajectory() -> None:
    """300 records of 10,000 bodies."""
    print("| trajectory | s | MB in memory | MB on disk |\n|-|-|-|-|")
    world = heap(10_000)
    with tempfile.TemporaryDirectory() as folder:
        stream, kept = ZarrTrajectory(Path(folder) / "t.zarr"), Trajectory(Path(folder) / "t.npz")
        for name, observer, finish in (
            ("zarr", stream, stream.close), ("npz", kept, kept.save_again),
        ):  # fmt: skip
            tracemalloc.start()
            start = perf_counter()
            for step in range(300):
                world.step_count = step
                observer(world)
            finish()
            seconds, peak = perf_counter() - start, tracemalloc.get_traced_memory()[1]
            tracemalloc.stop()
            files = [path for path in Path(folder).rglob("*") if path.is_file()]
            size = sum(path.stat().st_size for path in files if f"t.{name}" in str(path))
            print(f"| {name} | {seconds:.1f} | {peak / 1e6:.0f} | {size / 1e6:.0f} |")


TABLES = {"contacts": contacts, "setup": setup, "steering": steering, "trajectory": trajectory}


def main(arguments: list[str]) -> int:
    """Print the tables named, or all."""
    for name in arguments or TABLES:
        print(f"\n{name}\n")
        TABLES[name]()
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
