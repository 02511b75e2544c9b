"""Physics models: rigid bodies, constraints, and models within models."""

from __future__ import annotations

from dataclasses import dataclass, field

from hypothesis import strategies as st

from colladaphy.testing.composing.places import Nodes, draw_steps
from colladaphy.testing.composing.shapes import FORMS, Geometries, Materials, draw_shapes, masses
from colladaphy.testing.making.scalars import several
from colladaphy.testing.markup import numbers, tag

__all__ = ["Model", "Models", "draw_values"]

_moments = st.integers(1, 40).map(lambda number: number / 8)
_ends = st.sampled_from(
    [(0.0, 0.0), (float("-inf"), float("inf")), (-45.0, 90.0), (-0.5, 0.25), (0.0, float("inf"))]
)
_stiffness = st.sampled_from([0.0, 1.5, 200.0])


def draw_values(draw: st.DrawFn, materials: Materials, *, often: bool) -> str:
    """What a body and its instance can say: dynamic, mass, mass_frame, inertia and material."""

    def says() -> bool:
        return draw(st.integers(0, 2 if often else 4)) == 1

    values = tag("dynamic", draw(st.sampled_from(["true", "false"]))) if says() else ""
    values += tag("mass", numbers([draw(masses)])) if says() else ""
    values += tag("mass_frame", draw_steps(draw, 1)) if says() else ""
    if says():  # no moment exceeds the sum of the others
        x, y, z = (draw(_moments) for _ in range(3))
        values += tag("inertia", numbers((y + z, x + z, x + y)))
    return values + (materials.use(draw) if says() else "")


@dataclass
class _Constraint:
    sid: str
    bodies: tuple[str | None, str | None]
    text: str


@dataclass
class Model:
    """A physics model, and what an instance of it has to know."""

    id: str
    bodies: list[str]
    constraints: list[_Constraint] = field(default_factory=list)
    text: str = ""


class Models:
    """The physics models of a document."""

    def __init__(
        self, mark: str, nodes: Nodes, geometries: Geometries, materials: Materials,
        features: set[str],
    ) -> None:  # fmt: skip
        self._mark = mark
        self._nodes = nodes
        self._geometries = geometries
        self._materials = materials
        self._features = features
        self.all: list[Model] = []

    def new(self, draw: st.DrawFn) -> None:
        """Makes one more model, in which earlier ones may be nested."""
        number = len(self.all)
        model = Model(f"{self._mark}p{number}", [])
        bodies = several(draw, 1, 3, lambda draw: self._body(draw, model))
        constraints = several(draw, 0, 2, lambda draw: self._constraint(draw, model))
        nested: list[str] = []
        if self.all:
            nested = several(
                draw, 0, 2, lambda draw: self.instance(draw, draw(st.sampled_from(self.all)))
            )
        if nested:
            self._features.add("nested-models")
        model.text = tag("physics_model", *bodies, *constraints, *nested, id=model.id)
        self.all.append(model)

    def _body(self, draw: st.DrawFn, model: Model) -> str:
        sid = f"{self._mark}b{len(model.bodies)}"
        model.bodies.append(sid)
        values = draw_values(draw, self._materials, often=True)
        shapes = draw_shapes(draw, self._geometries, self._materials, FORMS)
        return tag("rigid_body", tag("technique_common", values, shapes), sid=sid)

    def _constraint(self, draw: st.DrawFn, model: Model) -> str:
        sid = f"{self._mark}c{len(model.constraints)}"
        first = draw(st.sampled_from([None, *model.bodies]))
        others = [body for body in model.bodies if body != first]
        second = draw(st.sampled_from(others)) if others else None
        ends = []
        for name, end in (("ref_attachment", first), ("attachment", second)):
            spelled = "" if end is None else draw(st.sampled_from(["", "./"])) + end
            ends.append(tag(name, draw_steps(draw), rigid_body=spelled))
        flags = ""
        if draw(st.booleans()):
            flags = tag("enabled", draw(st.sampled_from(["true", "false"])))
        if draw(st.booleans()):
            flags += tag("interpenetrate", draw(st.sampled_from(["true", "false"])))
        common = tag("technique_common", flags, _limits(draw), _springs(draw))
        text = tag("rigid_constraint", *ends, common, sid=sid)
        model.constraints.append(_Constraint(sid, (first, second), text))
        return text

    def instance(self, draw: st.DrawFn, model: Model, sid: str | None = None) -> str:
        """An instance of a model, of some of its bodies and of the constraints between these."""
        counts: dict[str | None, int] = {}

        def body(draw: st.DrawFn) -> str:
            sid = draw(st.sampled_from(model.bodies))
            if counts.setdefault(sid, 0):
                self._features.add("shared-bodies")
            counts[sid] += 1
            return self._instance_of_body(draw, sid)

        bodies = several(draw, 1, len(model.bodies) + 1, body)
        constraints = [
            tag("instance_rigid_constraint", constraint=each.sid)
            for each in model.constraints
            if all(name is None or counts.get(name) == 1 for name in each.bodies)
        ]
        if constraints:
            self._features.add("constraints")
        parent = None
        if draw(st.integers(0, 2)) == 2:
            parent = f"#{self._nodes.some(draw)}"
            self._features.add("parents")
        return tag(
            "instance_physics_model", *bodies, *constraints, url=f"#{model.id}", parent=parent,
            sid=sid,
        )  # fmt: skip

    def _instance_of_body(self, draw: st.DrawFn, sid: str) -> str:
        motion = ""
        if draw(st.booleans()):
            motion = tag("angular_velocity", numbers((draw(_moments), -90.0, 0.0)))
        if draw(st.booleans()):
            motion += tag("velocity", numbers((0.0, draw(_moments), -draw(_moments))))
        values = draw_values(draw, self._materials, often=False)
        if draw(st.integers(0, 5)) == 5:
            values += draw_shapes(draw, self._geometries, self._materials, FORMS)
        if values:
            self._features.add("overrides")
        node = self._nodes.some(draw)
        common = tag("technique_common", motion, values)
        return tag("instance_rigid_body", common, body=sid, target=f"#{node}")


def _limits(draw: st.DrawFn) -> str:
    found = ""
    for name in ("swing_cone_and_twist", "linear"):
        if draw(st.booleans()):
            ends = [draw(_ends) for _ in range(3)]
            low, high = ([end[side] for end in ends] for side in (0, 1))
            found += tag(name, tag("min", numbers(low)), tag("max", numbers(high)))
    return tag("limits", found) if found else ""


def _springs(draw: st.DrawFn) -> str:
    found = ""
    for name in ("angular", "linear"):
        if draw(st.integers(0, 3)) == 3:
            values = tag("stiffness", numbers([draw(_stiffness)]))
            values += tag("damping", numbers([draw(_moments)]))
            values += tag("target_value", numbers([draw(_moments)]))
            found += tag(name, values)
    return tag("spring", found) if found else ""
