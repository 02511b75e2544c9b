"""Does every reference lead where it should? (COLLADA 1.5 §Address syntax)

A reference of the physics that leads nowhere is an error, as a scene cannot be loaded without it.
One of the rest (a material, an image, the geometry of a shape, which costs one body) is a warning.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from difflib import get_close_matches

from colladaphy.errors import ColladaError
from colladaphy.findings import Finding, Severity
from colladaphy.links.rules import MISSING, WRONG_TYPE
from colladaphy.meaning import link_rules
from colladaphy.meaning.context import Context, TextRows
from colladaphy.meaning.hits import Hit
from colladaphy.meaning.references import NEEDED, URIS
from colladaphy.source import rules as source_rules

__all__ = ["CHECKS", "expected_text", "reference_hits"]


_OUTSIDE = {
    rule.code: rule for rule in (source_rules.REFERENCE_REFUSED, source_rules.REFERENCE_MISSING)
}


def uris(context: Context) -> Iterator[Hit]:
    """References by URI."""
    for element, attribute, expected in URIS:
        if attribute:
            for reference in context.doubtful(element, attribute, expected):
                yield from reference_hits(
                    context, reference.element, attribute, reference.text, expected
                )
            continue
        rows = context.rows(TextRows, element)
        assert rows.ordinals is not None
        for number, text in zip(rows.ordinals.tolist(), rows.value, strict=True):
            yield from reference_hits(context, number, "", text, expected)


def reference_hits(
    context: Context, element: int, attribute: str, text: str, expected: tuple[str, ...],
    *, severity: Severity | None = None, addressed: bool = False,
) -> Iterable[Hit]:  # fmt: skip
    """Why a reference at an element cannot be followed to an element of the expected names.

    `addressed` where a SID address is as good as a URI.
    """
    ids, columns = context.resource.ids, context.columns
    name = columns.local_name(element)
    if severity is None:
        severity = Severity.ERROR if name in NEEDED else Severity.WARNING
    what = f"attribute {attribute!r}" if attribute else f"text of <{name}>"
    text = text.strip()
    if not text:
        if attribute != "url":  # a body without a node stands at its model's place
            severity = Severity.WARNING
        message = f"The {what} is empty, so it refers to nothing."
        return [Hit(MISSING, element, message, attribute=attribute, severity=severity)]
    number = context.named(text[1:]) if text[0] == "#" else -1
    target = number if number >= 0 else None
    if target is None and text[0] != "#":
        target = ids.get(text)
        if target is not None and not addressed and columns.local_name(target) in expected:
            message = f"The {what} is {text!r}: to be the id of an element it lacks the '#'."
            return [Hit(link_rules.NO_HASH, element, message, (target,), attribute,
                        hint=f"Write '#{text}'.")]  # fmt: skip
    if target is not None:
        found = columns.local_name(target)
        if found in expected:
            return []
        message = f"{text!r} is a <{found}>, not {expected_text(expected)}."
        return [Hit(WRONG_TYPE, element, message, (target,), attribute, severity)]
    if text[0] == "#" and "/" not in text:
        message = f"The reference {text!r} leads nowhere: no element has that id."
        hint = _hint(context, text[1:], expected)
        return [Hit(MISSING, element, message, (), attribute, severity, hint)]
    return _followed(context, element, attribute, text, expected, severity)


def _followed(
    context: Context, element: int, attribute: str, text: str, expected: tuple[str, ...],
    severity: Severity,
) -> list[Hit]:  # fmt: skip
    """The same for what is not the id of an element of this document."""
    if "#" not in text and "/" not in text and not _names_file(text):
        hint = _hint(context, text, expected)
        known = {"attachment", "ref_attachment"}
        if context.name(element) not in known:
            message = f"There is no element of the id {text!r}, and the '#' before it is missing."
            return [Hit(MISSING, element, message, (), attribute, severity, hint)]
    try:
        context.resource.follow(text, element, expected)
    except ColladaError as error:
        hits = []
        for finding in error.findings:
            rule = _OUTSIDE.get(finding.code)
            if rule is None:
                rule = WRONG_TYPE if finding.code == WRONG_TYPE.code else MISSING
                level = severity
            else:  # only what is in that file is not there, and it cannot be checked
                told = context.shared(_unreachable)
                if finding in told:
                    continue
                told.add(finding)
                level = Severity.WARNING
            hits.append(Hit(rule, element, finding.message, (), attribute, level, finding.hint))
        return hits
    return []


def _unreachable(_: Context) -> set[Finding]:
    """What was said of files that cannot be reached: each is one finding."""
    return set()


def _names_file(text: str) -> bool:
    return text.lower().endswith((".dae", ".xml", ".zae")) or "://" in text


def _hint(context: Context, id: str, expected: tuple[str, ...]) -> str | None:
    """Ids that may be meant: in another case first, then those that are nearly the same."""
    folded, known = context.shared(_ids_by_case), context.shared(_ids_by_type)
    for name in expected:
        if same := folded.get((name, id.casefold())):
            return f"Ids are told apart by case: write '#{same}'."
    if sum(len(known.get(name, ())) for name in expected) > 200:  # enough to compare one by one
        return None
    some = [other for name in expected for other in known.get(name, ())]
    close = get_close_matches(id, some, 1)
    return f"Did you mean '#{close[0]}'?" if close else None


def _ids_by_case(context: Context) -> dict[tuple[str, str], str]:
    """The first id of each type of element and spelling without case."""
    found: dict[tuple[str, str], str] = {}
    for name, ids in context.shared(_ids_by_type).items():
        for id in ids:
            found.setdefault((name, id.casefold()), id)
    return found


def _ids_by_type(context: Context) -> dict[str, list[str]]:
    found: dict[str, list[str]] = {}
    for id, element in context.resource.ids.items():
        found.setdefault(context.name(element), []).append(id)
    return found


def expected_text(expected: tuple[str, ...]) -> str:
    """The names of elements for a message."""
    names = [f"<{name}>" for name in expected]
    return f"a {names[0]}" if len(names) == 1 else f"one of {', '.join(names)}"


CHECKS = (uris,)
