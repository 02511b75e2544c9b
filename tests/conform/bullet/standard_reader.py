"""A plain reading of COLLADA 1.5 physics, by the standard: slow, obvious, with matrices."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from lxml import etree

Array = np.ndarray[Any, np.dtype[np.float64]]


@dataclass
class Shape:
    kind: str
    sizes: Array
    """As the standard has them: heights are whole, planes are n and -D at unit length."""
    pose: Array
    """In the world."""


@dataclass
class Body:
    dynamic: bool
    mass: float
    center: Array
    shapes: list[Shape]
    velocity: Array
    angular_velocity: Array


@dataclass
class Constraint:
    first: int | None
    second: int | None
    frames: tuple[Array, Array]
    """In the world, as the bodies stand."""
    low: list[float]
    high: list[float]


@dataclass
class Scene:
    gravity: Array
    bodies: list[Body] = field(default_factory=list)
    constraints: list[Constraint] = field(default_factory=list)


def name_of(element: etree._Element) -> str:
    return str(etree.QName(element).localname) if isinstance(element.tag, str) else ""


def floats(element: etree._Element) -> list[float]:
    return [float(word) for word in (element.text or "").split()]


def child(element: etree._Element | None, *path: str) -> etree._Element | None:
    for name in path:
        if element is not None:
            element = next((c for c in element if name_of(c) == name), None)
    return element


def step(element: etree._Element) -> Array:
    values, result = floats(element), np.eye(4)
    match name_of(element):
        case "translate":
            result[:3, 3] = values
        case "scale":
            result[:3, :3] = np.diag(values)
        case "matrix":
            result = np.array(values).reshape(4, 4)
        case "rotate":
            axis = np.array(values[:3]) / np.linalg.norm(values[:3])
            angle = math.radians(values[3])
            for i in range(3):
                e = np.eye(3)[i]
                result[:3, i] = (
                    e * math.cos(angle)
                    + np.cross(axis, e) * math.sin(angle)
                    + axis * (axis @ e) * (1 - math.cos(angle))
                )
    return result


def transform(element: etree._Element | None) -> Array:
    result = np.eye(4)
    for part in element if element is not None else ():
        result = result @ step(part)
    return result


def rigid(matrix: Array) -> Array:
    """Without a scale, which is uniform in what is tested here."""
    result = matrix.copy()
    result[:3, :3] /= np.cbrt(np.linalg.det(matrix[:3, :3]))
    return result


def visuals(root: etree._Element) -> list[tuple[str, Array]]:
    """Where every geometry is shown: url and transform, through parents and instances."""
    ids = {e.get("id"): e for e in root.iter(etree.Element) if e.get("id")}
    found: list[tuple[str, Array]] = []

    def walk(node: etree._Element, outer: Array) -> None:
        place = outer @ transform(node)
        for part in node:
            if name_of(part) == "instance_geometry":
                found.append((part.get("url", ""), place))
            elif name_of(part) == "node":
                walk(part, place)
            elif name_of(part) == "instance_node":
                walk(ids[part.get("url", "")[1:]], place)

    for scene in root.iter(etree.Element):
        if name_of(scene) == "visual_scene":
            for node in scene:
                if name_of(node) == "node":
                    walk(node, np.eye(4))
    return found


class Reader:
    def __init__(self, data: bytes) -> None:
        root = etree.fromstring(data)
        self.ids = {e.get("id"): e for e in root.iter(etree.Element) if e.get("id")}
        url = (child(root, "scene", "instance_physics_scene")).get("url")  # type: ignore[union-attr]
        scene = self.ids[url[1:]]
        gravity = child(scene, "technique_common", "gravity")
        self.scene = Scene(np.zeros(3) if gravity is None else np.array(floats(gravity)))
        self.places: dict[str, Array] = {}
        self._place_nodes(root)
        for instance in scene:
            if name_of(instance) == "instance_physics_model":
                self._model(instance)

    def _place_nodes(self, root: etree._Element) -> None:
        def walk(node: etree._Element, outer: Array) -> None:
            place = outer @ transform(node)
            self.places.setdefault(node.get("id", ""), place)
            for part in node:
                if name_of(part) == "node":
                    walk(part, place)
                elif name_of(part) == "instance_node":
                    walk(self.ids[part.get("url", "")[1:]], place)

        for scene in root.iter(etree.Element):
            if name_of(scene) == "visual_scene":
                for node in scene:
                    if name_of(node) == "node":
                        walk(node, np.eye(4))

    def _model(self, instance: etree._Element) -> None:
        model = self.ids[instance.get("url", "")[1:]]
        own: dict[str, int] = {}
        frames: dict[int, Array] = {}
        for user in instance:
            if name_of(user) == "instance_rigid_body":
                body = next(c for c in model if c.get("sid") == user.get("body"))
                own[user.get("body", "")] = len(self.scene.bodies)
                frame = rigid(self.places[user.get("target", "")[1:]])
                frames[len(self.scene.bodies)] = frame
                self.scene.bodies.append(self._body(user, body, frame))
        for user in instance:
            if name_of(user) == "instance_rigid_constraint":
                element = next(c for c in model if c.get("sid") == user.get("constraint"))
                self._constraint(element, own, frames)
        for inner in model:
            if name_of(inner) == "instance_physics_model":
                self._model(inner)

    def _body(self, user: etree._Element, body: etree._Element, frame: Array) -> Body:
        def value(name: str) -> etree._Element | None:
            given = child(user, "technique_common", name)
            return child(body, "technique_common", name) if given is None else given

        holder = child(user, "technique_common")
        if child(holder, "shape") is None:
            holder = child(body, "technique_common")
        shapes, weights = [], []
        for element in holder if holder is not None else ():
            if name_of(element) == "shape":
                shape, volume = self._shape(element)
                mass, density = child(element, "mass"), child(element, "density")
                weight = volume * (1.0 if density is None else floats(density)[0])
                weights.append(weight if mass is None else floats(mass)[0])
                shapes.append(shape)
        dynamic, mass = value("dynamic"), value("mass")
        moves = dynamic is None or (dynamic.text or "true").strip() in ("true", "1")
        moves = moves and all(shape.kind != "plane" for shape in shapes)
        total = sum(weights) if mass is None else floats(mass)[0]
        mass_frame = value("mass_frame")
        if mass_frame is not None:
            center = transform(mass_frame)[:3, 3]
        elif sum(weights):
            parts = [w * s.pose[:3, 3] for w, s in zip(weights, shapes, strict=True)]
            center = np.array(sum(parts)) / sum(weights)
        else:
            center = np.zeros(3)
        for shape in shapes:
            shape.pose = frame @ shape.pose
        velocities = []
        for name in ("velocity", "angular_velocity"):
            found = child(user, "technique_common", name)
            velocities.append(np.array((floats(found) if found is not None else None) or [0.0] * 3))
        return Body(
            moves,
            total,
            (frame @ [*center, 1.0])[:3],
            shapes,
            velocities[0],
            np.radians(velocities[1]),
        )

    def _shape(self, element: etree._Element) -> tuple[Shape, float]:
        for geometry in element:
            values = {name_of(c): floats(c) for c in geometry if not len(c)}
            match name_of(geometry):
                case "box":
                    sizes = values["half_extents"]
                    volume = 8 * math.prod(sizes)
                case "sphere":
                    sizes = values["radius"]
                    volume = 4 / 3 * math.pi * sizes[0] ** 3
                case "cylinder":
                    sizes = [values["radius"][0], values["height"][0]]
                    volume = math.pi * sizes[0] ** 2 * sizes[1]
                case "capsule":
                    sizes = [values["radius"][0], values["height"][0]]
                    volume = math.pi * sizes[0] ** 2 * (sizes[1] + 4 / 3 * sizes[0])
                case "plane":
                    a, b, c, d = values["equation"]
                    length = math.hypot(a, b, c)
                    sizes = [a / length, b / length, c / length, -d / length]
                    volume = 0.0
                case _:
                    continue
            return Shape(name_of(geometry), np.array(sizes), transform(element)), volume
        raise AssertionError("a shape without a primitive is not tested here")

    def _constraint(
        self, element: etree._Element, own: dict[str, int], frames: dict[int, Array]
    ) -> None:
        bodies: list[int | None] = []
        places = []
        for name in ("ref_attachment", "attachment"):
            attachment = child(element, name)
            assert attachment is not None
            reference = attachment.get("rigid_body", "").rpartition("/")[2]
            index = own[reference] if reference else None
            bodies.append(index)
            frame = np.eye(4) if index is None else frames[index]
            places.append(frame @ transform(attachment))
        low, high = [], []
        for kind, turn in (("linear", 1.0), ("swing_cone_and_twist", math.pi / 180)):
            for end, values in (("min", low), ("max", high)):
                found = child(element, "technique_common", "limits", kind, end)
                numbers = (floats(found) if found is not None else None) or [0.0] * 3
                values.extend(number * turn for number in numbers)
        self.scene.constraints.append(
            Constraint(bodies[0], bodies[1], (places[0], places[1]), low, high)
        )


def read(data: bytes) -> Scene:
    return Reader(data).scene
