"""A battery of checks for whatever reads COLLADA physics, ours or another."""

from __future__ import annotations

import io
import random
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from typing import Any, TypeVar

from hypothesis import HealthCheck, Phase, given, seed, settings
from hypothesis import strategies as st

import colladaphy.world
from colladaphy.document import read, write
from colladaphy.testing.broken import broken_documents
from colladaphy.testing.changes import REWRITES, edits, equivalents
from colladaphy.testing.hostile import hostile_inputs
from colladaphy.testing.kit.report import Check, Failure, ImporterReport, MismatchError
from colladaphy.testing.physics import physics_documents
from colladaphy.testing.worlds import worlds
from colladaphy.validation import validate
from colladaphy.world import World

__all__ = ["CHECKS", "check_importer"]

T = TypeVar("T")
Compare = Callable[[World, T], Iterable[object]]

CHECKS: tuple[str, ...] = ("meaning", "again", "alike", "edited", "worlds", "stored",
                           "refused")  # fmt: skip
"""The names of the checks, in the order in which they run."""


def check_importer(
    load: Callable[[bytes], T],
    store: Callable[[T], bytes] | None = None,
    *,
    compare: Compare[T] | None = None,
    documents: st.SearchStrategy[bytes] | None = None,
    checks: Iterable[str] | None = None,
    refuses: type[Exception] | tuple[type[Exception], ...] | None = None,
    rtol: float = 0.0,
    atol: float = 0.0,
    examples: int | None = None,
    raises: bool = True,
) -> ImporterReport:
    """Hold an importer of COLLADA physics to what documents mean.

    `load` makes anything of the bytes of a document; `store`, if there is one, makes a document
    of that. `compare` takes the World that the document means, and what `load` made of it, and
    returns their differences, none if it is right; an importer that makes Worlds needs none: they
    are compared to the bit, or within `rtol` and `atol` (see `colladaphy.compare`).

    The CHECKS (all, or those that `checks` names) are:

    - meaning: documents of physics load, and mean what they say;
    - again: the same document gives the same, and is not changed in memory;
    - alike: what does not matter (order, spelling, comments, encoding) changes nothing;
    - edited: so for what editors made of a document, with a stale profile perhaps;
    - worlds: so for any World that we wrote;
    - stored: what `store` writes is valid, and we read the same World from it;
    - refused: of documents with a fault, and of inputs that attack it, it makes something or
      raises one of `refuses`, its own errors; it runs where these are named.

    `documents` are drawn in place of `physics_documents()`, for importers of less than all of it.
    `examples` is how many a check takes (None: as hypothesis's profile says).

    The report has the smallest example of each failure. Raises AssertionError with it if a check
    fails, unless `raises` is false; ValueError for an unknown check.
    """
    judge: Compare[T] = compare or _worlds_differ(rtol, atol)
    drawn = physics_documents() if documents is None else documents
    battery = _battery(load, store, judge, drawn)
    if refuses is not None:
        battery["refused"] = _refusing(load, refuses)
    wanted = tuple(battery) if checks is None else tuple(checks)
    for name in wanted:
        if name not in CHECKS:
            raise ValueError(f"no check {name!r}; there are {', '.join(CHECKS)}")
        if name not in battery:
            raise ValueError(f"the check {name!r} needs `{_NEEDED[name]}`")
    report = ImporterReport()
    for name in CHECKS:
        if name in wanted:
            _run(battery[name], report, examples)
    if raises and not report.passed:
        raise AssertionError(f"\n{report}")
    return report


_NEEDED = {"stored": "store", "refused": "refuses"}


def _refusing(
    load: Callable[[bytes], object], refuses: type[Exception] | tuple[type[Exception], ...]
) -> Check:
    own = refuses if isinstance(refuses, tuple) else (refuses,)

    def refused(data: bytes, seen: list[bytes]) -> None:
        seen[:] = [data]
        with suppress(*own):
            load(data)

    broken = broken_documents(errors=True).map(lambda document: document.data)
    about = "what is broken or hostile is refused with an error of its own"
    return Check("refused", about, broken | hostile_inputs(), refused)


