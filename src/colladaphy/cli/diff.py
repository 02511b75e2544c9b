"""``colladaphy diff``."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from dataclasses import asdict
from itertools import groupby
from typing import TYPE_CHECKING, Any

import click

from colladaphy.cli.console import EXIT_FINDINGS, EXIT_IO, note, say, say_findings
from colladaphy.cli.files import convention_option, format_option, limits_option, source_of
from colladaphy.cli.progress import waiting

if TYPE_CHECKING:
    from colladaphy.source.limits import Limits
    from colladaphy.world import World
    from colladaphy.world.differences import Difference

__all__ = ["command"]


@click.command("diff")
@click.argument("first", metavar="A")
@click.argument("second", metavar="B")
@click.option(
    "--rtol",
    type=click.FloatRange(min=0),
    default=0.0,
    show_default=True,
    metavar="R",
    help="What numbers may be apart, as a share of the larger one's size.",
)
@click.option(
    "--atol",
    type=click.FloatRange(min=0),
    default=0.0,
    show_default=True,
    metavar="A",
    help="What numbers may be apart besides, in the documents' unit.",
)
@click.option("--si", is_flag=True, help="Compare in metres, whatever the documents' units.")
@click.option("--repair", is_flag=True, help="Take documents of any version, and mend them.")
@click.option(
    "--most",
    type=click.IntRange(min=1),
    default=20,
    show_default=True,
    metavar="N",
    help="Show as text the differences of this many bodies, joints and so on; JSON has all.",
)
@format_option
@convention_option
@limits_option
def command(
    first: str,
    second: str,
    rtol: float,
    atol: float,
    si: bool,
    repair: bool,
    most: int,
    form: str,
    convention: str,
    limits: Limits | None,
) -> int:
    """Compare the Worlds of two documents, body by body.

    Without tolerances they are equal if all numbers are, to the last bit. The exit code is 0 if
    nothing differs, 1 if something does, and 2 if they cannot be compared.
    """
    from colladaphy.errors import ColladaError
    from colladaphy.world.compare import differing

    if first == second == "-":
        raise click.UsageError("Only one of them can be standard input.")
    if not (math.isfinite(rtol) and math.isfinite(atol)):
        raise click.UsageError("Tolerances are finite.")
    options = {"repair": repair, "convention": convention, "limits": limits}
    worlds: list[World] = []
    try:
        for name in (first, second):
            with waiting(f"Loading {name}"):
                worlds.append(_load(name, si=si, **options))
    except ColladaError as error:
        say_findings(error.findings)
        return EXIT_IO
    found = differing(worlds[0], worlds[1], rtol, atol)
    if form == "json":
        say(json.dumps(_plain(first, second, rtol, atol, found), indent=2))
    else:
        for line in _text(worlds, found, most):
            say(line)
    return EXIT_FINDINGS if found else 0


def _load(name: str, *, si: bool, **options: Any) -> World:
    import colladaphy
    from colladaphy.findings import Severity

    document = colladaphy.read(source_of(name), **options)
    world: World = document.load(si=si)
    for finding in document.report:  # what is not in the World is not compared
        if finding.severity in (Severity.ERROR, Severity.WARNING):
            note(str(finding))
    return world


def _plain(
    first: str, second: str, rtol: float, atol: float, found: list[Difference]
) -> dict[str, Any]:
    """As JSON, in which numbers that are not finite are texts, and bytes are left out."""
    rows = [{key: _finite(value) for key, value in asdict(item).items()} for item in found]
    return {"first": first, "second": second, "rtol": rtol, "atol": atol, "equal": not found,
            "differences": rows}  # fmt: skip


def _finite(value: Any) -> Any:
    if isinstance(value, dict):  # an engine's own state
        return {key: _finite(item) for key, item in value.items() if key != "data"}
    if isinstance(value, (list, tuple)):
        return [_finite(item) for item in value]
    return str(value) if isinstance(value, float) and not math.isfinite(value) else value


def _text(worlds: list[World], found: list[Difference], most: int) -> Iterator[str]:
    order = {kind: place for place, kind in enumerate(("world", "body", "member", "joint"))}

    def place(difference: Difference) -> tuple[Any, ...]:
        id = difference.id
        ids = () if id is None else id if isinstance(id, tuple) else (id,)
        return order.get(difference.kind, len(order)), difference.kind, ids

    shown = 0
    for _, group in groupby(sorted(found, key=place), key=place):
        items = list(group)
        shown += 1
        if shown <= most:
            yield _named(worlds, items[0])
            for item in items:
                yield f"  {_line(item)}"
    if shown > most:
        yield f"… and {shown - most} more (--most N, or --format json, shows them)"
    yield _summary(worlds, found)


def _named(worlds: list[World], item: Difference) -> str:
    if item.id is None:
        return "world"
    name = None
    for world in worlds:
        if item.kind in ("body", "member"):
            name = name or world.names.get(int(item.id))  # type: ignore[arg-type]
        elif item.kind == "joint":
            name = name or world.joint_names.get(int(item.id))  # type: ignore[arg-type]
        elif item.kind == "material":
            name = name or world.materials.names.get(int(item.id))  # type: ignore[arg-type]
    return f"{item.kind} {item.id}" + (f" {name!r}" if name else "")


def _line(item: Difference) -> str:
    if item.what == "presence":
        return f"only in {'A' if item.first else 'B'}"
    if item.what == "engine_state":
        return "engine_state: another one"
    if item.apart is None:
        return f"{item.what}: {item.first!r} | {item.second!r}"
    by = f"apart by {item.apart:.3g}, {item.relative:.3g} of it"
    return f"{item.what}: {item.first!r} | {item.second!r} ({by})"


def _summary(worlds: list[World], found: list[Difference]) -> str:
    bodies = len({item.id for item in found if item.kind == "body"})
    joints = len({item.id for item in found if item.kind == "joint"})
    counts = [f"{len(world.bodies)} bodies and {len(world.joints)} joints" for world in worlds]
    sizes = counts[0] if counts[0] == counts[1] else f"{counts[0]}, and {counts[1]}"
    if not found:
        return f"Equal: {sizes}."
    worst = max((item.apart or 0.0 for item in found), default=0.0)
    by = f" Numbers are apart by {worst:.3g} at most." if worst else ""
    return f"Different: {bodies} bodies and {joints} joints of {sizes}.{by}"
