"""Chapters 6 to 8, validation and conclusion: exactness, other programs, growth."""

from __future__ import annotations

import re

import numpy as np
import pytest
from tests.thesis.worlds import document_of, text_of

import colladaphy
from colladaphy import demo
from colladaphy.mapper.numbers import degrees_exactly, same_bits
from colladaphy.world import EngineState, World, compare


@pytest.mark.parametrize(("name", "build"), demo.CASES, ids=[name for name, _ in demo.CASES])
def test_6_1_the_world_is_unchanged(name: str, build: object) -> None:
    """6.1: write, read back into a new World, and compare; here to the last bit."""
    world = build()  # type: ignore[operator]
    assert compare(world, document_of(world).load()) == []


def test_6_1_rotations_are_not_distorted() -> None:
    """6.1, problem 1: conversion between quaternion and axis-angle lost bits; it does no more."""
    world = World()
    box = world.create_box(1, (0, 0, 0), (1, 1, 1), "iron")
    for _ in range(50):
        box.rotate(0.1, 0.2, 0.3)
    again = document_of(world).load()
    assert again.orientations.tobytes() == world.orientations.tobytes()


def test_6_1_degrees_convert_back_where_any_do() -> None:
    """6.1, problem 1: of neighbouring doubles the one is written that reads back exactly."""
    radians = np.random.default_rng(3).normal(size=10_000)
    degrees, exact = degrees_exactly(radians)
    assert np.array_equal(same_bits(degrees * (np.pi / 180.0), radians), exact)
    assert exact.mean() > 0.9


def test_6_1_system_ids_are_conserved() -> None:
    """6.1, problem 2: system ids are kept, and instances are written in their order."""
    world = World()
    for sid in (9, 4, 30, 2):
        world.create_sphere(sid, (sid, 0, 0), 1.0, "iron", sid=sid)
    numbers = re.findall(r'<instance_rigid_body [^>]*body="Body(\d+)"', text_of(world))
    assert numbers == ["2", "4", "9", "30"]
    assert document_of(world).load().sids.tolist() == [2, 4, 9, 30]


def test_6_1_order_is_kept_where_ids_are_taken() -> None:
    """6.1: with preexisting bodies ids may change, their order may not."""
    world = World()
    for sid in (1, 2, 3):
        world.create_sphere(sid, (sid, 0, 0), 1.0, "iron", sid=sid)
    target = World()
    target.create_sphere(100, (0, 0, 0), 1.0, "iron", sid=2)
    document_of(world).load(target)
    loaded = [each.uid for each in target.bodies if each.uid != 100]
    assert loaded == [1, 2, 3]


def test_6_2_1_edits_by_other_software_are_seen() -> None:
    """6.2.1: other software keeps the custom profile and edits the common one."""
    world = World()
    box = world.create_box(1, (0, 0, 0), (1, 2, 3), "iron")
    box.rotate(0.5, 0, 0)
    text = text_of(world, profile="full")
    edited = re.sub(r"<half_extents>[^<]*", "<half_extents>1 1 1", text)
    again = colladaphy.read(edited.encode())
    found = again.load().bodies[0]
    assert found.lengths.tolist() == [2.0, 2.0, 2.0]
    assert found.orientation.tobytes() == box.orientation.tobytes()
    assert "profile-old-value" in [finding.code for finding in again.report]
    assert again.load(prefer="profile").bodies[0].lengths.tolist() == [1.0, 2.0, 3.0]


def test_6_2_1_second_libraries_are_read() -> None:
    """6.2.1, observation 2: new content can stand in further libraries of the same kind."""
    world = World()
    world.create_sphere(1, (0, 0, 0), 1.0, "iron")
    text = text_of(world)
    start, end = text.index("<library_physics_materials>"), text.index("<library_physics_models>")
    library = text[start:end]
    more = library.replace('"Material0"', '"Other"').replace('"iron"', '"clay"')
    more = re.sub("<extra>.*?</extra>", "", more)
    text = text[:end] + more + text[end:]
    text = text.replace('url="#Material0"', 'url="#Other"')
    material = colladaphy.read(text.encode()).load().bodies[0].material
    assert material is not None
    assert material.name == "clay"


def test_6_2_1_heights_are_whole_lengths() -> None:
    """6.2.1, observation 3: a COLLADA height is the whole length, not half of it."""
    world = World()
    world.create_capsule(1, (0, 0, 0), 0.5, 3.0, "iron")
    world.create_cylinder(2, (0, 0, 0), 0.5, 2.0, "iron")
    assert re.findall("<height>([^<]*)", text_of(world)) == ["3", "2"]


def test_6_2_2_bodies_with_a_zero_dimension_are_skipped() -> None:
    """6.2.2, observation 2: a body with a volume of zero is not loaded, and that is reported."""
    world = World()
    world.create_box(1, (0, 0, 0), (1, 2, 3), "iron")
    world.create_box(2, (0, 0, 0), (1, 2, 4), "iron")
    text = text_of(world).replace("<half_extents>0.5 1 1.5<", "<half_extents>0.5 1 0<")
    document = colladaphy.read(text.encode())
    assert [each.uid for each in document.load().bodies] == [2]
    assert [finding.code for finding in document.report] == [
        "load-empty-shape", "load-body-skipped",
    ]  # fmt: skip


def test_8_1_a_checkpoint_is_complete() -> None:
    """8.1: the clock, the counters and the engine's state are part of the file."""
    world = World(gravity=(0, 0, -9.81), time_step=0.01, name="checkpoint")
    sphere = world.create_sphere(1, (0, 0, 0), 1.0, "iron")
    world.create_sphere(2, (5, 0, 0), 1.0, "iron")
    world.destroy(world.bodies[1])
    sphere.force, sphere.torque, sphere.sleeping = (1, 2, 3), (4, 5, 6), True
    world.time, world.step_count = 12.3, 1230
    world.engine_state = EngineState("engine", "1.2", bytes(range(256)))
    again = document_of(world).load()
    assert compare(world, again) == []
    assert again.engine_state == world.engine_state


def test_8_1_a_damaged_state_is_not_used() -> None:
    """8.1: the engine's state has a checksum."""
    world = World()
    world.engine_state = EngineState("engine", "1.2", b"state")
    text = re.sub('sha256="..', 'sha256="00', text_of(world))
    document = colladaphy.read(text.encode())
    assert document.load().engine_state is None
    assert [finding.code for finding in document.report] == ["profile-engine-state"]


def test_8_1_files_are_read_by_people() -> None:
    """8.1: the files are human-readable: a body is a line."""
    world = World()
    for number in range(3):
        world.create_sphere(number, (number, 0, 0), 1.0, "iron")
    lines = [line for line in text_of(world).splitlines() if line.startswith("<rigid_body")]
    assert len(lines) == 3


def test_8_2_another_reader_sees_a_valid_file() -> None:
    """8.2: what others read is the common profile, valid without ours."""
    world = demo.open_box()
    text = text_of(world, profile="none")
    assert "<pe:" not in text
    again = colladaphy.read(text.encode()).load()
    assert np.allclose(again.positions, world.positions)
    assert len(again.joints) == len(world.joints)
