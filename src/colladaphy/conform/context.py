"""What a rule works with: the tree, the findings, where things go that have no place."""

from __future__ import annotations

import copy
import math
import re
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import replace
from functools import cache, lru_cache
from typing import cast

from lxml import etree

from colladaphy.conform.grammar import NAMESPACE, ComplexType, root_declaration, stated_type
from colladaphy.conform.trace import Trace
from colladaphy.findings import Finding, Rule

__all__ = [
    "CONFORM",
    "NS",
    "OWN_MAP",
    "Context",
    "local",
    "settle_notes",
    "standard_elements",
    "standard_elements_with",
    "text_of",
]

NS = "{" + NAMESPACE + "}"
CONFORM = "urn:colladaphy:conform:1"
OWN_MAP = {"conform": CONFORM}


def local(element: etree._Element) -> str:
    """The local name of an element; "" for a comment or a processing instruction."""
    return _name_in(element.tag)


@lru_cache(maxsize=4096)  # tags repeat; taking them apart each time costs half the run
def _name_in(tag: object) -> str:
    return tag.rpartition("}")[2] if isinstance(tag, str) else ""


def line_of(element: etree._Element) -> int | None:
    """The source line of an element, from 1; None where it has none."""
    line = element.sourceline
    return line if isinstance(line, int) else None


