"""Validating in blocks where a tree has very many siblings, so that errors stay cheap.

For every error libxml2 writes down the path of its element, and counts siblings for it: with n
faulty siblings that is n² steps, minutes for a hundred thousand. So where an element has very many
children, a random sample of them is validated first. If that finds little, errors are rare, and
the whole tree is validated at once. Otherwise copies of the tree are validated that hold one block
of the children each.
"""

from __future__ import annotations

import random
from collections.abc import Callable
from copy import deepcopy
from functools import partial
from itertools import groupby
from typing import Any

from lxml import etree

__all__ = ["Complaint", "validate_in_blocks", "wide_parents"]

#: An element, libxml2's code, and its message.
Complaint = tuple[etree._Element, int, str]
Validator = Callable[[etree._ElementTree], list[Complaint]]
_Kept = dict[etree._Element, list[etree._Element]]

_WIDE = 4000
_BLOCK = 1000
"""How many children are validated together: fewer cost more copies, more cost longer paths."""
_SAMPLE = (40, 300)
"""How many children are tried: one in a hundred, but at least and at most so many."""
_FEW = 5000
"""So many errors cost less in the whole tree, with their paths, than blocks would."""
# Where bodies, instances, nodes and primitives are; deeper ones would cost every document dear.
_LEVELS = 5
# A child that has so many before it; to ask every element whether it has one takes twice the time.
_find_wide = etree.XPath(" | ".join("/*" * level + f"/*[{_WIDE}]" for level in range(1, _LEVELS)))


def wide_parents(tree: etree._ElementTree) -> list[etree._Element]:
    """The elements with very many children."""
    found = _find_wide(tree)
    nodes = found if isinstance(found, list) else []
    parents = [node.getparent() for node in nodes if isinstance(node, etree._Element)]
    return [parent for parent in parents if parent is not None]


def validate_in_blocks(
    tree: etree._ElementTree,
    parents: list[etree._Element],
    validate: Validator,
    *,
    expected: int = 0,
) -> list[Complaint]:
    """What `validate` says about `tree`, whose elements `parents` have very many children.

    `expected` complaints are known to come that a sample may not show.
    """
    sample = {parent: _sampled(_children(parent)) for parent in parents}
    found = len(_validate_reduced(tree, sample, validate))
    share = min(len(sample[parent]) / len(parent) for parent in parents)
    if found < _FEW * share and expected < _FEW:
        return validate(tree)
    thin = {parent: _thinned(_children(parent)) for parent in parents}
    complaints: dict[Complaint, None] = {}
    for parent in parents:
        children = _children(parent)
        for start in range(0, len(children), _BLOCK):
            block = set(children[start : start + _BLOCK])
            kept = thin | {parent: _merge(parent, thin[parent], block)}
            complaints |= dict.fromkeys(_validate_reduced(tree, kept, validate))
    return list(complaints)


def _children(parent: etree._Element) -> list[etree._Element]:
    return list(parent.iterchildren(etree.Element))


def _sampled(children: list[etree._Element]) -> list[etree._Element]:
    """Some children from anywhere, so that no document can hide its errors from them."""
    last = len(children) - 1
    count = min(max(len(children) // 100, _SAMPLE[0]), _SAMPLE[1])
    chosen = {0, 1, last - 1, last, *random.sample(range(last), count)}
    return [children[index] for index in sorted(chosen)]


def _thinned(children: list[etree._Element]) -> list[etree._Element]:
    """Of every run of children of one name the first two and the last: what content models see."""
    kept: list[etree._Element] = []
    for _, group in groupby(children, key=lambda child: child.tag):
        run = list(group)
        kept += run if len(run) <= 3 else [*run[:2], run[-1]]
    return kept[:_WIDE]


def _merge(
    parent: etree._Element, kept: list[etree._Element], more: set[etree._Element]
) -> list[etree._Element]:
    wanted = more.union(kept)
    return [child for child in _children(parent) if child in wanted]


def _validate_reduced(
    tree: etree._ElementTree, kept: _Kept, validate: Validator
) -> list[Complaint]:
    """Complaints about a copy without the children that are not kept, as of the original."""
    ways = {node for parent in kept for node in (parent, *parent.iterancestors())}
    originals: dict[etree._Element, etree._Element] = {}
    root = _copy(tree.getroot(), None, kept, ways, originals)
    return [
        (originals[element], code, message)
        for element, code, message in validate(etree.ElementTree(root))
    ]


def _copy(
    element: etree._Element,
    parent: etree._Element | None,
    kept: _Kept,
    ways: set[etree._Element],
    originals: dict[etree._Element, etree._Element],
) -> etree._Element:
    names: Any = element.nsmap
    make = etree.Element if parent is None else partial(etree.SubElement, parent)
    copy = make(str(element.tag), nsmap=names)
    for key, value in element.items():
        copy.set(key, value)
    copy.text, copy.tail = element.text, element.tail
    originals[copy] = element
    for child in kept.get(element) or element.iterchildren(etree.Element):
        if child in ways:
            _copy(child, copy, kept, ways, originals)
        else:
            twin = deepcopy(child)
            copy.append(twin)
            pairs = zip(twin.iter(etree.Element), child.iter(etree.Element), strict=True)
            originals.update(pairs)
    return copy
