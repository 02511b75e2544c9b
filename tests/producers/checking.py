"""What must hold of every file that comes in by the door."""

from __future__ import annotations

import contextlib
import io
from collections import Counter
from pathlib import Path
from tempfile import TemporaryDirectory

from lxml import etree

import colladaphy
from colladaphy.cli import run
from colladaphy.conform import conform
from colladaphy.findings import Severity
from colladaphy.world import World, compare

__all__ = ["accept", "codes", "faults", "words_outside"]

AUTHORS = ("geometry-", "animation-")
FORM = ("io-", "xml-", "schema-", "link-")

# Where the physics is: what may be rewritten, completed and moved.
_PHYSICS = frozenset(
    {
        "library_physics_materials", "library_physics_models", "library_physics_scenes",
        "library_force_fields", "asset", "scene",
    }
)  # fmt: skip


def faults(document: bytes, stages: tuple[str, ...] = ("",)) -> list[str]:
    """The errors of a document that was mended, but for those that only its author could mend.

    Numbers and inputs that a mesh or an animation lacks are such.
    """
    return [
        str(finding)
        for finding in colladaphy.validate(document)
        if finding.severity is Severity.ERROR
        and finding.code.startswith(stages)
        and not finding.code.startswith(AUTHORS)
    ]


def accept(
    data: bytes,
    *,
    convention: str = "auto",
    cli: bool = False,
    errors: bool = False,
    outside: bool = True,
) -> World:
    """Read, load, write, read strictly and load again; returns the World.

    Asserts that each way leads to the same World, that what is written is valid, that a second
    repair changes nothing, that a change is a finding, and that what is not physics stays where
    it was (unless not `outside`). The report has errors only where they may be expected.
    """
    document = colladaphy.read(data, repair=True, convention=convention)
    assert all(finding.severity is not Severity.ERROR for finding in document.report)
    written = to_bytes(document)
    assert document.report.findings or words_outside(data) == words_outside(written)
    world = document.load()
    found = [finding for finding in document.report if finding.severity is Severity.ERROR]
    assert errors or not found, found

    wrong = faults(written, FORM if errors else ("",))
    assert not wrong, wrong
    again = colladaphy.read(written)
    same = again.load()
    assert compare(world, same) == []
    twin, more = conform(again.tree)
    assert more == [], [str(finding) for finding in more]
    assert etree.tostring(twin) == etree.tostring(again.tree)

    stored = io.BytesIO()
    colladaphy.write(world, stored)
    assert compare(world, colladaphy.read(stored.getvalue()).load()) == []

    lost = words_outside(data) - words_outside(written)
    assert not outside or not lost, f"lost outside of physics: {dict(lost.most_common(5))}"
    if cli:
        convert_by_command(data)
    return world


def to_bytes(document: colladaphy.Document) -> bytes:
    stream = io.BytesIO()
    document.write(stream)
    return stream.getvalue()


def words_outside(data: bytes) -> Counter[str]:
    """Tags, and words of texts, outside of the physics: visuals, kinematics, extras, all of it."""
    found: Counter[str] = Counter()
    root = etree.fromstring(data)
    for child in root.iterchildren(etree.Element):
        if etree.QName(child).localname in _PHYSICS:
            continue
        for element in child.iter(etree.Element):
            found.update((element.text or "").split())
            if etree.QName(element).localname in (
                "float_array",
                "p",
                "vcount",
                "instance_geometry",
                "translate",
                "rotate",
                "matrix",
                "color",
            ):
                found[etree.QName(element).localname] += 1  # fmt: skip
    return found


def convert_by_command(data: bytes) -> None:
    """The command line makes the same of it, and what it writes is valid."""
    with TemporaryDirectory() as folder:
        source, target = Path(folder, "in.dae"), Path(folder, "out.dae")
        source.write_bytes(data)
        said = io.StringIO()
        with contextlib.redirect_stderr(said), contextlib.redirect_stdout(said):
            assert run(["convert", str(source), str(target)]) == 0, said.getvalue()
            assert run(["validate", str(target)]) == 0, said.getvalue()
        assert source.read_bytes() == data


def codes(data: bytes, convention: str = "auto") -> Counter[str]:
    """How often each kind of change is made on reading."""
    document = colladaphy.read(data, repair=True, convention=convention)
    return Counter(finding.code for finding in document.report)
