"""What is wrong with a document that is not valid, or not 1.5, as far as it can be read.

The rules of meaning read a copy that is mended. What they find is told of the elements as they
came, but for what the mending itself has changed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace

from lxml import etree

from colladaphy.columns.reading import Document as Columns
from colladaphy.conform.context import local
from colladaphy.conform.kinds import FORM, UPGRADE
from colladaphy.conform.versions import detect_version
from colladaphy.findings import Finding
from colladaphy.gate import rules
from colladaphy.gate.faults import violations
from colladaphy.links.resource import Resource
from colladaphy.links.rules import MISSING
from colladaphy.meaning import Hit, findings_of, hits_of
from colladaphy.meaning.profile import strangers
from colladaphy.meaning.profile_rules import NAMESPACE
from colladaphy.source import COLLADA_1_4, COLLADA_1_5
from colladaphy.validation.apart import only, without
from colladaphy.validation.copies import Copy
from colladaphy.validation.mendable import with_repairs
from colladaphy.validation.older import meant_1_4, violations_1_4
from colladaphy.validation.options import HUGE, MANY, NOTHING_BEHIND, Options, is_large
from colladaphy.validation.schema_stage import Found, schema_hits, with_schema_repairs
from colladaphy.validation.touched import SEPARATORS, Touched, touched

__all__ = ["Came", "check_behind", "check_meaning"]

_PLACED = frozenset(
    {"physics-frames-apart", "physics-frames-turned", "link-not-rigid", "physics-gravity-unit",
     "physics-gravity-axis", "asset-inner-axis", "asset-unit-name"}
)  # fmt: skip
"""Rules about where things stand, and how large they are."""
COMPARED = frozenset(
    {"physics-inertia-size", "physics-inertia-zero", "physics-mass-zero", "physics-density-zero",
     "physics-mass-density", "physics-mass-sum", "physics-mass-frame", "physics-hollow",
     "physics-velocity-fixed", "physics-plane-moves", "physics-joint-fixed",
     "physics-joint-target", "physics-frames-apart", "physics-frames-turned",
     "physics-material-frictions", "geometry-accessor-range",
     "geometry-accessor-stride", "geometry-index-range", "geometry-index-lacking",
     "geometry-primitive-count", "geometry-vcount", "geometry-normal", "geometry-vertex-count",
     "animation-skin-bind", "animation-skin-count", "animation-skin-index",
     "animation-skin-joint", "animation-skin-sum", "animation-morph-targets",
     "animation-key-count", "animation-output-width", "kinematics-value",
     "kinematics-transform", "profile-old-value", "profile-union"}
)  # fmt: skip
"""Rules about one element that compare it with what stands beside it."""

_NAMED_BY = {
    "body": ("rigid_body",),
    "constraint": ("rigid_constraint",),
    "rigid_body": ("rigid_body", "physics_model"),
    "target": ("node", "material"),
    "parent": ("node",),
    "source": ("source", "vertices", "sampler", "geometry", "controller"),
}
"""What references of an attribute lead to, where the element does not say it."""


@dataclass(frozen=True, slots=True)
class Came:
    """A document as it came."""

    tree: etree._ElementTree
    data: bytes
    """What the tree was parsed from."""
    file: str | None
    read: Callable[[etree._ElementTree], Resource]
    """Makes a resource of a tree in the document's place."""
    exists: Callable[[str], str | None] | None

    def told(self, hits: Sequence[Hit | Finding]) -> list[Finding]:
        """Findings about its elements."""
        return findings_of(Columns.of(self.data, lambda: self.tree), self.file, hits)


def check_behind(came: Came, first: Found | None, options: Options) -> list[Finding]:
    """Everything that is wrong with a document that is not valid COLLADA 1.5.

    `first` is what libxml2 says of a document of 1.5; None for another version. Of a large one no
    copy is mended: the records that are faulty are looked at alone, and left out of the rest.
    """
    if first and len(came.data) >= HUGE:
        return came.told([*_as_said(came, first), Hit(rules.LARGE, 0, NOTHING_BEHIND)])
    whole = Copy.of(came.tree)
    if first and is_large(came.data):
        return came.told([*_of_form(whole, first), *_behind_large(came, whole, first)])
    current = whole
    hits: list[Hit] = []
    if first is None:
        hits += _version(whole, options)
        current = whole.mended(UPGRADE, inherited=True)
        if etree.QName(current.tree.getroot()).namespace != COLLADA_1_5:
            return came.told(hits)
        first = violations(current.tree)
        own = violations_1_4(came.tree) if _is_1_4(came.tree) else None
        if own is None:
            hits += schema_hits(current, first)
        else:
            hits += [
                Hit(said.rule, whole.by_element[element], said.message, (), said.attribute)
                for element, said in own
            ]
    else:
        hits += schema_hits(current, first)
    start = Copy.of(current.tree)
    form = start.mended(FORM) if first else start
    if _is_1_4(came.tree):
        hits += [
            Hit(rule, whole.by_element[element], message, (), severity=severity)
            for element, rule, message, severity in meant_1_4(came.tree)
        ]
    if first and violations(form.tree):
        return came.told(hits)  # it cannot be read
    mended = form.upon(current)
    hits = with_schema_repairs(hits, whole, mended)
    shown = mended.in_our_spelling()
    meant = _translated(hits_of(came.read(shown.tree), came.exists), shown)
    meant += [
        Hit(NAMESPACE, mended.by_element[element], message)
        for element, message in strangers(mended.tree)
        if mended.by_element[element] >= 0
    ]
    if first:
        ours = _Ours(touched(start, form), current, whole)
        meant = [hit for hit in meant if not ours.has_part_in(hit)]
    return came.told(hits + with_repairs(meant, whole))


