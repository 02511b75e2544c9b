"""A World as a document: COLLADA 1.5, valid and deterministic (thesis 5.4)."""

from __future__ import annotations

import base64
import hashlib
import logging
import re
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from lxml import etree

from colladaphy.errors import SchemaError
from colladaphy.gate import gate, is_valid_text
from colladaphy.mapper.body_texts import (
    ShapeTexts,
    identity,
    inertia_text,
    instance_texts,
    kept_name,
    node_texts,
)
from colladaphy.mapper.joint_texts import joint_texts
from colladaphy.mapper.markup import COLLADA, PE, attribute, escape, pe_technique
from colladaphy.mapper.material_texts import material_text, pair_texts
from colladaphy.mapper.mesh_texts import mesh_text
from colladaphy.mapper.numbers import float_text, floats_text, same_bits
from colladaphy.mapper.options import WriteOptions
from colladaphy.mapper.union_texts import UnionTexts, mass_frame
from colladaphy.world.columns import BODY_FIELDS
from colladaphy.world.kinds import Kind
from colladaphy_schema.codec import paused_collector

if TYPE_CHECKING:
    from colladaphy.findings import Finding
    from colladaphy.world import Mesh, World

__all__ = ["store", "store_text"]

_log = logging.getLogger(__name__)

_NMTOKEN = re.compile(r"[A-Za-z0-9._:-]+\Z")
_BOOLEANS = ("false", "true")
_ID = re.compile(' id="([^"]*)"')


def store(world: World, options: WriteOptions | None = None) -> bytes:
    """The World as a schema-valid document in UTF-8; SchemaError if it should not be one."""
    with paused_collector():
        text = store_text(world, options or WriteOptions())
        data = text.encode()
        faults = _faults(text, data)
    if faults:
        raise SchemaError(faults)
    _log.info("stored %d bodies, %d joints in %d bytes", len(world.bodies), len(world.joints),
              len(data))  # fmt: skip
    return data


def _faults(text: str, data: bytes) -> list[Finding]:
    """What is wrong with a document; the gate is asked where anything is."""
    ids = _ID.findall(text)
    if len(set(ids)) == len(ids) and is_valid_text(data):
        return []
    parser = etree.XMLParser(resolve_entities=False, no_network=True, huge_tree=True)
    return gate(etree.ElementTree(etree.fromstring(data, parser)), fresh=True)


def store_text(world: World, options: WriteOptions) -> str:
    """The text of the document, before it is checked."""
    return _Writer(world, options).text()


