"""What Bullet's converter makes of a document that it loaded and saves again.

It edits the document: bodies that it loaded get the transform of their node and their velocities
written anew, constraints are written anew, every number comes out with six significant digits, and
what it does not know stays as it was, the pe profile too, which is then older than the rest. New
bodies go to a model of their own. The result is not always schema-valid, as Bullet's is not.

    text, _ = for_bullet(tree)                       # or any file that Bullet can load
    saved = rewrite(text, {"Body1": State(position=(0, 1, 0))}, [NewBody("BulletUnnamed-0", "box")])
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from lxml import etree
from tests.conform.bullet import bullet_reader
from tests.conform.bullet.bullet_reader import NS

Vector = tuple[float, float, float]

_NUMBERS = frozenset(
    ("translate", "rotate", "scale", "matrix", "mass", "inertia", "half_extents", "radius",
     "height", "equation", "density", "gravity", "time_step", "min", "max", "velocity",
     "angular_velocity", "dynamic_friction", "static_friction", "restitution", "stiffness",
     "damping", "target_value", "float_array")
)  # fmt: skip


@dataclass(frozen=True)
class State:
    """Where a body is now; what is None is as it was loaded. Angles in degrees, speeds in rad/s."""

    position: Vector | None = None
    rotation: tuple[float, float, float, float] | None = None
    velocity: Vector | None = None
    angular_velocity: Vector | None = None


@dataclass(frozen=True)
class NewBody:
    """A body that the program made: box, sphere, cylinder, capsule, plane or compound."""

    name: str
    kind: str
    sizes: tuple[float, ...] = (1.0, 1.0, 1.0)
    """As Bullet has them: half extents, radius, radius and half height, normal and constant."""
    state: State = State()
    mass: float = 1.0
    friction: float = 0.5
    restitution: float = 0.0
    parts: tuple[tuple[str, tuple[float, ...], Vector], ...] = ()
    """Of a compound: kind, sizes and place of each part."""


def rewrite(
    data: bytes, states: Mapping[str, State] | None = None, new: Sequence[NewBody] = ()
) -> bytes:
    """The document as Bullet saves it, with bodies (by sid) in new states and with new bodies."""
    world = bullet_reader.read(data)
    root = etree.fromstring(data)
    by_sid = {body.sid: body for body in world.bodies}
    ids = {element.get("id"): element for element in root.iter(etree.Element)}
    for user in root.iter(NS + "instance_rigid_body"):
        body = by_sid.get(user.get("body", ""))
        if body is None:
            continue
        state = (states or {}).get(body.sid, State())
        _move(ids[user.get("target", "")[1:]], body, state)
        _speed(user, body, state)
    constraints = {c.get("sid"): c for c in root.iter(NS + "rigid_constraint")}
    for user in root.iter(NS + "instance_rigid_constraint"):
        _bind(constraints[user.get("constraint")])
        _close(constraints[user.get("constraint")])
    if new:
        _add(root, new)
    for element in root.iter(NS + "*"):
        if etree.QName(element).localname in _NUMBERS and not _is_foreign(element):
            element.text = " ".join(_six(float(word)) for word in (element.text or "").split())
    return _without_prefixes(etree.tostring(root))


def _without_prefixes(data: bytes) -> bytes:
    """Its DOM drops the declarations of prefixes at the root, and keeps what has the prefixes."""
    end = data.index(b">", data.index(b"<COLLADA"))
    return re.sub(rb' xmlns:[^=]+="[^"]*"', b"", data[:end]) + data[end:]


def _six(value: float) -> str:
    return f"{value:.6g}".replace("inf", "INF").replace("nan", "NaN")


def _text(*values: float) -> str:
    return " ".join(_six(value) for value in values)


def _is_foreign(element: etree._Element) -> bool:
    return any(True for _ in element.iterancestors(NS + "technique"))


def axis_angle(matrix: bullet_reader.Array) -> tuple[float, float, float, float]:
    """Axis and angle in degrees; of no rotation, Bullet writes the x axis."""
    r = matrix[:3, :3]
    _, vectors = np.linalg.eigh(r + r.T)
    axis = vectors[:, -1]
    turned = np.array([r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]])
    if turned @ axis < 0:
        axis = -axis
    angle = math.degrees(math.atan2(float(np.linalg.norm(turned)), float(np.trace(r)) - 1))
    if angle == 0.0:
        return 1.0, 0.0, 0.0, 0.0
    return float(axis[0]), float(axis[1]), float(axis[2]), angle


def _move(node: etree._Element, body: bullet_reader.BulletBody, state: State) -> None:
    position = body.pose[:3, 3] if state.position is None else state.position
    rotation = axis_angle(body.pose) if state.rotation is None else state.rotation
    steps = [
        child
        for child in node
        if child.tag in (NS + "translate", NS + "rotate", NS + "matrix")
    ]  # fmt: skip
    for step in steps:
        node.remove(step)
    # A scale stays; the new steps come after it.
    scales = node.findall(NS + "scale") or node.findall(NS + "asset")
    place = node.index(scales[-1]) + 1 if scales else 0
    for offset, (name, values) in enumerate((("translate", position), ("rotate", rotation))):
        element = etree.Element(NS + name)
        element.text = _text(*values)
        node.insert(place + offset, element)


def _speed(user: etree._Element, body: bullet_reader.BulletBody, state: State) -> None:
    common = user.find(NS + "technique_common")
    if common is None:
        common = etree.SubElement(user, NS + "technique_common")
    for offset, name in enumerate(("angular_velocity", "velocity")):
        old = common.find(NS + name)
        if old is not None:
            common.remove(old)
        now = getattr(state, name)
        element = etree.Element(NS + name)
        element.text = _text(*(getattr(body, name) if now is None else now))
        common.insert(offset, element)


def _bind(constraint: etree._Element) -> None:
    """Everything that Bullet's joint does not have is gone: enabled, free axes as 1 and 0."""
    common = constraint.find(NS + "technique_common")
    assert common is not None
    for name, value in (("interpenetrate", "false"), ("enabled", "true")):
        element = common.find(NS + name)
        if element is None:
            element = etree.Element(NS + name)
            common.insert(0, element)
        element.text = value
    for kind, threshold in (("swing_cone_and_twist", 180.0), ("linear", 999999.0)):
        low = common.find(f"{NS}limits/{NS}{kind}/{NS}min")
        high = common.find(f"{NS}limits/{NS}{kind}/{NS}max")
        assert low is not None
        assert high is not None
        pairs = [
            (1.0, 0.0) if a < -threshold or b > threshold else (a, b)
            for a, b in zip(
                map(float, (low.text or "").split()), map(float, (high.text or "").split()),
                strict=True,
            )
        ]  # fmt: skip
        low.text, high.text = (_text(*(pair[i] for pair in pairs)) for i in range(2))
    for name in ("ref_attachment", "attachment"):
        attachment = constraint.find(NS + name)
        if attachment is not None:
            _attach(attachment)


