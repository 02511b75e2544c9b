"""One version of a document becomes the next: bodies, joints and the scene of a World in it."""

from __future__ import annotations

from typing import Any

import numpy as np
from lxml import etree
from numpy.typing import NDArray

from colladaphy.document import rules
from colladaphy.document.updating.bodies import (
    foreign_content,
    pin,
    replace_body,
    replace_joint,
    set_motion,
)
from colladaphy.document.updating.differences import Differences
from colladaphy.document.updating.elements import child, drop, name_after, put, put_next
from colladaphy.document.updating.joints import add_frame, gone_for_good, release_kinematics
from colladaphy.document.updating.nodes import Nodes, transforms_of
from colladaphy.document.updating.owning import Owner
from colladaphy.document.updating.plan import Demands, Plan
from colladaphy.document.updating.scene import Scene
from colladaphy.document.updating.sources import Sources
from colladaphy.document.updating.stored import Stored, stored_motions, stored_scene
from colladaphy.findings import Finding
from colladaphy.links.names import c
from colladaphy.links.poses import Poses
from colladaphy.links.resource import Resource
from colladaphy.mapper import Loaded, WriteOptions
from colladaphy.source.copying import copy_tree
from colladaphy.world import World

__all__ = ["Edit"]

Array = NDArray[Any]

_COMPACT = WriteOptions()
_FULL = WriteOptions(profile="full")


