"""One fault is told once, at its cause, and what follows from it is told with it."""

from __future__ import annotations

import io
import random
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from tests.meaning.test_cases import BASES, FAULTS
from tests.meaning.test_loading import edited

import colladaphy
from colladaphy import World
from colladaphy.findings import Severity
from colladaphy.meaning import consequences
from colladaphy.meaning.consequences import FOLLOWING
from colladaphy.testing import worlds


def test_whatever_follows_has_a_document_in_which_it_does(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    used: set[Any] = set()
    let_follow = consequences._let_follow

    def recorded(context: Any, each: Any, *others: Any) -> set[int]:
        found: set[int] = let_follow(context, each, *others)
        if found:
            used.add(each)
        return found

    monkeypatch.setattr(consequences, "_let_follow", recorded)
    for parameter in FAULTS:
        parameter.values[0].report(tmp_path)
    assert [each for each in FOLLOWING if each not in used] == []


some = settings(max_examples=25, deadline=None, suppress_health_check=list(HealthCheck))


@some
@given(worlds(min_bodies=1, extreme=False), st.integers(0, 2**32), st.integers(1, 4))
def test_what_is_left_is_as_grave(world: World, seed: int, times: int) -> None:
    target = io.BytesIO()
    colladaphy.write(world, target)
    data = edited(target.getvalue(), random.Random(seed), times)
    kept = list(colladaphy.validate(data))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(consequences, "FOLLOWING", ())
        every = list(colladaphy.validate(data))
    assert len(kept) <= len(every)
    places = {(finding.code, finding.path, finding.attribute) for finding in every}
    assert {(finding.code, finding.path, finding.attribute) for finding in kept} <= places
    grave = [Severity.HINT, Severity.INFO, Severity.WARNING, Severity.ERROR]
    one, other = (max((grave.index(found.severity) for found in each), default=-1)
                  for each in (kept, every))  # fmt: skip
    assert one == other


def test_only_what_is_named_by_sid_follows_from_sids_that_are_there_twice() -> None:
    text = BASES["physics"].read_text("utf-8")
    text = text.replace('sid="stone"', 'sid="rod"').replace('url="#steel"', 'url="#tin"')
    found = {(finding.code, (finding.path or "").rpartition("/")[2].partition("[")[0])
             for finding in colladaphy.validate(text.encode())}  # fmt: skip
    assert ("link-duplicate-sid", "rigid_body") in found
    assert ("link-missing", "instance_physics_material") in found
    assert ("link-missing", "instance_rigid_body") not in found