def _close(constraint: etree._Element) -> None:
    """The world is written as the body itself, with the frame that the body has."""
    first, second = constraint.find(NS + "ref_attachment"), constraint.find(NS + "attachment")
    assert first is not None
    assert second is not None
    if not second.get("rigid_body"):
        second.set("rigid_body", first.get("rigid_body", ""))
        second[:] = [etree.fromstring(etree.tostring(child)) for child in first]


def _attach(attachment: etree._Element) -> None:
    frame = np.eye(4)
    frame[:3, :] = bullet_reader.transform(attachment, matrices=False)[:3, :]
    for child in list(attachment):
        if child.tag in (NS + "translate", NS + "rotate"):
            attachment.remove(child)
    for offset, (name, values) in enumerate(
        (("translate", frame[:3, 3]), ("rotate", axis_angle(frame)))
    ):
        element = etree.Element(NS + name)
        element.text = _text(*values)
        attachment.insert(offset, element)


# -- new bodies -------------------------------------------------------------------------------


def _add(root: etree._Element, bodies: Sequence[NewBody]) -> None:
    models = root.find(NS + "library_physics_models")
    scene = root.find(f"{NS}library_physics_scenes/{NS}physics_scene")
    visual = root.find(f"{NS}library_visual_scenes/{NS}visual_scene")
    assert models is not None
    assert scene is not None
    assert visual is not None
    name = "Bullet-PhysicsModel"
    model = etree.SubElement(models, NS + "physics_model", id=name, name=name)
    instance = etree.Element(NS + "instance_physics_model", url="#" + name)
    common = scene.find(NS + "technique_common")
    assert common is not None
    common.addprevious(instance)
    materials = etree.Element(NS + "library_physics_materials", name="Bullet-PhysicsMaterials")
    models.addprevious(materials)
    for body in bodies:
        model.append(_rigid_body(body))
        materials.append(_material(body))
        names = {"body": f"{body.name}-RigidBody", "target": f"#{body.name}"}
        user = etree.SubElement(instance, NS + "instance_rigid_body", names)
        speeds = etree.SubElement(user, NS + "technique_common")
        for kind in ("angular_velocity", "velocity"):
            found = getattr(body.state, kind)
            etree.SubElement(speeds, NS + kind).text = _text(*(found or (0.0, 0.0, 0.0)))
        node = etree.SubElement(visual, NS + "node", id=body.name, name=body.name)
        position = body.state.position or (0.0, 0.0, 0.0)
        etree.SubElement(node, NS + "translate").text = _text(*position)
        rotation = body.state.rotation or (1.0, 0.0, 0.0, 0.0)
        etree.SubElement(node, NS + "rotate").text = _text(*rotation)


