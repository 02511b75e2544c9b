"""An edit of the common profile wins, and only where it is one (thesis 6.2.1)."""

from __future__ import annotations

import io
import re

import numpy as np
import pytest

import colladaphy
from colladaphy.mapper import WriteOptions
from colladaphy.mapper.loading.sameness import Sameness, significant_digits
from colladaphy.world import World, compare

NUMBER = re.compile(rb"(?<=[> ])-?\d+\.\d+(?:e[-+]?\d+)?(?=[< ])")


def text_of(world: World, **options: object) -> bytes:
    stream = io.BytesIO()
    colladaphy.write(world, stream, options=WriteOptions(**options))  # type: ignore[arg-type]
    return stream.getvalue()


def in_six_digits(data: bytes) -> bytes:
    """As a C++ stream writes: what stands in the common profile, with six significant digits."""
    parts = re.split(rb'(<technique profile="pe">.*?</technique>)', data, flags=re.DOTALL)
    return b"".join(
        part if part.startswith(b"<technique p") else NUMBER.sub(
            lambda match: f"{float(match[0]):.6g}".encode(), part
        )
        for part in parts
    )  # fmt: skip


def a_world() -> World:
    world = World(gravity=(0.1234567890123, 0.0, -9.80665123456))
    soft = world.create_material(
        "soft", density=1.23456789012, restitution=0.412345678901, static_friction=0.51234567891,
        dynamic_friction=0.112345678912, poisson_ratio=0.2, young_modulus=1, stiffness=8,
        damping_normal=0, damping_tangential=0,
    )  # fmt: skip
    world.create_plane(1, np.array([1.0, 2.0, 3.0]) / np.sqrt(14.0), 0.123456789123, soft)
    box = world.create_box(2, (1.123456789, 2.0, 3.0), (1.234567891234, 2.0, 3.0), soft)
    box.rotate(0.1, 0.2, 0.3)
    box.linear_velocity = (0.123456789123, 1.0, 2.0)
    box.angular_velocity = (0.1, 0.777777777777, 2.0)
    one = world.create_sphere(3, (7.0, 8.123456789, 9.0), 1.98765432109, soft)
    two = world.create_capsule(4, (9.0, 8.0, 9.0), 0.5, 2.123456789, soft)
    two.rotate(0.3, 0.2, 0.1)
    inner = world.create_union(5, [one, two])
    three = world.create_cylinder(6, (7.0, 4.0, 9.0), 0.512345678912, 2.0, soft)
    union = world.create_union(7, [inner, three])
    union.rotate(0.5, 0.6, 0.7)
    world.attach_hinge_joint(box, union, axis=(1, 2, 3), limits=(-0.3, 0.712345678912))
    return world


def load(data: bytes, prefer: str = "newer") -> tuple[World, list[str]]:
    document = colladaphy.read(data)
    world = document.load(prefer=prefer)
    told = [each.message for each in document.report if each.code == "profile-old-value"]
    return world, told


def test_six_digits_are_no_edit() -> None:
    world = a_world()
    data = in_six_digits(text_of(world, profile="full"))
    assert data != text_of(world, profile="full")
    again, messages = load(data)
    assert messages == []
    assert compare(world, again) == []


