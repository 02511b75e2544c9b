"""`python -m tools.bench [--bodies 1000,10000,100000] [--repeat 5] [--kinds all] [--engines]`."""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

from tools.bench.measuring import HEAPS, Timing, exponent, interleaved, peak_memory
from tools.bench.steps import KIND_STEPS, STEPS, STOCK, document, steps_of


def sizes(text: str) -> list[int]:
    return sorted({int(word) for word in text.split(",")})


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="python -m tools.bench", description=__doc__)
    parser.add_argument("--bodies", type=sizes, metavar="N,…")
    parser.add_argument("--repeat", type=int, default=5, help="turns that count (default 5)")
    parser.add_argument(
        "--stock-up-to", type=int, default=1000, metavar="N",
        help="largest size for stock xsdata, which is slow (default 1000)",
    )  # fmt: skip
    parser.add_argument("--no-memory", action="store_true", help="leave peak memory out")
    parser.add_argument(
        "--kinds", metavar="NAME,…", help="compare kinds of content in place of sizes; 'all' of "
        "them, or some (10,000 bodies unless --bodies says otherwise)",
    )  # fmt: skip
    parser.add_argument(
        "--engines", action="store_true", help="measure the engines in place of load and store"
    )
    options = parser.parse_args(arguments)
    if options.engines:
        from tools.bench import checkpoint, engines

        engines.main([])
        print("\ncheckpoints\n")
        return checkpoint.main([])
    if options.kinds:
        return compare_kinds(options.kinds, (options.bodies or [10_000])[-1], options.repeat)
    options.bodies = options.bodies or [1000, 10_000, 100_000]
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


def compare_kinds(names: str, count: int, repeat: int) -> int:
    """Print what every kind of content takes, on a warm and on a cold heap."""
    from tools.bench.kinds import KINDS

    chosen = list(KINDS) if names == "all" else names.split(",")
    unknown = [name for name in chosen if name not in KINDS]
    if unknown:
        raise SystemExit(f"There is no kind {unknown[0]!r}, but {', '.join(KINDS)}.")
    columns = KIND_STEPS[1:]
    print(f"| {count} bodies | bytes a body | heap | parse, µs a body | {' | '.join(columns)} |")
    print("|-" * (4 + len(columns)) + "|")
    with tempfile.TemporaryDirectory() as folder:
        for name in chosen:
            file = Path(folder) / f"{name}.dae"
            file.write_bytes(document(count, name))
            for heap in HEAPS:
                times = interleaved(file, steps_of(name), repeat, heap=heap, kind=name)
                ratios = [f"{times[step].ratio:.2f}" if step in times else "–"
                          for step in columns]  # fmt: skip
                parse = times["parse"].seconds / count * 1e6
                size = file.stat().st_size / count
                print(f"| {name} | {size:.0f} | {heap} | {parse:.2f} | {' | '.join(ratios)} |",
                      flush=True)  # fmt: skip
    print(
        "\nAll else is × parse, which is lxml.etree.parse of the same file; schema is to parse it"
    )
    print("and to validate the tree by the schema, which validate has to be held against. All are")
    print("time of the processor, in turns, the median of the turns.")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
