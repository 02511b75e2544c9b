"""Work grows with the file: four times the bodies, about four times the calls.

Calls are counted, not seconds: they are the same on every machine.
"""

from __future__ import annotations

import cProfile
import io
from collections.abc import Callable

import pytest
from lxml import etree

import colladaphy
from colladaphy.conform import conform
from colladaphy.testing.producers import flat, habits, robots
from colladaphy.testing.producers.habits import PRODUCERS
from colladaphy.testing.producers.truth import Joint, Link, Scene, Solid

PLACE = (("translate", (0.5, 0.0, -0.25)), ("rotate", (0.0, 0.6, 0.8, 30.0)))


def calls(work: Callable[[], object]) -> int:
    """How many functions are called."""
    profile = cProfile.Profile()
    profile.runcall(work)
    return sum(entry.callcount for entry in profile.getstats())


def file(name: str, count: int) -> bytes:
    """A file of so many bodies with most deviations."""
    if name == "robot":
        links = tuple(
            Link(f"rigid{i}", PLACE, (Solid("mesh", (0.1, 0.2, 0.3)),), 1.0, PLACE,
                 (0.05, 0.04, 0.03), parent=0 if i else None)
            for i in range(count)
        )  # fmt: skip
        quirks = frozenset({*robots.QUIRKS} - {"no-shapes", "moved-joints"})
        return robots.write(Scene(links), "ros", quirks)
    producer = PRODUCERS[name]
    links = tuple(
        Link(f"link{i}", PLACE, (Solid("mesh", (0.1, 0.2, 0.3)), Solid("sphere", (1.0,))), 2.0)
        for i in range(count)
    )
    joints = tuple(Joint(f"joint{i}", i - 1, i) for i in range(1, count)) if producer.joints else ()
    scene = habits.meant(Scene(links, joints), producer)
    return flat.write(scene, producer, frozenset(producer.may))


@pytest.mark.parametrize("name", ["robot", "illusoft", "nxustream2", "chimera"])
def test_four_times_the_bodies_are_four_times_the_work(name: str) -> None:
    work: dict[str, list[int]] = {}
    file_and_forget = file(name, 3)  # what is made once is made now
    colladaphy.read(file_and_forget, repair=True).load()
    for count in (120, 480):
        data = file(name, count)
        tree = etree.ElementTree(etree.fromstring(data))
        work.setdefault("conform", []).append(calls(lambda tree=tree: conform(tree)))
        document = colladaphy.read(data, repair=True)
        work.setdefault("load", []).append(calls(document.load))
        stream = io.BytesIO()
        work.setdefault("write", []).append(
            calls(lambda document=document, stream=stream: document.write(stream))
        )
        written = stream.getvalue()
        work.setdefault("validate", []).append(
            calls(lambda written=written: colladaphy.validate(written))
        )
    for what, (few, many) in work.items():
        assert many < 5 * few, what
