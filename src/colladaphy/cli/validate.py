"""``colladaphy validate``."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from colladaphy.cli.choices import codes, outputs, patterns, severities, workers
from colladaphy.cli.console import EXIT_FINDINGS, EXIT_IO, note, paint, say, say_findings
from colladaphy.cli.files import limits_option, refuse_same, source_of, target_of
from colladaphy.cli.progress import counting
from colladaphy.findings import Severity
from colladaphy.validation.formats import FORMATS

if TYPE_CHECKING:
    from colladaphy.errors import InputError
    from colladaphy.source.limits import Limits
    from colladaphy.validation.checking import Checked
    from colladaphy.validation.reporters import Presentation

__all__ = ["command"]

_TEXT = ("full", "concise")
_LEVELS = [str(severity) for severity in Severity]
_EPILOG = """\b
Exit codes:
  0  nothing as grave as --fail-level was found
  1  something was
  2  wrong usage or configuration, or a file that cannot be read
  3  a fault of colladaphy itself
\b
Formats:
""" + "\n".join(f"  {name:8} {what}" for name, what in FORMATS.items())


def _print_schema(context: click.Context, _: click.Parameter, wanted: bool) -> None:
    if wanted:
        from colladaphy.validation.reporters.json import json_schema

        say(json_schema().rstrip())
        context.exit()


@click.command("validate", epilog=_EPILOG)
@click.argument("files", nargs=-1, required=True, metavar="FILE...")
@click.option(
    "--format",
    "form",
    type=click.Choice(list(FORMATS)),
    default="full",
    show_default=True,
    help="What the report looks like; see below.",
)
@click.option(
    "--report",
    "others",
    multiple=True,
    metavar="FORMAT=FILE",
    callback=outputs,
    help="Write one more report to a file; may be repeated.",
)
@click.option(
    "--select",
    multiple=True,
    metavar="CODES",
    callback=codes,
    help="Report only these: codes, their beginnings (schema, physics-mass) or all, with "
    "commas between.",
)
@click.option(
    "--ignore",
    multiple=True,
    metavar="CODES",
    callback=codes,
    help="Leave these out; what is said more exactly wins.",
)
@click.option(
    "--severity",
    "severity",
    multiple=True,
    metavar="CODE=LEVEL",
    callback=severities,
    help="Another severity: error, warning, info or hint.",
)
@click.option(
    "--fail-level",
    type=click.Choice(_LEVELS),
    help="The least severity for which the exit code is 1.  [default: error]",
)
@click.option(
    "--collada-14",
    type=click.Choice(["error", "warning", "ignore"]),
    help="How much it matters that a document is COLLADA 1.4; it is checked as such.  "
    "[default: error]",
)
@click.option(
    "--exclude",
    multiple=True,
    metavar="PATTERN",
    callback=patterns,
    help="Leave out files of folders, as .gitignore does.",
)
@click.option(
    "--force-exclude", is_flag=True, help="Leave out files that are named themselves, too."
)
@click.option(
    "--config",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="The configuration. Otherwise each file's is the first colladaphy.toml, or "
    "pyproject.toml with [tool.colladaphy], in its folder or above.",
)
@click.option("--isolated", is_flag=True, help="Look for no configuration.")
@click.option(
    "--baseline",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Report only what is not in this baseline.",
)
@click.option(
    "--write-baseline",
    metavar="FILE",
    help="Write all that is found to a baseline, and report nothing.",
)
@click.option(
    "--max-findings",
    type=click.IntRange(0),
    default=5,
    show_default=True,
    metavar="N",
    help="How many of a kind are shown of each file in full and concise; 0 shows all.",
)
@click.option(
    "--statistics",
    is_flag=True,
    help="Count the codes in place of showing findings, in full and concise.",
)
@click.option("-q", "--quiet", is_flag=True, help="Show findings only: nothing about files.")
@click.option(
    "-j",
    "--jobs",
    "processes",
    type=click.IntRange(0),
    default=1,
    show_default=True,
    metavar="N",
    callback=workers,
    help="How many files are checked at once; 0: as many as there are processors.",
)
@click.option("--stdin-name", metavar="NAME", help="What standard input (-) is called in reports.")
@click.option("--exit-zero", is_flag=True, help="Exit with 0 whatever is found.")
@limits_option
@click.option(
    "--json-schema",
    is_flag=True,
    is_eager=True,
    expose_value=False,
    callback=_print_schema,
    help="Print the schema of the json format.",
)
def command(files: tuple[str, ...], form: str, others: Sequence[tuple[str, str]],
            processes: int, quiet: bool, statistics: bool, max_findings: int, exit_zero: bool,
            write_baseline: str | None, limits: Limits | None, **chosen: Any) -> int:  # fmt: skip
    """Check documents (.dae, .zae) and report everything that is wrong with them.

    FILE can be a folder, which is searched through, a quoted pattern such as 'robots/**/*.dae',
    or - for standard input.
    """
    from colladaphy.validation.reporters import Presentation
    from colladaphy.validation.reporters.sources import Sources
    from colladaphy.validation.session import Request, Session

    if statistics and form not in _TEXT:
        raise click.UsageError(f"--statistics is for the formats {' and '.join(_TEXT)}.")
    if chosen["config"] is not None and chosen["isolated"]:
        raise click.UsageError("--config and --isolated exclude each other.")
    stdin = _standard_input(limits) if "-" in files else None
    session = Session(
        Request(
            arguments=files,
            overrides=_overrides(chosen),
            without_baseline=write_baseline is not None,
            limits=limits,
            stdin=stdin,
            **chosen,
        )
    )
    for option, file in (
        ("--write-baseline", write_baseline),
        *(("--report", f) for _, f in others),
    ):
        if file not in (None, "-"):
            refuse_same(option, file, session.files)
    kept: list[Checked] = []
    results = _kept(counting(session.results(processes), len(session.files), "checking"), kept)
    given = {}
    if isinstance(stdin, bytes):
        given[chosen["stdin_name"] or "-"] = stdin
    sources = Sources(given, limits)
    if write_baseline is not None:
        _write_baseline(results, write_baseline)
    else:
        most = max_findings or None
        _write(results, form, Presentation(paint, most, quiet, statistics, sources), "-")
        for name, file in others:
            _write(kept, name, Presentation(sources=sources), file)
        if session.gone:
            note(f"{session.gone} of the baseline's findings are gone; --write-baseline FILE "
                 "writes it anew.")  # fmt: skip
    if not all(result.readable for result in kept):
        return EXIT_IO
    fails = not exit_zero and write_baseline is None
    return EXIT_FINDINGS if fails and any(result.failed for result in kept) else 0


def _overrides(chosen: dict[str, Any]) -> dict[str, Any]:
    """Takes the options that are settings out of `chosen`; what was not given says nothing."""
    found = {name: chosen.pop(name) for name in ("select", "ignore", "severity", "fail_level",
                                                 "collada_14")}  # fmt: skip
    found = {name: value for name, value in found.items() if value}
    for name in ("fail_level", "collada_14"):
        if name in found:
            found[name] = None if found[name] == "ignore" else Severity(found[name])
    return found


def _standard_input(limits: Limits | None) -> bytes | InputError:
    """What standard input gives, up to the limit."""
    from colladaphy.errors import InputError
    from colladaphy.source.limits import Limits
    from colladaphy.source.references import read_limited

    try:
        stream = source_of("-")
        assert not isinstance(stream, str)
        return read_limited(stream, (limits or Limits()).bytes, "-")
    except InputError as error:
        return error


def _kept(results: Iterable[Checked], kept: list[Checked]) -> Iterator[Checked]:
    """The results, which are added to `kept` as they pass."""
    for result in results:
        kept.append(result)
        yield result


def _write(results: Iterable[Checked], form: str, presentation: Presentation, file: str) -> None:
    """Write a report to a file, or, as it comes, to standard output."""
    from colladaphy.validation.reporters import reporter

    lines = reporter(form)(results, presentation)
    if file == "-":
        for line in lines:
            say(line)
    else:
        _save("".join(f"{line}\n" for line in lines), file)


def _write_baseline(results: Iterable[Checked], file: str) -> None:
    from colladaphy.validation.baseline import baseline_text

    known = list(results)
    _save(baseline_text(known, Path(file)), file)
    count = sum(len(result.report) for result in known if result.readable)
    note(f"{count} finding{'s' * (count != 1)} written to {file}.")
    for result in known:
        if not result.readable:
            say_findings(result.report)


def _save(text: str, file: str) -> None:
    from colladaphy.source import save

    save(text.encode("utf-8", "backslashreplace"), target_of(file))
