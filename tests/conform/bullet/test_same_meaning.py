"""Bullet reads from the export what the standard reads from the document."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import given, settings
from lxml import etree
from tests.conform.bullet import bullet_reader, standard_reader
from tests.conform.bullet.conftest import Export
from tests.conform.bullet.scenes import scenes


@settings(max_examples=50)
@given(document=scenes())
def test_bullet_reads_the_same(document: bytes, export: Export) -> None:
    text, _ = export(document)
    expected = standard_reader.read(document)
    found = bullet_reader.read(text)
    compare(expected, found)
    before = standard_reader.visuals(etree.fromstring(document))
    after = standard_reader.visuals(etree.fromstring(text))
    assert_same_visuals(before, after)


def compare(expected: standard_reader.Scene, found: bullet_reader.BulletWorld) -> None:
    assert not found.lost
    assert np.array_equal(found.gravity, expected.gravity)
    assert len(found.bodies) == len(expected.bodies)
    for want, body in zip(expected.bodies, found.bodies, strict=True):
        compare_body(want, body)
    assert len(found.constraints) == len(expected.constraints)
    for bound, constraint in zip(expected.constraints, found.constraints, strict=True):
        compare_constraint(bound, constraint, found.bodies)


def compare_body(want: standard_reader.Body, body: bullet_reader.BulletBody) -> None:
    assert (body.mass > 0) == want.dynamic
    if want.dynamic:
        assert math.isclose(body.mass, want.mass, rel_tol=1e-12)
        assert np.allclose(body.pose[:3, 3], want.center, atol=1e-6)
        assert np.allclose(body.velocity, want.velocity)
        assert np.allclose(body.angular_velocity, want.angular_velocity)
    assert len(body.shapes) == len(want.shapes)
    for real, shape in zip(want.shapes, body.shapes, strict=True):
        pose = body.pose @ shape.local
        assert shape.kind == real.kind
        assert np.allclose(pose, real.pose, atol=1e-6)
        sizes = shape.sizes.copy()
        if shape.kind == "cylinder":
            sizes[1] *= 2  # it was half a height
        assert np.allclose(sizes, real.sizes, rtol=1e-12)


def free(low: float, high: float) -> bool:
    return low > high or (math.isinf(low) and math.isinf(high))


def compare_constraint(
    want: standard_reader.Constraint,
    found: bullet_reader.BulletConstraint,
    bodies: list[bullet_reader.BulletBody],
) -> None:
    assert want.first is not None
    assert want.second is not None
    assert found.first is bodies[want.first]
    assert found.second is bodies[want.second]
    for frame, place, body in zip(
        found.frames, want.frames, (found.first, found.second), strict=True
    ):
        assert np.allclose(body.pose @ frame, place, atol=1e-6)
    # Bullet measures minus the angle: what may turn from a to b turns from -b to -a there.
    lows = [*found.low[:3], *(0.0 - value for value in found.high[3:])]
    highs = [*found.high[:3], *(0.0 - value for value in found.low[3:])]
    lows[3:], highs[3:] = zip(
        *(
            (1.0, 0.0) if pair == (0.0, -1.0) else pair
            for pair in zip(lows[3:], highs[3:], strict=True)
        ),
        strict=True,
    )
    for low, high, wanted_low, wanted_high in zip(lows, highs, want.low, want.high, strict=True):
        if free(wanted_low, wanted_high):
            assert (low, high) == (1.0, 0.0)
        else:
            assert math.isclose(low, wanted_low)
            assert math.isclose(high, wanted_high)


def assert_same_visuals(
    before: list[tuple[str, standard_reader.Array]],
    after: list[tuple[str, standard_reader.Array]],
) -> None:
    assert len(before) == len(after)
    rest = list(after)
    for url, place in before:
        match = next(
            i
            for i, (other, there) in enumerate(rest)
            if other == url and np.allclose(place, there, atol=1e-6)
        )
        del rest[match]