class Context:
    """One run of conform over one document.

    `only` limits the run to rules of these codes. `note` records a change; a rule asks `wants`
    before it makes one.
    """

    def __init__(
        self,
        root: etree._Element,
        *,
        file: str | None = None,
        only: Collection[str] | None = None,
        origin: str = "colladaphy-repair",
    ) -> None:
        self.root = root
        self.file = file
        self.findings: list[Finding] = []
        self.origin = origin
        self.far_lines: dict[etree._Element, int] = {}
        self.trace: Trace | None = None
        self.unplaced: set[etree._Element] = set()
        """Frames of mass that were made and do not say yet where they are."""
        self.nothing: etree._Element | None = None
        """The geometry without points that stands for none, once it is needed."""
        self.digits = 0
        """Significant digits of the values that were converted, as the file has them."""
        self._only = None if only is None else frozenset(only)
        # The stubs of lxml do not know that a prefix may be None.
        self._map = cast(Mapping[str, str], {root.prefix: NAMESPACE})
        self._labels: dict[etree._Element, dict[etree._Element, str]] = {}
        self._places: dict[tuple[etree._Element, str], etree._Element] = {}
        self._ids: dict[str, etree._Element] | None = None

    def wants(self, rule: Rule) -> bool:
        """Whether changes of this rule are wanted in this run."""
        return self._only is None or rule.code in self._only

    def note(self, rule: Rule, element: etree._Element | None, message: str) -> None:
        """Record a finding at `element`, as it stands now."""
        line = None
        node = element
        while node is not None and line is None:
            line = self.far_lines.get(node) or line_of(node)
            node = node.getparent()
        path = None if element is None else self.path(element)
        if self.trace is not None:
            self.trace.note(rule.code, element)
        self.findings.append(rule.at(None, message, file=self.file, line=line, path=path))

    def path(self, element: etree._Element) -> str:
        """The path of an element, with positions as they were when first asked for.

        The positions among siblings are counted once a parent, not once a finding.
        """
        steps: list[str] = []
        node, parent = element, element.getparent()
        while parent is not None:
            if parent not in self._labels:
                self._labels[parent] = _labels(parent)
            steps.append(self._labels[parent].get(node) or local(node))
            node, parent = parent, parent.getparent()
        return "/" + "/".join(reversed([*steps, local(node)]))

    # -- finding things -----------------------------------------------------------------------

    def all(self, *names: str) -> list[etree._Element]:
        """Every standard element of these names outside techniques' free content, in order."""
        tags = [NS + name for name in names]
        return [
            element
            for element in self.root.iter(*tags)
            if not any(local(above) == "technique" for above in element.iterancestors())
            or self._is_effect_technique(element)
        ]

    @staticmethod
    def _is_effect_technique(element: etree._Element) -> bool:
        for above in element.iterancestors(NS + "technique"):
            parent = above.getparent()
            if parent is None or not local(parent).startswith("profile_"):
                return False
        return True

    @property
    def ids(self) -> dict[str, etree._Element]:
        """The first element of every id; made anew after `forget_ids`."""
        if self._ids is None:
            self._ids = {}
            for element in standard_elements_with(self.root, "id"):
                if name := element.get("id"):
                    self._ids.setdefault(name, element)
        return self._ids

    def forget_ids(self) -> None:
        """Let `ids` be computed anew: ids were changed, added or removed."""
        self._ids = None

    def by_url(self, url: str | None) -> etree._Element | None:
        """The element of this document that a url points to."""
        if not url:
            return None
        return self.ids.get(url[1:] if url.startswith("#") else url)

    def new_id(self, wish: str) -> str:
        """An id like `wish` that is free; it counts as taken from now on."""
        name, number = wish, 2
        while name in self.ids:
            name, number = f"{wish}-{number}", number + 1
        self.ids[name] = self.root
        return name

    # -- making things ------------------------------------------------------------------------

    def make(self, name: str, text: str | None = None, /, **attributes: str) -> etree._Element:
        """A new element of the standard's namespace, in the prefix the document uses."""
        element = etree.Element(NS + name, nsmap=self._map)
        element.text = text or None
        for key, value in attributes.items():
            element.set(key, value)
        return element

    def library(self, kind: str) -> etree._Element:
        """The first library of a kind (``geometries``), which is made where there is none."""
        found = self.root.find(NS + "library_" + kind)
        if found is None:
            found = self.make("library_" + kind)
            before = next(
                (i for i, child in enumerate(self.root) if local(child) in ("scene", "extra")),
                len(self.root),
            )
            insert(self.root, before, found)
        return found

    def write(self, element: etree._Element, values: Iterable[float]) -> str:
        """Set an element's text to numbers that were converted; returns what it was.

        `digits` becomes the number of significant digits that the file has for such values: what
        is computed from them is no more exact than they were.
        """
        words = settle_notes(element).split()
        self.digits = max([self.digits, *(digits_of(word) for word in words)])
        element.text = " ".join(_spell(value) for value in values)
        return " ".join(words)

    # -- keeping things -----------------------------------------------------------------------

    def place(self, near: etree._Element, profile: str | None = None) -> etree._Element:
        """A technique in an extra of `near` or of the nearest ancestor that may have one."""
        profile = profile or self.origin
        owner: etree._Element | None = near
        while owner is not None and not self._may_have_extra(owner):
            owner = owner.getparent()
        owner = self.root if owner is None else owner
        if (owner, profile) not in self._places:
            extra = self.make("extra")
            technique = self.make("technique", profile=profile)
            extra.append(technique)
            append(owner, extra)
            self._places[owner, profile] = technique
        return self._places[owner, profile]

    def stash(self, element: etree._Element, profile: str | None = None) -> etree._Element:
        """Move `element` into an extra near its place, with a note of where it stood."""
        parent = element.getparent()
        assert parent is not None
        technique = self.place(parent, profile)
        owner = technique.getparent()
        home = None if owner is None else owner.getparent()
        moved = etree.SubElement(technique, f"{{{CONFORM}}}moved", nsmap=OWN_MAP)
        if home is not None and home is not parent:
            moved.set("from", path_below(home, parent))
        remove(element)
        moved.append(element)
        return moved

    def keep(self, near: etree._Element, kind: str, **values: str) -> None:
        """Keep a value that has no place (an attribute, a text) in an extra near its element."""
        self.keep_all(near, kind, [values])

    def keep_all(self, near: etree._Element, kind: str, kept: list[dict[str, str]]) -> None:
        """Keep values of one element; see `keep`."""
        technique = self.place(near)
        owner = technique.getparent()
        home = None if owner is None else owner.getparent()
        origin = None if home is None or home is near else path_below(home, near)
        for values in kept:
            element = etree.SubElement(technique, f"{{{CONFORM}}}{kind}", nsmap=OWN_MAP)
            if origin is not None:
                element.set("from", origin)
            for key, value in values.items():
                element.set(key, value)

    def _may_have_extra(self, element: etree._Element) -> bool:
        kind = type_of(element)
        return kind is not None and "extra" in kind.children


def standard_elements(root: etree._Element) -> Iterator[etree._Element]:
    """Every element but those inside the free content of techniques."""
    stack = [root]
    while stack:
        element = stack.pop()
        yield element
        if local(element) == "technique" and element.get("profile") is not None:
            continue
        stack.extend(reversed(list(element.iterchildren(tag=etree.Element))))


def standard_elements_with(root: etree._Element, attribute: str) -> list[etree._Element]:
    """The elements of `standard_elements` that have an attribute, without a look at the others."""
    found = _having(attribute)(root)
    assert isinstance(found, list)
    return cast("list[etree._Element]", found)


