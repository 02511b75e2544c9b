"""`python -m tools.bench [--bodies 1000,10000,100000] [--repeat 5]`."""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

from tools.bench.measuring import Timing, exponent, interleaved, peak_memory
from tools.bench.steps import STEPS, STOCK, document


def sizes(text: str) -> list[int]:
    return sorted({int(word) for word in text.split(",")})


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="python -m tools.bench", description=__doc__)
    parser.add_argument("--bodies", type=sizes, default=[1000, 10_000, 100_000], metavar="N,…")
    parser.add_argument("--repeat", type=int, default=5, help="turns that count (default 5)")
    parser.add_argument(
        "--stock-up-to", type=int, default=1000, metavar="N",
        help="largest size for stock xsdata, which is slow (default 1000)",
    )  # fmt: skip
    parser.add_argument("--no-memory", action="store_true", help="leave peak memory out")
    options = parser.parse_args(arguments)
    timings: dict[str, dict[int, Timing]] = {step: {} for step in STEPS}
    with tempfile.TemporaryDirectory() as folder:
        print(f"{'':18}{'bodies':>8}{'µs a body':>12}{'× parse':>9}{'peak MB':>9}")
        for size in options.bodies:
            file = Path(folder) / f"{size}.dae"
            file.write_bytes(document(size))
            steps = [s for s in STEPS if s not in STOCK or size <= options.stock_up_to]
            for step, timing in interleaved(file, steps, options.repeat).items():
                timings[step][size] = timing
                memory = "" if options.no_memory else f"{peak_memory(step, file):9.0f}"
                print(
                    f"{step:18}{size:8}{timing.seconds / size * 1e6:12.1f}"
                    f"{timing.ratio:9.2f}{memory}",
                    flush=True,
                )
    print("\ngrowth: time ~ bodies ^ exponent")
    for step, by_size in timings.items():
        slope = exponent({size: timing.seconds for size, timing in by_size.items()})
        if slope is not None:
            print(f"{step:18}{slope:8.2f}")
    if options.bodies[-1] > options.stock_up_to:
        print(f"\nstock xsdata was measured up to {options.stock_up_to} bodies only")
    print("Spheres with pose, velocity and mass, one material. The unit is lxml.etree.parse of the")
    print("same file. Peak memory is that of a whole process that prepares and does the step.")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
