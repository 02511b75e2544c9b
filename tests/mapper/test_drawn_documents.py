"""Documents of any structure: against the slow reference, in other units, axes and spellings."""

from __future__ import annotations

import io

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.mapper.reference import Reference

import colladaphy
from colladaphy.mapper import WriteOptions
from colladaphy.testing import edits, linked_files, physics_documents, worlds
from colladaphy.testing.files import LinkedFiles
from colladaphy.world import World, compare, rotations

plain = physics_documents(profiles=False, oddities=False)


def check(world: World, reference: Reference) -> None:
    """All that the reference knows, which is all but inertias and joints."""
    expected = reference.bodies()
    assert len(world.bodies) == len(expected)
    size = 1 + np.abs(world.positions).max(initial=0)
    for found, wanted in zip(world.bodies, expected, strict=True):
        assert found.fixed == (wanted["fixed"] or wanted["infinite"])
        assert np.allclose(found.linear_velocity, wanted["velocity"])
        assert np.allclose(found.angular_velocity, wanted["turning"])
        if wanted["infinite"]:  # the centre of a half space is anywhere
            continue
        assert found.mass == pytest.approx(wanted["mass"])
        assert np.allclose(found.position, wanted["position"], rtol=0, atol=1e-9 * size)
        members = found.members or (found,)
        if found.members or len(wanted["members"]) == 1:
            for member, place in zip(members, wanted["members"], strict=True):
                assert np.allclose(member.position, place, rtol=0, atol=1e-9 * size)


@settings(max_examples=30)
@given(document=plain)
def test_load_is_what_the_slow_reference_reads(document: bytes) -> None:
    check(colladaphy.read(document).load(), Reference(document))


@settings(max_examples=25)
@given(files=linked_files())
def test_in_several_files_too(files: LinkedFiles) -> None:
    world = colladaphy.read(files.archive()).load()
    check(world, Reference(files.alone))


@settings(max_examples=30)
@given(data=st.data(), document=plain)
def test_and_after_edits(data: st.DataObject, document: bytes) -> None:
    kinds = ["nodes-moved", "nodes-turned", "masses", "velocities", "bodies-removed",
             "bodies-copied", "bodies-added", "joints-removed", "indented"]  # fmt: skip
    edited = data.draw(edits(document, kinds=kinds))
    check(colladaphy.read(edited).load(), Reference(edited))


@settings(max_examples=30)
@given(document=physics_documents())
def test_units_commute_with_loading(document: bytes) -> None:
    """Another unit changes no number; in metres all lengths are as many times longer."""
    as_it_is = colladaphy.read(document).load()
    loaded = colladaphy.read(document).load(si=True)
    size = as_it_is.unit_meter
    assert loaded.unit_meter == 1.0
    assert np.allclose(loaded.positions, as_it_is.positions * size, rtol=1e-12, atol=0)
    assert np.allclose(loaded.linear_velocities, as_it_is.linear_velocities * size, rtol=1e-12)
    assert np.allclose(loaded.gravity, as_it_is.gravity * size, rtol=1e-12)
    assert np.allclose(loaded.masses, as_it_is.masses, rtol=1e-12)
    assert np.allclose(loaded.inertias, as_it_is.inertias * size**2, rtol=1e-9)
    assert np.allclose(loaded.angular_velocities, as_it_is.angular_velocities, rtol=1e-12)


@settings(max_examples=30)
@given(document=physics_documents(), axis=st.sampled_from(["X_UP", "Y_UP", "Z_UP"]))
def test_axes_commute_with_loading(document: bytes, axis: str) -> None:
    """With another axis upwards everything is turned, by one rotation, and nothing else."""
    as_it_is = colladaphy.read(document).load()
    turned = colladaphy.read(document).load(up_axis=axis)
    assert turned.up_axis == axis
    up = {"X_UP": (1.0, 0.0, 0.0), "Y_UP": (0.0, 1.0, 0.0), "Z_UP": (0.0, 0.0, 1.0)}
    if axis == as_it_is.up_axis:
        assert compare(as_it_is, turned) == []
        return
    turn = rotations.multiply(turned.orientations[0], rotations.conjugate(as_it_is.orientations[0]))
    assert np.allclose(rotations.rotate(turn, up[as_it_is.up_axis]), up[axis], atol=1e-9)
    size = 1 + np.abs(as_it_is.positions).max(initial=0)
    for before, after in (
        (as_it_is.positions, turned.positions),
        (as_it_is.linear_velocities, turned.linear_velocities),
        (as_it_is.angular_velocities, turned.angular_velocities),
    ):
        assert np.allclose([rotations.rotate(turn, row) for row in before], after,
                           rtol=0, atol=1e-9 * max(size, np.abs(before).max()))  # fmt: skip
    assert np.allclose(turned.masses, as_it_is.masses, rtol=1e-12)


@settings(max_examples=30)
@given(document=physics_documents())
def test_a_document_comes_back_from_its_world(document: bytes) -> None:
    """Loaded, stored as a World and loaded again; updated with its own World; both to the bit."""
    first = colladaphy.read(document)
    world = first.load()
    stored = io.BytesIO()
    colladaphy.write(world, stored)
    assert compare(world, colladaphy.read(stored.getvalue()).load()) == []
    first.update(world)
    written = io.BytesIO()
    first.write(written)
    assert colladaphy.validate(written.getvalue()).valid
    assert compare(world, colladaphy.read(written.getvalue()).load()) == []


@settings(max_examples=25)
@given(world=worlds(min_bodies=0))
def test_archives_hold_the_same_world(
    world: World, tmp_path_factory: pytest.TempPathFactory
) -> None:
    path = tmp_path_factory.mktemp("archives") / "world.zae"
    colladaphy.write(world, path)
    assert path.read_bytes()[:2] == b"PK"
    assert compare(world, colladaphy.read(path).load()) == []


@settings(max_examples=25)
@given(world=worlds(), group=st.integers(1, 3))
def test_parts_hold_the_same_world(world: World, group: int) -> None:
    """Bodies in models of their own; a joint binds bodies of one."""
    stream = io.BytesIO()
    options = WriteOptions(group=lambda body: str(body.uid % group), shape_weight="density")
    colladaphy.write(world, stream, options=options)
    assert compare(world, colladaphy.read(stream.getvalue()).load()) == []
