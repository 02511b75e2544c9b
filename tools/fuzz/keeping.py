"""Values of properties as text, so that a failure that was found once is run for ever after."""

from __future__ import annotations

import base64
import hashlib
import json
from dataclasses import asdict, fields, is_dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from colladaphy.world import Body, BodyColumns, EngineState, Kind, World
from colladaphy.world.materials import VALUES

__all__ = ["copied", "keep", "plain", "read", "value_of"]

_JOINT = ("frame1", "frame2", "linear_min", "linear_max", "angular_min", "angular_max",
          "linear_spring", "angular_spring", "motor", "enabled", "interpenetrate", "uid", "sid",
          "name")  # fmt: skip


def keep(folder: Path, name: str, values: tuple[Any, ...], why: str) -> Path:
    """Write the values that a property does not hold of to a file; returns it."""
    content = {"property": name, "why": why, "values": [plain(value) for value in values]}
    text = json.dumps(content, indent=1, ensure_ascii=False) + "\n"
    digest = hashlib.sha256(json.dumps(content["values"]).encode()).hexdigest()[:12]
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{name}-{digest}.json"
    part = path.with_suffix(".part")  # whole or not there: the process may end at any moment
    part.write_text(text, "utf-8", errors="surrogatepass")
    part.replace(path)
    return path


def copied(values: tuple[Any, ...]) -> tuple[Any, ...]:
    """The same values, whatever happens to these."""
    return tuple(value_of(json.loads(json.dumps(plain(value)))) for value in values)


def read(path: Path) -> tuple[str, tuple[Any, ...]]:
    """The name of the property, and the values."""
    content = json.loads(path.read_text("utf-8", errors="surrogatepass"))
    return content["property"], tuple(value_of(value) for value in content["values"])


def plain(value: Any) -> Any:
    """A value as JSON holds it; floats read back to the same bits."""
    match value:
        case None | bool() | int() | float() | str():
            return value
        case bytes():
            try:
                text = value.decode("utf-8")
            except UnicodeDecodeError:
                return {"base64": base64.b64encode(value).decode()}
            return {"text": text}
        case list():
            return [plain(each) for each in value]
        case tuple():
            return {"tuple": [plain(each) for each in value]}
        case dict():
            return {"dict": {key: plain(each) for key, each in value.items()}}
        case frozenset():
            return {"set": sorted(value)}
        case World():
            return {"world": _world(value)}
        case _ if is_dataclass(value) and not isinstance(value, type):
            kind = type(value)
            content = {part.name: plain(getattr(value, part.name)) for part in fields(value)}
            return {f"{kind.__module__}:{kind.__qualname__}": content}
        case np.generic() | np.ndarray():
            return value.tolist()
    raise TypeError(f"{type(value).__name__} cannot be kept")


def value_of(kept: Any) -> Any:
    """The value that was made plain."""
    if isinstance(kept, list):
        return [value_of(each) for each in kept]
    if not isinstance(kept, dict):
        return kept
    ((kind, content),) = kept.items()
    match kind:
        case "base64":
            return base64.b64decode(content)
        case "text":
            return content.encode("utf-8")
        case "tuple":
            return tuple(value_of(each) for each in content)
        case "dict":
            return {key: value_of(each) for key, each in content.items()}
        case "set":
            return frozenset(content)
        case "world":
            return _world_of(content)
    module, _, name = kind.partition(":")
    if name:  # a dataclass
        made = {key: value_of(each) for key, each in content.items()}
        return getattr(import_module(module), name)(**made)
    raise ValueError(f"nothing is kept as {kind!r}")


def _world(world: World) -> dict[str, Any]:
    state = world.engine_state
    materials = {material.id: asdict(material) for material in world.materials}
    return {
        "gravity": plain(world.gravity),
        "unit": [world.unit_name, world.unit_meter],
        "up_axis": world.up_axis,
        "time_step": world.time_step,
        "name": world.name,
        "time": world.time,
        "step_count": world.step_count,
        "next": [world.next_body_sid, world.next_joint_sid],
        "engine_state": state
        and [state.engine, state.version, base64.b64encode(state.data).decode()],
        "materials": list(materials.values()),
        "pairs": [asdict(pair) for pair in world.pair_overrides],
        "meshes": [
            [mesh.id, mesh.vertices.tolist(), mesh.faces.tolist(), mesh.convex]
            for mesh in world.meshes.values()
        ],
        "bodies": [_body(body, False) for body in world.bodies],
        "joints": [
            {
                "bodies": [body and body.sid for body in (joint.body1, joint.body2)],
                **{name: _numbers(getattr(joint, name)) for name in _JOINT},
            }
            for joint in world.joints
        ],
    }


