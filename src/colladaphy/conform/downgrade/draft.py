"""A 1.5 document on its way to 1.4.1: its elements by name, its findings, its kept content."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import cast

from lxml import etree

from colladaphy.findings import Finding, Rule

__all__ = ["KEPT_PROFILE", "NS15", "Draft", "detach", "local", "tag15"]

NS15 = "http://www.collada.org/2008/03/COLLADASchema"
KEPT_PROFILE = "colladaphy-1.5"

# The elements of 1.4.1 that may end with extras. Those of 1.5 that are not here (asset,
# technique_common, sampler, instance_rigid_body's shapes aside) leave it to an ancestor.
_HOLDER_NAMES = """
    COLLADA scene geometry mesh convex_mesh spline control_vertices lines linestrips polygons
    polylist triangles trifans tristrips vertices image light material camera optics imager
    animation animation_clip controller skin joints vertex_weights morph targets node visual_scene
    bind_material effect profile_COMMON box plane sphere cylinder capsule force_field
    physics_material physics_scene rigid_body rigid_constraint ref_attachment attachment
    physics_model shape instance_controller instance_effect instance_geometry instance_material
    instance_node instance_physics_model instance_rigid_body instance_rigid_constraint
    library_animations library_animation_clips library_cameras library_controllers
    library_geometries library_effects library_force_fields library_images library_lights
    library_materials library_nodes library_physics_materials library_physics_models
    library_physics_scenes library_visual_scenes
