"""Drives xsdata in process, in a folder of its own, and compares or installs the outcome."""

from __future__ import annotations

import contextlib
import difflib
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

from xsdata.codegen.transformer import ResourceTransformer
from xsdata.codegen.writer import CodeWriter
from xsdata.models.config import DocstringStyle, GeneratorConfig, StructureStyle
from xsdata.models.xsd import Element, Schema

from tools.bindings.common import PACKAGE
from tools.bindings.locality import with_other_content
from tools.bindings.model import DEFAULT_MARK
from tools.bindings.modules import content_module
from tools.bindings.plugin import BindingsGenerator

PROJECT = Path(__file__).resolve().parents[2]
SCHEMA = PROJECT / "schema" / "document.xsd"
TARGET = PROJECT / "generated" / PACKAGE
FORMAT = "dataclasses"


class Transformer(ResourceTransformer):
    """Reads the schema and keeps the defaults of elements, which the analysis would drop."""

    def parse_schema(self, uri: str, namespace: str | None) -> Schema | None:
        """Parse a schema file and note the defaults of its elements as their documentation."""
        schema = super().parse_schema(uri, namespace)
        if schema is not None:
            mark_defaults(schema)
        return schema


def mark_defaults(node: object) -> None:
    """Move the default of every element below `node` into its documentation."""
    for child in node.children():  # type: ignore[attr-defined]
        if isinstance(child, Element):
            child.annotations.clear()
            if child.default is not None:
                child.annotations.append(documentation(DEFAULT_MARK + child.default))
                child.default = None
        mark_defaults(child)


def documentation(text: str) -> object:
    """An annotation that says `text`."""
    from xsdata.models.xsd import Annotation, Documentation

    return Annotation(documentations=[Documentation(content=[text])])


def configuration() -> GeneratorConfig:
    """The settings of xsdata; compound fields keep the order of mixed elements."""
    config = GeneratorConfig()
    output = config.output
    output.package = PACKAGE
    output.structure_style = StructureStyle.FILENAMES
    output.docstring_style = DocstringStyle.BLANK
    output.unnest_classes = True
    output.compound_fields.enabled = True
    output.format.slots = True
    output.format.kw_only = True
    output.max_line_length = 99
    return config


def generate(schema: Path, folder: Path) -> Path:
    """Generate the package below `folder`, formatted; returns its path."""
    previous = CodeWriter.generators[FORMAT]
    CodeWriter.register_generator(FORMAT, BindingsGenerator)
    try:
        with contextlib.chdir(folder):
            Transformer(configuration()).process([schema.resolve().as_uri()])
    finally:
        CodeWriter.register_generator(FORMAT, previous)
    package = folder / PACKAGE
    content = content_module(with_other_content(schema))
    (package / "content.py").write_text(content, encoding="utf-8")
    ruff = Path(sys.executable).with_name("ruff")
    command = [str(ruff if ruff.exists() else "ruff"), "--config"]
    for action in (["check", "--select", "I,F401", "--fix", "--quiet"], ["format", "--quiet"]):
        subprocess.run(
            [command[0], *action, "--isolated", "--line-length", "100", str(package)],
            check=True,
            env={**os.environ, "RUFF_NO_CACHE": "true"},
        )
    return package


@contextlib.contextmanager
def generated(schema: Path = SCHEMA) -> Iterator[Path]:
    """A freshly generated package, in a temporary folder."""
    with tempfile.TemporaryDirectory() as folder:
        yield generate(schema, Path(folder))


def texts(package: Path) -> dict[str, str]:
    """The files of a package by name."""
    if not package.is_dir():
        return {}
    return {
        path.name: path.read_text(encoding="utf-8")
        for path in sorted(package.iterdir())
        if path.is_file()
    }


def drift(fresh: Path, present: Path) -> list[str]:
    """What differs between a fresh package and the present one, a line a file, with a sample."""
    new, old = texts(fresh), texts(present)
    report: list[str] = []
    for name in sorted(new.keys() | old.keys()):
        if name not in old:
            report.append(f"{name}: missing")
        elif name not in new:
            report.append(f"{name}: not generated")
        elif new[name] != old[name]:
            lines = list(
                difflib.unified_diff(
                    old[name].splitlines(), new[name].splitlines(), "present", "generated", "", "",
                    n=0, lineterm="",
                )
            )  # fmt: skip
            changed = sum(line[:1] in "+-" for line in lines[2:])
            report.append(f"{name}: {changed} lines differ")
            report += [f"    {line}" for line in lines[2:12]]
    return report


def install(fresh: Path, present: Path) -> int:
    """Make the present package equal to the fresh one; returns how many files changed."""
    new, old = texts(fresh), texts(present)
    present.mkdir(parents=True, exist_ok=True)
    changed = 0
    for name in old.keys() - new.keys():
        (present / name).unlink()
        changed += 1
    for name, text in new.items():
        if old.get(name) != text:
            (present / name).write_text(text, encoding="utf-8")
            changed += 1
    return changed