@pytest.mark.parametrize("six", [False, True], ids=["full digits", "six digits"])
@pytest.mark.parametrize("prefer", ["newer", "profile", "common"])
@pytest.mark.parametrize(
    ("what", "pattern", "edit", "read"),
    [
        ("mass", rb"(Body2.*?<mass>)[^<]*", b"12.5", lambda w: w.bodies[1].mass),
        ("shape", rb"(Body2.*?<half_extents>)[^<]*", b"0.5 1 2", lambda w: w.bodies[1].lengths[2]),
        ("plane", rb"(<equation>)[^<]*", b"0 0 1 -4", lambda w: w.bodies[0].displacement),
        ("dynamic", rb"(Body2.*?<dynamic>)[^<]*", b"false", lambda w: w.bodies[1].fixed),
        (
            "friction",
            rb"(<dynamic_friction>)[^<]*",
            b"0.75",
            lambda w: w.bodies[1].material.dynamic_friction,
        ),
        (
            "restitution",
            rb"(<restitution>)[^<]*",
            b"0.25",
            lambda w: w.bodies[1].material.restitution,
        ),
        ("position", rb"(Node2.*?<translate>)[^<]*", b"1 1 1", lambda w: w.bodies[1].position[0]),
        (
            "orientation",
            rb"(Node2.*?<rotate>)[^<]*",
            b"0 0 1 90",
            lambda w: w.bodies[1].orientation[3],
        ),
        ("velocity", rb"(<velocity>)[^<]*", b"5 5 5", lambda w: w.bodies[1].linear_velocity[0]),
        (
            "angular velocity",
            rb"(<angular_velocity>)[^<]*",
            b"90 90 90",
            lambda w: w.bodies[1].angular_velocity[0],
        ),
        (
            "angular limits",
            rb"(<swing_cone_and_twist>.*?<max>)[^<]*",
            b"0 0 90",
            lambda w: w.joints[0].angular_max[2],
        ),
    ],
)  # fmt: skip
def test_an_edit_wins(
    what: str, pattern: bytes, edit: bytes, read: object, prefer: str, six: bool
) -> None:
    world = a_world()
    data = text_of(world, profile="full")
    if six:
        data = in_six_digits(data)
    edited, count = re.subn(pattern, rb"\g<1>" + edit, data, count=1, flags=re.DOTALL)
    assert count == 1
    assert edited != data
    again, messages = load(edited, prefer)
    value, old = read(again), read(world)  # type: ignore[operator]
    if prefer == "profile":
        assert value == old
        assert messages == []
    else:
        assert value != old
        expected = {"mass": 12.5, "shape": 4.0, "plane": 4.0, "dynamic": True, "friction": 0.75,
                    "restitution": 0.25, "position": 1.0, "velocity": 5.0}  # fmt: skip
        if what in expected:
            assert value == expected[what]
        assert len(messages) == (1 if prefer == "newer" else 0)


def test_the_rest_stays_exact_beside_an_edit() -> None:
    world = a_world()
    data = in_six_digits(text_of(world, profile="full"))
    edited = re.sub(rb"(Body2.*?<mass>)[^<]*", rb"\g<1>12.5", data, count=1, flags=re.DOTALL)
    again, _ = load(edited)
    differences = compare(world, again)
    assert [line.split(",")[1].split(":")[0] for line in differences] == [" masses"]


def test_editing_a_member_of_a_union() -> None:
    world = a_world()
    data = text_of(world, profile="full")
    edited = data.replace(b"<sphere><radius>1.98765432109<", b"<sphere><radius>3<")
    assert edited != data
    again, messages = load(edited)
    union = again.bodies[2]
    assert [member.uid for member in union.members] == [5, 6]
    assert union.members[0].members[0].radius == 3.0
    assert len(messages) == 1
    whole = world.bodies[2]
    assert np.allclose(union.members[0].members[0].position, whole.members[0].members[0].position)


def test_removing_a_shape_of_a_union_drops_the_tree() -> None:
    data = text_of(a_world())
    start = data.index(b"<shape>", data.index(b'sid="Body7"'))
    end = data.index(b"</shape>", start) + len(b"</shape>")
    document = colladaphy.read(data[:start] + data[end:])
    world = document.load()
    assert [member.kind.name for member in world.bodies[2].members] == ["CAPSULE", "CYLINDER"]
    assert "profile-not-understood" in [finding.code for finding in document.report]


def test_common_profile_alone_is_close() -> None:
    world = a_world()
    again, messages = load(text_of(world), "common")
    assert messages == []
    assert [body.sid for body in again.bodies] == [body.sid for body in world.bodies]
    for body, other in zip(world.bodies, again.bodies, strict=True):
        assert np.allclose(body.position, other.position) or body.kind.name == "PLANE"
        assert np.isclose(body.mass, other.mass)
        assert np.allclose(
            np.linalg.eigvalsh(body.inertia), np.linalg.eigvalsh(other.inertia), atol=1e-9
        )


def test_significant_digits() -> None:
    words = {
        b"1": 1,
        b"100": 1,
        b"1.0": 1,
        b"100.0": 1,
        b"1.50": 3,
        b"0.001": 1,
        b"-12.50": 4,
        b"1.25e-7": 3,
        b"0": 0,
    }
    assert {word: significant_digits(word) for word in words} == words


def test_numbers_are_the_same_to_the_precision_of_their_record() -> None:
    asked: list[int] = []

    def measure(row: int) -> float:
        asked.append(row)
        return 0.5e-5

    sameness = Sameness(4, measure)
    inf = float("inf")
    one = np.array([[0.1234565], [0.123455], [inf], [inf]])
    other = np.array([[0.123457], [0.123457], [inf], [1.0]])
    assert sameness.each(np.arange(4), one, other).tolist() == [True, False, True, False]
    assert asked == [0, 1, 3]  # what is plainly the same is not measured
