"""What a World refuses, and that nothing is left behind when it does."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from colladaphy.errors import WorldError
from colladaphy.findings import Severity
from colladaphy.world import World
from colladaphy.world.rules import RULES

ORIGIN = (0, 0, 0)
BAD_SIZES = (0, -1, -0.0, math.nan, math.inf, "wide", None)

Creator = Callable[[World, Any], Any]
CREATORS: dict[str, Creator] = {
    "sphere": lambda w, s: w.create_sphere(1, ORIGIN, s, "iron"),
    "box x": lambda w, s: w.create_box(1, ORIGIN, (s, 1, 1), "iron"),
    "box z": lambda w, s: w.create_box(1, ORIGIN, (1, 1, s), "iron"),
    "capsule radius": lambda w, s: w.create_capsule(1, ORIGIN, s, 1, "iron"),
    "capsule length": lambda w, s: w.create_capsule(1, ORIGIN, 1, s, "iron"),
    "cylinder radius": lambda w, s: w.create_cylinder(1, ORIGIN, (1, s), 1, "iron"),
    "cylinder length": lambda w, s: w.create_cylinder(1, ORIGIN, 1, s, "iron"),
    "ellipsoid": lambda w, s: w.create_ellipsoid(1, ORIGIN, (1, s, 1), "iron"),
}


def refused(code: str, action: Callable[[], Any]) -> None:
    with pytest.raises(WorldError) as caught:
        action()
    finding = caught.value.findings[0]
    assert finding.code == code
    assert finding.stage == "physics"
    assert finding.hint


@pytest.mark.parametrize("what", CREATORS)
@pytest.mark.parametrize("size", BAD_SIZES)
def test_dimensions_have_to_be_positive(what: str, size: object) -> None:
    world = World()
    refused("physics-dimension", lambda: CREATORS[what](world, size))
    assert len(world.bodies) == 0 and world.next_body_sid == 1


@pytest.mark.parametrize("normal", [(0, 0, 0), (-0.0, 0, 0)])
def test_planes_need_a_normal(normal: Any) -> None:
    refused("physics-dimension", lambda: World().create_plane(1, normal, 0, "iron"))


@pytest.mark.parametrize("size", [1e-200, 1e150])
def test_masses_out_of_range_are_refused_unless_given(size: float) -> None:
    world = World()
    refused("physics-mass", lambda: world.create_sphere(1, ORIGIN, size, "iron"))
    body = world.create_sphere(1, ORIGIN, size, "iron", mass=1, inertia=(1, 1, 1))
    assert body.mass == 1


@pytest.mark.parametrize("mass", [-1, math.nan, math.inf])
def test_bad_masses(mass: float) -> None:
    refused("physics-mass", lambda: World().create_sphere(1, ORIGIN, 1, "iron", mass=mass))


@pytest.mark.parametrize("inertia", [np.eye(2), (1, 2), np.full((3, 3), np.nan)])
def test_bad_inertias(inertia: Any) -> None:
    refused("physics-inertia", lambda: World().create_sphere(1, ORIGIN, 1, "iron", inertia=inertia))


@pytest.mark.parametrize("value", [(0, 0), (0, 0, math.nan), (0, math.inf, 0), "no", (0, 0, "x")])
def test_bad_vectors(value: Any) -> None:
    world = World()
    body = world.create_sphere(1, ORIGIN, 1, "iron")
    refused("physics-number", lambda: world.create_sphere(1, value, 1, "iron"))
    for name in ("position", "linear_velocity", "angular_velocity", "force", "torque"):
        refused("physics-number", lambda name=name: setattr(body, name, value))
    refused("physics-number", lambda: setattr(world, "gravity", value))
    assert body.position.tolist() == [0, 0, 0]


@pytest.mark.parametrize("value", [(0, 0, 0, 0), (1, 0, 0), (1, 0, 0, math.nan)])
def test_bad_orientations(value: Any) -> None:
    body = World().create_sphere(1, ORIGIN, 1, "iron")
    refused("physics-number", lambda: setattr(body, "orientation", value))


def test_orientations_of_another_length_are_normalised() -> None:
    body = World().create_sphere(1, ORIGIN, 1, "iron", orientation=(0, 0, 0, 5))
    assert body.orientation.tolist() == [0, 0, 0, 1]
    body.orientation = (1e-300, 0, 0, 0)
    assert body.orientation.tolist() == [1, 0, 0, 0]
    third = (1 / 3, 2 / 3, 2 / 3, 0)
    body.orientation = third
    assert body.orientation.tolist() == list(third)


def test_system_and_user_ids() -> None:
    world = World()
    world.create_sphere(1, ORIGIN, 1, "iron", sid=5)
    for sid in (5, 0, -1, 2**63):
        refused("physics-system-id", lambda s=sid: world.create_sphere(1, ORIGIN, 1, "oak", sid=s))
    for uid in (2**63, -(2**63) - 1, 1.5, "one"):
        refused("physics-user-id", lambda u=uid: world.create_sphere(u, ORIGIN, 1, "iron"))
    assert world.create_sphere(-(2**63), ORIGIN, 1, "iron").sid == 6


def test_unknown_materials() -> None:
    world, other = World(), World()
    strange = other.create_material("strange", **VALUES)
    for material in ("adamant", strange, 9):
        refused("physics-material-unknown", lambda m=material: world.create_sphere(1, ORIGIN, 1, m))


VALUES = {
    "density": 1.2,
    "restitution": 0.4,
    "static_friction": 0.5,
    "dynamic_friction": 0.1,
    "poisson_ratio": 0.2,
    "young_modulus": 1.0,
    "stiffness": 8.0,
    "damping_normal": 0.0,
    "damping_tangential": 0.0,
}


@pytest.mark.parametrize(
    ("key", "bad"),
    [
        ("density", 0),
        ("density", math.inf),
        ("restitution", -0.1),
        ("restitution", 1.0000001),
        ("static_friction", -1e-9),
        ("dynamic_friction", math.nan),
        ("poisson_ratio", -1.01),
        ("poisson_ratio", 0.51),
        ("young_modulus", 0),
        ("stiffness", -3),
        ("damping_normal", -1),
        ("damping_tangential", -1),
    ],
)
def test_bad_material_values(key: str, bad: float) -> None:
    world = World()
    refused("physics-material-value", lambda: world.create_material("soft", **{**VALUES, key: bad}))
    assert "soft" not in world.materials
    world.create_material("soft", **VALUES)
    refused("physics-material-name", lambda: world.create_material("soft", **VALUES))
    refused("physics-material-name", lambda: world.create_material("other", **VALUES, id=5))


def test_properties_of_another_kind() -> None:
    world = World()
    box = world.create_box(1, ORIGIN, (1, 1, 1), "iron")
    for name in ("radius", "radii", "length", "normal", "displacement", "mesh"):
        with pytest.raises(WorldError, match="A box has no"):
            getattr(box, name)
        assert not hasattr(box, name)
    assert not hasattr(world.create_sphere(1, ORIGIN, 1, "iron"), "lengths")


def test_destroyed_bodies_and_bodies_of_others() -> None:
    world, other = World(), World()
    body = world.create_sphere(1, ORIGIN, 1, "iron", name="gone")
    stranger = other.create_sphere(1, ORIGIN, 1, "iron")
    assert body != stranger and len({body, stranger}) == 2
    refused("physics-body-gone", lambda: world.destroy(stranger))
    world.destroy(body)
    for action in (lambda: body.position, lambda: world.destroy(body), lambda: body.name):
        refused("physics-body-gone", action)
    assert "destroyed" in repr(body) and world.names == {}


def test_rules_are_well_formed() -> None:
    assert len({rule.code for rule in RULES}) == len(RULES)
    assert all(rule.stage == "physics" and rule.severity is Severity.ERROR for rule in RULES)
