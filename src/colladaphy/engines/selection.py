"""Which engine runs a World."""

from __future__ import annotations

from importlib import import_module
from importlib.metadata import PackageNotFoundError, version
from typing import TYPE_CHECKING, Final

from colladaphy.engines.rules import CHOSEN, NO_ENGINE, NOT_INSTALLED, UNKNOWN, refuse
from colladaphy.errors import EngineError
from colladaphy.findings import Finding, Severity
from colladaphy.source import extensions

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

    from colladaphy.engines.options import Value
    from colladaphy.engines.protocol import Engine
    from colladaphy.world import World

__all__ = ["ENGINES", "choose", "create_engine", "engine_names"]

ENGINES: Final = {
    "pymunk": ("colladaphy.engines.pymunk_engine", "PymunkEngine"),
    "mujoco": ("colladaphy.engines.mujoco_engine", "MujocoEngine"),
}
"""Engines by name, in the order in which "auto" tries them: module and class."""


def engine_names() -> tuple[str, ...]:
    """The names of all engines, whether they work or not, ours first.

    Other packages offer theirs as entry points of `extensions.ENGINES`: classes, or functions that
    take the options and return an engine.
    """
    return (*ENGINES, *_offered())


def _offered() -> dict[str, EntryPoint]:
    points = extensions.offered(extensions.ENGINES)
    return {point.name: point for point in points if point.name not in ENGINES}


def create_engine(name: str, **options: Value) -> Engine:
    """The engine of a name; EngineError if there is none, or if its library does not load.

    Its `options` are in docs/engines.md; numbers and switches may be texts.
    """
    names = engine_names()
    if name not in names:
        known = ", ".join(("auto", *names))
        raise refuse(UNKNOWN, f"There is no engine named {name!r}; there are {known}.")
    try:
        if name in ENGINES:
            module, cls = ENGINES[name]
            maker = getattr(import_module(module), cls)
        else:
            maker = _offered()[name].load()
    except Exception as error:  # a library can fail in any way when it is loaded
        raise _not_installed(name, error) from error
    engine: Engine = maker(**options)
    return engine


def _not_installed(name: str, error: Exception) -> EngineError:
    hint = "Install it: pip install 'colladaphy[mujoco]'." if name == "mujoco" else (
        "Install it anew: pip install --force-reinstall pymunk." if name == "pymunk"
        else "Ask the package that offers it."
    )  # fmt: skip
    versions = {dist: found for dist in _MUJOCO if (found := _installed(dist))}
    if name == "mujoco" and len({number.split(".")[0] for number in versions.values()}) > 1:
        both = " and ".join(f"{dist} {number}" for dist, number in versions.items())
        hint = (
            f"{both} overwrite each other's files. Keep one: pip uninstall {' '.join(versions)}, "
            "then pip install mujoco."
        )
    message = f"The engine {name} cannot be loaded: {type(error).__name__}: {error}."
    return EngineError(NOT_INSTALLED.at(message=message, hint=hint))


_MUJOCO: Final = ("mujoco", "mujoco-core")


def _installed(distribution: str) -> str:
    try:
        return version(distribution)
    except PackageNotFoundError:
        return ""


def choose(world: World) -> tuple[Engine, list[Finding]]:
    """The first engine that can run `world`, and the findings that say why and at what cost.

    Planar scenes go to pymunk, all others to MuJoCo, and what that refuses to engines of other
    packages. EngineError lists everything that stands against each engine.
    """
    reasons: list[Finding] = []
    missing: list[Finding] = []
    for name in engine_names():
        try:
            engine = create_engine(name)
        except EngineError as error:
            missing += error.findings
            continue
        findings = engine.check(world)
        errors = [finding for finding in findings if finding.severity is Severity.ERROR]
        if not errors:
            return engine, [_chosen(name, reasons), *findings]
        reasons += errors
    if missing:
        raise EngineError((NO_ENGINE.at(), *reasons, *missing))
    raise EngineError(reasons)


def _chosen(name: str, reasons: list[Finding]) -> Finding:
    if not reasons:
        return CHOSEN.at(message=f"The engine is {name}.")
    why = reasons[0].message
    more = f" (and {len(reasons) - 1} more reasons)" if len(reasons) > 1 else ""
    return CHOSEN.at(message=f"The engine is {name}, not pymunk: {why}{more}")
