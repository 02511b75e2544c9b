"""A model of how Bullet's COLLADA converter reads a file, its faults included.

Written from what it was seen to do, not from our writer, with which it shares no code.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from lxml import etree

NS = "{http://www.collada.org/2005/11/COLLADASchema}"
Array = np.ndarray[Any, np.dtype[np.float64]]


class AbortError(Exception):
    """Bullet's converter would end the whole program here."""


@dataclass
class BulletShape:
    kind: str
    sizes: Array
    """Half extents, a radius, radius and half height, radius and height, n and D, or points."""
    local: Array


@dataclass
class BulletBody:
    sid: str
    mass: float
    """0 where the body is static."""
    pose: Array
    """Of the centre of mass."""
    shapes: list[BulletShape]
    compound: bool
    velocity: Array
    angular_velocity: Array
    """Radians a second."""


@dataclass
class BulletConstraint:
    first: BulletBody
    second: BulletBody | None
    frames: tuple[Array, Array]
    """In the bodies; that of the world in the world."""
    low: list[float]
    high: list[float]
    """Three linear limits, three angular ones in radians; an axis is free where low > high.

    The angles are Bullet's: minus those of COLLADA about each axis.
    """
    collide: bool


@dataclass
class BulletWorld:
    gravity: Array
    bodies: list[BulletBody] = field(default_factory=list)
    constraints: list[BulletConstraint] = field(default_factory=list)
    lost: list[str] = field(default_factory=list)


def read(data: bytes) -> BulletWorld:
    root = etree.fromstring(data)
    if root.tag != NS + "COLLADA":
        raise AbortError("it only knows the namespace of 1.4.1")
    return _Reader(root).world


def _floats(element: etree._Element) -> list[float]:
    return [float(word) for word in (element.text or "").split()]


def transform(element: etree._Element, matrices: bool = True) -> Array:
    """The order of the steps is lost: the last matrix, all rotates, all translates added."""
    basis, origin = np.eye(3), np.zeros(3)
    for matrix in element.findall(NS + "matrix") if matrices else []:
        values = np.array(_floats(matrix)).reshape(4, 4)
        basis, origin = values[:3, :3], values[:3, 3]
    for rotate in element.findall(NS + "rotate"):
        x, y, z, angle = _floats(rotate)
        half = math.radians(angle) / 2
        length = math.sqrt(x * x + y * y + z * z)
        q = np.array([x, y, z]) * (math.sin(half) / length)
        a, b, c = q
        cross = np.array([[0, -c, b], [c, 0, -a], [-b, a, 0]])
        basis = basis @ (np.eye(3) + 2 * math.cos(half) * cross + 2 * cross @ cross)
    for translate in element.findall(NS + "translate"):
        origin = origin + _floats(translate)
    result = np.eye(4)
    result[:3, :3], result[:3, 3] = basis, origin
    return result