class Edit:
    """Makes a new tree from the one that was loaded: in `tree`, with `findings`."""

    def __init__(
        self, resource: Resource, loaded: Loaded, scene: tuple[Resource, int] | None, world: World,
        changes: Differences, demands: Demands,
    ) -> None:  # fmt: skip
        self._loaded, self._world = loaded, world
        self._changes, self._demands = changes, demands
        self.tree = copy_tree(resource.shown_tree)
        self.findings: list[Finding] = []
        root = self.tree.getroot()
        taken = {id for element in root.iter(etree.Element) if (id := element.get("id"))}
        self._owner = Owner(loaded, root, taken)
        self._nodes = Nodes(root, self._owner)
        self._sources = Sources(loaded, world, self._owner)
        place = None
        if scene is not None:
            home = loaded.tables.pool.number(scene[0])
            place = self._owner.scene_element(home, scene[1], scene[1])
        self._scene = Scene(root, self._owner, place)
        self._plan = Plan(loaded, world, changes, demands, self._kept_steps())
        self._target: tuple[etree._Element, etree._Element] | None = None
        self._labels: dict[int, etree._Element] = {}
        self._taken: dict[str, set[str]] = {}
        self._last: dict[tuple[etree._Element, str], etree._Element] = {}
        self._referred: dict[etree._Element, set[str]] = {}
        self._make_own()
        self._write_bodies()
        self._write_joints()
        if gone := gone_for_good(loaded, world, changes.joints_gone):
            release_kinematics(root)
            names = ", ".join(map(repr, gone))
            message = f"The kinematics are not in effect any more: they have the joint {names}."
            self.findings.append(rules.RELEASED.at(message=message))
        others = self._plan.new or self._plan.gone or self._plan.joints_new or changes.joints_gone
        if changes.scene or others or self._plan.values:
            # The counters of system ids tell what is not there, too.
            self._scene.set_values(stored_scene(world, _COMPACT), world, self._sources)

    def _kept_steps(self) -> dict[int, NDArray[np.float64]]:
        """Bodies whose nodes keep their steps, and what stands before these."""
        found, table = self._loaded.bodies.found, self._loaded.tables.placement.nodes
        mine = np.flatnonzero(found.nodes >= 0)
        mine = mine[table.homes(found.nodes[mine]) == 0]
        kept = {}
        for row, number in zip(
            mine.tolist(), table.ordinals[found.nodes[mine]].tolist(), strict=True
        ):
            before = self._nodes.before_steps(self._owner.element(number))
            if before is not None:
                kept[row] = before
        return kept

    # --- elements of their own, before any of them is changed

    def _make_own(self) -> None:
        owner, places = self._owner, self._plan.places
        sids = self._loaded.bodies.parts.sids[self._loaded.bodies.tops]
        along = set(sids[places.moved | places.own].tolist()) & self._plan.still
        self._plan.motions |= along - self._plan.planes
        for sid in sorted(self._plan.motions | self._plan.gone | along):
            owner.instance(self._plan.row[sid])
        for sid in sorted(self._plan.values):
            owner.rigid_body(self._plan.row[sid])
        if self._plan.pins:
            self._pin_bodies()
        changed = (
            self._changes.joints_changed | self._demands.joints
        ) & self._plan.joint_row.keys()
        again = self._plan.reframed | self._plan.anew
        ends = self._world.joint_table.column("bodies")
        touched = np.isin(ends, sorted(again)).any(axis=1)
        changed |= set(self._world.joint_table.column("sids")[touched].tolist())
        self._joints = (changed & self._plan.joint_row.keys()) - self._changes.joints_gone
        for sid in sorted(self._joints):
            owner.constraint(self._plan.joint_row[sid])
            owner.constraint_instance(self._plan.joint_row[sid])
        for sid in sorted(self._changes.joints_gone & self._plan.joint_row.keys()):
            owner.constraint_instance(self._plan.joint_row[sid])
        touched = np.isin(self._world.joint_table.column("sids"),
                          sorted(self._joints | self._plan.joints_new))  # fmt: skip
        for sid in np.unique(ends[touched]).tolist():
            if sid in self._plan.still:
                owner.rigid_body(self._plan.row[sid])
        self.findings += [rules.COPIED.at(message=message) for message in owner.copied]

    def _pin_bodies(self) -> None:
        """Let bodies say their system ids, which else depend on what other bodies there are."""
        for sid in sorted(self._plan.still - self._plan.values):
            self._owner.rigid_body(self._plan.row[sid])

    # --- bodies

    def _write_bodies(self) -> None:
        loaded, owner = self._loaded, self._owner
        changed = self._plan.values | self._plan.new
        joints = self._joints | self._plan.joints_new
        self._stored = Stored(self._world, changed, joints, _COMPACT)
        self._write_nodes()
        for sid in sorted(self._plan.values):
            row = self._plan.row[sid]
            body, made = owner.rigid_body(row), self._stored.rigid_bodies[sid]
            self._sources.resolve(made, self._stored)
            replace_body(body, owner.instance(row), made)
            pin(body, "body", "Body", sid)
        if self._plan.pins:
            for sid in sorted(self._plan.still - self._plan.values):
                pin(owner.rigid_body(self._plan.row[sid]), "body", "Body", sid)
        self._write_motions()
        nodes = []
        foreign = {
            sid: foreign_content(owner.rigid_body(self._plan.row[sid])) for sid in self._plan.anew
        }
        for sid in sorted(self._plan.gone):
            row = self._plan.row[sid]
            drop(owner.instance(row))
            if not owner.shares_rigid_body(row):
                self._drop_body(owner.rigid_body(row))
            node = int(loaded.bodies.found.nodes[row])
            if node >= 0 and int(loaded.tables.placement.nodes.homes(np.array([node]))[0]) == 0:
                nodes.append(owner.element(int(loaded.tables.placement.nodes.ordinals[node])))
        for sid in sorted(self._plan.new):
            self._add_body(sid, foreign.get(sid, []))
        self._nodes.remove_bare(nodes)

    def _drop_body(self, body: etree._Element) -> None:
        """Take out a rigid_body, unless a constraint that is no joint still refers to it."""
        model = body.getparent()
        if model is None:
            return
        if model not in self._referred:
            self._referred[model] = self._still_referred(model)
        if body.get("sid") not in self._referred[model]:
            drop(body)

    def _still_referred(self, model: etree._Element) -> set[str]:
        """The sids of rigid_bodies in constraints of a model that are not written anew."""
        owner, rows = self._owner, self._plan.joint_row
        gone = self._changes.joints_gone & rows.keys()
        other = {owner.constraint(rows[sid]) for sid in gone
                 if not owner.shares_constraint(rows[sid])}  # fmt: skip
        other |= {owner.constraint(rows[sid]) for sid in self._joints}
        return {
            end.get("rigid_body", "").rpartition("/")[2]
            for constraint in model.iterchildren(c("rigid_constraint")) if constraint not in other
            for end in constraint.iterchildren(c("ref_attachment"), c("attachment"))
        }  # fmt: skip

    def _write_nodes(self) -> None:
        loaded, owner, places = self._loaded, self._owner, self._plan.places
        sids = loaded.bodies.parts.sids[loaded.bodies.tops].tolist()
        rows = np.flatnonzero(places.moved | places.own)
        steps = places.poses.take(rows)
        reframed = np.array([sids[row] in self._plan.reframed for row in rows.tolist()], np.bool_)
        # Nothing is computed of what stands in no other frame.
        direct = np.flatnonzero(reframed & places.plain[rows])
        steps.put(direct, self._plan.body_poses.take(rows[direct]))
        made = transforms_of(steps, _by_place(places.matrices, rows))
        inner = transforms_of(Poses.none(len(rows)), _by_place(places.inner, rows))
        table = loaded.tables.placement.nodes
        for at, row in enumerate(rows.tolist()):
            if places.own[row]:
                name = self._nodes.add(f"Node{sids[row]}", made[at])
                owner.instance(row).set("target", f"#{name}")
                message = f"The body {sids[row]} got the node {name!r} of its own."
                self.findings.append(rules.NODE.at(owner.instance(row), message))
                continue
            node = owner.element(int(table.ordinals[loaded.bodies.found.nodes[row]]))
            if inner[at]:
                self._nodes.wrap(node, inner[at])
            if row in self._plan.kept:
                self._nodes.precede(node, made[at])
            else:
                self._nodes.place(node, made[at])

    def _write_motions(self) -> None:
        framed = self._loaded.bodies.origins.is_identity()
        simple: list[int] = []
        other: list[int] = []
        for sid in sorted(self._plan.motions):
            row = self._plan.row[sid]
            exact = sid in self._plan.planes or (
                self._plan.places.plain[row] and (framed[row] or sid in self._plan.values)
            )
            (simple if exact else other).append(sid)
        for sids, options in ((simple, _COMPACT), (other, _FULL)):
            made = stored_motions(self._world, np.array(sids, np.int64), options)
            for sid, stored in zip(sids, made, strict=True):
                set_motion(self._owner.instance(self._plan.row[sid]), stored)

    # --- what is new

    def _home(self) -> tuple[etree._Element, etree._Element]:
        """The model that takes what is new, and its instance: of the scene's, or a new one."""
        if self._target is None:
            expansion, owner = self._loaded.expansion, self._owner
            for instance in np.flatnonzero(expansion.around < 0).tolist():
                effect = owner.model_instance(instance)
                if (
                    expansion.chains[instance] < 0
                    and effect.getparent() is self._scene.element
                    and owner.has_its_own(instance)
                ):
                    self._target = owner.model(instance), effect
                    break
            else:
                self._target = self._scene.add_model()
        return self._target

    def _append(
        self, parent: etree._Element, node: etree._Element, before: tuple[str, ...]
    ) -> None:
        """Put an element in, behind the one of its kind that was put in last."""
        key = parent, str(node.tag)
        if key in self._last:
            put_next(node, self._last[key])
        else:
            put(parent, node, before)
        self._last[key] = node

    def _label(self, model: etree._Element, kind: str, wanted: str) -> str:
        """A sid that is free in the model that takes what is new."""
        if kind not in self._taken:
            self._taken[kind] = {other.get("sid", "") for other in model.iterchildren(c(kind))}
        return name_after(wanted, self._taken[kind])

    def _add_body(self, sid: int, foreign: list[etree._Element]) -> None:
        model, effect = self._home()
        body, instance = self._stored.rigid_bodies[sid], self._stored.instances[sid]
        node = self._stored.nodes[sid]
        self._sources.resolve(body, self._stored)
        label = self._label(model, "rigid_body", f"Body{sid}")
        body.set("sid", label)
        pin(body, "body", "Body", sid)
        for element in foreign:
            body.append(element)
        self._append(model, body, ("asset", "rigid_body"))
        instance.set("body", label)
        name = self._nodes.add(f"Node{sid}", list(node))
        instance.set("target", f"#{name}")
        self._append(effect, instance, ("instance_force_field", "instance_rigid_body"))
        self._labels[sid] = body

    # --- joints

    def _write_joints(self) -> None:
        owner = self._owner
        for sid in sorted(self._changes.joints_gone & self._plan.joint_row.keys()):
            row = self._plan.joint_row[sid]
            drop(owner.constraint_instance(row))
            if not owner.shares_constraint(row):
                drop(owner.constraint(row))
        if self._plan.pins or self._changes.joints_gone or self._plan.joints_new:
            for sid in sorted(self._plan.joint_row.keys() - self._changes.joints_gone):
                pin(owner.constraint(self._plan.joint_row[sid]), "joint", "Joint", sid)
        framed = self._joints | self._plan.joints_new
        if not framed:
            return
        exact = self._stored
        table = self._world.joint_table
        ends = dict(
            zip(table.column("sids").tolist(), table.column("bodies").tolist(), strict=True)
        )
        off = {sid for sid in framed if any(self._frame(end) is not None for end in ends[sid])}
        if off:
            exact = Stored(self._world, (), off, _FULL)
        for sid in sorted(framed):
            made = (exact if sid in off else self._stored).constraints[sid]
            for name, end in zip(("ref_attachment", "attachment"), ends[sid], strict=True):
                attachment = child(made, name)
                assert attachment is not None
                if end:
                    attachment.set("rigid_body", self._address(end))
                add_frame(attachment, self._frame(end))
            if sid in self._plan.joint_row:
                constraint = owner.constraint(self._plan.joint_row[sid])
                replace_joint(constraint, made)
                pin(constraint, "joint", "Joint", sid)
            else:
                self._add_joint(sid, made)

    def _frame(self, sid: int) -> Poses | None:
        """Where a body stands in its rigid_body; None for the same frame."""
        if sid not in self._plan.still or sid in self._plan.values or sid in self._plan.planes:
            return None
        row = np.array([self._plan.row[sid]])
        origin = self._loaded.bodies.origins.take(row)
        return None if origin.is_identity()[0] else origin.inverse()

    def _address(self, sid: int) -> str:
        """The path to the rigid_body of a body."""
        body = self._labels.get(sid)
        if body is None:
            body = self._owner.rigid_body(self._plan.row[sid])
        model = body.getparent()
        assert model is not None
        return f"{model.get('id')}/{body.get('sid')}"

    def _add_joint(self, sid: int, made: etree._Element) -> None:
        model, effect = self._home()
        label = self._label(model, "rigid_constraint", f"Joint{sid}")
        made.set("sid", label)
        pin(made, "joint", "Joint", sid)
        self._append(model, made, ("asset", "rigid_body", "rigid_constraint"))
        instance = etree.Element(c("instance_rigid_constraint"))
        instance.set("constraint", label)
        before = ("instance_force_field", "instance_rigid_body", "instance_rigid_constraint")
        self._append(effect, instance, before)


def _by_place(matrices: dict[int, NDArray[np.float64]], rows: Array) -> dict[int, Any]:
    return {at: matrices[row] for at, row in enumerate(rows.tolist()) if row in matrices}