def check_meaning(came: Came, resource: Resource, hits: list[Hit | Finding]) -> list[Finding]:
    """What is wrong with the meaning of a valid document, with the repairs that mend it."""
    whole = Copy.of(came.tree)
    others = [hit for hit in hits if isinstance(hit, Finding)]
    # Where the profile is spelled otherwise, the rules have seen a copy with other elements.
    shown = whole.in_our_spelling() if resource.has_other_spelling else whole
    return came.told([*others, *with_repairs(_translated(hits, shown), whole)])


def _as_said(came: Came, first: Found) -> list[Hit]:
    """What libxml2 says, for itself: for many elements, to look for more takes long."""
    wanted = {element for element, _ in first}
    numbers = {
        element: number
        for number, element in enumerate(came.tree.iter(etree.Element))
        if element in wanted
    }
    return [
        Hit(said.rule, numbers[element], said.message, (), said.attribute)
        for element, said in first
    ]


def _of_form(whole: Copy, first: Found) -> list[Hit]:
    """The faults of form of a large document, each looked at in the record around it."""
    part = only(whole, {element for element, _ in first}, MANY)
    if part is None:
        return [Hit(said.rule, whole.by_element[element], said.message, (), said.attribute)
                for element, said in first]  # fmt: skip
    hits = schema_hits(part.copy, [(part.twins[element], said) for element, said in first])
    # What stands around the records lacks the others.
    named = {whole.by_element[element] for element, _ in first}
    hits = [hit for hit in hits if hit.element in part.inner or hit.element in named]
    mended = part.copy.mended(FORM)
    kept = tuple((code, number) for code, number in mended.repairs if number in part.inner)
    return with_schema_repairs(hits, part.copy, replace(mended, repairs=kept))


def _behind_large(came: Came, whole: Copy, first: Found) -> list[Hit]:
    """What the rest of a large document means, without the records that are faulty."""
    rest, done = without(whole, {element for element, _ in first})
    if rest.tree.getroot() is None or violations(rest.tree):
        return [Hit(rules.LARGE, 0, NOTHING_BEHIND)]
    shown = rest.in_our_spelling()
    ours = _Ours(done, whole, whole)
    meant = _translated(hits_of(came.read(shown.tree), came.exists), shown)
    hits = [hit for hit in meant if not ours.has_part_in(hit)]
    return [*hits, Hit(rules.LARGE, 0, rules.LARGE.summary)]


def _translated(hits: Iterable[Hit | Finding], copy: Copy) -> list[Hit]:
    """What was found in a copy, as of the elements of the document; nothing about new ones."""
    found = []
    for hit in hits:
        if isinstance(hit, Hit) and (element := copy.numbers[hit.element]) >= 0:
            related = [copy.numbers[other] for other in hit.related]
            kept = tuple(number for number in related if number >= 0)
            found.append(replace(hit, element=element, related=kept))
    return found


class _Ours:
    """What a mending has done, by the numbers of a document."""

    def __init__(self, done: Touched, current: Copy, whole: Copy) -> None:
        self._done, self._parents = done, whole.parents
        self._changed = {current.numbers[number] for number in done.changed}
        self._around = {current.numbers[number] for number in done.around}
        self._elements = {number: element for element, number in whole.by_element.items()}

    def has_part_in(self, hit: Hit) -> bool:
        """Whether it may be the mending that a rule speaks of."""
        if hit.rule.stage == "link" and hit.attribute is not None:
            # A reference is right or wrong by itself, where nobody has taken its target away.
            element = self._elements[hit.element]
            text = (element.get(hit.attribute) if hit.attribute else element.text) or ""
            names = text.translate(SEPARATORS).split()
            if hit.element in self._changed or not self._done.names.isdisjoint(names):
                return True
            # What a reference misses may be what has no name of its own.
            wanted = _NAMED_BY.get(hit.attribute, (local(element).removeprefix("instance_"),))
            return hit.rule is MISSING and not self._done.nameless.isdisjoint(wanted)
        around = [hit.element, *hit.related]
        if hit.rule.code in COMPARED:
            above = self._parents.get(hit.element, -1)
            around += [above, self._parents.get(above, -1)]
        if self._done.moved and hit.rule.code in _PLACED:
            return True
        return not self._around.isdisjoint(around)


def _is_1_4(tree: etree._ElementTree) -> bool:
    return etree.QName(tree.getroot()).namespace == COLLADA_1_4


def _version(whole: Copy, options: Options) -> list[Hit]:
    """What there is to say of the namespace."""
    namespace = etree.QName(whole.tree.getroot()).namespace
    if namespace == COLLADA_1_4:
        message = f"The document is COLLADA {detect_version(whole.tree)}, not 1.5."
        severity = options.collada_14
        hit = Hit(rules.VERSION_1_4, 0, message, severity=severity, repair="upgrade-version")
        return [] if severity is None else [hit]
    message = f"The root element is in the namespace {namespace!r}."
    if not namespace:
        message = "The root element has no namespace."
    return [Hit(rules.WRONG_NAMESPACE, 0, message, repair="repair-namespace")]
