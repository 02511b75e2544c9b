"""Which engine runs a World."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Final

from colladaphy.engines.rules import CHOSEN, NO_ENGINE, NOT_INSTALLED, UNKNOWN, refuse
from colladaphy.errors import EngineError
from colladaphy.findings import Finding, Severity

if TYPE_CHECKING:
    from colladaphy.engines.options import Value
    from colladaphy.engines.protocol import Engine
    from colladaphy.world import World

__all__ = ["ENGINES", "choose", "create_engine"]

ENGINES: Final = {
    "pymunk": ("colladaphy.engines.pymunk_engine", "PymunkEngine"),
    "mujoco": ("colladaphy.engines.mujoco_engine", "MujocoEngine"),
}
"""Engines by name, in the order in which "auto" tries them: module and class."""


def create_engine(name: str, **options: Value) -> Engine:
    """The engine of a name; EngineError if there is none, or if its library is not installed.

    Its `options` are in docs/engines.md; numbers and switches may be texts.
    """
    if name not in ENGINES:
        known = ", ".join(("auto", *ENGINES))
        raise refuse(UNKNOWN, f"There is no engine named {name!r}; there are {known}.")
    module, cls = ENGINES[name]
    try:
        engine: Engine = getattr(import_module(module), cls)(**options)
    except ImportError as error:
        extra = "colladaphy" if name == "pymunk" else f"colladaphy[{name}]"
        hint = f"Install it: pip install '{extra}'."
        message = f"The engine {name} cannot be loaded: {error}."
        raise EngineError(NOT_INSTALLED.at(message=message, hint=hint)) from error
    return engine


def choose(world: World) -> tuple[Engine, list[Finding]]:
    """The first engine that can run `world`, and the findings that say why and at what cost.

    Planar scenes go to pymunk, all others to MuJoCo. EngineError lists everything that stands
    against each engine.
    """
    reasons: list[Finding] = []
    missing: list[Finding] = []
    for name in ENGINES:
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
