"""What a checkpoint costs, in steps: ``python -m tools.bench.checkpoint [ENGINE ...]``.

For each engine and number of bodies: the time of a step, and that of a checkpoint, of its three
parts (writing the file, starting the engine anew, proving the file whole before an older one is
removed) and of resuming, each as a multiple of a step. Times vary with the machine; the ratios
vary less.
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from time import perf_counter

import colladaphy
from colladaphy.engines import ENGINES, Checkpoints, Simulation, create_engine, read_checkpoint
from colladaphy.errors import EngineError
from colladaphy.world import World

SIZES = (10, 100, 1000)
STEPS = 20
REPEATS = 3


def pile(count: int) -> World:
    """Planar towers of ten boxes each on the ground, in contact."""
    world = World((0, 0, -9.81), time_step=1 / 240)
    world.create_plane(1, (0, 0, 1), 0, "granite")
    for number in range(count):
        tower, floor = divmod(number, 10)
        world.create_box(number, (2.0 * tower, 0, 0.5 + floor), (1, 1, 1), "oak")
    return world


def best(action: Callable[[], object]) -> float:
    """The shortest time of a few, in seconds."""
    times = []
    for _ in range(REPEATS):
        start = perf_counter()
        action()
        times.append(perf_counter() - start)
    return min(times)


def measure(name: str, count: int, folder: Path) -> dict[str, float]:
    """Seconds of a step, and of a checkpoint and its parts."""
    engine = create_engine(name)
    simulation = Simulation(pile(count), engine)
    simulation.run(5)
    world, file = simulation.world, folder / f"{name}-{count}.dae"
    series = Checkpoints(folder / f"{name}-{count}", keep=1)

    def checkpoint() -> None:
        simulation.run(1)
        simulation.checkpoint(series)

    step = best(lambda: simulation.run(STEPS)) / STEPS
    checkpoint()
    times = {
        "step": step,
        "checkpoint": best(checkpoint) - step,
        "write": best(lambda: colladaphy.write(world, file)),
        "load engine": best(lambda: engine.load(world)),
    }
    simulation.checkpoint(file)
    times["prove whole"] = best(lambda: read_checkpoint(file))
    times["resume"] = best(lambda: Simulation.resume(file, name))
    times["size"] = file.stat().st_size
    return times


def main(arguments: list[str]) -> int:
    """Print the table for the engines named, or for all that are installed."""
    parts = ("checkpoint", "write", "load engine", "prove whole", "resume")
    print("| engine | bodies | step, ms | " + " | ".join(f"{p}, steps" for p in parts) + " | kB |")
    print("|-" * (4 + len(parts)) + "|")
    with tempfile.TemporaryDirectory() as folder:
        for name in arguments or list(ENGINES):
            try:
                create_engine(name)
            except EngineError as error:
                print(error, file=sys.stderr)
                continue
            for count in SIZES:
                times = measure(name, count, Path(folder))
                ratios = " | ".join(f"{times[part] / times['step']:.1f}" for part in parts)
                size = times["size"] / 1000
                print(f"| {name} | {count} | {1000 * times['step']:.3f} | {ratios} | {size:.0f} |")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
