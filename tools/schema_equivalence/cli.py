"""The command: ``python -m tools.schema_equivalence [OURS] [OFFICIAL] [--names]``."""

import argparse
import os
import sys
from collections.abc import Sequence
from pathlib import Path

from tools.schema_equivalence.loading import OFFICIAL, OURS, SchemaError, load
from tools.schema_equivalence.walk import compare

VARIABLE = "COLLADA_SCHEMA"
"""The environment variable that names the official schema where it is not installed by Debian."""

EQUAL, DIFFERENT, UNUSABLE = 0, 1, 2


def official_path() -> Path:
    """Where the official schema is expected."""
    return Path(os.environ.get(VARIABLE, OFFICIAL))


def main(arguments: Sequence[str] | None = None) -> int:
    """Prints every difference, or what was compared. 0 equal, 1 different, 2 cannot compare."""
    parser = argparse.ArgumentParser(
        prog="python -m tools.schema_equivalence",
        description="Compares our COLLADA 1.5 schema with the official one.",
    )
    parser.add_argument("ours", nargs="?", type=Path, default=OURS, help=f"default: {OURS.name}")
    parser.add_argument(
        "official",
        nargs="?",
        type=Path,
        default=official_path(),
        help=f"default: ${VARIABLE}, or {OFFICIAL} (Debian package opencollada-tools)",
    )
    parser.add_argument(
        "--names", action="store_true", help="also compare all global types by their names"
    )
    options = parser.parse_args(arguments)
    try:
        found = compare(load(options.ours), load(options.official), names=options.names)
    except SchemaError as error:
        print(f"schema_equivalence: {error}", file=sys.stderr)
        return UNUSABLE
    for difference in found.differences:
        print(difference)
    print(f"{len(found.differences)} differences; compared {found.counted()}")
    return DIFFERENT if found.differences else EQUAL
