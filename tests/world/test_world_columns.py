"""Columns stay aligned with bodies, whatever is created, joined and destroyed."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, precondition, rule

from colladaphy.errors import WorldError
from colladaphy.world import BodyColumns, Kind, World, compare
from colladaphy.world.shapes import NEEDED


class Columns(RuleBasedStateMachine):
    """A World beside a plain dictionary of what it should hold."""

    def __init__(self) -> None:
        super().__init__()
        self.world = World()
        self.top: dict[int, float] = {}
        self.inner: dict[int, int] = {}

    @rule(x=st.floats(-9, 9), ahead=st.integers(0, 3))
    def create(self, x: float, ahead: int) -> None:
        sid = self.world.next_body_sid + ahead if ahead else None
        body = self.world.create_sphere(1, (x, 0, 0), 1, "iron", sid=sid)
        self.top[body.sid] = x

    @rule(x=st.floats(-9, 9), sid=st.integers(1, 40))
    def create_out_of_order(self, x: float, sid: int) -> None:
        if sid in self.world:
            with pytest.raises(WorldError):
                self.world.create_sphere(1, (x, 0, 0), 1, "iron", sid=sid)
        else:
            self.world.create_sphere(1, (x, 0, 0), 1, "iron", sid=sid)
            self.top[sid] = x

    @rule(xs=st.lists(st.floats(-9, 9), max_size=5))
    def extend(self, xs: list[float]) -> None:
        count = len(xs)
        rows = np.zeros((count, 3))
        rows[:, 0] = xs
        sids = self.world.extend(
            BodyColumns(
                kinds=np.zeros(count, dtype=int),
                positions=rows,
                dimensions=np.tile([1.0, 0, 0, 0], (count, 1)),
            )
        )
        self.top.update(zip(sids.tolist(), xs, strict=True))

    @precondition(lambda self: self.top)
    @rule(data=st.data())
    def unite(self, data: st.DataObject) -> None:
        sids = data.draw(st.lists(st.sampled_from(sorted(self.top)), min_size=1, max_size=3,
                                  unique=True))  # fmt: skip
        union = self.world.create_union(1, [self.world.body(sid) for sid in sids])
        for sid in sids:
            del self.top[sid]
            self.inner[sid] = union.sid
        self.top[union.sid] = float(union.position[0])

    @precondition(lambda self: self.top)
    @rule(data=st.data())
    def destroy(self, data: st.DataObject) -> None:
        sid = data.draw(st.sampled_from(sorted(self.top)))
        self.world.destroy(self.world.body(sid))
        gone = {sid}
        while more := {key for key, parent in self.inner.items() if parent in gone}:
            for key in more:
                del self.inner[key]
            gone |= more
        del self.top[sid]
        assert sid not in self.world
        with pytest.raises(WorldError):
            _ = self.world.body(sid).mass

    @rule()
    def move_all(self) -> None:
        self.world.positions += (1.0, 0.0, 0.0)
        self.top = {sid: x + 1.0 for sid, x in self.top.items()}

    @invariant()
    def single_bodies(self) -> None:
        for sid, x in self.top.items():
            assert self.world.body(sid).position[0] == x
        for sid, parent in self.inner.items():
            assert self.world.body(sid).parent == self.world.body(parent)
        assert len(self.world.bodies) == len(self.top)

    @rule()
    def whole_columns(self) -> None:
        assert self.world.sids.tolist() == sorted(self.top)
        assert [body.sid for body in self.world.bodies] == sorted(self.top)
        assert self.world.positions[:, 0].tolist() == [self.top[sid] for sid in sorted(self.top)]
        assert self.world.member_columns.sids.tolist() == sorted(self.inner)
        assert compare(self.world, self.world) == []


TestColumns = Columns.TestCase


def grid(count: int) -> BodyColumns:
    rng = np.random.default_rng(3)
    kinds = np.arange(count) % 6
    dimensions = rng.uniform(0.5, 2, size=(count, 4))
    for kind, columns in NEEDED.items():
        for column in set(range(4)) - set(columns):
            dimensions[kinds == kind, column] = 0
    planes = kinds == Kind.PLANE
    dimensions[planes, :3] /= np.linalg.norm(dimensions[planes, :3], axis=1)[:, None]
    return BodyColumns(
        kinds=kinds,
        positions=rng.normal(size=(count, 3)),
        dimensions=dimensions,
        material_ids=np.arange(count) % 5,
        hollow=np.arange(count) % 7 == 0,
        uids=np.arange(count) * 3,
        names=[f"body {row}" if row % 2 else None for row in range(count)],
    )


def test_many_at_once_are_as_one_by_one() -> None:
    columns = grid(60)
    many, single = World(), World()
    sids = many.extend(columns)
    assert sids.tolist() == list(range(1, 61))
    for row in range(60):
        kind = Kind(int(columns.kinds[row]))
        x, y, z, length = columns.dimensions[row].tolist()
        common = {
            "material": single.materials[row % 5],
            "name": columns.names[row],
        }
        uid, position = row * 3, columns.positions[row]
        if kind is Kind.PLANE:
            single.create_plane(uid, (x, y, z), length, position=position, **common)
            continue
        common["hollow"] = bool(columns.hollow[row])
        match kind:
            case Kind.SPHERE:
                single.create_sphere(uid, position, x, **common)
            case Kind.BOX:
                single.create_box(uid, position, (x, y, z), **common)
            case Kind.ELLIPSOID:
                single.create_ellipsoid(uid, position, (x, y, z), **common)
            case Kind.CYLINDER:
                single.create_cylinder(uid, position, (y, z), length, **common)
            case _:
                single.create_capsule(uid, position, (x, y, z), length, **common)
    one, two = many.columns(), single.columns()
    for name in ("positions", "orientations", "masses", "inertias", "fixed", "uids", "kinds"):
        assert np.array_equal(getattr(one, name), getattr(two, name)), name
    assert one.names == two.names


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("positions", np.zeros((3, 2))),
        ("positions", np.full((3, 3), np.nan)),
        ("orientations", np.zeros((3, 4))),
        ("dimensions", np.zeros((3, 4))),
        ("dimensions", np.ones((3, 4))),
        ("kinds", np.full(3, Kind.UNION)),
        ("kinds", np.full(3, Kind.MESH)),
        ("masses", np.full(3, -1.0)),
        ("material_ids", np.full(3, 77)),
        ("mesh_ids", np.zeros(3)),
        ("sids", np.array([1, 2, 1])),
        ("sids", np.array([1, 2, 0])),
        ("sids", np.array([1, 2])),
        ("names", ["one"]),
    ],
)
def test_bad_columns_create_nothing(name: str, value: object) -> None:
    world = World()
    columns = BodyColumns(kinds=np.zeros(3, int), dimensions=np.tile([1.0, 0, 0, 0], (3, 1)))
    setattr(columns, name, value)
    with pytest.raises(WorldError):
        world.extend(columns)
    assert len(world.bodies) == 0 and world.names == {}


def test_views_write_into_the_world() -> None:
    world = World()
    world.extend(grid(30))
    body = world.bodies[4]
    world.linear_velocities[4] = (1, 2, 3)
    assert body.linear_velocity.tolist() == [1, 2, 3]
    world.linear_velocities *= 2
    assert body.linear_velocity.tolist() == [2, 4, 6]
    world.positions = np.ones((30, 3))
    assert body.position.tolist() == [1, 1, 1]
    for name in ("sids", "kinds", "dimensions", "mesh_ids"):
        with pytest.raises(ValueError, match="read-only"):
            getattr(world, name)[0] = 0
    with pytest.raises(ValueError, match="read-only"):
        body.position[0] += 99
    assert body.position[0] == 1


@given(st.tuples(*[st.floats(-9, 9)] * 3))
def test_planes_follow_when_columns_move_them(shift: tuple[float, float, float]) -> None:
    world = World()
    plane = world.create_plane(1, (0, 0.6, 0.8), 0.1, "iron")
    assert plane.displacement == 0.1
    world.positions += shift
    expected = 0.1 + 0.6 * shift[1] + 0.8 * shift[2]
    assert plane.displacement == pytest.approx(expected, abs=1e-12)
    assert world.dimensions[0, 3] == plane.displacement
    plane.rotate(0.5, 0, 0)
    assert plane.normal == pytest.approx([0, 0.6 * np.cos(0.5) - 0.8 * np.sin(0.5),
                                          0.6 * np.sin(0.5) + 0.8 * np.cos(0.5)])  # fmt: skip
