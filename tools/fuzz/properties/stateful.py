"""Worlds and checkpoints over many steps, against a plain model of what they should hold."""

from __future__ import annotations

import io
import os
import shutil
import tempfile
from pathlib import Path
from typing import Any

from hypothesis import strategies as st
from tests.engines.scenes import SCENES

import colladaphy
from colladaphy import Document, World, compare
from colladaphy.engines import Simulation
from colladaphy.errors import ColladaError, EngineError
from colladaphy.world import Kind
from tools.fuzz.registry import note, of

__all__: list[str] = []

KINDS = ("create", "create", "create", "move", "move", "spin", "fix", "join", "join", "group",
         "delete", "unjoin", "save", "update", "step")  # fmt: skip
Step = tuple[str, int, int, float]


def _steps() -> st.SearchStrategy[list[Step]]:
    number = st.integers(0, 99)
    step = st.tuples(st.sampled_from(KINDS), number, number, st.floats(-5, 5))
    return st.lists(step, min_size=1, max_size=25)


@of(_steps, weight=2)
def world_in_any_order(steps: list[Step]) -> None:
    """Create, move, join, group, delete, save, update and step in any order, beside a model."""
    model = Model()
    for kind, one, two, value in steps:
        getattr(model, kind)(one, two, value)
        model.agrees()
    model.save(0, 0, 0.0)
    model.agrees()


class Model:
    """What a World should hold: bodies by system id, members of unions, joints."""

    def __init__(self) -> None:
        self.world = World(gravity=(0, 0, -9.81), time_step=1 / 240)
        self.document: Document | None = None
        self.bodies: dict[int, dict[str, Any]] = {}
        self.members: dict[int, list[int]] = {}
        self.joints: dict[int, tuple[int, int]] = {}

    def agrees(self) -> None:
        """The World says what the model says."""
        world = self.world
        assert world.sids.tolist() == sorted(self.bodies)
        assert {sid: list(found) for sid, found in world.children.items()} == self.members
        for sid, known in self.bodies.items():
            body = world.body(sid)
            assert (body.uid, body.name, body.fixed, body.kind) == (
                known["uid"], known["name"], known["fixed"], known["kind"]
            )  # fmt: skip
            assert body.position.tolist() == known["position"]
            assert body.linear_velocity.tolist() == known["velocity"]
        found = {
            joint.sid: tuple(0 if end is None else end.sid for end in (joint.body1, joint.body2))
            for joint in world.joints
        }
        assert found == self.joints

    def _some(self, number: int) -> int | None:
        sids = sorted(self.bodies)
        return sids[number % len(sids)] if sids else None

    def create(self, one: int, two: int, value: float) -> None:
        name = None if two % 3 else f"näme {one}"
        place, world = [value, float(two), 10.0 * len(self.bodies)], self.world
        match one % 4:
            case 0:
                body = world.create_sphere(one, place, 0.5, "iron", name=name)
            case 1:
                body = world.create_box(one, place, (1, 2, 0.5), "oak", name=name)
            case 2:
                body = world.create_capsule(one, place, 0.5, 1, "iron", name=name)
            case _:
                body = world.create_cylinder(one, place, 0.5, 1, "fir", name=name)
        assert body.sid not in self.bodies
        self.bodies[body.sid] = {
            "uid": one, "name": name, "fixed": False, "kind": body.kind, "position": place,
            "velocity": [0.0] * 3,
        }  # fmt: skip

    def move(self, one: int, two: int, value: float) -> None:
        if (sid := self._some(one)) is not None:
            place = [value, 3.0 * two, -value]
            self.world.body(sid).position = place
            self.bodies[sid]["position"] = place

    def spin(self, one: int, two: int, value: float) -> None:
        if (sid := self._some(one)) is not None and not self.bodies[sid]["fixed"]:
            self.world.body(sid).rotate(value, 0.1 * two, 0)
            self.world.body(sid).linear_velocity = (0, value, 0)
            self.bodies[sid]["velocity"] = [0.0, value, 0.0]

    def fix(self, one: int, two: int, value: float) -> None:
        if (sid := self._some(one)) is not None:
            body, fixed = self.world.body(sid), bool(two % 2)
            body.fixed = fixed
            self.bodies[sid]["fixed"] = fixed
            self.bodies[sid]["velocity"] = body.linear_velocity.tolist()

    def join(self, one: int, two: int, value: float) -> None:
        first, second = self._some(one), self._some(two)
        if first is None or first == second:
            return
        attach = (self.world.attach_fixed_joint, self.world.attach_ball_joint)[one % 2]
        other = None if two % 5 == 0 or second is None else self.world.body(second)
        joint = attach(self.world.body(first), other)
        self.joints[joint.sid] = (first, 0 if other is None else other.sid)

    def group(self, one: int, two: int, value: float) -> None:
        members = sorted({sid for sid in (self._some(one), self._some(two)) if sid is not None})
        joined = {sid for ends in self.joints.values() for sid in ends}
        if not members or joined & set(members):
            return
        union = self.world.create_union(one, [self.world.body(sid) for sid in members])
        assert union.kind is Kind.UNION
        for sid in members:
            del self.bodies[sid]
        self.members[union.sid] = members
        self.bodies[union.sid] = {
            "uid": one, "name": None, "fixed": union.fixed, "kind": Kind.UNION,
            "position": union.position.tolist(), "velocity": union.linear_velocity.tolist(),
        }  # fmt: skip

    def delete(self, one: int, two: int, value: float) -> None:
        if (sid := self._some(one)) is None:
            return
        self.world.destroy(self.world.body(sid))
        del self.bodies[sid]
        gone = [sid]
        while gone:
            gone += self.members.pop(gone.pop(), [])
        self.joints = {key: ends for key, ends in self.joints.items() if sid not in ends}

    def unjoin(self, one: int, two: int, value: float) -> None:
        if self.joints:
            sid = sorted(self.joints)[one % len(self.joints)]
            self.world.destroy_joint(next(j for j in self.world.joints if j.sid == sid))
            del self.joints[sid]

    def save(self, one: int, two: int, value: float) -> None:
        stream = io.BytesIO()
        colladaphy.write(self.world, stream)
        self.document = colladaphy.read(note(stream.getvalue()))
        again = self.document.load()
        assert compare(self.world, again) == []
        self.world = again

    def update(self, one: int, two: int, value: float) -> None:
        if self.document is None:
            return
        self.document.update(self.world)
        stream = io.BytesIO()
        self.document.write(stream, check=False)
        self.document = colladaphy.read(note(stream.getvalue()))
        again = self.document.load()
        assert compare(self.world, again) == []
        self.world = again

    def step(self, one: int, two: int, value: float) -> None:
        before = self.world.step_count
        self.world.engine_state = None
        try:
            run = Simulation(self.world, "mujoco")
            run.run(1 + one % 3)
        except EngineError as error:
            assert error.findings
        else:
            self.world = run.world
            assert self.world.step_count == before + 1 + one % 3
        for sid, known in self.bodies.items():
            body = self.world.body(sid)
            assert not known["fixed"] or body.position.tolist() == known["position"]
            known["position"] = body.position.tolist()
            known["velocity"] = body.linear_velocity.tolist()