class _Writer:
    def __init__(self, world: World, options: WriteOptions) -> None:
        self._world = world
        self._options = options
        self._columns: dict[str, Any] = {
            name: getattr(world, name) for name in ("sids", *BODY_FIELDS)
        }
        self._sids: list[int] = self._columns["sids"].tolist()
        self._models = self._grouped()
        self._tessellated: dict[str, Mesh] = {}

    def _grouped(self) -> dict[str, list[int]]:
        """The rows of each physics model, by its name."""
        group = self._options.group
        if group is None:
            return {"": list(range(len(self._sids)))}
        models: dict[str, list[int]] = {}
        for row, body in enumerate(self._world.bodies):
            models.setdefault(str(group(body)), []).append(row)
        return models or {"": []}

    def text(self) -> str:
        options, world = self._options, self._world
        records = self._bodies()
        moved = self._columns["kinds"] != Kind.PLANE
        instances = instance_texts(self._columns, options, moved)
        nodes = self._nodes(moved)
        model_of = {
            self._sids[row]: number
            for number, rows in enumerate(self._models.values(), 1)
            for row in rows
        }
        joints: dict[int, list[tuple[int, str]]] = {}
        for (sid, text), joint in zip(
            joint_texts(world, options, lambda sid: f"Model{model_of[sid]}/Body{sid}"),
            world.joints,
            strict=True,
        ):
            joints.setdefault(model_of[sid], []).append((joint.sid, text))
        models, effects = [], []
        for number, (name, rows) in enumerate(self._models.items(), 1):
            title = attribute("name", name or None)
            constraints = joints.get(number, [])
            models.append(f'<physics_model id="Model{number}"{title}>')
            models += [records[row] for row in rows]
            models += [text for _, text in constraints]
            models.append("</physics_model>")
            effects.append(f'<instance_physics_model url="#Model{number}">')
            effects += [instances[row] for row in rows]
            effects += [
                f'<instance_rigid_constraint constraint="Joint{sid}"/>' for sid, _ in constraints
            ]
            effects.append("</instance_physics_model>")
        return "\n".join([*self._head(), *self._library("physics_models", models),
                          *self._scene(effects), *self._visual(nodes), "</COLLADA>\n"])  # fmt: skip

    # --- bodies

    def _bodies(self) -> list[str]:
        """The rigid_body of each body (thesis 5.4)."""
        columns, options, world = self._columns, self._options, self._world
        kinds = columns["kinds"]
        planes: dict[int, Sequence[float]] = {}
        for row in np.flatnonzero(kinds == Kind.PLANE).tolist():
            planes[row] = columns["dimensions"][row].tolist()
        is_union = kinds == Kind.UNION
        texts = ShapeTexts(world, columns, options, planes)
        self._tessellated |= texts.tessellated
        shapes = texts.shapes()
        values, profiles = self._values(texts)
        if np.any(is_union):
            unions = UnionTexts(world, options)
            self._tessellated |= unions.tessellated
            for row in np.flatnonzero(is_union).tolist():
                shapes[row], content, mass = unions.shapes(self._sids[row])
                values[row] = self._union_values(row, mass)
                if options.profile != "none":
                    profiles[row] = self._union_profile(row, content)
        names = self._names()
        return [
            f'<rigid_body sid="Body{sid}"{name}><technique_common>'
            f"<dynamic>{_BOOLEANS[not fixed]}</dynamic>{value}{shape}</technique_common>"
            f"{profile}</rigid_body>"
            for sid, name, fixed, value, shape, profile in zip(
                self._sids,
                names,
                columns["fixed"].tolist(),
                values,
                shapes,
                profiles,
                strict=True,
            )
        ]

    def _names(self) -> list[str]:
        names = self._world.names
        if not names:
            return [""] * len(self._sids)
        return [attribute("name", names.get(sid)) for sid in self._sids]

    def _values(self, texts: ShapeTexts) -> tuple[list[str], list[str]]:
        """Body-level values and the pe profile of primitives."""
        columns, names = self._columns, self._world.names
        count = len(self._sids)
        values = [""] * count
        if self._options.redundant:
            values = [
                f"<mass>{float_text(mass)}</mass>"
                f'<instance_physics_material url="#Material{material}"/>'
                for mass, material in zip(
                    columns["masses"].tolist(), columns["material_ids"].tolist(), strict=True
                )
            ]
        for row in np.flatnonzero(texts.says_inertia).tolist():
            mass, found, material = values[row].partition("</mass>")
            frame = mass_frame(columns["inertias"][row])
            values[row] = mass + found + frame + material
        if self._options.profile == "none":
            return values, values[:0] or [""] * count
        uids = columns["uids"].tolist()
        profiles = [f'<technique profile="pe"><pe:body uid="{uid}"/></technique>' for uid in uids]
        special = texts.says_shape | texts.says_mass | texts.says_inertia
        rows = set(np.flatnonzero(special).tolist())
        if names:
            rows |= {row for row, sid in enumerate(self._sids) if kept_name(names.get(sid))}
        if self._options.profile == "full":
            rows = set(range(count))
        for row in sorted(rows):
            profiles[row] = self._profile(row, texts)
        return values, profiles

    def _profile(self, row: int, texts: ShapeTexts) -> str:
        columns = self._columns
        if columns["kinds"][row] == Kind.UNION:
            return ""
        who = identity(
            int(columns["uids"][row]), None, kept_name(self._world.names.get(self._sids[row]))
        )
        content = texts.values(row, bool(columns["fixed"][row]))
        geometry = texts.profile_shape(row, columns["positions"][row].tolist())
        if geometry:
            content += f"<pe:shape>{geometry}</pe:shape>"
        return pe_technique(f"<pe:body{who}>{content}</pe:body>" if content else f"<pe:body{who}/>")

    def _union_values(self, row: int, sum_of_masses: float) -> str:
        """What the common profile says of a whole union."""
        columns = self._columns
        mass = float(columns["masses"][row])
        text = ""
        if self._options.redundant or not same_bits(np.array(mass), np.array(sum_of_masses)):
            text = f"<mass>{float_text(mass)}</mass>"
        text += mass_frame(columns["inertias"][row])
        if self._options.redundant:
            material = self._world.body(self._sids[row]).material
            if material is not None:
                text += f'<instance_physics_material url="#Material{material.id}"/>'
        return text

    def _union_profile(self, row: int, members: str) -> str:
        columns = self._columns
        who = identity(
            int(columns["uids"][row]), None, kept_name(self._world.names.get(self._sids[row]))
        )
        values = ""
        if self._options.profile == "full":
            values = (
                f"<pe:fixed>{_BOOLEANS[bool(columns['fixed'][row])]}</pe:fixed>"
                f"<pe:mass>{float_text(float(columns['masses'][row]))}</pe:mass>"
            )
        values += inertia_text(columns["inertias"][row])
        return pe_technique(f"<pe:body{who}>{values}<pe:union>{members}</pe:union></pe:body>")

    def _nodes(self, moved: Any) -> list[str]:
        columns = self._columns
        positions, orientations = columns["positions"], columns["orientations"]
        if not np.all(moved):
            # A plane's equation is in world coordinates; its node stays at the origin.
            positions, orientations = positions.copy(), orientations.copy()
            positions[~moved] = 0.0
            orientations[~moved] = (1.0, 0.0, 0.0, 0.0)
        return node_texts(columns["sids"], positions, orientations)

    # --- the parts of the document

    def _head(self) -> list[str]:
        world, options = self._world, self._options
        unit = world.unit_name if _NMTOKEN.match(world.unit_name) else "unit"
        title = "" if options.title is None else f"<title>{escape(options.title)}</title>"
        lines = [
            '<?xml version="1.0" encoding="UTF-8"?>',
            f'<COLLADA xmlns="{COLLADA}" xmlns:pe="{PE}" version="1.5.0">',
            "<asset>",
            "<contributor><authoring_tool>colladaphy</authoring_tool></contributor>",
            f"<created>{escape(options.created)}</created>",
            f"<modified>{escape(options.created)}</modified>{title}",
            f'<unit meter="{float_text(world.unit_meter)}" name="{escape(unit)}"/>',
            f"<up_axis>{world.up_axis}</up_axis>",
            "</asset>",
        ]
        lines += self._library("geometries", self._geometries())
        return lines + self._library("physics_materials", self._materials())

    @staticmethod
    def _library(name: str, content: Sequence[str]) -> list[str]:
        """A library; nothing where it would be empty, which is not valid."""
        if not content:
            return []
        return [f"<library_{name}>", *content, f"</library_{name}>"]

    def _used(self, column: str) -> list[int]:
        inner = getattr(self._world.member_columns, column)
        ids = np.union1d(self._columns[column], inner).tolist()
        return [id for id in ids if id >= 0]

    def _geometries(self) -> list[str]:
        meshes = self._world.meshes
        stored = [mesh_text(meshes[id], f"Mesh{id}") for id in self._used("mesh_ids")]
        return stored + [mesh_text(mesh, name) for name, mesh in self._tessellated.items()]

    def _written_materials(self) -> list[int]:
        if self._options.materials == "all":
            return [material.id for material in self._world.materials]
        return self._used("material_ids")

    def _materials(self) -> list[str]:
        materials = self._world.materials
        return [material_text(materials[id], self._options) for id in self._written_materials()]

    def _scene(self, effects: Iterable[str]) -> list[str]:
        world = self._world
        values = f"<gravity>{floats_text(world.gravity.tolist())}</gravity>"
        if world.time_step is not None:
            values += f"<time_step>{float_text(float(world.time_step))}</time_step>"
        lines = [f'<physics_scene id="Scene1"{attribute("name", world.name)}>', *effects]
        lines.append(f"<technique_common>{values}</technique_common>")
        if self._options.profile != "none":
            lines.append(pe_technique(self._world_profile()))
        lines.append("</physics_scene>")
        return self._library("physics_scenes", lines)

    def _world_profile(self) -> str:
        world = self._world
        inner_sids = world.member_columns.sids
        sids = [*self._sids[-1:], *inner_sids[-1:].tolist()]
        joint_sids = world.joints.columns()["sids"][-1:].tolist()
        next_body, next_joint = max(sids, default=0) + 1, max(joint_sids, default=0) + 1
        who = (
            attribute("name", kept_name(world.name))
            + attribute("unit", None if _NMTOKEN.match(world.unit_name) else world.unit_name)
            + attribute("time", None if world.time.hex() == "0x0.0p+0" else float_text(world.time))
            + attribute("step_count", world.step_count or None)
            + attribute(
                "next_body_sid", None if world.next_body_sid == next_body else world.next_body_sid
            )
            + attribute(
                "next_joint_sid",
                None if world.next_joint_sid == next_joint else world.next_joint_sid,
            )
        )
        content = ""
        if self._options.profile == "full":
            content = f"<pe:gravity>{floats_text(world.gravity.tolist())}</pe:gravity>"
            if world.time_step is not None:
                content += f"<pe:time_step>{float_text(float(world.time_step))}</pe:time_step>"
        content += pair_texts(world.pair_overrides, set(self._written_materials()))
        state = world.engine_state
        if state is not None:
            content += (
                f"<pe:engine_state{attribute('engine', state.engine)}"
                f"{attribute('version', state.version)}"
                f' sha256="{hashlib.sha256(state.data).hexdigest()}">'
                f"{base64.b64encode(state.data).decode()}</pe:engine_state>"
            )
        return f"<pe:world{who}>{content}</pe:world>" if content else f"<pe:world{who}/>"

    def _visual(self, nodes: Sequence[str]) -> list[str]:
        """The nodes, and the scene that puts everything into effect."""
        if not nodes:
            return ["<scene>", '<instance_physics_scene url="#Scene1"/>', "</scene>"]
        visual = ['<visual_scene id="VisualScene1">', *nodes, "</visual_scene>"]
        return [
            *self._library("visual_scenes", visual),
            "<scene>",
            '<instance_physics_scene url="#Scene1"/>',
            '<instance_visual_scene url="#VisualScene1"/>',
            "</scene>",
        ]
