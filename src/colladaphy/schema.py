"""The XSD gate: what passes it is schema-valid COLLADA 1.5, pe profile included."""

from __future__ import annotations

import re
import threading
from collections import defaultdict
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lxml import etree

from colladaphy import schema_rules as rules
from colladaphy.findings import Finding
from colladaphy.schema_blocks import Complaint, validate_in_blocks, wide_parents
from colladaphy.schema_messages import Violation, translate
from colladaphy.source.xml import COLLADA_1_4, COLLADA_1_5

if TYPE_CHECKING:
    from lxml.etree import _Element, _ElementTree

__all__ = ["gate", "is_valid", "is_valid_text", "schema_folder"]

_STEP = re.compile(r"([^/\[\]]+)(?:\[(\d+)\])?")
_LOCK = threading.Lock()
_XS = "{http://www.w3.org/2001/XMLSchema}"
_PE = "urn:colladaphy:pe:1"
_all_ids = etree.XPath("//*/@id", smart_strings=False)
_NCNAME = re.compile(r"[^\W\d][\w.\-·]*\Z")


def schema_folder() -> Path:
    """Where the schema files are: beside the package when installed, else in the checkout."""
    here = Path(__file__).resolve().parent
    for folder in (here / "schema", here.parents[1] / "schema"):
        if (folder / "document.xsd").is_file():
            return folder
    raise FileNotFoundError(f"the schema files of colladaphy are missing beside {here}")


def gate(tree: _ElementTree, *, fresh: bool = False) -> list[Finding]:
    """All deviations of a tree from the schema, in the order of the document; none: it is valid.

    libxml2 stops at the first wrong child of an element, so mending a document can show more. A
    `fresh` tree is as the parser made it and was never validated, which saves looking for ids.
    """
    root = tree.getroot()
    namespace = etree.QName(root).namespace
    if namespace == COLLADA_1_4:
        return [rules.VERSION_1_4.at(root)]
    if namespace != COLLADA_1_5:
        message = f"The root element is in the namespace {namespace!r}."
        if not namespace:
            message = "The root element has no namespace."
        return [rules.WRONG_NAMESPACE.at(root, message)]
    parents = wide_parents(tree)
    complaints = validate_in_blocks(tree, parents, _validate) if parents else _validate(tree)
    violations = [(element, translate(code, message)) for element, code, message in complaints]
    places = _Places(root)
    found = [*_clean(violations), *_unknown_profile(tree)]
    if violations or not fresh:
        found += _duplicate_ids(tree)
    found.sort(key=lambda pair: places.order(pair[0]))
    findings = [
        violation.rule.at(element, violation.message, path=places.path(element))
        for element, violation in found
    ]
    return list(dict.fromkeys(findings))


def is_valid(tree: _ElementTree) -> bool:
    """Whether libxml2 finds nothing wrong with a tree, whatever there is to find.

    It is asked while parsing: validating a tree takes time with the square of the errors, as a
    path is made for each, and leaves ids behind in the tree.
    """
    return is_valid_text(etree.tostring(tree.getroot()))


def is_valid_text(data: bytes) -> bool:
    """Whether the text of a document passes libxml2's validation, which is told while parsing.

    That takes half the time of a tree and the `gate`, and no memory, but says neither what is
    wrong nor whether an id is there twice. False for text that is not well-formed, too.
    """
    nothing: Any = _Nothing()
    parser = etree.XMLParser(
        target=nothing, schema=_schema(), huge_tree=True, resolve_entities=False, no_network=True
    )
    try:
        etree.fromstring(data, parser)
    except etree.XMLSyntaxError:
        return False
    return not len(parser.error_log)


class _Nothing:
    """A parser's target that takes no events."""

    def close(self) -> None:
        """Called at the end."""


@cache
def _schema() -> etree.XMLSchema:
    parser = etree.XMLParser(no_network=True, load_dtd=False, resolve_entities=False)
    return etree.XMLSchema(etree.parse(schema_folder() / "document.xsd", parser))


@cache
def _profile_elements() -> frozenset[str]:
    """The global elements of the pe profile: what a technique may hold of it."""
    root = etree.parse(schema_folder() / "pe-profile.xsd").getroot()
    return frozenset(
        f"{{{_PE}}}{child.get('name')}" for child in root.iterchildren(f"{_XS}element")
    )


def _validate(tree: _ElementTree) -> list[Complaint]:
    """What libxml2 says, by element."""
    schema = _schema()
    with _LOCK:  # the schema object keeps the log of its last run
        schema.validate(tree)
        log: Any = schema.error_log
        entries = [(entry.path, entry.type, entry.message) for entry in log]
    places = _Places(tree.getroot())
    return [(places.element(path or "/*"), code, message) for path, code, message in entries]


_Found = tuple["_Element", Violation]


