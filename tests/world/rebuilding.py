"""A World made anew from its columns, along the path that files take."""

from __future__ import annotations

import numpy as np

from colladaphy.world import Body, BodyColumns, Kind, World
from colladaphy.world.columns import BODY_FIELDS
from colladaphy.world.materials import VALUES


def rebuilt(world: World) -> World:
    """An equal World, built with public creators and given values only."""
    copy = World(
        world.gravity,
        unit=(world.unit_name, world.unit_meter),
        up_axis=world.up_axis,
        time_step=world.time_step,
        name=world.name,
    )
    copy.time, copy.step_count = world.time, world.step_count
    copy.engine_state = world.engine_state
    for material in world.materials:
        if material.id not in copy.materials:
            values = {key: getattr(material, key) for key in VALUES}
            copy.create_material(material.name, id=material.id, **values)
    for pair in world.pair_overrides:
        copy.set_pair(
            pair.first, pair.second, pair.restitution, pair.static_friction, pair.dynamic_friction
        )
    for mesh in world.meshes.values():
        copy.add_mesh(mesh.vertices, mesh.faces, convex=mesh.convex, id=mesh.id)
    columns = world.columns()
    primitives = np.flatnonzero(columns.kinds != Kind.UNION)
    names = [world.bodies[row].name for row in primitives.tolist()]
    fields = {key: getattr(columns, key)[primitives] for key in ("sids", *BODY_FIELDS)}
    copy.extend(BodyColumns(**fields, names=names))
    for row in np.flatnonzero(columns.kinds == Kind.UNION).tolist():
        union = world.bodies[row]
        made = _union(union, copy)
        made.linear_velocity = union.linear_velocity
        made.angular_velocity = union.angular_velocity
        made.force, made.torque, made.sleeping = union.force, union.torque, union.sleeping
    for joint in world.joints:
        bodies = [body and copy.body(body.sid) for body in (joint.body1, joint.body2)]
        copy.attach_joint(
            *bodies,
            frame1=joint.frame1,
            frame2=joint.frame2,
            linear_min=joint.linear_min,
            linear_max=joint.linear_max,
            angular_min=joint.angular_min,
            angular_max=joint.angular_max,
            linear_spring=joint.linear_spring,
            angular_spring=joint.angular_spring,
            motor=joint.motor,
            enabled=joint.enabled,
            interpenetrate=joint.interpenetrate,
            uid=joint.uid,
            sid=joint.sid,
            name=joint.name,
        )
    copy.next_body_sid, copy.next_joint_sid = world.next_body_sid, world.next_joint_sid
    return copy


def _union(union: Body, copy: World) -> Body:
    for member in union.members:
        if member.kind is Kind.UNION:
            _union(member, copy)
    primitives = [member for member in union.members if member.kind is not Kind.UNION]
    if primitives:
        copy.extend(
            BodyColumns(
                kinds=np.array([body.kind for body in primitives]),
                sids=np.array([body.sid for body in primitives]),
                uids=np.array([body.uid for body in primitives]),
                positions=np.array([body.local_position for body in primitives]),
                orientations=np.array([body.local_orientation for body in primitives]),
                masses=np.array([body.mass for body in primitives]),
                inertias=np.array([body.inertia for body in primitives]),
                material_ids=np.array(
                    [-1 if body.material is None else body.material.id for body in primitives]
                ),
                dimensions=np.array([body.dimensions for body in primitives]),
                hollow=np.array([body.hollow for body in primitives]),
                mesh_ids=np.array(
                    [body.mesh.id if body.kind is Kind.MESH else -1 for body in primitives]
                ),
                names=[body.name for body in primitives],
            )
        )
    return copy.create_union(
        union.uid,
        [copy.body(member.sid) for member in union.members],
        position=union.local_position,
        orientation=union.local_orientation,
        mass=union.mass,
        inertia=union.inertia,
        fixed=union.fixed,
        linear_velocity=(0, 0, 0),
        angular_velocity=(0, 0, 0),
        sid=union.sid,
        name=union.name,
        members_are_local=True,
    )
