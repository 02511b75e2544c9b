"""Regular bodies take a quicker path through columns, and come out the same."""

from __future__ import annotations

import io
import re

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.strategies.worlds import worlds

import colladaphy
from colladaphy.mapper.load import load
from colladaphy.world import BodyColumns, Kind, World, compare


def both_ways(data: bytes, prefer: str = "newer") -> tuple[World, World, list[str], list[str]]:
    quick, slow = colladaphy.read(data), colladaphy.read(data)
    one = load(quick, prefer=prefer)
    other = load(slow, prefer=prefer, columns=False)
    return one, other, [f.code for f in quick.report], [f.code for f in slow.report]


def text_of(world: World) -> bytes:
    stream = io.BytesIO()
    colladaphy.write(world, stream)
    return stream.getvalue()


@settings(max_examples=40)
@given(worlds(), st.sampled_from(["newer", "profile", "common"]))
def test_both_paths_give_the_same_world(world: World, prefer: str) -> None:
    one, other, codes, others = both_ways(text_of(world), prefer)
    assert compare(one, other) == []
    assert sorted(codes) == sorted(others)


# What other writers and editors do to a file, as substitutions in its text.
EDITS = {
    "six digits": (rb"\d+\.\d{7,}", lambda match: f"{float(match[0]):.6g}".encode()),
    "no profile": (rb'<technique profile="pe">.*?</technique>', b'<technique profile="a"/>'),
    "other profile": (rb'<technique profile="pe">', b'<technique profile="other">'),
    "no dynamic": (rb"<dynamic>\w+</dynamic>", b""),
    "one for true": (rb">true<", b"> 1 <"),
    "empty velocity": (rb"<velocity>[^<]*</velocity>", b"<velocity/>"),
    "no rotation": (rb"<rotate>[^<]*</rotate></node>", b"</node>"),
    "turned the other way": (rb"<rotate>0 0 1 -90</rotate>", b"<rotate>0 0 1 90</rotate>"),
    "blanks": (rb"(<translate>)", rb"\1\n  "),
    "comments": (rb"(<translate>)", rb"\1<!-- here -->"),
    "flat": (rb"<radius>[^<]*</radius></sphere>", b"<radius>0</radius></sphere>"),
    "no mass": (rb"<mass>[^<]*</mass>", b""),
    "no material": (rb'<instance_physics_material url="[^"]*"/>', b""),
    "negative mass": (rb"<mass>[^<]*</mass>", b"<mass>-1</mass>"),
    "names": (rb"<instance_rigid_body ", b'<instance_rigid_body name="n" '),
    "no ids": (rb"Body(\d+)", rb"Part\1"),
}


@settings(max_examples=60)
@given(
    worlds(wild=False),
    st.lists(st.sampled_from(sorted(EDITS)), min_size=1, max_size=3, unique=True),
)
def test_both_paths_agree_on_edited_files(world: World, edits: list[str]) -> None:
    data = text_of(world)
    for edit in edits:
        pattern, replacement = EDITS[edit]
        data = re.sub(pattern, replacement, data, flags=re.DOTALL)
    one, other, codes, others = both_ways(data)
    assert compare(one, other) == []
    assert sorted(codes) == sorted(others)


def test_instances_in_another_order_than_bodies() -> None:
    world = World()
    iron = world.materials["iron"]
    for number in range(5):
        world.create_sphere(number, (number, 0, 0), 1.0 + number, iron)
    data = text_of(world)
    lines = re.findall(rb"<instance_rigid_body .*?</instance_rigid_body>\n", data)
    data = data.replace(b"".join(lines), b"".join(reversed(lines)))
    one, other, _, _ = both_ways(data)
    assert compare(one, world) == []
    assert compare(other, world) == []


def test_a_body_that_is_instanced_twice_is_two() -> None:
    world = World()
    world.create_sphere(7, (1, 2, 3), 1.0, world.materials["iron"])
    data = text_of(world)
    line = re.findall(rb"<instance_rigid_body .*?</instance_rigid_body>\n", data)[0]
    one, other, _, _ = both_ways(data.replace(line, line + line))
    assert len(one.bodies) == 2
    assert compare(one, other) == []


def test_many_spheres_are_read_in_columns() -> None:
    count = 500
    generator = np.random.default_rng(1)
    world = World()
    dimensions = np.zeros((count, 4))
    dimensions[:, 0] = generator.uniform(0.1, 2.0, count)
    world.extend(
        BodyColumns(
            kinds=np.full(count, Kind.SPHERE, dtype=np.int8),
            positions=generator.normal(size=(count, 3)),
            linear_velocities=generator.normal(size=(count, 3)),
            angular_velocities=generator.normal(size=(count, 3)),
            dimensions=dimensions,
        )
    )
    one, other, _, _ = both_ways(text_of(world))
    assert compare(one, world) == []
    assert compare(other, world) == []
