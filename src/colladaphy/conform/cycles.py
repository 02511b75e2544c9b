"""Nodes and physics models that are instanced within themselves, directly or through others."""

from __future__ import annotations

from lxml import etree

from colladaphy.conform import reference_rules
from colladaphy.conform.context import NS, Context, local

__all__ = ["break_cycles"]


def break_cycles(context: Context) -> None:
    """Move instances that would hold what they stand in into an extra."""
    for kind in ("node", "physics_model"):
        for instance in _closing(context, kind) if context.wants(reference_rules.CYCLE) else ():
            message = (
                f"<instance_{kind} url={instance.get('url')!r}> stands in what it refers to; "
                "moved into an extra"
            )
            context.note(reference_rules.CYCLE, instance, message)
            context.stash(instance)


def _closing(context: Context, kind: str) -> list[etree._Element]:
    """The instances that close a circle, found by one walk along all of them.

    The walk begins where the scene does, so that what is reached from there is whole.
    """
    targets: dict[etree._Element, etree._Element] = {}
    for instance in context.all(f"instance_{kind}"):
        url = instance.get("url", "")
        found = context.by_url(url) if url.startswith("#") else None
        if found is not None and local(found) == kind:
            targets[instance] = found
    inside = {
        target: [i for i in target.iterdescendants(f"{NS}instance_{kind}") if i in targets][::-1]
        for target in targets.values()
    }
    closing: dict[etree._Element, None] = {}
    done: set[etree._Element] = set()
    first = [target for target in _from_outside(targets, kind) if target in inside]
    for start in dict.fromkeys([*first, *inside]):
        waiting = [] if start in done else [start]
        open_ = set[etree._Element]()
        while waiting:
            current = waiting[-1]
            open_.add(current)
            while inside[current]:
                instance = inside[current].pop()
                target = targets[instance]
                if target in done:
                    continue
                if target in open_:
                    closing[instance] = None
                    continue
                waiting.append(target)
                break
            else:
                waiting.pop()
                open_.discard(current)
                done.add(current)
    return list(closing)


def _from_outside(targets: dict[etree._Element, etree._Element], kind: str) -> list[etree._Element]:
    """What is instanced from outside of all such elements, or stands where the scene shows it."""
    found = []
    for instance, target in targets.items():
        if next(instance.iterancestors(NS + kind), None) is None:
            found.append(target)
        else:
            *_, top = instance.iterancestors(NS + kind)
            holder = top.getparent()
            if holder is not None and local(holder) == "visual_scene":
                found.append(top)
    return found
