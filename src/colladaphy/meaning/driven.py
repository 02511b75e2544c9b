"""Nodes that both physics and an animation move (COLLADA 1.5 §channel, §instance_rigid_body)."""

from __future__ import annotations

from collections.abc import Iterator

from colladaphy.meaning import physics_rules
from colladaphy.meaning.animation import addressed
from colladaphy.meaning.body_table import bodies_of
from colladaphy.meaning.context import Context
from colladaphy.meaning.hits import Hit
from colladaphy.meaning.node_table import nodes_of

__all__ = ["CHECKS"]


def driven(context: Context) -> Iterator[Hit]:
    """Channels that move the nodes of bodies that move by themselves."""
    nodes, bodies = nodes_of(context), bodies_of(context)
    movers: dict[int, int] = {}
    for instance, target in nodes.targets.items():
        if target >= 0 and bodies.moves[bodies.row(instance)]:
            movers.setdefault(target, instance)
    if not movers:
        return
    for reference in context.references("target", "channel"):
        found = addressed(context, reference.text.strip())
        node = -1 if isinstance(found, str) else int(context.parent[found[0]])
        if node in movers:
            message = f"{context.label(node)} is moved by a body as well."
            yield Hit(physics_rules.NODE_ANIMATED, reference.element, message,
                      (movers[node], node), "target")  # fmt: skip


CHECKS = (driven,)