@cache
def _having(attribute: str) -> etree.XPath:
    inside = "ancestor::*[local-name() = 'technique'][@profile]"
    return etree.XPath(f"/descendant-or-self::*[@{attribute}][not({inside})]")


_MANTISSA = re.compile(r"[+-]?0*\.?0*([0-9]*)\.?([0-9]*)")


def digits_of(word: str) -> int:
    """The significant digits of a number as it is written."""
    found = _MANTISSA.match(word)
    return 0 if found is None else len(found[1]) + len(found[2])


def _spell(value: float) -> str:
    """A float as XML Schema spells it."""
    if math.isnan(value):
        return "NaN"
    if math.isinf(value):
        return "INF" if value > 0 else "-INF"
    return str(int(value)) if value == int(value) and abs(value) < 1e15 else repr(float(value))


def _labels(parent: etree._Element) -> dict[etree._Element, str]:
    names = [(child, local(child)) for child in parent.iterchildren(tag=etree.Element)]
    total = Counter(name for _, name in names)
    seen: Counter[str] = Counter()
    labels = {}
    for child, name in names:
        seen[name] += 1
        labels[child] = f"{name}[{seen[name]}]" if total[name] > 1 else name
    return labels


def type_of(element: etree._Element) -> ComplexType | None:
    """The complex type of a standard element where it stands; None where the schema knows none."""
    steps = [element, *element.iterancestors()]
    declaration = root_declaration()
    for step in reversed(steps[:-1]):
        kind = declaration.type
        if not isinstance(kind, ComplexType) or step.tag != NS + local(step):
            return None
        declared = kind.children.get(local(step))
        if declared is None:
            return None
        declaration = replace(declared, type=stated_type(step, declared.type) or declared.type)
    return declaration.type if isinstance(declaration.type, ComplexType) else None


def path_below(top: etree._Element, element: etree._Element) -> str:
    """The path from `top` down to `element`, with ids, sids or positions."""
    steps: list[str] = []
    node: etree._Element | None = element
    while node is not None and node is not top:
        name = local(node)
        for key in ("id", "sid"):
            if value := node.get(key):
                name += f"[@{key}='{value}']"
                break
        else:
            position = sum(1 for _ in node.itersiblings(node.tag, preceding=True)) + 1
            name += f"[{position}]" if position > 1 else ""
        steps.append(name)
        node = node.getparent()
    return "/".join(reversed(steps))


def insert(parent: etree._Element, index: int, element: etree._Element) -> None:
    """Insert a child, indented as its siblings are."""
    blank = parent.text if len(parent) else None
    if blank is not None and not blank.strip() and "\n" in blank:
        if index >= len(parent):
            last = parent[-1]
            element.tail, last.tail = last.tail, blank
        else:
            element.tail = blank
    parent.insert(index, element)


def append(parent: etree._Element, element: etree._Element) -> None:
    """Append a child, indented as its siblings are."""
    insert(parent, len(parent), element)


def remove(element: etree._Element) -> None:
    """Take an element out of its parent; the text after it stays, and the indentation fits."""
    parent = element.getparent()
    if parent is None:
        return
    tail = element.tail
    before = element.getprevious()
    if tail and tail.strip():
        if before is None:
            parent.text = (parent.text or "") + tail
        else:
            before.tail = (before.tail or "") + tail
    elif element.getnext() is None and tail is not None:
        if before is None:
            parent.text = tail
        else:
            before.tail = tail
    element.tail = None
    parent.remove(element)


def rename(element: etree._Element, name: str) -> None:
    """Give a standard element another local name."""
    element.tag = NS + name


def children(element: etree._Element, *names: str) -> Iterator[etree._Element]:
    """The children of these local names, in document order."""
    return element.iterchildren(*(NS + name for name in names))


def clone(element: etree._Element) -> etree._Element:
    """A copy of an element without the text after it."""
    twin = copy.deepcopy(element)
    twin.tail = None
    return twin


def text_of(element: etree._Element) -> str:
    """The text of an element, around comments."""
    return (element.text or "") + "".join(child.tail or "" for child in element)


def settle_notes(element: etree._Element) -> str:
    """Put comments in a text that is to be changed before its element; gives the text."""
    text = text_of(element)
    for note in list(element):
        note.tail = None
        element.addprevious(note)
    element.text = text
    return text