def _worlds_differ(rtol: float, atol: float) -> Callable[[World, Any], Sequence[str]]:
    def differ(meant: World, made: object) -> Sequence[str]:
        if not isinstance(made, World):
            kind = type(made).__name__
            raise TypeError(f"load made a {kind}, not a World: check_importer needs `compare`")
        return colladaphy.world.compare(meant, made, rtol, atol)

    return differ


def _battery(
    load: Callable[[bytes], T],
    store: Callable[[T], bytes] | None,
    compare: Compare[T],
    documents: st.SearchStrategy[bytes],
) -> dict[str, Check]:
    def agrees(meant: World, made: T, what: str) -> None:
        differences = [str(each) for each in compare(meant, made)]
        if differences:
            raise MismatchError("\n".join([f"{what}:", *differences]))

    def given_to(data: bytes, seen: list[bytes]) -> T:
        seen[:] = [data]
        return load(data)

    def meaning(data: bytes, seen: list[bytes]) -> None:
        agrees(_meant(data), given_to(data, seen), "it means another World")

    def again(data: bytes, seen: list[bytes]) -> None:
        meant, copy = _meant(data), bytes(bytearray(data))
        agrees(meant, given_to(data, seen), "it means another World")
        agrees(meant, given_to(copy, seen), "loaded again, it means another World")

    def alike(pair: tuple[bytes, bytes], seen: list[bytes]) -> None:
        meant, made = _meant(pair[0]), given_to(pair[1], seen)
        meant.name = _meant(pair[1]).name  # of a model, which may be renamed
        agrees(meant, made, "it means the same as before, but was read otherwise")

    def written(world: World, seen: list[bytes]) -> None:
        agrees(world, given_to(_written(world), seen), "the World that was written differs")

    def stored(world: World, seen: list[bytes]) -> None:
        assert store is not None
        data = _written(world)
        text = store(given_to(data, seen))
        seen[:] = [text]
        faults = [str(error) for error in validate(text).errors]
        if faults:
            raise MismatchError("\n".join(["what was stored is not valid:", *faults]))
        agrees(read(text).load(), load(data), "what was stored is another World")

    kinds = [kind for kind in REWRITES if kind != "ids"]  # which what has no name is called by
    pairs = documents.flatmap(lambda data: st.tuples(st.just(data), equivalents(data, kinds=kinds)))
    calm = worlds(extreme=False, physical=True, max_bodies=8)
    found = [
        Check("meaning", "documents of physics mean what they say", documents, meaning),
        Check("again", "the same document gives the same", documents, again),
        Check("alike", "what does not matter changes nothing", pairs, alike),
        Check("edited", "edited documents mean what they say", documents.flatmap(edits), meaning),
        Check("worlds", "Worlds that were written are read", calm, written),
    ]
    if store is not None:
        found.append(Check("stored", "what is stored is valid and the same", calm, stored))
    return {check.name: check for check in found}


def _meant(data: bytes) -> World:
    """The World that a valid document means."""
    return read(data).load()


def _written(world: World) -> bytes:
    stream = io.BytesIO()
    write(world, stream)
    return stream.getvalue()


def _run(check: Check, report: ImporterReport, examples: int | None) -> None:
    """Run one check; its first failure is shrunk and reported."""
    seen: list[bytes] = []
    count = 0

    def attempt(example: Any) -> None:
        nonlocal count
        count += 1
        seen.clear()
        check.holds(example, seen)

    own = settings()
    test = given(check.examples)(attempt)
    if own.derandomize:
        test = seed(random.Random(check.name).getrandbits(64))(test)
    test = settings(
        own,
        max_examples=own.max_examples if examples is None else examples,
        deadline=None,
        database=None,
        derandomize=False,
        phases=[Phase.generate, Phase.shrink],
        print_blob=False,
        report_multiple_bugs=False,
        suppress_health_check=list(HealthCheck),
    )(test)
    try:
        test()
    except Exception as error:
        message = (
            str(error) if isinstance(error, MismatchError) else f"{type(error).__name__}: {error}"
        )
        document = seen[0] if seen else None
        report.failures.append(Failure(check.name, check.about, message, document, error))
    report.counts[check.name] = count
