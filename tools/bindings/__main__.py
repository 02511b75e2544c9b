"""`python -m tools.bindings [--check]`."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from tools.bindings.generate import SCHEMA, TARGET, drift, generated, install


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="python -m tools.bindings", description=__doc__)
    parser.add_argument("--check", action="store_true", help="exit 1 if the package has drifted")
    parser.add_argument("--schema", type=Path, default=SCHEMA, help="the schema of a document")
    parser.add_argument("--target", type=Path, default=TARGET, help="the folder of the package")
    options = parser.parse_args(arguments)
    with generated(options.schema) as fresh:
        if not options.check:
            print(f"{install(fresh, options.target)} files changed in {options.target}")
            return 0
        report = drift(fresh, options.target)
    print("\n".join(report) if report else "no drift")
    if report:
        print("run `python -m tools.bindings`", file=sys.stderr)
    return 1 if report else 0


if __name__ == "__main__":
    raise SystemExit(main())
