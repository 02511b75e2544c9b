"""Bodies as text, by column: rigid_body, its instance and its node, one line each.

What every body of a World has is turned into text a column at a time; only unions are written
one by one (`union_texts`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.mapper.markup import attribute, pe_technique, token
from colladaphy.mapper.numbers import (
    column_texts,
    degrees_exactly,
    float_text,
    floats_text,
    row_texts,
    same_bits,
)
from colladaphy.mapper.shape_texts import (
    geometry_texts,
    halves_are_exact,
    profile_geometry,
    settling_steps,
)
from colladaphy.mapper.tessellation import extent, tessellate
from colladaphy.world import rotations
from colladaphy.world.creation import mass_and_inertia
from colladaphy.world.kinds import Kind
from colladaphy.world.shapes import solid_volume

if TYPE_CHECKING:
    from colladaphy.mapper.options import WriteOptions
    from colladaphy.world import Mesh, World

__all__ = ["ShapeTexts", "identity", "instance_texts", "node_texts", "rotation_texts"]

Array = NDArray[Any]

_NO_TURN = np.array([1.0, 0.0, 0.0, 0.0])


def identity(uid: int | None, sid: int | None, name: str | None) -> str:
    """The attributes of the pe profile that say who a body or joint is."""
    return attribute("uid", uid) + attribute("sid", sid) + attribute("name", name)


def kept_name(name: str | None) -> str | None:
    """The name, if the common profile's name attribute would not keep it as it is."""
    return name if name is not None and token(name) != name else None