def _moments() -> st.SearchStrategy[int]:
    return st.integers(0, 80)


@of(_moments, lambda: st.integers(1, 3), lambda: st.sampled_from(["walker", "chain"]))
def checkpoints_killed(moment: int, keep: int, scene: str) -> None:
    """Killed at any operation on files, a run resumes with a state that it had, and goes on."""
    name = scene if scene in SCENES else sorted(SCENES)[0]
    folder = Path(tempfile.mkdtemp(prefix="fuzz-checkpoints-"))
    try:
        child = os.fork()
        if child == 0:
            _run_until(folder, name, keep, moment)
        _, status = os.waitpid(child, 0)
        assert os.waitstatus_to_exitcode(status) in (0, 9)
        _resumes(folder, name)
    finally:
        shutil.rmtree(folder)


_STEPS, _EVERY = 30, 5


def _run_until(folder: Path, scene: str, keep: int, moment: int) -> None:
    """A run in a child, which ends at one operation on files."""
    from colladaphy.engines import Checkpoints

    left = moment

    def counting(original: Any) -> Any:
        def call(*args: Any, **values: Any) -> Any:
            nonlocal left
            left -= 1
            if left < 0:
                os._exit(9)
            return original(*args, **values)

        return call

    try:
        for function in ("open", "replace", "fsync", "unlink", "rename", "write", "close"):
            setattr(os, function, counting(getattr(os, function)))
        Simulation(SCENES[scene](), "mujoco").run(
            _STEPS, checkpoints=Checkpoints(folder, keep=keep), checkpoint_every=_EVERY
        )
    except BaseException:
        os._exit(1)
    os._exit(0)


def _resumes(folder: Path, scene: str) -> None:
    whole = Simulation(SCENES[scene](), "mujoco")
    try:
        run = Simulation.resume(folder)
    except ColladaError as error:
        assert "no checkpoint" in str(error).lower()
        assert len([path for path in folder.iterdir() if path.suffix == ".dae"]) == 0
        return
    assert run.world.step_count % _EVERY == 0
    whole.run(run.world.step_count)
    assert compare(whole.world, run.world) == []
    run.run(3)
    whole.run(3)
    assert compare(whole.world, run.world) == []
