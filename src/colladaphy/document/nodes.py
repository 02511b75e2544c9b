"""Where nodes stand: transforms in document order, through parents and instance_node.

COLLADA 1.5 §node, §instance_node: the transforms of a node are applied as if each were the parent
of the next; an instance_node puts a node of a library below the node that holds the instance.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from lxml import etree

from colladaphy.document import rules
from colladaphy.document.affine import lookat_matrix, skew_matrix
from colladaphy.document.names import c
from colladaphy.document.poses import (
    IDENTITY,
    Matrix,
    Pose,
    matrix_of,
    multiply_matrices,
    quaternion_from_axis_angle,
    rigid_part,
)
from colladaphy.errors import DocumentError

if TYPE_CHECKING:
    from colladaphy.document.document import Document

__all__ = ["Placement", "floats_of", "own_transform", "pose_of_steps", "text_of"]

Transform = Pose | Matrix

_NODE = c("node")
_TRANSLATE = c("translate")
_ROTATE = c("rotate")


def floats_of(element: etree._Element) -> list[float]:
    """The numbers of an element's text; XML's INF and NaN are Python's too."""
    return [float(word) for word in text_of(element).split()]


def text_of(element: etree._Element) -> str:
    """The text of an element, with comments in it passed over."""
    return element.text or "" if not len(element) else str(element.xpath("string()"))


def pose_of_steps(steps: Iterable[etree._Element]) -> Pose:
    """The pose of translate and rotate elements in their order; others are passed over."""
    pose = IDENTITY
    for step in steps:
        if step.tag == _TRANSLATE:
            x, y, z = floats_of(step)
            pose = pose.then(Pose((x, y, z)))
        elif step.tag == _ROTATE:
            pose = pose.then(Pose(None, quaternion_from_axis_angle(*floats_of(step))))
    return pose


def _affine(element: etree._Element) -> Matrix:
    values = floats_of(element)
    name = element.tag
    if name == c("matrix"):
        return tuple(
            (values[row], values[row + 1], values[row + 2], values[row + 3])
            for row in (0, 4, 8, 12)
        )
    if name == c("scale"):
        x, y, z = values
        return ((x, 0.0, 0.0, 0.0), (0.0, y, 0.0, 0.0), (0.0, 0.0, z, 0.0), (0.0, 0.0, 0.0, 1.0))
    if name == c("skew"):
        return skew_matrix(values)
    return lookat_matrix(values)


_AFFINE_TAGS = frozenset(c(name) for name in ("matrix", "scale", "skew", "lookat"))
_TRANSFORM_TAGS = _AFFINE_TAGS | {_TRANSLATE, _ROTATE}


def own_transform(node: etree._Element) -> Transform:
    """The transform of a node in its parent: a Pose where it is made of translate and rotate."""
    steps = [child for child in node if child.tag in _TRANSFORM_TAGS]
    transform: Transform = IDENTITY
    for step in steps:
        if step.tag in _AFFINE_TAGS:
            transform = compose(transform, _affine(step))
        else:
            transform = compose(transform, pose_of_steps((step,)))
    return transform


def compose(outer: Transform, inner: Transform) -> Transform:
    """`inner` within `outer`; poses stay poses."""
    if isinstance(outer, Pose) and isinstance(inner, Pose):
        return outer.then(inner)
    if inner == IDENTITY:
        return outer
    if outer == IDENTITY:
        return inner
    first = matrix_of(outer) if isinstance(outer, Pose) else outer
    second = matrix_of(inner) if isinstance(inner, Pose) else inner
    return multiply_matrices(first, second)


class Placement:
    """World transforms of the nodes that one document and those it refers to hold.

    Remembers what it found; raises DocumentError where nodes are instanced in a circle.
    """

    def __init__(self, document: Document) -> None:
        self._document = document
        self._known: dict[etree._Element, Transform] = {}
        self._holders: dict[etree._Element, list[tuple[Document, etree._Element]]] | None = None
        self._reported: set[etree._Element] = set()

    def pose(self, document: Document, node: etree._Element) -> Pose:
        """The world pose of a node; what is not rigid in it is left out and reported."""
        transform = self.transform(document, node)
        if isinstance(transform, Pose):
            return transform
        pose, exact = rigid_part(transform)
        if not exact and node not in self._reported:
            self._reported.add(node)
            name = node.get("id") or node.get("name") or "?"
            self._document.note(
                rules.NOT_RIGID,
                node,
                f"The transform of node {name!r} scales, skews or mirrors; "
                "its rotation and translation are taken.",
                file=document.file,
            )
        return pose

    def transform(self, document: Document, node: etree._Element) -> Transform:
        """The world transform of a node."""
        return self._transform(document, node, [])

    def _transform(
        self, document: Document, node: etree._Element, path: list[etree._Element]
    ) -> Transform:
        known = self._known.get(node)
        if known is not None:
            return known
        if node in path:
            message = f"The node {node.get('id')!r} is instanced within itself."
            raise DocumentError(rules.CYCLE.at(node, message, file=document.file))
        own = own_transform(node)
        parent = node.getparent()
        if parent is not None and parent.tag == _NODE:
            outer = self._transform(document, parent, [*path, node])
        else:
            outer = self._outside(document, node, [*path, node])
        result = self._known[node] = compose(outer, own)
        return result

    def _outside(
        self, document: Document, node: etree._Element, path: list[etree._Element]
    ) -> Transform:
        """The world transform of the node that instances `node`, which has no parent node."""
        parent = node.getparent()
        if parent is None or parent.tag == c("visual_scene"):
            return IDENTITY
        holders = self._instances().get(node, ())
        if not holders:
            return IDENTITY
        if len(holders) > 1:
            self._document.note(
                rules.SEVERAL_PLACES,
                node,
                f"The node {node.get('id')!r} is instanced {len(holders)} times; "
                "the first instance places it.",
                file=document.file,
            )
        where, holder = holders[0]
        return self._transform(where, holder, path)

    def is_within(self, node: etree._Element, ancestor: etree._Element) -> bool:
        """Whether `ancestor` is above `node`, through parents and instances, or is it."""
        seen: set[etree._Element] = set()
        current: etree._Element | None = node
        while current is not None and current not in seen:
            if current is ancestor:
                return True
            seen.add(current)
            parent = current.getparent()
            if parent is not None and parent.tag == _NODE:
                current = parent
            else:
                holders = self._instances().get(current, ())
                current = holders[0][1] if holders else None
        return False

    def _instances(self) -> dict[etree._Element, list[tuple[Document, etree._Element]]]:
        """The nodes that hold instances, by the node that is instanced."""
        if self._holders is None:
            self._holders = {}
            documents = [self._document]
            for document in documents:
                for instance in document.index.node_instances:
                    holder = instance.getparent()
                    if holder is None:
                        continue
                    try:
                        target = document.resolve(instance.get("url", ""), instance, "node")
                    except DocumentError as error:
                        self._document.report.extend(error.findings)
                        continue
                    self._holders.setdefault(target.element, []).append((document, holder))
                    if target.document not in documents:
                        documents.append(target.document)
        return self._holders
