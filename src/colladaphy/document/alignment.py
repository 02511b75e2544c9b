"""Which child of one version of an element became which child of another version."""

from __future__ import annotations

from bisect import bisect_left
from collections import defaultdict, deque
from collections.abc import Callable, Hashable, Sequence
from hashlib import blake2b

from lxml import etree

__all__ = ["align", "longest_increasing"]

# What tells an element from its siblings, the surest first.
_IDENTIFYING = (
    "id", "sid", "url", "body", "constraint", "rigid_body", "source", "target", "ref",
    "semantic", "symbol", "profile", "name",
)  # fmt: skip


def _digest(node: etree._Element) -> bytes:
    """A short stand-in for everything inside a node, its tail excepted."""
    return blake2b(etree.tostring(node, with_tail=False), digest_size=16).digest()


def align(
    before: Sequence[etree._Element], after: Sequence[etree._Element]
) -> list[tuple[int | None, bool]]:
    """For each node of `after` the index in `before` of what it was, and whether it changed.

    The index is None for a new one.
    Equal nodes belong together, then those of the same name and identity, then those of the same
    name in their order. No node of `before` is named twice. Linear in the number of nodes.
    """
    old, new = [_digest(node) for node in before], [_digest(node) for node in after]
    result: list[int | None] = [None] * len(after)
    start = 0
    while start < min(len(old), len(new)) and old[start] == new[start]:
        result[start] = start
        start += 1
    stop = 0
    while stop < min(len(old), len(new)) - start and old[-1 - stop] == new[-1 - stop]:
        stop += 1
        result[-stop] = len(old) - stop
    left = list(range(start, len(old) - stop))
    open_ = list(range(start, len(new) - stop))
    keys: tuple[Callable[[bool, int], Hashable], ...] = (
        lambda is_new, i: new[i] if is_new else old[i],
        lambda is_new, i: _identity(after[i] if is_new else before[i]),
        lambda is_new, i: (after[i] if is_new else before[i]).tag,
    )
    for key in keys:
        waiting: defaultdict[Hashable, deque[int]] = defaultdict(deque)
        for i in left:
            waiting[key(False, i)].append(i)
        for i in open_:
            same = waiting.get(key(True, i))
            if same:
                result[i] = same.popleft()
        left = sorted(i for queue in waiting.values() for i in queue)
        open_ = [i for i in open_ if result[i] is None]
    return [(i, i is None or old[i] != mine) for i, mine in zip(result, new, strict=True)]


def _identity(node: etree._Element) -> Hashable:
    if isinstance(node.tag, str):
        for name in _IDENTIFYING:
            value = node.get(name)
            if value is not None:
                return node.tag, name, value
    return node


def longest_increasing(numbers: Sequence[int]) -> set[int]:
    """The members of a longest increasing subsequence of distinct numbers."""
    ends: list[int] = []  # the smallest end of an increasing run, by its length
    before: dict[int, int | None] = {}
    for number in numbers:
        place = bisect_left(ends, number)
        before[number] = ends[place - 1] if place else None
        ends[place : place + 1] = [number]
    result: set[int] = set()
    number_or_none = ends[-1] if ends else None
    while number_or_none is not None:
        result.add(number_or_none)
        number_or_none = before[number_or_none]
    return result
