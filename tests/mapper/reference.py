"""A slow, obvious reading of documents, as an oracle: 4x4 matrices and nothing clever.

It shares no code with the package: elements are searched for each time they are needed, transforms
are matrices that are multiplied, and a body is a dictionary.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from lxml import etree
from numpy.typing import NDArray

NS = {"c": "http://www.collada.org/2008/03/COLLADASchema"}
Matrix = NDArray[np.float64]


def local(element: etree._Element) -> str:
    return etree.QName(element).localname


def numbers(element: etree._Element) -> list[float]:
    return [float(word) for word in (element.text or "").split()]


def step_matrix(element: etree._Element) -> Matrix:
    values = numbers(element)
    made = np.eye(4)
    match local(element):
        case "translate":
            made[:3, 3] = values
        case "rotate":
            x, y, z = np.array(values[:3]) / np.linalg.norm(values[:3])
            c, s = math.cos(math.radians(values[3])), math.sin(math.radians(values[3]))
            cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
            axis = np.array([x, y, z])
            made[:3, :3] = c * np.eye(3) + s * cross + (1 - c) * np.outer(axis, axis)
        case "matrix":
            made = np.array(values).reshape(4, 4)
        case "lookat":
            eye, towards, up = np.array(values).reshape(3, 3)
            back = (eye - towards) / np.linalg.norm(eye - towards)
            right = np.cross(up, back) / np.linalg.norm(np.cross(up, back))
            made[:3, :4] = np.column_stack([right, np.cross(back, right), back, eye])
        case "scale":
            made = np.diag([*values, 1.0])
    return made


def transform(element: etree._Element) -> Matrix:
    made = np.eye(4)
    for child in element:
        if local(child) in ("translate", "rotate", "matrix", "scale", "lookat"):
            made = made @ step_matrix(child)
    return made


class Reference:
    """Reads the bodies and constraints of the scenes in effect."""

    def __init__(self, data: bytes, others: dict[str, bytes] | None = None) -> None:
        self.root = etree.fromstring(data)
        self.others = {name: etree.fromstring(each) for name, each in (others or {}).items()}

    def find(self, reference: str, home: etree._Element) -> tuple[etree._Element, etree._Element]:
        file, _, name = reference.partition("#")
        root = self.others[file] if file else home
        (found,) = root.xpath("//*[@id=$name]", name=name)
        return found, root

    def holder(self, node: etree._Element) -> etree._Element | None:
        """The node around a node, or the first one that instances it."""
        parent = node.getparent()
        assert parent is not None
        if local(parent) == "node":
            return parent
        if local(parent) == "library_nodes":
            for root in (self.root, *self.others.values()):
                for instance in root.iter("{*}instance_node"):
                    if self.find(instance.get("url"), root)[0] is node:
                        return instance.getparent()
        return None

    def node_matrix(self, node: etree._Element) -> Matrix:
        holder = self.holder(node)
        return transform(node) if holder is None else self.node_matrix(holder) @ transform(node)

    def outer_matrix(self, node: etree._Element, parents: list[etree._Element]) -> Matrix:
        """The parents of a model and of those around it; a node in one has it already."""
        outer = np.eye(4)
        for parent in reversed(parents):
            above: etree._Element | None = node
            while above is not None and above is not parent:
                above = self.holder(above)
            if above is parent:
                break
            outer = self.node_matrix(parent) @ outer
        return outer

    def bodies(self) -> list[dict[str, Any]]:
        found: list[dict[str, Any]] = []
        for instance in self.root.findall("c:scene/c:instance_physics_scene", NS):
            scene, home = self.find(instance.get("url"), self.root)
            for model in scene.findall("c:instance_physics_model", NS):
                self._model(model, home, [], found)
        return found

    def _model(
        self, instance: etree._Element, home: etree._Element, parents: list[etree._Element],
        found: list[Any],
    ) -> None:  # fmt: skip
        model, model_home = self.find(instance.get("url"), home)
        if instance.get("parent"):
            parents = [*parents, self.find(instance.get("parent"), home)[0]]
        for each in instance.findall("c:instance_rigid_body", NS):
            (body,) = [
                body
                for body in model.findall("c:rigid_body", NS)
                if body.get("sid") == each.get("body")
            ]
            node = self.find(each.get("target"), home)[0]
            where = self.outer_matrix(node, parents) @ self.node_matrix(node)
            found.append(self._body(body, each, where, model_home))
        for inner in model.findall("c:instance_physics_model", NS):
            self._model(inner, model_home, parents, found)

    def _solid(self, shape: etree._Element, home: etree._Element) -> tuple[float, Matrix]:
        """Volume and centre of a shape, before its transform; meshes are boxes along the axes."""
        size: dict[str, list[float]] = {
            name: numbers(found)
            for name in ("radius", "height", "half_extents")
            if (found := shape.find(f"*/c:{name}", NS)) is not None
        }
        middle = np.zeros(3)
        for kind in ("sphere", "box", "capsule", "cylinder", "plane"):
            if shape.find(f"c:{kind}", NS) is None:
                continue
            radius = size.get("radius", [0.0])
            tube = math.pi * radius[0] * radius[-1] * size.get("height", [0.0])[0]
            ends = 4 / 3 * math.pi * math.prod(radius)
            return {
                "sphere": 4 / 3 * math.pi * radius[0] ** 3,
                "box": 8 * math.prod(size.get("half_extents", [0.0])),
                "capsule": tube + ends,
                "cylinder": tube,
                "plane": 0.0,
            }[kind], middle
        instance = shape.find("c:instance_geometry", NS)
        assert instance is not None
        geometry, root = self.find(instance.get("url"), home)
        hull = geometry.find("c:convex_mesh[@convex_hull_of]", NS)
        if hull is not None:
            geometry, root = self.find(hull.get("convex_hull_of"), root)
        array, accessor = geometry.find(".//c:float_array", NS), geometry.find(".//c:accessor", NS)
        first, stride = int(accessor.get("offset", "0")), int(accessor.get("stride", "1"))
        words = numbers(array)[first:]
        points = np.array([words[at : at + 3] for at in range(0, len(words), stride)])
        low, high = points.min(axis=0), points.max(axis=0)
        return float(np.prod(high - low)), (low + high) / 2

    def _body(
        self, body: etree._Element, instance: etree._Element, where: Matrix, home: etree._Element
    ) -> dict[str, Any]:
        common = body.find("c:technique_common", NS)
        override = instance.find("c:technique_common", NS)
        assert common is not None
        assert override is not None

        def value(name: str) -> list[float] | None:
            for holder in (override, common):
                element = holder.find(f"c:{name}", NS)
                if element is not None:
                    return numbers(element)
            return None

        shapes = override.findall("c:shape", NS) or common.findall("c:shape", NS)
        masses, centers = [], []
        for shape in shapes:
            mass, density = shape.find("c:mass", NS), shape.find("c:density", NS)
            volume, center = self._solid(shape, home)
            dense = 1.0 if density is None else numbers(density)[0]
            masses.append(dense * volume if mass is None else numbers(mass)[0])
            centers.append(transform(shape) @ np.append(center, 1.0))
        total = value("mass")
        frame = override.find("c:mass_frame", NS)
        if frame is None:
            frame = common.find("c:mass_frame", NS)
        weights = masses if any(masses) else None
        center = np.average(centers, axis=0, weights=weights)
        if frame is not None:
            center = transform(frame)[:, 3]
        dynamic = override.find("c:dynamic", NS)
        if dynamic is None:
            dynamic = common.find("c:dynamic", NS)
        velocity = override.find("c:velocity", NS)
        turning = override.find("c:angular_velocity", NS)
        return {
            "mass": sum(masses) if total is None else total[0],
            "position": (where @ center)[:3],
            "members": [(where @ each)[:3] for each in centers],
            "rotation": where[:3, :3],
            "infinite": any(shape.find("c:plane", NS) is not None for shape in shapes),
            "fixed": dynamic is not None and dynamic.text == "false",
            "velocity": [0.0] * 3 if velocity is None else numbers(velocity),
            "turning": [0.0] * 3
            if turning is None
            else [math.radians(each) for each in numbers(turning)],
        }
