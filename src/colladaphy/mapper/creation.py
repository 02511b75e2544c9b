"""Plans become bodies: system ids first, then primitives in bulk, then unions one by one."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from colladaphy.errors import WorldError
from colladaphy.mapper import rules
from colladaphy.mapper.plans import Part, Plan
from colladaphy.world.columns import BodyColumns
from colladaphy.world.kinds import Kind

if TYPE_CHECKING:
    from colladaphy.document import Document
    from colladaphy.world import World

__all__ = ["create_bodies", "free_ids", "parts_of"]


def parts_of(part: Part) -> Iterator[Part]:
    """The part and all its members, members first."""
    for member in part.members:
        yield from parts_of(member)
    yield part


def free_ids(wanted: Sequence[int | None], taken: Iterable[int]) -> list[int]:
    """System ids: the wanted ones where they are free, and their order always (thesis 6.1).

    Those that want none come after all others, in their own order.
    """
    used = set(taken)
    given: list[int | None] = [None] * len(wanted)
    order = sorted(
        (place for place, sid in enumerate(wanted) if sid is not None),
        key=lambda place: (wanted[place], place),
    )
    last = 0
    for place in order:
        sid = wanted[place]
        assert sid is not None
        sid = max(sid, 1)
        if sid <= last or sid in used:
            sid = max(last + 1, sid)
            while sid in used:
                sid += 1
        given[place] = last = sid
    last = max(last, max(used, default=0))
    made = []
    for sid in given:
        if sid is None:
            last += 1
            sid = last
        made.append(sid)
    return made


def create_bodies(world: World, plans: Sequence[Plan], document: Document) -> list[Plan]:
    """Create all bodies; returns the plans of those that the World took."""
    whole = [plan for plan in plans if plan.part.kind is not Kind.UNION]
    unions = [plan for plan in plans if plan.part.kind is Kind.UNION]
    created = _create_primitives(world, whole, document)
    there = _create_members(world, unions)
    for plan in unions:
        try:
            _create_union(world, plan, there=there)
        except WorldError as error:
            _refused(document, plan, error)
        else:
            created.append(plan)
    return created


def _create_members(world: World, unions: Sequence[Plan]) -> bool:
    """Create the primitives of all unions in bulk; False, and none, if the World refuses any."""
    groups: dict[tuple[bool, bool], list[Part]] = {}
    for plan in unions:
        for part in parts_of(plan.part):
            if part.kind is not Kind.UNION:
                key = (part.mass is None, part.inertia is None)
                groups.setdefault(key, []).append(part)
    made: list[int] = []
    for group in groups.values():
        try:
            made += world.extend(columns_of(group, None)).tolist()
        except WorldError:
            for sid in made:
                world.destroy(world.body(sid))
            return False
    return True


def _refused(document: Document, plan: Plan, error: WorldError) -> None:
    message = f"{error.findings[0].message} The body is skipped."
    document.note(rules.BAD_VALUE, plan.element, message, file=plan.file)


def _create_primitives(world: World, plans: Sequence[Plan], document: Document) -> list[Plan]:
    """Create primitives, in bulk where the World takes them all."""
    groups: dict[tuple[bool, bool], list[Plan]] = {}
    for plan in plans:
        key = (plan.part.mass is None, plan.part.inertia is None)
        groups.setdefault(key, []).append(plan)
    created: list[Plan] = []
    for group in groups.values():
        try:
            world.extend(columns_of([plan.part for plan in group], group))
        except WorldError:
            for plan in group:
                try:
                    world.extend(columns_of([plan.part], [plan]))
                except WorldError as error:
                    _refused(document, plan, error)
                else:
                    created.append(plan)
        else:
            created += group
    return created


def columns_of(parts: Sequence[Part], plans: Sequence[Plan] | None) -> BodyColumns:
    """The columns of primitives; masses and inertias if the first part has them."""
    columns = BodyColumns(kinds=np.array([part.kind for part in parts], dtype=np.int8))
    columns.sids = np.array([part.sid for part in parts], dtype=np.int64)
    columns.uids = np.array([part.uid or 0 for part in parts], dtype=np.int64)
    columns.positions = np.array([part.pose.translation for part in parts])
    columns.orientations = np.array([part.pose.rotation for part in parts])
    columns.dimensions = np.array([part.dimensions for part in parts])
    columns.material_ids = np.array([part.material_id for part in parts], dtype=np.int64)
    columns.mesh_ids = np.array([part.mesh_id for part in parts], dtype=np.int64)
    columns.hollow = np.array([part.hollow for part in parts])
    columns.names = [part.name for part in parts]
    if parts[0].mass is not None:
        columns.masses = np.array([part.mass for part in parts])
    if parts[0].inertia is not None:
        columns.inertias = np.array([part.inertia for part in parts]).reshape(-1, 3, 3)
    if plans is not None:
        columns.fixed = np.array([plan.fixed for plan in plans])
        columns.sleeping = np.array([plan.sleeping for plan in plans])
        columns.linear_velocities = np.array([plan.linear_velocity for plan in plans])
        columns.angular_velocities = np.array([plan.angular_velocity for plan in plans])
        columns.forces = np.array([plan.force for plan in plans])
        columns.torques = np.array([plan.torque for plan in plans])
    return columns


def _create_union(world: World, plan: Plan, *, there: bool) -> None:
    """Create a union exactly as the plan has it; its primitives may be `there` already."""
    try:
        _create_part(world, plan.part, there=there)
    except WorldError:
        for part in reversed(list(parts_of(plan.part))):
            if part.sid in world and part.sid is not None and world.parent_of(part.sid) is None:
                world.destroy(world.body(part.sid))
        raise
    sid = plan.part.sid
    assert sid is not None
    row = world.top.find(sid)
    for name, value in (
        ("fixed", plan.fixed or world.is_infinite(sid)),
        ("sleeping", plan.sleeping),
        ("linear_velocities", plan.linear_velocity),
        ("angular_velocities", plan.angular_velocity),
        ("forces", plan.force),
        ("torques", plan.torque),
    ):
        world.top.raw(name)[row] = value


def _create_part(world: World, part: Part, *, there: bool) -> None:
    assert part.sid is not None
    if part.kind is not Kind.UNION:
        if not there:
            world.extend(columns_of([part], None))
        return
    for member in part.members:
        _create_part(world, member, there=there)
    inertia = None if part.inertia is None else np.array(part.inertia).reshape(3, 3)
    world.create_union(
        part.uid or 0,
        [world.body(member.sid) for member in part.members if member.sid is not None],
        position=part.pose.translation,
        orientation=part.pose.rotation,
        mass=part.mass,
        inertia=inertia,
        sid=part.sid,
        name=part.name,
        members_are_local=True,
    )
    # As it was stored, even where its length is not one.
    world.top.raw("orientations")[world.top.find(part.sid)] = part.pose.rotation