def _clean(violations: list[_Found]) -> list[_Found]:
    """Leave out what says a thing twice, and libxml2's view of ids, which `_duplicate_ids` has."""
    kept: list[_Found] = []
    seen: set[tuple[_Element, str | None]] = set()
    for element, violation in violations:
        if violation.rule in (rules.INVALID_VALUE, rules.WRONG_LENGTH):
            if (element, violation.attribute) in seen:
                continue
            seen.add((element, violation.attribute))
            if violation.attribute == "id" and _NCNAME.match(violation.value or ""):
                continue
        kept.append((element, violation))
    return kept


def _duplicate_ids(tree: _ElementTree) -> list[_Found]:
    """Ids that are there twice.

    libxml2 remembers ids in the tree from run to run, so after edits its own answer is no use;
    in a fresh tree it finds every one.
    Content of techniques is left out: what it means by `id` is its own affair.
    """
    ids = _all_ids(tree)
    if not isinstance(ids, list) or len(set(ids)) == len(ids):
        return []
    owners: defaultdict[str, list[_Element]] = defaultdict(list)
    technique = f"{{{COLLADA_1_5}}}technique"
    for element in tree.iter(f"{{{COLLADA_1_5}}}*"):
        name = element.get("id")
        if name is not None and next(element.iterancestors(technique), None) is None:
            owners[name.strip()].append(element)
    found: list[_Found] = []
    for name, elements in owners.items():
        first = elements[0]
        for element in elements[1:]:
            line = f" (line {first.sourceline})" if first.sourceline else ""
            message = (
                f"The id {name!r} is already that of a <{etree.QName(first).localname}>{line}."
            )
            found.append((element, Violation(rules.DUPLICATE_ID, message, "id", name)))
    return found


def _unknown_profile(tree: _ElementTree) -> list[_Found]:
    """Elements of the pe profile that it does not have; the schema's wildcards let them pass."""
    known = _profile_elements()
    return [
        (
            element,
            Violation(
                rules.UNKNOWN_ELEMENT,
                f"The pe profile has no element <pe:{etree.QName(element).localname}>.",
                None,
                None,
            ),
        )
        for element in tree.iter(f"{{{_PE}}}*")
        if element.tag not in known
        and not str(getattr(element.getparent(), "tag", "")).startswith(f"{{{_PE}}}")
    ]


class _Places:
    """Elements by libxml2's paths, and paths and places of elements; linear for any number."""

    def __init__(self, root: _Element) -> None:
        self._root = root
        self._elements: dict[str, _Element] = {}
        self._children: dict[_Element, list[_Element]] = {}
        self._named: dict[tuple[_Element, str], list[_Element]] = {}
        self._steps: dict[_Element, tuple[str, int]] = {root: (_local(root), 0)}

    def element(self, path: str) -> _Element:
        """The element that a path such as ``/*/*[2]/pe:body`` means."""
        known = self._elements.get(path)
        if known is None:
            parent, _, step = path.rpartition("/")
            known = self._child(self.element(parent), step) if parent else self._root
            self._elements[path] = known
        return known

    def path(self, element: _Element) -> str:
        """The path of an element as findings give it."""
        return "/" + "/".join(self._step(node)[0] for node in self._chain(element))

    def order(self, element: _Element) -> tuple[int, ...]:
        """A key that sorts elements by their place in the document."""
        return tuple(self._step(node)[1] for node in self._chain(element))

    def _chain(self, element: _Element) -> list[_Element]:
        return [*reversed(list(element.iterancestors())), element]

    def _child(self, parent: _Element, step: str) -> _Element:
        match = _STEP.fullmatch(step)
        if match is None:
            return parent
        name, position = match[1], int(match[2] or 1)
        if name == "*":
            same = self._all(parent)
        else:
            key = (parent, name)
            if key not in self._named:
                self._named[key] = [
                    child for child in self._all(parent) if _prefixed(child) == name
                ]
            same = self._named[key]
        return same[position - 1] if position <= len(same) else parent

    def _all(self, parent: _Element) -> list[_Element]:
        children = self._children.get(parent)
        if children is None:
            children = list(parent.iterchildren(etree.Element))
            self._children[parent] = children
        return children

    def _step(self, element: _Element) -> tuple[str, int]:
        step = self._steps.get(element)
        if step is None:
            parent = element.getparent()
            assert parent is not None
            children = self._all(parent)
            names = [_local(child) for child in children]
            totals: defaultdict[str, int] = defaultdict(int)
            for name in names:
                totals[name] += 1
            seen: defaultdict[str, int] = defaultdict(int)
            for index, (child, name) in enumerate(zip(children, names, strict=True)):
                seen[name] += 1
                shown = f"{name}[{seen[name]}]" if totals[name] > 1 else name
                self._steps[child] = (shown, index)
            step = self._steps[element]
        return step


def _local(element: _Element) -> str:
    return str(element.tag).rpartition("}")[2]


def _prefixed(element: _Element) -> str:
    return f"{element.prefix}:{_local(element)}" if element.prefix else _local(element)
