"""`python -m tools.fuzz.guided [--minutes M] [--structured] [--log FOLDER]`: guided by coverage.

Atheris (libFuzzer for Python) changes the files of a corpus wherever that reaches new code of
colladaphy, and takes each through validate → repair → load → write, at first as bytes, then as
documents whose elements it takes from a list. What fails is kept in tests/regressions.
"""

from __future__ import annotations

import argparse
import importlib.util
import io
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from tools.fuzz import keeping
from tools.fuzz.properties.anything import survives

ROOT = Path(__file__).resolve().parents[2]
CORPUS = Path(__file__).resolve().parent / "corpus"
REGRESSIONS = ROOT / "tests" / "regressions"
PROPERTY = "anything-at-all"

_SLOW = 30
"""Seconds that one input may take."""
_MEMORY = 4096
"""Megabytes that the process may take."""


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="python -m tools.fuzz.guided", description=__doc__)
    parser.add_argument("--minutes", type=float, default=10.0, metavar="M", help="default 10")
    parser.add_argument("--structured", action="store_true", help="only the second kind")
    parser.add_argument("--bytes", action="store_true", help="only the first kind")
    parser.add_argument("--seed", type=int, default=0, help="where to begin (default: anywhere)")
    parser.add_argument("--regressions", type=Path, default=REGRESSIONS, metavar="FOLDER")
    parser.add_argument("--grown", type=Path, metavar="FOLDER",
                        help="keep what reaches new code there, for the next time")  # fmt: skip
    options = parser.parse_args(arguments)
    if not is_installed() and not install():
        print(
            "make fuzz-atheris needs atheris, and pip has no build of it for Python "
            f"{sys.version_info[0]}.{sys.version_info[1]} on {sys.platform}: run it with a Python "
            "that it supports (make VENV=.venv-311 PYTHON=python3.11 fuzz-atheris). "
            "make fuzz covers the same without guidance.",
            file=sys.stderr,
        )
        return 2
    kinds = [kind for kind in ("bytes", "structured")
             if not (options.bytes or options.structured) or getattr(options, kind)]  # fmt: skip
    results = [_run(kind, options, options.minutes / len(kinds)) for kind in kinds]
    return max(results)


def is_installed() -> bool:
    """Whether atheris can be imported."""
    return importlib.util.find_spec("atheris") is not None


def install() -> bool:
    """Install atheris for this Python, if there is a build of it."""
    command = [sys.executable, "-m", "pip", "install", "--quiet", "--only-binary=:all:", "atheris"]
    done = subprocess.run(command, check=False, capture_output=True)
    importlib.invalidate_caches()
    return done.returncode == 0 and is_installed()


def _run(kind: str, options: argparse.Namespace, minutes: float) -> int:
    """One kind, in a process of its own: libFuzzer ends the process that it runs in."""
    with tempfile.TemporaryDirectory(prefix="fuzz-guided-") as folder:
        found = Path(folder, "found")
        found.mkdir()
        grown = (options.grown or Path(folder, "grown")) / kind
        grown.mkdir(parents=True, exist_ok=True)
        command = [
            sys.executable, "-m", "tools.fuzz.guided_target", kind, str(grown),
            *([str(CORPUS)] if kind == "bytes" else []),
            f"-max_total_time={int(minutes * 60)}", f"-timeout={_SLOW}",
            f"-rss_limit_mb={_MEMORY}", f"-artifact_prefix={found}{os.sep}", "-max_len=20000",
            f"-dict={CORPUS.parent / 'words.dict'}", "-print_final_stats=1", "-verbosity=0",
            *([f"-seed={options.seed}"] if options.seed else []),
        ]  # fmt: skip
        started = time.monotonic()
        done = subprocess.run(command, check=False, cwd=ROOT, capture_output=True, text=True,
                              errors="replace")  # fmt: skip
        stats = [line for line in done.stderr.splitlines() if line.startswith("stat::")]
        executed = next((line.split()[-1] for line in stats if "number_of_executed" in line), "?")
        print(f"{kind}: {executed} inputs in {time.monotonic() - started:.0f} s, "
              f"{len(list(grown.iterdir()))} of them new code")  # fmt: skip
        failed = sorted(found.iterdir())
        for path in failed:
            why = next((line for line in done.stderr.splitlines() if "Error" in line), path.name)
            kept = keeping.keep(
                options.regressions, PROPERTY, (input_of(kind, path.read_bytes()),), why[:300]
            )
            print(f"FAILED {why}\n  kept in {kept}")
        if done.returncode and not failed:
            print(done.stderr[-3000:], file=sys.stderr)
    return 1 if done.returncode else 0


def input_of(kind: str, data: bytes) -> bytes:
    """The document that libFuzzer's bytes stand for."""
    return data if kind == "bytes" else structured(data)


def structured(data: bytes) -> bytes:
    """A document with one of the corpus as its base, changed as the bytes say."""
    from lxml import etree

    files = sorted(CORPUS.glob("*.dae"))
    take = iter(data)

    def number(most: int) -> int:
        high, low = next(take, 0), next(take, 0)
        return ((high << 8) | low) % most if most else 0

    root = etree.parse(files[number(len(files))]).getroot()
    while (kind := next(take, None)) is not None:
        elements = list(root.iter(etree.Element))
        element = elements[number(len(elements))]
        _change(kind % 7, element, elements, number)
    stream = io.BytesIO()
    etree.ElementTree(root).write(stream, encoding="utf-8", xml_declaration=True)
    return stream.getvalue()


_WORDS = ("", "0", "-1", "NaN", "INF", "1e308", "1e-320", "1 2 3", "99999999999999999999", "#", "a",
          "true", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1", "#m", "1,5", "é", "..", "#x/y(0)")  # fmt: skip


def _change(kind: int, element: Any, elements: list[Any], number: Any) -> None:
    import copy

    other = elements[number(len(elements))]
    parent = element.getparent()
    if parent is None:
        return
    match kind:
        case 0:
            element.text = _WORDS[number(len(_WORDS))]
        case 1:
            words = (element.text or "").split()
            if words:
                words[number(len(words))] = _WORDS[number(len(_WORDS))]
                element.text = " ".join(words)
        case 2:
            if element.attrib:
                keys = sorted(element.attrib)
                values = [*_WORDS, *(str(value) for value in other.attrib.values())]
                element.set(keys[number(len(keys))], values[number(len(values))])
        case 3:
            parent.remove(element)
        case 4:
            if len(elements) < 2000:
                parent.insert(number(len(parent) + 1), copy.deepcopy(element))
        case 5:
            if len(elements) < 2000 and other.tag != elements[0].tag:
                element.append(copy.deepcopy(other))
        case _:
            element.tag = other.tag


def check(data: bytes) -> None:
    """Anything at all gives a result, or an error of our own."""
    survives(data)


if __name__ == "__main__":
    raise SystemExit(main())