class _Reader:
    def __init__(self, root: etree._Element) -> None:
        self.root = root
        self.ids = {e.get("id"): e for e in root.iter(etree.Element) if e.get("id")}
        up = root.findtext(f"{NS}asset/{NS}up_axis")
        gravity = {"X_UP": (-10, 0, 0), "Y_UP": (0, -10, 0), "Z_UP": (0, 0, -10)}.get(up or "")
        self.world = BulletWorld(np.array(gravity or (0, 0, 0), dtype=float))
        # Every scene, whatever <scene> says.
        for scene in root.findall(f"{NS}library_physics_scenes/{NS}physics_scene"):
            found = scene.find(f"{NS}technique_common/{NS}gravity")
            if found is not None:
                self.world.gravity = np.array(_floats(found))
            instances = scene.findall(NS + "instance_physics_model")
            for instance in instances:
                model = self._element(instance.get("url", ""))
                for inner in model.findall(NS + "instance_physics_model"):
                    self._bodies(inner, self._element(inner.get("url", "")))
                self._bodies(instance, model)
            for instance in instances:
                model = self._element(instance.get("url", ""))
                self._constraints(instance, model)

    def _element(self, url: str) -> etree._Element:
        if url[:1] != "#" or url[1:] not in self.ids:
            raise AbortError(f"{url} is followed without a look")
        return self.ids[url[1:]]

    def _bodies(self, instance: etree._Element, model: etree._Element) -> None:
        for user in instance.findall(NS + "instance_rigid_body"):
            for body in model.findall(NS + "rigid_body"):
                if body.get("sid") == user.get("body"):
                    self._body(user, body)
                    break
            else:
                self.world.lost.append(user.get("body", ""))

    def _body(self, user: etree._Element, body: etree._Element) -> None:
        common = body.find(NS + "technique_common")
        assert common is not None
        mass, dynamic = 1.0, True
        found = common.find(NS + "mass")
        if found is not None:
            mass = _floats(found)[0]
        found = common.find(NS + "dynamic")
        if found is not None:
            dynamic = (found.text or "").strip() in ("true", "1")
        for technique in body.findall(f"{NS}extra/{NS}technique"):
            for child in technique:
                if etree.QName(child).localname == "kinematic" and child.text == "true":
                    dynamic = False
        shapes, compound = [], False
        elements = common.findall(NS + "shape")
        for element in elements:
            shape = self._shape(element, dynamic)
            if shape is None:
                continue
            kind, sizes = shape
            inner = element.findall(NS + "rotate") + element.findall(NS + "translate")
            if len(elements) > 1 or inner:
                compound = True
            shapes.append(BulletShape(kind, sizes, transform(element)))
        if not shapes:
            self.world.lost.append(body.get("sid", ""))
            return
        node = self._element(user.get("target", ""))
        for scale in node.findall(NS + "scale"):
            for shape_ in shapes:
                shape_.sizes = shape_.sizes * _floats(scale)[0]
        if dynamic and mass == 0.0:
            mass = 1.0
        velocities = []
        for name in ("velocity", "angular_velocity"):
            found = user.find(f"{NS}technique_common/{NS}{name}")
            values = [0.0] * 3 if found is None or not dynamic else _floats(found)
            velocities.append(np.array(values))
        self.world.bodies.append(
            BulletBody(
                body.get("sid", ""),
                mass if dynamic else 0.0,
                transform(node),
                shapes,
                compound,
                velocities[0],
                velocities[1],
            )
        )

    def _shape(self, shape: etree._Element, dynamic: bool) -> tuple[str, Array] | None:
        """The last geometry that it understands."""
        for child in shape:
            name = etree.QName(child).localname
            values = {etree.QName(c).localname: _floats(c) for c in child if len(c) == 0}
            if name == "plane":
                equation = np.array(values["equation"])
                equation[:3] /= np.linalg.norm(equation[:3])
                return "plane", equation
            if name == "box":
                return "box", np.array(values["half_extents"])
            if name == "sphere":
                return "sphere", np.array(values["radius"])
            if name == "cylinder":
                # The height is taken for half of it.
                return "cylinder", np.array([values["radius"][0], values["height"][0]])
            if name == "capsule":
                return "capsule", np.array([values["radius"][0], values["height"][0]])
            if name == "instance_geometry":
                return self._geometry(child.get("url", ""), dynamic)
        return None

    def _geometry(self, url: str, dynamic: bool) -> tuple[str, Array] | None:
        if url[1:] not in self.ids:
            return None
        geometry = self.ids[url[1:]]
        mesh = geometry.find(NS + "mesh")
        if mesh is not None:
            sets = mesh.findall(NS + "triangles")
            if not sets:
                return None
            points = self._positions(mesh)
            last = sets[-1]
            inputs = last.findall(NS + "input")
            stride = max(int(i.get("offset", "0")) for i in inputs) + 1
            offset = next(
                int(i.get("offset", "0")) for i in inputs if i.get("semantic") == "VERTEX"
            )
            p = last.find(NS + "p")
            if p is None:
                raise AbortError("triangles without p")
            corners = [int(word) for word in (p.text or "").split()][offset::stride]
            corners = corners[: 3 * int(last.get("count", "0"))]
            return ("hull" if dynamic else "triangles"), points[corners]
        convex = geometry.find(NS + "convex_mesh")
        if convex is None:
            return None
        linked = convex.get("convex_hull_of")
        if linked is None:
            return "hull", self._positions(convex)
        for other in self.root.iter(NS + "geometry"):
            if other.get("id") is None:
                raise AbortError("an id of a geometry is compared that is not there")
            # The first character is skipped, whatever it is.
            if other.get("id") == linked[1:]:
                mesh = other.find(NS + "mesh")
                if mesh is not None:
                    return "hull", self._positions(mesh)
        return None

    def _positions(self, mesh: etree._Element) -> Array:
        vertices = mesh.find(NS + "vertices")
        if vertices is None:
            raise AbortError("a mesh without vertices")
        for entry in vertices.findall(NS + "input"):
            if entry.get("semantic") == "POSITION":
                source = self._element(entry.get("source", ""))
                array = source.find(NS + "float_array")
                if array is not None:
                    # Every three numbers are a point, whatever the accessor says.
                    numbers = _floats(array)
                    return np.array(numbers[: len(numbers) // 3 * 3]).reshape(-1, 3)
        return np.zeros((0, 3))

    def _constraints(self, instance: etree._Element, model: etree._Element) -> None:
        for user in instance.findall(NS + "instance_rigid_constraint"):
            for constraint in model.findall(NS + "rigid_constraint"):
                if constraint.get("sid") == user.get("constraint"):
                    self._constraint(constraint)

    def _constraint(self, element: etree._Element) -> None:
        attachments = [element.find(NS + name) for name in ("ref_attachment", "attachment")]
        bodies: list[BulletBody | None] = []
        frames = []
        for attachment in attachments:
            assert attachment is not None
            name = attachment.get("rigid_body", "")
            bodies.append(next((b for b in reversed(self.world.bodies) if b.sid == name), None))
            frames.append(transform(attachment, matrices=False))
        common = element.find(NS + "technique_common")
        assert common is not None
        low, high = [], []
        for name, threshold in (("linear", 999999.0), ("swing_cone_and_twist", 180.0)):
            ends = [common.find(f"{NS}limits/{NS}{name}/{NS}{end}") for end in ("min", "max")]
            if ends[0] is None or ends[1] is None:
                raise AbortError("a limit is missing")
            for a, b in zip(_floats(ends[0]), _floats(ends[1]), strict=True):
                free = a < -threshold or b > threshold
                low.append(1.0 if free else a)
                high.append(0.0 if free else b)
        first, second = bodies
        if first is None and second is None:
            return
        if first is None:
            first, second = second, first
            frames.reverse()
        assert first is not None
        if second is None:
            # A new static body stands where the other is, with the same frame.
            frames[1] = first.pose @ frames[0]
        interpenetrate = common.find(NS + "interpenetrate")
        collide = interpenetrate is None or (interpenetrate.text or "").strip() not in ("true", "1")
        self.world.constraints.append(
            BulletConstraint(first, second, (frames[0], frames[1]), low, high, collide)
        )
