"""Which COLLADA a document is, and a copy of it in the namespace of 1.5."""

from __future__ import annotations

import copy
from collections.abc import Mapping
from typing import Any, cast

from lxml import etree

from colladaphy.conform import version_rules
from colladaphy.conform.context import Context, line_of, local
from colladaphy.conform.grammar import NAMESPACE
from colladaphy.source.copying import copy_tree

__all__ = ["NAMESPACE_1_4", "copy_as_1_5", "detect_version", "note_version"]

NAMESPACE_1_4 = "http://www.collada.org/2005/11/COLLADASchema"
_XSI = "http://www.w3.org/2001/XMLSchema-instance"
_FAR = 65535  # libxml2 keeps line numbers in sixteen bits


def detect_version(tree: etree._ElementTree) -> str | None:
    """The version of COLLADA a document says it is (``"1.4.1"``); None where it is none.

    The namespace decides; the version attribute only refines it, or speaks where there is no
    namespace that we know.
    """
    root = tree.getroot()
    if root is None or local(root).upper() != "COLLADA":
        return None
    namespace = etree.QName(root).namespace
    stated = (root.get("version") or "").strip()
    if namespace == NAMESPACE:
        return "1.5.0"
    if namespace == NAMESPACE_1_4:
        return stated if stated.startswith("1.4") else "1.4.1"
    return stated or "1.4.1"


def copy_as_1_5(
    tree: etree._ElementTree,
) -> tuple[etree._ElementTree, dict[etree._Element, int]]:
    """A copy of `tree` with standard elements in the namespace of 1.5.

    Comments, processing instructions, text, prefixes and source lines are those of the original.
    The second value holds the lines beyond 65535, which the tree itself cannot keep.
    """
    old = tree.getroot()
    current = etree.QName(old).namespace == NAMESPACE
    if current and not _other_namespaces(old):
        twin = copy_tree(tree)
        root = twin.getroot()
    else:
        root = _rebuild(old)
        twin = root.getroottree()
        for node in reversed(list(old.itersiblings(preceding=True))):
            root.addprevious(copy.deepcopy(node))
        for node in reversed(list(old.itersiblings())):
            root.addnext(copy.deepcopy(node))
    last = max((line_of(element) or 0) for element in list(old)[-1:] or [old])
    far: dict[etree._Element, int] = {}
    if last >= _FAR:
        for before, after in zip(old.iter(), root.iter(), strict=True):
            if (line := line_of(before) or 0) >= _FAR:
                far[after] = line
    return twin, far


def _is_old(tag: str) -> bool:
    """Whether a tag is COLLADA's, but not in the namespace of 1.5."""
    namespace = tag[1:].partition("}")[0] if tag.startswith("{") else ""
    if namespace == NAMESPACE:
        return False
    return "collada.org" in namespace and namespace.rstrip("/").endswith("COLLADASchema")


def _other_namespaces(root: etree._Element) -> set[str]:
    tags = {str(element.tag) for element in root.iter(etree.Element)}
    return {tag[1:].partition("}")[0] for tag in tags if _is_old(tag)}


def _rebuild(old: etree._Element) -> etree._Element:
    bare = etree.QName(old).namespace is None
    foreign = etree.QName(old).namespace

    def new_tag(tag: str) -> str:
        namespace, _, name = tag[1:].rpartition("}") if tag.startswith("{") else ("", "", tag)
        ours = _is_old(tag) or (not namespace and bare) or (namespace and namespace == foreign)
        return f"{{{NAMESPACE}}}{name}" if ours else tag

    def new_map(nsmap: Mapping[str | None, str]) -> Mapping[str, str]:
        # The stubs of lxml do not know that a prefix may be None.
        return cast(
            Mapping[str, str],
            {
                prefix: NAMESPACE if uri == foreign or _is_old(f"{{{uri}}}x") else uri
                for prefix, uri in nsmap.items()
            },
        )

    def attributes(element: etree._Element) -> dict[str, str]:
        return {str(key): str(value) for key, value in element.attrib.items()}

    outer = {**old.nsmap, None: NAMESPACE} if bare else dict(old.nsmap)
    root = etree.Element(new_tag(str(old.tag)), attributes(old), new_map(outer))
    twins = {old: root}
    maps = {old: dict(old.nsmap)}
    root.text = old.text
    _set_line(root, old)
    for node in old.iterdescendants():
        parent = node.getparent()
        assert parent is not None
        if isinstance(node.tag, str):
            own = dict(node.nsmap)
            twin = etree.SubElement(
                twins[parent],
                new_tag(node.tag),
                attributes(node),
                None if own == maps[parent] else new_map(own),
            )
            twin.text, twin.tail = node.text, node.tail
            if len(node):
                twins[node], maps[node] = twin, own
        else:
            twin = copy.deepcopy(node)
            twins[parent].append(twin)
        _set_line(twin, node)
    return root


def _set_line(twin: Any, node: etree._Element) -> None:
    twin.sourceline = min(line_of(node) or 0, _FAR)


def note_version(context: Context, original: etree._Element, version: str) -> None:
    """Say what version the document was, and make its root say what it is now."""
    root = context.root
    namespace = etree.QName(original).namespace
    if version.startswith("1.4"):
        message = (
            f"the document was COLLADA {version} ({namespace or 'no namespace'}), is now 1.5.0"
        )
        context.note(version_rules.VERSION, root, message)
    elif namespace == NAMESPACE and (strays := _other_namespaces(original)):
        message = f"elements were in {', '.join(sorted(strays))}, are now in {NAMESPACE}"
        context.note(version_rules.NAMESPACE_FIXED, root, message)
    elif namespace != NAMESPACE:
        message = f"the namespace was {namespace or 'missing'}, is now {NAMESPACE}"
        context.note(version_rules.NAMESPACE_FIXED, root, message)
    if not version.startswith("1.4") and original.get("version") != "1.5.0":
        message = f"version was {original.get('version')!r}, is now '1.5.0'"
        context.note(version_rules.VERSION_ATTRIBUTE, root, message)
    if local(root) != "COLLADA":
        root.tag = f"{{{NAMESPACE}}}COLLADA"
    root.set("version", "1.5.0")
    hint = f"{{{_XSI}}}schemaLocation"
    if NAMESPACE_1_4 in (where := root.get(hint, "")):
        del root.attrib[hint]
        message = f"xsi:schemaLocation pointed to the schema of 1.4 ({where}); removed"
        context.note(version_rules.SCHEMA_LOCATION, root, message)
