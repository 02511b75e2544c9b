"""One World for every kind of thing that a file can hold, and files with one irregularity."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from io import BytesIO
from typing import Any

import numpy as np
from lxml import etree

import colladaphy
from colladaphy.links.poses import Poses
from colladaphy.world import Kind, World
from colladaphy.world.columns import BodyColumns, JointColumns
from colladaphy.world.materials import VALUES

__all__ = ["KINDS", "BenchKind"]

Array = np.ndarray[Any, Any]

_SIZES = {
    Kind.SPHERE: (0,), Kind.BOX: (0, 1, 2), Kind.CAPSULE: (0, 1, 2, 3), Kind.CYLINDER: (1, 2, 3),
}  # fmt: skip
_MEMBERS = 5


@dataclass(frozen=True)
class BenchKind:
    """What is measured: a World of a number of bodies, and how its file comes about."""

    world: Callable[[int], World]
    options: dict[str, Any]
    edit: Callable[[bytes], bytes] | None = None
    """Changes the file; there is nothing to store then."""

    def document(self, count: int) -> bytes:
        """The file of the World."""
        target = BytesIO()
        colladaphy.write(self.world(count), target, options=self.write_options)
        return target.getvalue() if self.edit is None else self.edit(target.getvalue())

    @property
    def write_options(self) -> Any:
        """How the World is written."""
        return colladaphy.WriteOptions(**self.options)


def bodies(kind: Kind, count: int, world: World) -> BodyColumns:
    """Bodies of one material, each with pose, velocity and mass of its own."""
    random = np.random.default_rng(count)
    dimensions = np.zeros((count, 4))
    for column in _SIZES.get(kind, ()):
        dimensions[:, column] = random.uniform(0.5, 2.0, count)
    return BodyColumns(
        kinds=np.full(count, int(kind)),
        uids=np.arange(count),
        positions=random.uniform(-100.0, 100.0, (count, 3)),
        orientations=_quaternions(random, count),
        linear_velocities=random.standard_normal((count, 3)),
        angular_velocities=random.standard_normal((count, 3)),
        masses=random.uniform(1.0, 10.0, count),
        material_ids=np.full(count, soft(world)),
        dimensions=dimensions,
    )


def soft(world: World) -> int:
    """A material that is not one of the five that every World has."""
    if "soft" not in world.materials:
        world.create_material(
            "soft", density=1.2, restitution=0.4, static_friction=0.5, dynamic_friction=0.1,
            poisson_ratio=0.2, young_modulus=1.0, stiffness=8.0, damping_normal=0.0,
            damping_tangential=0.0,
        )  # fmt: skip
    return world.materials["soft"].id


def _quaternions(random: np.random.Generator, count: int) -> Array:
    made = random.standard_normal((count, 4))
    return np.asarray(made / np.linalg.norm(made, axis=1)[:, None])


def _world() -> World:
    return World(gravity=(0.0, 0.0, -9.81))


def primitives(kind: Kind) -> Callable[[int], World]:
    """Primitives of a kind."""

    def make(count: int) -> World:
        world = _world()
        world.extend(bodies(kind, count, world))
        return world

    return make


def materials(count: int) -> World:
    """Spheres, each with a material of its own."""
    world = _world()
    random = np.random.default_rng(count)
    values = {key: random.uniform(0.1, 0.4, count) for key in VALUES}
    values["static_friction"] += values["dynamic_friction"]
    ids = world.materials.extend([f"m{number}" for number in range(count)], values)
    columns = bodies(Kind.SPHERE, count, world)
    columns.material_ids = ids
    world.extend(columns)
    return world


def planes(count: int) -> World:
    """Planes."""
    world = _world()
    random = np.random.default_rng(count)
    normals = random.standard_normal((count, 3))
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    distances = random.uniform(-10.0, 10.0, (count, 1))
    world.extend(
        BodyColumns(
            kinds=np.full(count, int(Kind.PLANE)),
            uids=np.arange(count),
            material_ids=np.full(count, soft(world)),
            dimensions=np.hstack([normals, distances]),
        )
    )
    return world


def inertias(count: int) -> World:
    """Boxes with an inertia of their own, of no particular axes."""
    world = _world()
    columns = bodies(Kind.BOX, count, world)
    halves = np.random.default_rng(count).uniform(0.5, 2.0, (count, 3, 3))
    spread = halves @ halves.transpose(0, 2, 1)  # of mass, so that there is such a body
    traces = np.trace(spread, axis1=1, axis2=2)[:, None, None]
    columns.inertias = traces * np.eye(3) - spread
    world.extend(columns)
    return world


_CORNERS = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=float)
_TRIANGLES = np.array([
    (0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1),
    (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3),
])  # fmt: skip


def meshes(*, shared: bool) -> Callable[[int], World]:
    """Bodies of one mesh of twelve triangles, or of a mesh each."""

    def make(count: int) -> World:
        world = _world()
        random = np.random.default_rng(count)
        every = random.uniform(0.5, 2.0, (1 if shared else count, 1, 3)) * _CORNERS + 0.25
        first = len(world.meshes)
        world.add_meshes([(points, _TRIANGLES, True) for points in every])
        columns = bodies(Kind.MESH, count, world)
        columns.mesh_ids = np.full(count, first) if shared else first + np.arange(count)
        world.extend(columns)
        return world

    return make


def joints(*, hinge: bool) -> Callable[[int], World]:
    """Spheres in a chain, each joined to the one before, the first one to the world."""

    def make(count: int) -> World:
        world = _world()
        columns = bodies(Kind.SPHERE, count, world)
        world.extend(columns)
        random = np.random.default_rng(count + 1)
        limits = np.zeros((count, 2, 3))
        if hinge:
            limits[:, 0, 0], limits[:, 1, 0] = -random.random(count), random.random(count)
        ends = np.column_stack([np.arange(count), np.arange(1, count + 1)])
        # The frames of both bodies meet, at some place near the second one.
        outer = Poses.of(count + 1, np.vstack([np.zeros(3), columns.positions]),
                         np.vstack([[1.0, 0.0, 0.0, 0.0], columns.orientations]))  # fmt: skip
        places = outer.positions[1:] + random.standard_normal((count, 3))
        meeting = Poses.of(count, places, _quaternions(random, count))
        frames = [outer.take(each).inverse().then(meeting) for each in ends.T]
        world.extend_joints(
            JointColumns(
                bodies=ends,
                uids=np.arange(count),
                positions=np.stack([each.positions for each in frames], axis=1),
                orientations=np.stack([each.orientations for each in frames], axis=1),
                angular_limits=limits,
            )
        )
        return world

    return make


def unions(*, nested: bool) -> Callable[[int], World]:
    """Unions of five boxes, or of two and a union of three."""

    def make(count: int) -> World:
        world = _world()
        parts = bodies(Kind.BOX, count * _MEMBERS, world)
        world.extend(parts)
        boxes = list(world.bodies)
        for number in range(count):
            members = boxes[number * _MEMBERS : (number + 1) * _MEMBERS]
            if nested:
                members[2:] = [world.create_union(number, members[2:])]
            union = world.create_union(number, members)
            union.linear_velocity, union.angular_velocity = (1.0, 2.0, 3.0), (0.5, 0.25, 0.125)
        return world

    return make


def _in_middle(content: str, *, of: str) -> Callable[[bytes], bytes]:
    """Put some content at the end of one element in the middle of the file."""

    def edit(data: bytes) -> bytes:
        root = etree.fromstring(data, etree.XMLParser(huge_tree=True))
        found = list(root.iter(f"{{*}}{of}"))
        namespace = etree.QName(root).namespace
        for node in etree.fromstring(f'<a xmlns="{namespace}">{content}</a>').xpath("node()"):
            found[len(found) // 2].append(node)
        return etree.tostring(root, xml_declaration=True, encoding="UTF-8")

    return edit


def _density(data: bytes) -> bytes:
    """Let one shape in the middle state its density in place of its mass."""
    middle = data.index(b"<mass>", data.index(b"<rigid_body") + len(data) // 8)
    end = data.index(b"</mass>", middle)
    changed = data[middle:end].replace(b"<mass>", b"<density>") + b"</density>"
    return data[:middle] + changed + data[end + len(b"</mass>") :]


_SPHERES = primitives(Kind.SPHERE)

KINDS: dict[str, BenchKind] = {
    "spheres": BenchKind(_SPHERES, {}),
    "boxes": BenchKind(primitives(Kind.BOX), {}),
    "capsules": BenchKind(primitives(Kind.CAPSULE), {}),
    "cylinders": BenchKind(primitives(Kind.CYLINDER), {}),
    "a material each": BenchKind(materials, {}),
    "planes": BenchKind(planes, {}),
    "an inertia each": BenchKind(inertias, {}),
    "a shared mesh": BenchKind(meshes(shared=True), {}),
    "a mesh each": BenchKind(meshes(shared=False), {}),
    "a fixed joint each": BenchKind(joints(hinge=False), {}),
    "a hinge each": BenchKind(joints(hinge=True), {}),
    "unions of five": BenchKind(unions(nested=False), {}),
    "nested unions": BenchKind(unions(nested=True), {}),
    "a model each": BenchKind(_SPHERES, {"group": lambda body: str(body.sid)}),
    "one comment": BenchKind(_SPHERES, {}, _in_middle("<!-- here -->", of="rigid_body")),
    "one extra": BenchKind(
        _SPHERES, {}, _in_middle('<extra><technique profile="x"/></extra>', of="rigid_body")
    ),
    "one density": BenchKind(_SPHERES, {}, _density),
    "one off centre": BenchKind(
        _SPHERES, {}, _in_middle("<translate>0.25 0 0</translate>", of="shape")
    ),
}
"""By name; the last four are spheres but for one, and nothing but the time of loading differs."""