class ShapeTexts:
    """What the shapes of bodies, or of members of unions, say; each list has one text a row."""

    def __init__(
        self,
        world: World,
        columns: dict[str, Array],
        options: WriteOptions,
        planes: Mapping[int, Sequence[float]],
    ) -> None:
        self._columns = columns
        self._world = world
        self._options = options
        kinds, dimensions = columns["kinds"], columns["dimensions"]
        self.kinds: list[int] = kinds.tolist()
        self.geometry = geometry_texts(kinds, dimensions, columns["mesh_ids"], planes)
        self._settled: dict[tuple[int, int], str] = {}
        self.tessellated: dict[str, Mesh] = {}
        """The meshes that stand for primitives, by the ids of their geometries."""
        if options.tessellate:
            self._tessellate()
        self.weight, weight_is_exact = self._weights()
        self._derived = self._derived_inertias()
        solid = kinds != Kind.UNION
        box_is_exact = (kinds != Kind.BOX) | halves_are_exact(dimensions)
        full = options.profile == "full" or options.tessellate
        self.says_shape: Array = solid & (~box_is_exact | (kinds == Kind.PLANE) | full)
        keep_all = options.profile == "full"
        self.says_mass: Array = solid & (~weight_is_exact | keep_all)
        self.says_inertia: Array = solid & (~self._derived | keep_all)

    def _weights(self) -> tuple[list[str], Array]:
        """The mass or density element of every shape, and whether the mass is exact in it."""
        masses, kinds = self._columns["masses"], self._columns["kinds"]
        exact = np.ones(len(masses), dtype=np.bool_)
        texts = [f"<mass>{mass}</mass>" for mass in column_texts(masses)]
        without = (kinds == Kind.PLANE) & same_bits(masses, np.zeros(len(masses)))
        for row in np.flatnonzero(without).tolist():
            texts[row] = ""
        if self._options.shape_weight == "density":
            volumes = self._volumes()
            with np.errstate(all="ignore"):
                densities = masses / volumes
                exact = same_bits(densities * volumes, masses)
                # Not where the volume is too small or too large to say the mass by it.
                usable = np.abs(densities * volumes - masses) <= 1e-12 * masses
            usable &= np.isfinite(densities) & (volumes > 0)
            usable &= (kinds != Kind.BOX) | halves_are_exact(self._columns["dimensions"])
            for row, density in zip(
                np.flatnonzero(usable).tolist(), column_texts(densities[usable]), strict=True
            ):
                texts[row] = f"<density>{density}</density>"
            exact |= ~usable
        return texts, exact

    def _volumes(self) -> Array:
        kinds, dimensions = self._columns["kinds"], self._columns["dimensions"]
        volumes = np.zeros(len(kinds))
        with np.errstate(all="ignore"):
            for kind in np.unique(kinds).tolist():
                rows = kinds == kind
                volumes[rows] = solid_volume(Kind(kind), dimensions[rows])
        for row in np.flatnonzero(kinds == Kind.MESH).tolist():
            volumes[row] = self._world.meshes[int(self._columns["mesh_ids"][row])].volume
        return volumes

    def _derived_inertias(self) -> Array:
        """Where the inertia is the one that shape and mass have by themselves, to the last bit."""
        columns = self._columns
        solid = columns["kinds"] != Kind.UNION
        _, inertias = mass_and_inertia(
            columns, columns["masses"], self._world.materials, self._world.meshes
        )
        derived: Array = solid & np.all(same_bits(inertias, columns["inertias"]), axis=(1, 2))
        return derived

    def _tessellate(self) -> None:
        """Let meshes stand for all primitives but planes."""
        columns = self._columns
        known: dict[tuple[float, ...], str] = {}
        for row, kind in enumerate(self.kinds):
            if kind in (Kind.PLANE, Kind.MESH, Kind.UNION):
                continue
            dimensions = tuple(columns["dimensions"][row].tolist())
            name = known.get((kind, *dimensions))
            if name is None:
                name = known[kind, *dimensions] = f"Shape{columns['sids'][row]}"
                size = extent(Kind(kind), dimensions)
                if size is None or not 1e-50 < np.min(size) <= np.max(size) < 1e50:
                    # Too small or too large for arithmetic; it stays what it is.
                    known[kind, *dimensions] = ""
                    continue
                self.tessellated[name] = tessellate(Kind(kind), dimensions, row)
            if name:
                self.geometry[row] = f'<instance_geometry url="#{name}"/>'

    def _settling(self, kind: int, mesh_id: int, geometry: str) -> str:
        """The transforms that put a geometry into the body's own frame."""
        if mesh_id < 0 and geometry.startswith("<instance"):
            return ""
        known = self._settled.get((kind, mesh_id))
        if known is None:
            mesh = self._world.meshes[mesh_id] if kind == Kind.MESH else None
            known = self._settled[kind, mesh_id] = settling_steps(Kind(kind), mesh)
        return known

    def shape(self, row: int, pose_steps: str) -> str:
        """The shape element of a primitive that stands at `pose_steps` in its rigid_body."""
        columns = self._columns
        hollow = "<hollow>true</hollow>" if columns["hollow"][row] else ""
        material = _material(int(columns["material_ids"][row]))
        geometry = self.geometry[row]
        steps = self._settling(self.kinds[row], int(columns["mesh_ids"][row]), geometry)
        return f"<shape>{hollow}{self.weight[row]}{material}{geometry}{pose_steps}{steps}</shape>"

    def shapes(self) -> list[str]:
        """The shape elements of primitives that are their rigid_body's only shape."""
        columns = self._columns
        materials = {id: _material(id) for id in np.unique(columns["material_ids"]).tolist()}
        hollow = ("", "<hollow>true</hollow>")
        settling = self._settling
        return [
            f"<shape>{hollow[is_hollow]}{weight}{materials[material]}{geometry}"
            f"{settling(kind, mesh_id, geometry)}</shape>"
            for is_hollow, weight, material, geometry, kind, mesh_id in zip(
                columns["hollow"].tolist(),
                self.weight,
                columns["material_ids"].tolist(),
                self.geometry,
                self.kinds,
                columns["mesh_ids"].tolist(),
                strict=True,
            )
        ]

    def values(self, row: int, fixed: bool | None = None) -> str:
        """The values of the pe profile that are needed for a primitive: mass and inertia."""
        columns = self._columns
        text = ""
        if fixed is not None and self._options.profile == "full":
            text += f"<pe:fixed>{_BOOLEANS[fixed]}</pe:fixed>"
        if self.says_mass[row]:
            text += f"<pe:mass>{float_text(float(columns['masses'][row]))}</pe:mass>"
        if self.says_inertia[row]:
            text += inertia_text(columns["inertias"][row])
        return text

    def profile_shape(self, row: int, anchor: Sequence[float] | None) -> str:
        """The geometry of the pe profile, if it is needed."""
        if not self.says_shape[row]:
            return ""
        kind = Kind(self.kinds[row])
        return profile_geometry(kind, self._columns["dimensions"][row].tolist(), anchor)


_BOOLEANS = ("false", "true")


def inertia_text(inertia: Array) -> str:
    """A 3x3 tensor of the pe profile."""
    return f"<pe:inertia>{floats_text(inertia.reshape(9).tolist())}</pe:inertia>"


def _material(id: int) -> str:
    return f'<instance_physics_material url="#Material{id}"/>'


