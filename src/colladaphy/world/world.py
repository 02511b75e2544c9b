"""The World: bodies, unions, joints and materials in numpy columns."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from colladaphy.world.attaching import Attaching
from colladaphy.world.body import Body
from colladaphy.world.joints import Joints
from colladaphy.world.materials import Material, MaterialPair, PairOverride
from colladaphy.world.rules import UNION_MEMBERS, refuse

__all__ = ["Bodies", "World"]

SHOWN = 5
"""How many bodies the text of all bodies names."""


class World(Attaching):
    """Rigid bodies, joints and materials after the pe engine (thesis 2).

    `gravity` (3,) is in units of length/s². `unit` is the unit of length: its name and its size in
    metres. Nothing is converted: all lengths are in that unit, masses in kg, angles in radians.
    `time_step` is the step that the scene asks for, None if it does not.
    """

    @property
    def bodies(self) -> Bodies:
        """The top-level bodies in the order of their system ids."""
        return Bodies(self)

    @property
    def joints(self) -> Joints:
        """The joints in the order of their system ids."""
        return Joints(self)

    def body(self, sid: int) -> Body:
        """The body, member or not, of a system id; WorldError if there is none."""
        self.locate(sid)
        return Body(self, sid)

    def body_or_none(self, sid: int) -> Body | None:
        """The body of a system id, None for 0, which stands for the world itself."""
        return Body(self, sid) if sid else None

    def destroy(self, body: Body) -> None:
        """Remove a top-level body, its members and the joints at it."""
        self.check_own(body)
        if self.parent_of(body.sid) is not None:
            raise refuse(UNION_MEMBERS, f"{body!r} is a member of a union; destroy that.")
        for joint in tuple(self.joints_of.get(body.sid, ())):
            self.remove_joint(joint)
        self._forget(body.sid)

    def _forget(self, sid: int) -> None:
        for member in self.children.pop(sid, ()):
            self._forget(member)
        table, row = self.locate(sid)
        table.remove(row)
        self.names.pop(sid, None)

    def create_material(
        self,
        name: str,
        *,
        density: float,
        restitution: float,
        static_friction: float,
        dynamic_friction: float,
        poisson_ratio: float,
        young_modulus: float,
        stiffness: float,
        damping_normal: float,
        damping_tangential: float,
        id: int | None = None,
    ) -> Material:
        """Add a material (thesis 4.4). Names and ids are unique; WorldError on bad values."""
        return self.materials.create(
            name,
            id=id,
            density=density,
            restitution=restitution,
            static_friction=static_friction,
            dynamic_friction=dynamic_friction,
            poisson_ratio=poisson_ratio,
            young_modulus=young_modulus,
            stiffness=stiffness,
            damping_normal=damping_normal,
            damping_tangential=damping_tangential,
        )

    def pair(self, first: Material | str | int, second: Material | str | int) -> MaterialPair:
        """What holds where two materials meet: pe's rules and what was set by hand."""
        materials = self.materials
        return materials.pair(materials.resolve(first), materials.resolve(second))

    def set_pair(
        self,
        first: Material | str | int,
        second: Material | str | int,
        restitution: float | None = None,
        static_friction: float | None = None,
        dynamic_friction: float | None = None,
    ) -> None:
        """Set restitution and frictions of a pair; None leaves them to pe's rules."""
        self.materials.override(
            self.materials.resolve(first),
            self.materials.resolve(second),
            restitution,
            static_friction,
            dynamic_friction,
        )

    @property
    def pair_overrides(self) -> tuple[PairOverride, ...]:
        """The pairs set by hand, ordered by the ids of their materials."""
        return self.materials.overrides

    def __repr__(self) -> str:
        name = f" {self.name!r}" if self.name else ""
        return f"<World{name} of {len(self.top)} bodies, {len(self.joints)} joints>"


class Bodies(Sequence[Body]):
    """The top-level bodies of a World, by their place in the order of system ids."""

    __slots__ = ("_world",)

    def __init__(self, world: World) -> None:
        self._world = world

    def __len__(self) -> int:
        return len(self._world.top)

    def __getitem__(self, index: Any) -> Any:
        sids = self._world.top.column("sids")[index]
        if isinstance(index, slice):
            return [Body(self._world, sid) for sid in sids.tolist()]
        return Body(self._world, int(sids))

    def __iter__(self) -> Iterator[Body]:
        for sid in self._world.top.column("sids").tolist():
            yield Body(self._world, sid)

    def __repr__(self) -> str:
        first = [repr(body) for body in self[:SHOWN]]
        more = ["…"] if len(self) > SHOWN else []
        return f"<{len(self)} bodies: {', '.join(first + more) or 'none'}>"
