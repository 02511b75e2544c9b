"""Times and peak memory of the steps.

The same code takes twice as long on a heap that another step left in pieces or gave back, so the
heap is brought to a known state before every timing, and the time is that of the processor.
"""

from __future__ import annotations

import ctypes
import gc
import math
import resource
import statistics
import subprocess
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from time import process_time

from tools.bench.steps import prepare


@dataclass(frozen=True)
class Timing:
    """One step at one size: its best time, and its ratio to the unit measured beside it."""

    seconds: float
    ratio: float


def _warm() -> None:
    gc.collect()
    # The allocator tidies up before it serves so much.
    bytearray(_LARGE)


def _cold() -> None:
    gc.collect()
    trim = getattr(ctypes.CDLL(None), "malloc_trim", None) if sys.platform == "linux" else None
    if trim is not None:
        trim(0)


_LARGE = 1 << 28
HEAPS: dict[str, Callable[[], None]] = {"warm": _warm, "cold": _cold}
"""States of the heap: what was freed is there to be used again, or was given back."""


def interleaved(
    file: Path, steps: Sequence[str], repeat: int, *, heap: str = "warm", kind: str = "spheres"
) -> dict[str, Timing]:
    """Time the steps in turns, so that a slow moment of the machine meets all of them.

    The ratio is the median over the turns of a step's time to the time of the first step, the
    unit, in the same turn. The first turn warms up and does not count.
    """
    functions = {step: prepare(step, file, kind) for step in steps}
    times: dict[str, list[float]] = {step: [] for step in steps}
    for _ in range(repeat + 1):
        for step, function in functions.items():
            HEAPS[heap]()
            start = process_time()
            result = function()
            times[step].append(process_time() - start)
            del result
    unit = times[steps[0]][1:]
    return {
        step: Timing(
            min(values[1:]),
            statistics.median(mine / one for mine, one in zip(values[1:], unit, strict=True)),
        )
        for step, values in times.items()
    }


def exponent(times: Mapping[int, float]) -> float | None:
    """By what power of the size the time grows: the slope of a line through the logarithms."""
    if len(times) < 2:
        return None
    xs = [math.log(size) for size in times]
    ys = [math.log(time) for time in times.values()]
    return statistics.linear_regression(xs, ys).slope


def peak_memory(step: str, file: Path) -> float:
    """Peak resident memory in MB of a process that does the step once, its preparation included."""
    code = (
        "import sys; from pathlib import Path; from tools.bench.measuring import peak;"
        "print(peak(sys.argv[1], Path(sys.argv[2])))"
    )
    root = Path(__file__).resolve().parents[2]
    done = subprocess.run(
        [sys.executable, "-c", code, step, str(file)],
        capture_output=True,
        text=True,
        check=True,
        cwd=root,
    )
    return float(done.stdout)


def peak(step: str, file: Path) -> float:
    """Peak resident memory of this process in MB after one step."""
    prepare(step, file)()
    status = Path("/proc/self/status")
    if status.exists():  # where it does, ru_maxrss is at least that of the process which started us
        line = next(x for x in status.read_text().splitlines() if x.startswith("VmHWM"))
        return int(line.split()[1]) / 1e3
    usage = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return usage / (1e6 if sys.platform == "darwin" else 1e3)
