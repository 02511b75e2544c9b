"""Writing a World back into the document that it came from.

What a World of the document is now is compared with the given one, by system id; only what differs
is touched. The result is read again: what would not come back to the last bit (system ids and
materials depend on what else is there) is written more explicitly, until it does.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from lxml import etree

from colladaphy.document import rules
from colladaphy.document.updating.differences import Differences, differences
from colladaphy.document.updating.edit import Edit
from colladaphy.document.updating.plan import Demands
from colladaphy.findings import Report
from colladaphy.links.resource import Resource
from colladaphy.mapper import Chosen, trace
from colladaphy.world import World
from colladaphy_schema.codec import paused_collector

__all__ = ["updated"]

_ROUNDS = 6


def updated(
    resource: Resource, choose: Callable[[Resource], Chosen], world: World
) -> etree._ElementTree | None:
    """The document with a World in the place of the one that `choose` loads from it.

    None where nothing differs. What was noticed is added to the report of the resource.
    """
    # Numbers too large for arithmetic are told from what becomes of them.
    with paused_collector(), np.errstate(all="ignore"):
        quiet = _quiet(resource)
        chosen = choose(quiet)
        loaded = trace(quiet, chosen)
        changes = differences(loaded.world, world)
        if not changes:
            return None
        scene = chosen.scenes[0] if chosen.scenes else None
        # Where the links stand is where kinematic joints are at rest.
        demands = Demands(driven=bool(
            changes.poses or changes.values or changes.gone or changes.new or changes.joints_changed
            or changes.joints_new or changes.joints_gone))  # fmt: skip
        for round_ in range(_ROUNDS):
            edit = Edit(quiet, loaded, scene, world, changes, demands)
            again = _quiet(resource, edit.tree)
            left = differences(trace(again, choose(again)).world, world)
            if not left or not _demand(demands, left, round_):
                break
        resource.report.extend(edit.findings)
        if left:
            resource.report.add(rules.INEXACT.at(message=_told(left), file=resource.file))
        return edit.tree


def _quiet(resource: Resource, tree: etree._ElementTree | None = None) -> Resource:
    """The same document, whose findings are its own."""
    data = resource.data if tree is None and not resource.has_other_spelling else None
    return Resource(resource.shown_tree if tree is None else tree, data, file=resource.file,
                    report=Report(resource.file), opener=resource.opener, family=resource.family,
                    tolerant=True, member=resource.member)  # fmt: skip


def _demand(demands: Demands, left: Differences, round_: int) -> bool:
    """Ask for more where something did not come back; whether there is more to ask for."""
    before = repr(demands)
    if not demands.pins and (left.gone or left.new or left.values or left.joints_gone):
        demands.pins = True
    elif round_:
        demands.anew |= left.values & demands.values
        demands.values |= left.values
    demands.poses |= left.poses & demands.motions
    demands.motions |= left.poses | left.motions
    demands.joints |= left.joints_changed
    return repr(demands) != before


def _told(left: Differences) -> str:
    parts = [
        f"{name} {', '.join(map(str, sorted(sids)[:5]))}{' …' if len(sids) > 5 else ''}"
        for name, sids in (
            ("bodies", left.gone | left.new | left.values | left.poses | left.motions),
            ("joints", left.joints_gone | left.joints_new | left.joints_changed),
        )
        if sids
    ]
    if left.scene:
        parts.append("values of the scene")
    return f"Not read back exactly: {'; '.join(parts)}."
