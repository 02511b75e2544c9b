"""Findings: what was noticed, changed, assumed or refused, and where.

Every room of the house reports through the same three types. A `Rule` is a stable code with its
severity and its hint; `Rule.at` makes a `Finding` of it at a place in a document; a `Report`
collects findings. A finding looks the same from reading, validating, repairing and loading.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field, replace
from enum import StrEnum
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from lxml.etree import _Element

__all__ = [
    "STAGES",
    "Finding",
    "Paths",
    "Report",
    "Rule",
    "Severity",
    "element_path",
    "unchanging",
]

STAGES = ("config", "io", "xml", "upgrade", "repair", "convention", "schema", "asset", "link",
          "geometry", "scene", "animation", "load", "store", "physics", "kinematics", "profile",
          "engine", "downgrade")  # fmt: skip


class Severity(StrEnum):
    """How much a finding matters. Only errors make a document invalid."""

    ERROR = "error"
    WARNING = "warning"
    INFO = "info"
    HINT = "hint"


@dataclass(frozen=True, slots=True)
class Finding:
    """One thing that was found, at one place.

    `line` and `column` count from 1 and are None where a place has none (a World that was built
    in memory, say). `path` is the element path from the root, with positions among same-named
    siblings, such as ``/COLLADA/library_physics_models/physics_model[2]/rigid_body``.
    """

    code: str
    severity: Severity
    stage: str
    message: str
    file: str | None = None
    line: int | None = None
    column: int | None = None
    path: str | None = None
    hint: str | None = None
    why: str | None = None
    attribute: str | None = None
    """The attribute that it is about."""
    sid: str | None = None
    """The scoped id of the element."""
    related: tuple[tuple[str, int | None], ...] = ()
    """Paths and lines of elements that have to do with it."""
    repair: str | None = None
    """The code of the repair that mends it; None where only an author can."""

    def as_dict(self) -> dict[str, Any]:
        """The finding as the JSON report spells it (the file is named by the report)."""
        return {
            "code": self.code,
            "severity": str(self.severity),
            "stage": self.stage,
            "message": self.message,
            "line": self.line,
            "column": self.column,
            "path": self.path,
            "hint": self.hint,
            "why": self.why,
            "attribute": self.attribute,
            "sid": self.sid,
            "related": [{"path": path, "line": line} for path, line in self.related],
            "fixable": self.repair is not None,
            "repair": self.repair,
        }

    def __str__(self) -> str:
        place = ":".join(str(part) for part in (self.file, self.line, self.column) if part)
        text = f"{self.severity} {self.code}: {self.message}"
        if self.path:
            text += f" [at {self.path}]"
        if self.hint:
            text += f" ({self.hint})"
        return f"{place}: {text}" if place else text


@dataclass(frozen=True, slots=True)
class Rule:
    """A kind of finding: a stable code and what is always true of it.

    `code` begins with its stage (``repair-shape-order``). `section` names the part of the
    COLLADA 1.5 specification or of the thesis that the rule stands on, `why` says what goes wrong
    where it is not kept.
    """

    code: str
    severity: Severity
    summary: str
    hint: str | None = None
    section: str | None = None
    why: str | None = None

    @property
    def stage(self) -> str:
        """The stage of the pipeline that reports this rule."""
        return self.code.partition("-")[0]

    def at(
        self,
        element: _Element | None = None,
        message: str | None = None,
        *,
        file: str | None = None,
        line: int | None = None,
        column: int | None = None,
        path: str | None = None,
        severity: Severity | None = None,
        hint: str | None = None,
    ) -> Finding:
        """A finding of this rule; line and path are taken from `element` where it is given."""
        if element is not None:
            place: Any = element  # the stubs leave the type of sourceline open
            line = place.sourceline if line is None else line
            path = element_path(element) if path is None else path
        return Finding(
            code=self.code,
            severity=severity or self.severity,
            stage=self.stage,
            message=message or self.summary,
            file=file,
            line=line,
            column=column,
            path=path,
            hint=hint or self.hint,
            why=self.why,
        )


@dataclass(slots=True)
class Report:
    """Findings in the order in which they were made, about one file or one operation."""

    file: str | None = None
    findings: list[Finding] = field(default_factory=list)

    def add(self, *findings: Finding) -> None:
        """Append findings; one without a file gets the report's."""
        for finding in findings:
            if finding.file is None and self.file is not None:
                finding = replace(finding, file=self.file)
            self.findings.append(finding)

    def extend(self, findings: Iterable[Finding]) -> None:
        """Append all of `findings`."""
        self.add(*findings)

    @property
    def valid(self) -> bool:
        """True when there is no finding of severity error."""
        return not self.errors

    @property
    def errors(self) -> list[Finding]:
        """The findings of severity error."""
        return [finding for finding in self.findings if finding.severity is Severity.ERROR]

    @property
    def counts(self) -> dict[str, int]:
        """Number of findings by severity; every severity is a key."""
        seen = Counter(finding.severity for finding in self.findings)
        return {str(severity): seen[severity] for severity in Severity}

    def as_dict(self) -> dict[str, Any]:
        """The report of one file as the JSON reporter spells it."""
        return {
            "path": self.file,
            "valid": self.valid,
            "counts": self.counts,
            "findings": [finding.as_dict() for finding in self.findings],
        }

    def __iter__(self) -> Iterator[Finding]:
        return iter(self.findings)

    def __len__(self) -> int:
        return len(self.findings)

    def __repr__(self) -> str:
        about = f" of {self.file}" if self.file else ""
        found = [f"{n} {kind}{'s' * (n != 1)}" for kind, n in self.counts.items() if n]
        return f"<Report{about}: {', '.join(found) or 'no findings'}>"

    def __bool__(self) -> bool:
        return True