"""
_HOLDERS = frozenset(_HOLDER_NAMES.split())


def local(element: etree._Element) -> str:
    """The local name of an element; "" for a comment or a processing instruction."""
    tag = element.tag
    return tag.rpartition("}")[2] if isinstance(tag, str) else ""


def tag15(name: str) -> str:
    """The tag of a COLLADA 1.5 element."""
    return f"{{{NS15}}}{name}"


def detach(element: etree._Element) -> etree._Element:
    """Take an element out of its parent, leaving the indentation of what follows in order."""
    parent = element.getparent()
    if parent is not None:
        if element.getnext() is None:
            before = element.getprevious()
            if before is None:
                parent.text = element.tail
            else:
                before.tail = element.tail
        parent.remove(element)
    element.tail = None
    return element


class Draft:
    """The copy of a 1.5 document that the rules work on, still in the namespace of 1.5."""

    def __init__(self, root: etree._Element) -> None:
        _settle_notes(root)
        self.root = root
        self.findings: list[Finding] = []
        self._steps: dict[etree._Element, dict[etree._Element, str]] = {}
        self._by_name: dict[str, list[etree._Element]] | None = None
        self._techniques: dict[etree._Element, etree._Element] = {}

    # -- findings -----------------------------------------------------------------------------

    def note(self, rule: Rule, element: etree._Element, message: str) -> None:
        """Record a finding at an element."""
        self.findings.append(rule.at(element, message, path=self._path(element)))

    def _path(self, element: etree._Element) -> str:
        """The path of an element; the positions of siblings are counted once a parent."""
        steps: list[str] = []
        node: etree._Element | None = element
        while node is not None:
            parent = node.getparent()
            steps.append(local(node) if parent is None else self._step(parent, node))
            node = parent
        return "/" + "/".join(reversed(steps))

    def _step(self, parent: etree._Element, child: etree._Element) -> str:
        steps = self._steps.get(parent)
        if steps is None or child not in steps:
            steps = self._steps[parent] = _steps_of(parent)
        return steps[child]

    # -- elements -----------------------------------------------------------------------------

    def all(self, *names: str) -> Iterator[etree._Element]:
        """The elements of the standard of these names, in document order for each name.

        What a technique holds for a profile of its own is not the standard's.
        """
        if self._by_name is None:
            self._by_name = {}
            for element in _standard_elements(self.root):
                self._by_name.setdefault(local(element), []).append(element)
        for name in names:
            yield from self._by_name.get(name, ())

    def changed(self) -> None:
        """Let `all` look again: elements came, went or were renamed."""
        self._by_name = None

    def everything(self) -> Iterator[etree._Element]:
        """Every element of the standard."""
        return _standard_elements(self.root)

    # -- what 1.4.1 has no place for ------------------------------------------------------------

    def keep(self, element: etree._Element) -> None:
        """Move an element to the nearest place where 1.4.1 allows foreign content."""
        parent = element.getparent()
        if parent is not None:
            self._keep(detach(element), parent)

    def keep_copy(self, twin: etree._Element, original: etree._Element) -> None:
        """Keep a loose element, which says what `original` said, as if that were moved."""
        parent = original.getparent()
        if parent is not None:
            self._keep(twin, parent)

    def keep_attributes(self, element: etree._Element, *names: str) -> None:
        """Move attributes to an element of the same name in the extra that serves `element`."""
        kept = {name: str(element.attrib.pop(name)) for name in names if name in element.attrib}
        if kept:
            twin = self.make(local(element), attributes=kept)
            if "id" in element.attrib and not _may_hold(element):
                twin.set("id", element.attrib["id"])
            parent = element.getparent()
            self._keep(twin, element if _may_hold(element) or parent is None else parent)

    def make(
        self, name: str, text: str | None = None, attributes: Mapping[str, str] | None = None
    ) -> etree._Element:
        """A new element of COLLADA 1.5, with the prefix that the document uses."""
        nsmap = cast("dict[str, str]", {self.root.prefix: NS15})
        element = etree.Element(tag15(name), nsmap=nsmap)
        element.text = text
        for key, value in (attributes or {}).items():
            element.set(key, value)
        return element

    def _keep(self, element: etree._Element, near: etree._Element) -> None:
        holder = near
        while not _may_hold(holder):
            # The elements in between say where the kept one was.
            around = self.make(local(holder))
            for name in ("id", "sid"):
                if name in holder.attrib:
                    around.set(name, holder.attrib[name])
            around.append(element)
            element = around
            above = holder.getparent()
            if above is None:
                break
            holder = above
        self._technique(holder).append(element)

    def _technique(self, holder: etree._Element) -> etree._Element:
        technique = self._techniques.get(holder)
        if technique is None:
            technique = self.make("technique", attributes={"profile": KEPT_PROFILE})
            if local(holder) in ("source", "extra"):
                _append(holder, technique)
            else:
                extra = self.make("extra")
                extra.append(technique)
                _append(holder, extra)
            self._techniques[holder] = technique
        return technique


def _may_hold(element: etree._Element) -> bool:
    name = local(element)
    if name == "technique":
        return "profile" not in element.attrib
    return name in _HOLDERS or name in ("source", "extra")


def _append(parent: etree._Element, element: etree._Element) -> None:
    if len(parent):
        last = parent[-1]
        element.tail = last.tail
        last.tail = parent.text
    parent.append(element)


def _steps_of(parent: etree._Element) -> dict[etree._Element, str]:
    by_name: dict[str, list[etree._Element]] = {}
    for child in parent:
        by_name.setdefault(local(child), []).append(child)
    steps: dict[etree._Element, str] = {}
    for name, children in by_name.items():
        for position, child in enumerate(children, 1):
            steps[child] = f"{name}[{position}]" if len(children) > 1 else name
    return steps


def _settle_notes(root: etree._Element) -> None:
    """Put comments and instructions that stand within a text before its element: texts are whole.

    1.4.1 means the same by it, and every rule may read and write a text as one.
    """
    for element in list(_standard_elements(root)):
        notes = list(element)
        text = (element.text or "") + "".join(note.tail or "" for note in notes)
        if not notes or not text.strip() or any(local(note) for note in notes):
            continue
        for note in notes if element is not root else ():
            note.tail = None
            element.addprevious(note)
        element.text = text


def _standard_elements(root: etree._Element) -> Iterator[etree._Element]:
    stack = [root]
    while stack:
        element = stack.pop()
        if not isinstance(element.tag, str):
            continue
        yield element
        if "profile" in element.attrib and local(element) == "technique":
            continue
        stack.extend(reversed(element))
