"""Results of checks, drawn at random: for reporters, which must cope with all of them."""

from __future__ import annotations

from hypothesis import strategies as st

from colladaphy.findings import Finding, Report, Severity
from colladaphy.validation import all_rules
from colladaphy.validation.checking import Checked
from colladaphy.validation.settings import Settings

CODES = [rule.code for rule in all_rules()]
TEXTS = st.text(max_size=40)
NAMES = st.sampled_from(
    ["a.dae", "sub folder/ä#1.dae", "/else/where.dae", "-", "x,y:z%20.dae", "a.zae!in/b.dae",
     "../up.dae", "sub/c.ZAE!d.dae"]
)  # fmt: skip
LINES = st.none() | st.integers(1, 10**6)


@st.composite
def findings(draw: st.DrawFn) -> Finding:
    code = draw(st.sampled_from(CODES))
    line = draw(LINES)
    return Finding(
        code=code,
        severity=draw(st.sampled_from(list(Severity))),
        stage=code.partition("-")[0],
        message=draw(TEXTS),
        file=draw(st.none() | NAMES),
        line=line,
        column=draw(LINES) if line is not None else None,
        path=draw(st.none() | st.just("/COLLADA/asset") | TEXTS),
        hint=draw(st.none() | TEXTS),
        why=draw(st.none() | TEXTS),
        attribute=draw(st.none() | st.just("id")),
        sid=draw(st.none() | TEXTS),
        related=tuple(draw(st.lists(st.tuples(TEXTS, LINES), max_size=2))),
        repair=draw(st.none() | st.just("repair-empty-sid")),
    )


@st.composite
def checks(draw: st.DrawFn) -> Checked:
    report = Report(draw(NAMES), draw(st.lists(findings(), max_size=4)))
    settings = Settings(fail_level=draw(st.sampled_from(list(Severity))))
    counts = st.integers(0, 3)
    return Checked(report, settings, draw(st.booleans()), draw(counts), draw(counts))


def finding(code: str = "link-missing", **values: object) -> Finding:
    """A finding with some values that a test is about."""
    usual: dict[str, object] = {"severity": Severity.ERROR, "message": "It is wrong."}
    return Finding(code=code, stage=code.partition("-")[0], **(usual | values))  # type: ignore[arg-type]


def checked(*found: Finding, file: str = "a.dae", **values: object) -> Checked:
    """A result with these findings."""
    return Checked(Report(file, list(found)), Settings(), **values)  # type: ignore[arg-type]
