"""What atheris runs: `python -m tools.fuzz.guided_target bytes|structured CORPUS… -OPTION…`."""

from __future__ import annotations

import sys

import atheris

with atheris.instrument_imports(include=["colladaphy", "colladaphy_schema"]):
    from tools.fuzz.guided import check, input_of


def main() -> None:
    kind = sys.argv.pop(1)

    def one_input(data: bytes) -> None:
        check(input_of(kind, data))

    atheris.Setup(sys.argv, one_input)
    atheris.Fuzz()


if __name__ == "__main__":
    main()