def _material(body: NewBody) -> etree._Element:
    name = f"{body.name}-PhysicsMaterial"
    material = etree.Element(NS + "physics_material", id=name, name=name)
    common = etree.SubElement(material, NS + "technique_common")
    etree.SubElement(common, NS + "dynamic_friction").text = _six(body.friction)
    etree.SubElement(common, NS + "restitution").text = _six(body.restitution)
    etree.SubElement(common, NS + "static_friction").text = _six(body.friction)
    return material


def _rigid_body(body: NewBody) -> etree._Element:
    name = f"{body.name}-RigidBody"
    element = etree.Element(NS + "rigid_body", sid=name, name=name)
    common = etree.SubElement(element, NS + "technique_common")
    moves = body.mass > 0 and body.kind != "plane"
    etree.SubElement(common, NS + "dynamic").text = "true" if moves else "false"
    etree.SubElement(common, NS + "mass").text = _six(body.mass if moves else 0.0)
    etree.SubElement(common, NS + "inertia").text = "1 1 1" if moves else "0 0 0"
    url = f"#{body.name}-PhysicsMaterial"
    etree.SubElement(common, NS + "instance_physics_material", url=url)
    # A capsule and a compound leave their shape empty; the parts come after it.
    shape = etree.SubElement(common, NS + "shape")
    _geometry(shape, body.kind, body.sizes)
    for kind, sizes, place in body.parts:
        part = etree.SubElement(common, NS + "shape")
        _geometry(part, kind, sizes)
        etree.SubElement(part, NS + "translate").text = _text(*place)
        etree.SubElement(part, NS + "rotate").text = "1 0 0 0"
    return element


def _geometry(shape: etree._Element, kind: str, sizes: tuple[float, ...]) -> None:
    texts = {
        "box": {"half_extents": sizes[:3]},
        "sphere": {"radius": sizes[:1]},
        # The half height that Bullet has goes out as the height.
        "cylinder": {"height": sizes[1:2], "radius": (sizes[0], sizes[0])},
        "plane": {"equation": sizes[:4]},
    }
    if kind in texts:
        geometry = etree.SubElement(shape, NS + kind)
        for name, values in texts[kind].items():
            etree.SubElement(geometry, NS + name).text = _text(*values)