def rotation_texts(orientations: Array) -> list[str]:
    """The rotate element of each of (n, 4) quaternions; nothing for the identity."""
    turned = ~np.all(same_bits(orientations, np.broadcast_to(_NO_TURN, orientations.shape)), axis=1)
    texts = [""] * len(orientations)
    rows = np.flatnonzero(turned)
    if len(rows):
        axes, angles = rotations.to_axis_angle(orientations[rows])
        made = row_texts(np.column_stack([axes, np.degrees(angles)]))
        for row, text in zip(rows.tolist(), made, strict=True):
            texts[row] = f"<rotate>{text}</rotate>"
    return texts


def _unless_zero(name: str, rows: Array) -> list[str]:
    """An element for each row; nothing where all its numbers are (positive) zeros."""
    texts = [""] * len(rows)
    some = np.flatnonzero(_some(rows))
    if len(some) == len(rows):
        return [f"<{name}>{text}</{name}>" for text in row_texts(rows)]
    for row, text in zip(some.tolist(), row_texts(rows[some]), strict=True):
        texts[row] = f"<{name}>{text}</{name}>"
    return texts


def node_texts(sids: Array, positions: Array, orientations: Array) -> list[str]:
    """The node of each body, which says where it is (thesis 5.4)."""
    return [
        f'<node id="Node{sid}">{translate}{rotate}</node>' if translate or rotate
        else f'<node id="Node{sid}"/>'
        for sid, translate, rotate in zip(
            sids.tolist(),
            _unless_zero("translate", positions),
            rotation_texts(orientations),
            strict=True,
        )
    ]  # fmt: skip


def instance_texts(columns: dict[str, Array], options: WriteOptions, moved: Array) -> list[str]:
    """The instance_rigid_body of each body: how it moves, and its exact pose where needed.

    `moved` marks bodies whose node says where they are (not planes).
    """
    degrees, exact = degrees_exactly(columns["angular_velocities"])
    full = options.profile == "full"
    common = [
        f"<technique_common>{angular}{linear}</technique_common>" if angular or linear
        else "<technique_common/>"
        for angular, linear in zip(
            _unless_zero("angular_velocity", degrees),
            _unless_zero("velocity", columns["linear_velocities"]),
            strict=True,
        )
    ]  # fmt: skip
    motion = [""] * len(common)
    if options.profile != "none":
        motion = _motions(columns, full, np.all(exact, axis=1), moved)
    return [
        f'<instance_rigid_body body="Body{sid}" target="#Node{sid}">{values}{technique}'
        "</instance_rigid_body>"
        for sid, values, technique in zip(columns["sids"].tolist(), common, motion, strict=True)
    ]


def _motions(columns: dict[str, Array], full: bool, exact: Array, moved: Array) -> list[str]:
    """The pe profile's technique of each instance."""
    count = len(exact)
    texts = [""] * count
    orientations = columns["orientations"]
    turned = ~np.all(same_bits(orientations, np.broadcast_to(_NO_TURN, (count, 4))), axis=1)
    # A plane that says nothing is turned as its normal is.
    tilts = columns["dimensions"][:, :2]
    turned |= ~moved & ~np.all(same_bits(tilts, np.zeros(tilts.shape)), axis=1)
    wanted = {
        "position": (columns["positions"], np.full(count, full) & moved),
        "orientation": (orientations, turned | full),
        "linear_velocity": (columns["linear_velocities"], np.full(count, full)),
        "angular_velocity": (columns["angular_velocities"], ~exact | full),
        "force": (columns["forces"], _some(columns["forces"])),
        "torque": (columns["torques"], _some(columns["torques"])),
    }
    for name, (values, where) in wanted.items():
        rows = np.flatnonzero(where)
        for row, text in zip(rows.tolist(), row_texts(values[rows]), strict=True):
            texts[row] += f"<pe:{name}>{text}</pe:{name}>"
    sleeping = columns["sleeping"].tolist()
    return [
        pe_technique(
            f'<pe:motion{_SLEEPING[asleep]}>{text}</pe:motion>' if text
            else f'<pe:motion{_SLEEPING[asleep]}/>'
        ) if text or asleep else ""
        for text, asleep in zip(texts, sleeping, strict=True)
    ]  # fmt: skip


_SLEEPING = ("", ' sleeping="true"')


def _some(rows: Array) -> Array:
    return np.asarray(~np.all(same_bits(rows, np.zeros(rows.shape)), axis=1))
