"""The simulation of Bullet's saving, which other tests rely on, does what Bullet does."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from lxml import etree
from tests.conform.bullet import bullet_reader
from tests.conform.bullet.bullet_reader import NS
from tests.conform.bullet.conftest import Export
from tests.conform.bullet.rewritten import NewBody, State, rewrite
from tests.conform.bullet.scenes import scenes
from tests.conform.bullet.test_bullet import body, constrained, document


@settings(max_examples=25)
@given(document=scenes())
def test_saving_what_was_loaded_changes_only_digits(document: bytes, export: Export) -> None:
    text, _ = export(document)
    before, after = bullet_reader.read(text), bullet_reader.read(rewrite(text))
    assert len(before.bodies) == len(after.bodies)
    assert len(before.constraints) == len(after.constraints)
    for old, new in zip(before.bodies, after.bodies, strict=True):
        assert np.allclose(old.pose, new.pose, rtol=1e-5, atol=1e-4)
        assert np.isclose(old.mass, new.mass, rtol=1e-5)
        assert np.allclose(old.angular_velocity, new.angular_velocity, rtol=1e-5)
    for bound, again in zip(before.constraints, after.constraints, strict=True):
        assert np.allclose(bound.low, again.low, rtol=1e-5)
        assert np.allclose(bound.frames[0], again.frames[0], rtol=1e-4, atol=1e-4)


def test_a_moved_body_keeps_what_bullet_does_not_know(export: Export) -> None:
    profile = "<technique profile='pe'><mass>1.23456789</mass></technique>"
    bodies = body(before="<mass>1.23456789</mass>", after=profile)
    text, _ = export(document(bodies=bodies, nodes="<node id='n' name='x'/>"))
    state = State((1, 2, 3.14159265), (0, 0, 1, 90), (1, 0, 0), (0, 0.5, 0))
    saved = rewrite(text, {"b": state})
    found = bullet_reader.read(saved).bodies[0]
    assert list(found.pose[:3, 3]) == [1, 2, 3.14159]
    assert np.allclose(found.pose[:3, 0], [0, 1, 0])
    assert list(found.velocity) == [1, 0, 0]
    assert list(found.angular_velocity) == [0, 0.5, 0]
    root = etree.fromstring(saved)
    masses = [mass.text for mass in root.iter("{*}mass")]
    assert masses == ["1.23457", "1.23456789"]


def test_constraints_are_written_anew(export: Export) -> None:
    text, _ = export(constrained("rigid_body='m/b'", "rigid_body='m/c'"))
    text = text.replace(b"<enabled>true", b"<enabled>false")
    root = etree.fromstring(rewrite(text))
    assert root.findtext(f".//{NS}rigid_constraint//{NS}enabled") == "true"
    assert root.findtext(f".//{NS}rigid_constraint//{NS}interpenetrate") == "false"
    assert root.findtext(f".//{NS}ref_attachment/{NS}rotate") == "1 0 0 0"


def test_new_bodies_have_a_model_of_their_own(export: Export) -> None:
    text, _ = export(document())
    new = [
        NewBody("BulletUnnamed-0", "box", state=State(position=(0, 5, 0)), friction=0.25),
        NewBody("BulletUnnamed-1", "cylinder", (1.0, 2.0)),
        NewBody("BulletUnnamed-2", "capsule", (1.0, 2.0)),
        NewBody("BulletUnnamed-3", "compound", parts=(("sphere", (1.0,), (1.0, 0.0, 0.0)),)),
        NewBody("BulletUnnamed-4", "plane", (0.0, 1.0, 0.0, -2.0)),
    ]
    saved = rewrite(text, new=new)
    world = bullet_reader.read(saved)
    assert [found.sid for found in world.bodies[1:]] == [
        f"BulletUnnamed-{i}-RigidBody" for i in (0, 1, 3, 4)
    ]
    assert world.lost == ["BulletUnnamed-2-RigidBody"]
    assert list(world.bodies[2].shapes[0].sizes) == [1, 2]
    root = etree.fromstring(saved)
    assert root.find(f".//{NS}physics_model[@id='Bullet-PhysicsModel']") is not None
    empty = [shape for shape in root.iter(NS + "shape") if not len(shape)]
    assert len(empty) == 2
    material = root.find(f".//{NS}physics_material[@id='BulletUnnamed-0-PhysicsMaterial']")
    assert material is not None
    assert material.findtext(f".//{NS}static_friction") == "0.25"


def test_what_is_written_for_bullet_has_no_prefix_at_its_root(export: Export) -> None:
    """Bullet drops the declarations there; those where a profile begins come through."""
    profile = '<technique profile="pe"><pe:body uid="1"/></technique>'
    data = document(bodies=body(after=profile)).replace(
        b"<COLLADA ", b'<COLLADA xmlns:pe="urn:colladaphy:pe:1" '
    )
    saved = rewrite(export(data)[0])
    assert etree.fromstring(saved).find(".//{urn:colladaphy:pe:1}body") is not None