def _numbers(value: Any) -> Any:
    return [_numbers(each) for each in value] if isinstance(value, tuple) else plain(value)


def _body(body: Body, inside: bool) -> dict[str, Any]:
    made = {
        "kind": int(body.kind),
        "sid": body.sid,
        "uid": body.uid,
        "name": body.name,
        "position": plain(body.local_position if inside else body.position),
        "orientation": plain(body.local_orientation if inside else body.orientation),
        "mass": body.mass,
        "inertia": plain(body.inertia),
        "material": None if body.material is None else body.material.id,
        "mesh": body.mesh.id if body.kind is Kind.MESH else None,
        "members": [_body(member, True) for member in body.members],
    }
    if body.kind is not Kind.UNION:
        made["dimensions"], made["hollow"] = plain(body.dimensions), bool(body.hollow)
    if not inside:
        for name in ("fixed", "sleeping", "linear_velocity", "angular_velocity", "force", "torque"):
            made[name] = plain(getattr(body, name))
    return made


def _world_of(kept: dict[str, Any]) -> World:
    world = World(kept["gravity"], unit=tuple(kept["unit"]), up_axis=kept["up_axis"],
                  time_step=kept["time_step"], name=kept["name"])  # fmt: skip
    world.time, world.step_count = kept["time"], kept["step_count"]
    if kept["engine_state"]:
        engine, version, data = kept["engine_state"]
        world.engine_state = EngineState(engine, version, base64.b64decode(data))
    for material in kept["materials"]:
        if material["id"] not in world.materials:
            values = {key: material[key] for key in VALUES}
            world.create_material(material["name"], id=material["id"], **values)
    for pair in kept["pairs"]:
        world.set_pair(pair["first"], pair["second"], pair["restitution"],
                       pair["static_friction"], pair["dynamic_friction"])  # fmt: skip
    for id, vertices, faces, convex in kept["meshes"]:
        world.add_mesh(vertices, np.reshape(faces, (-1, 3)), convex=convex, id=id)
    for body in kept["bodies"]:
        _create(world, body)
    for joint in kept["joints"]:
        first, second = (None if sid is None else world.body(sid) for sid in joint["bodies"])
        world.attach_joint(first, second, **{name: joint[name] for name in _JOINT if name in joint})
    world.next_body_sid, world.next_joint_sid = kept["next"]
    return world


def _create(world: World, kept: dict[str, Any]) -> Body:
    """A body, after its members."""
    if kept["kind"] == Kind.UNION:
        members = [_create(world, member) for member in kept["members"]]
        body = world.create_union(
            kept["uid"], members, position=kept["position"], orientation=kept["orientation"],
            mass=kept["mass"], inertia=kept["inertia"], sid=kept["sid"], name=kept["name"],
            fixed=kept.get("fixed"), linear_velocity=(0, 0, 0), angular_velocity=(0, 0, 0),
            members_are_local=True,
        )  # fmt: skip
    else:
        world.extend(
            BodyColumns(
                kinds=[kept["kind"]], sids=[kept["sid"]], uids=[kept["uid"]],
                names=[kept["name"]], positions=[kept["position"]],
                orientations=[kept["orientation"]], masses=[kept["mass"]],
                inertias=[kept["inertia"]], dimensions=[kept["dimensions"]],
                hollow=[kept["hollow"]], fixed=[kept.get("fixed", False)],
                material_ids=[-1 if kept["material"] is None else kept["material"]],
                mesh_ids=[-1 if kept["mesh"] is None else kept["mesh"]],
            )
        )  # fmt: skip
        body = world.body(kept["sid"])
    for name in ("linear_velocity", "angular_velocity", "force", "torque", "sleeping"):
        if name in kept:
            setattr(body, name, kept[name])
    return body
