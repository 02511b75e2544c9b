"""``colladaphy info``."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import click

from colladaphy.cli.console import EXIT_FINDINGS, note, say
from colladaphy.cli.files import (
    convention_option,
    format_option,
    limits_option,
    source_of,
    units_options,
)
from colladaphy.cli.progress import waiting

if TYPE_CHECKING:
    from colladaphy.source.limits import Limits

__all__ = ["command"]


@click.command("info")
@click.argument("file", metavar="FILE")
@format_option
@convention_option
@limits_option
@units_options
def command(
    file: str, form: str, convention: str, limits: Limits | None, si: bool, up_axis: str | None
) -> int:
    """Show what a document of any version holds.

    Shown are the counts of the file as it stands, its physics scenes and models, and the World
    that its instantiated scenes make, in the document's unit and axes or in those that are asked
    for: the bodies that can be represented, and those that are skipped.
    """
    from colladaphy.validation.statistics import describe

    with waiting(f"Reading {file}"):
        facts = describe(
            source_of(file), convention=convention, limits=limits, si=si, up_axis=up_axis
        )
    if form == "json":
        say(json.dumps(facts, indent=2))
    else:
        for line in _text(facts):
            say(line)
        for problem in facts["problems"]:
            note(problem)
    return EXIT_FINDINGS if facts["problems"] else 0


def _text(facts: dict[str, Any]) -> Iterator[str]:
    unit = facts["unit"]
    yield f"{facts['path'] or '-'}: COLLADA {facts['version']}"
    yield f"  unit: {unit['name']} ({unit['meter']} m), up axis: {facts['up_axis']}"
    for tool in facts["authoring_tools"]:
        yield f"  written by: {tool}"
    yield from _document(facts["document"])
    for scene in facts["scenes"] or ():
        yield from _scene(scene)
    if facts["world"] is not None:
        yield from _world(facts["world"])


def _document(counts: dict[str, Any]) -> Iterator[str]:
    yield "document"
    yield f"  rigid bodies: {counts['rigid_body']}, instances: {counts['instance_rigid_body']}"
    yield (
        f"  constraints: {counts['rigid_constraint']}, "
        f"instances: {counts['instance_rigid_constraint']}"
    )
    yield f"  shapes: {_list(counts['shapes'])}"
    for robot in counts["robots"]:
        name = robot["name"] or robot["id"] or "(no id)"
        yield f"  robot {name}: links: {robot['links']}, joints: {robot['joints']}"
    yield f"  physics materials: {counts['physics_material']}"
    yield f"  libraries: {_list(counts['libraries'])}"
    yield f"  profiles: {_list(counts['techniques'])}"
    yield f"  elements: {counts['elements']}"


def _scene(scene: dict[str, Any]) -> Iterator[str]:
    state = "instantiated" if scene["is_instantiated"] else "not instantiated"
    yield f"scene {scene['id'] or scene['name'] or '(no id)'} ({state})"
    if scene["gravity"] is not None:
        yield f"  gravity: {' '.join(str(value) for value in scene['gravity'])}"
    if scene["time_step"] is not None:
        yield f"  time step: {scene['time_step']} s"
    for model in scene["models"]:
        yield (
            f"  model {model['sid'] or model['id'] or '(no id)'}: "
            f"bodies: {model['bodies']}, constraints: {model['constraints']}"
        )


def _world(world: dict[str, Any]) -> Iterator[str]:
    yield "world"
    unit = world["unit"]
    yield f"  unit: {unit['name']} ({unit['meter']} m), up axis: {world['up_axis']}"
    yield f"  gravity: {' '.join(str(value) for value in world['gravity'])}"
    if world["reach"] is not None:
        low, high = (" ".join(f"{value:g}" for value in end) for end in world["reach"])
        yield f"  positions: {low} to {high}, mass: {world['mass']:g} kg"
    yield f"  bodies: {world['bodies']} ({_list(world['kinds'])}), fixed: {world['fixed']}"
    yield f"  unions: {world['unions']} (members: {_list(world['members'])})"
    yield f"  joints: {_list(world['joints'])}"
    yield f"  materials: {', '.join(world['materials']) or 'none'}"
    yield f"  skipped bodies: {len(world['skipped_bodies'])}"
    yield f"  skipped shapes: {len(world['skipped_shapes'])}"
    yield f"  skipped constraints: {len(world['skipped_constraints'])}"
    for skipped in (
        *world["skipped_bodies"], *world["skipped_shapes"], *world["skipped_constraints"]
    ):  # fmt: skip
        place = f"line {skipped['line']}: " if skipped["line"] else ""
        yield f"    {place}{skipped['message']} [{skipped['code']}]"


def _list(counts: dict[str, int]) -> str:
    return ", ".join(f"{name} {count}" for name, count in counts.items()) or "none"
