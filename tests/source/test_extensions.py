"""Engines, conventions and rules that an installed package offers by entry points."""

from __future__ import annotations

import importlib
from collections.abc import Iterator
from pathlib import Path

import pytest

import colladaphy
from colladaphy.cli import run
from colladaphy.conform.conventions import conventions
from colladaphy.engines import ENGINES, Simulation, create_engine, engine_names
from colladaphy.errors import EngineError
from colladaphy.source import extensions
from colladaphy.validation import catalogue
from colladaphy.world import World

MODULE = """
from colladaphy.conform.conventions import Convention
from colladaphy.engines.pymunk_engine import PymunkEngine
from colladaphy.findings import Rule, Severity
from colladaphy.meaning.hits import Hit


class Engine(PymunkEngine):
    name = "acme"


def recognise(clues):
    return None


def apply(context, named, clues):
    for element in context.all("mass"):
        element.text = str(float(element.text) / 1000)


grams = Convention("grams", "masses in grams", recognise, apply)
taken = Convention("bullet", "not theirs", recognise, apply)
"""
RULES = """
from colladaphy.findings import Rule, Severity
from colladaphy.meaning.hits import Hit
from colladaphy_schema.rows import Rows

HEAVY = Rule("acme-heavy", Severity.WARNING, "A mass is written.", "Write densities.")
RULES = (HEAVY,)


def masses(context):
    bodies = context.rows(Rows, "rigid_body")
    common = context.children(bodies, "technique_common", Rows)
    _, elements = context.scalars(context.children(common, "shape", Rows), "mass")
    for element in elements[elements >= 0].tolist():
        yield Hit(HEAVY, element, "Here is one.")


CHECKS = (masses,)
"""
FAILING = """
RULES = ()


def fails(context):
    raise KeyError("no such thing")


CHECKS = (fails,)
"""
POINTS = """
[colladaphy.engines]
acme = acme_colladaphy:Engine
missing = acme_colladaphy:Nothing
pymunk = acme_colladaphy:Engine

[colladaphy.conventions]
grams = acme_colladaphy:grams

[colladaphy.rules]
acme = acme_rules
"""
BROKEN = """
[colladaphy.conventions]
taken = acme_colladaphy:taken
none = acme_colladaphy:Engine

[colladaphy.rules]
failing = acme_failing
gone = acme_gone
wrong = acme_colladaphy:recognise
"""


def forget() -> None:
    importlib.invalidate_caches()
    for cached in (extensions.offered, extensions.loaded, catalogue._offered):
        cached.cache_clear()


def install(folder: Path, name: str, points: str) -> None:
    """What an installer leaves of a package that has entry points."""
    info = folder / f"{name}-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(points)
    for module, text in (("acme_colladaphy", MODULE), ("acme_rules", RULES),
                         ("acme_failing", FAILING)):  # fmt: skip
        (folder / f"{module}.py").write_text(text)


@pytest.fixture
def site(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    folder = tmp_path / "site"
    folder.mkdir()
    monkeypatch.syspath_prepend(str(folder))
    monkeypatch.chdir(tmp_path)
    forget()
    yield folder
    forget()


@pytest.fixture
def scene(site: Path) -> Path:
    world = World((0, 0, -9.81))
    world.create_sphere(1, (0, 0, 0), 0.5, "oak", mass=500)
    file = site.parent / "scene.dae"
    colladaphy.write(world, file)
    return file


def test_engines(site: Path, scene: Path) -> None:
    install(site, "acme", POINTS)
    assert engine_names() == (*ENGINES, "acme", "missing")
    run_of = Simulation(colladaphy.read(scene).load(), create_engine("acme", iterations=5))
    run_of.run(10)
    checkpoint = run_of.checkpoint(site.parent / "stop.dae")
    resumed = Simulation.resume(checkpoint)
    assert resumed.engine.name == "acme" and type(resumed.engine).__module__ == "acme_colladaphy"
    assert type(create_engine("pymunk")).__module__ != "acme_colladaphy"
    with pytest.raises(EngineError, match="engine-not-installed"):
        create_engine("missing")
    assert run(["simulate", str(scene), "--engine", "acme", "--steps", "3"]) == 0


def test_conventions(site: Path, scene: Path, capsys: pytest.CaptureFixture[str]) -> None:
    install(site, "acme", POINTS)
    assert conventions()[-1].name == "grams"
    document = colladaphy.read(scene, repair=True, convention="grams")
    assert [f.message for f in document.report if f.code == "convention-applied"] or document.report
    assert document.load(prefer="common").bodies[0].mass == 0.5
    assert colladaphy.read(scene, repair=True).load().bodies[0].mass == 500
    assert run(["convert", str(scene), "out.dae", "--convention", "grams"]) == 0
    assert run(["convert", str(scene), "two.dae", "--convention", "tons"]) == 2
    assert "grams" in capsys.readouterr().err


def test_rules(site: Path, scene: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert not any(f.code == "acme-heavy" for f in colladaphy.validate(scene))
    install(site, "acme", POINTS)
    forget()
    report = colladaphy.validate(scene)
    found = [f for f in report if f.code == "acme-heavy"]
    assert len(found) == 1 and found[0].line and found[0].hint == "Write densities."
    assert catalogue.find_rule("acme-heavy") is not None
    assert "acme-heavy" not in {rule.code for rule in catalogue.own_rules()}
    assert run(["explain", "acme-heavy"]) == 0
    assert run(["validate", str(scene), "--isolated", "--severity", "acme-heavy=error"]) == 1
    assert run(["rules", "--stage", "acme"]) == 0
    assert "A mass is written." in capsys.readouterr().out


def test_what_is_broken_is_told_and_stops_nothing(site: Path, scene: Path) -> None:
    install(site, "acme", BROKEN)
    report = colladaphy.validate(scene)
    assert report.valid
    told = [f.message for f in report if f.code == "config-extension-broken"]
    for name, why in (("failing", "no such thing"), ("gone", "acme_gone"), ("wrong", "RULES")):
        assert any(f"'{name}' (colladaphy.rules)" in text and why in text for text in told)
    document = colladaphy.read(scene, repair=True)
    told = [f.message for f in document.report if f.code == "config-extension-broken"]
    assert any("'taken'" in text and "'bullet' is taken" in text for text in told)
    assert any("'none'" in text and "no Convention" in text for text in told)
    assert document.load().bodies[0].mass == 500
    assert colladaphy.read(scene, repair=True, convention="bullet").report is not None
