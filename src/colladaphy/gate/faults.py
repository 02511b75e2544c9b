"""Everything that is wrong with a tree by the schema, as findings."""

from __future__ import annotations

import re
import threading
from collections import defaultdict
from functools import partial
from typing import TYPE_CHECKING, Any

from lxml import etree

from colladaphy.findings import Finding
from colladaphy.gate import rules
from colladaphy.gate.blocks import Complaint, validate_in_blocks, wide_parents
from colladaphy.gate.messages import Violation, translate
from colladaphy.gate.places import Places
from colladaphy.gate.schema import PE, compiled, profile_elements
from colladaphy.source.xml import COLLADA_1_4, COLLADA_1_5

if TYPE_CHECKING:
    from lxml.etree import _Element, _ElementTree

__all__ = ["gate", "violations"]

_Found = tuple["_Element", Violation]
_LOCK = threading.Lock()
_all_ids = etree.XPath("//*/@id", smart_strings=False)
_NCNAME = re.compile(r"[^\W\d][\w.\-·]*\Z")


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
    places = Places(root)
    findings = [
        violation.rule.at(element, violation.message, path=places.path(element))
        for element, violation in violations(tree, fresh=fresh, places=places)
    ]
    return list(dict.fromkeys(findings))


def violations(
    tree: _ElementTree,
    *,
    fresh: bool = False,
    places: Places | None = None,
    schema: etree.XMLSchema | None = None,
) -> list[_Found]:
    """The deviations that `gate` makes findings of, each with its element; see there.

    `schema` is that of another version, for a tree of it.
    """
    places = places or Places(tree.getroot())
    parents = wide_parents(tree)
    validate = _validate if schema is None else partial(_validate, schema=schema)
    if parents:
        complaints = validate_in_blocks(tree, parents, validate, expected=_doubled(tree))
    else:
        complaints = validate(tree)
    said = [(element, translate(code, message)) for element, code, message in complaints]
    found = [*_clean(said), *_unknown_profile(tree)]
    if said or not fresh:
        found += _duplicate_ids(tree)
    found.sort(key=lambda pair: places.order(pair[0]))
    return found


def _validate(tree: _ElementTree, schema: etree.XMLSchema | None = None) -> list[Complaint]:
    """What libxml2 says, by element."""
    schema = schema or compiled()
    with _LOCK:  # the schema object keeps the log of its last run
        schema.validate(tree)
        log: Any = schema.error_log
        entries = [(_path(entry), entry.type, entry.message) for entry in log]
    places = Places(tree.getroot())
    return [(places.element(path), code, message) for path, code, message in entries]


def _path(entry: Any) -> str:
    """Where an element is; that of its parent where libxml2 cuts a long name within a letter."""
    try:
        return entry.path or "/*"
    except UnicodeDecodeError as error:
        return error.object.decode("utf-8", "ignore")


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


def _doubled(tree: _ElementTree) -> int:
    """How many ids are there again; content of techniques counts, too."""
    ids = _all_ids(tree)
    return len(ids) - len(set(ids)) if isinstance(ids, list) else 0


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
    namespace = etree.QName(tree.getroot()).namespace
    technique = f"{{{namespace}}}technique"
    for element in tree.iter(f"{{{namespace}}}*"):
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
    known = profile_elements()
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
        for element in tree.iter(f"{{{PE}}}*")
        if element.tag not in known
        and not str(getattr(element.getparent(), "tag", "")).startswith(f"{{{PE}}}")
    ]