@contextmanager
def unchanging() -> Iterator[None]:
    """While no tree changes, the paths of many elements take time in proportion to their number.

    Outside, siblings are counted anew for every path.
    """
    token = _PATHS.set(_PATHS.get() or Paths())
    try:
        yield
    finally:
        _PATHS.reset(token)


def element_path(element: _Element) -> str:
    """The path of an lxml element from its root, by local names.

    A position in brackets is given where an element has siblings of the same local name.
    """
    paths = _PATHS.get()
    if paths is not None:
        return paths.path(element)
    steps: list[str] = []
    node: _Element | None = element
    while node is not None:
        name = _local(node)
        parent = node.getparent()
        if parent is not None:
            before, after = _alike(node, name)
            if before or after:
                name = f"{name}[{before + 1}]"
        steps.append(name)
        node = parent
    return "/" + "/".join(reversed(steps))


class Paths:
    """Paths and places of nodes in trees that do not change; linear for any number."""

    def __init__(self) -> None:
        self._steps: dict[_Element, tuple[str, int]] = {}

    def path(self, element: _Element) -> str:
        """The path as `element_path` gives it."""
        return "/" + "/".join(self._step(node)[0] for node in _chain(element))

    def order(self, element: _Element) -> tuple[int, ...]:
        """A key that sorts nodes by their place in the document."""
        return tuple(self._step(node)[1] for node in _chain(element))

    def _step(self, element: _Element) -> tuple[str, int]:
        step = self._steps.get(element)
        if step is None:
            parent = element.getparent()
            siblings = [element] if parent is None else list(parent)
            names = [_local(sibling) for sibling in siblings]
            totals = Counter(names)
            seen: Counter[str] = Counter()
            for index, (sibling, name) in enumerate(zip(siblings, names, strict=True)):
                seen[name] += 1
                shown = f"{name}[{seen[name]}]" if totals[name] > 1 else name
                self._steps[sibling] = (shown, index)
            step = self._steps[element]
        return step


_PATHS: ContextVar[Paths | None] = ContextVar("paths of trees that do not change", default=None)


def _chain(element: _Element) -> list[_Element]:
    return [*reversed(list(element.iterancestors())), element]


def _alike(node: _Element, name: str) -> tuple[int, bool]:
    """How many siblings before a node have its name, and whether any after it has.

    They are told apart in C: a thousand findings among a thousand siblings are no rarity.
    """
    tag = f"{{*}}{name}" if isinstance(node.tag, str) else node.tag
    before = len(list(node.itersiblings(tag, preceding=True)))
    return before, next(node.itersiblings(tag), None) is not None


def _local(element: _Element) -> str:
    tag = element.tag
    if not isinstance(tag, str):
        return "comment()" if "Comment" in type(element).__name__ else "processing-instruction()"
    return tag.rpartition("}")[2]
