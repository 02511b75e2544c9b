"""Force fields, which no World has, are told once a scene, and stay in the document."""

from __future__ import annotations

import io

import colladaphy
from colladaphy.world import World

FIELD = (
    '<library_force_fields><force_field id="wind"><technique profile="x"/></force_field>'
    "</library_force_fields>"
)


def test_force_fields_are_told_and_kept() -> None:
    world = World((0, 0, -9.81))
    world.create_sphere(1, (0, 0, 0), 1, "oak")
    data = io.BytesIO()
    colladaphy.write(world, data)
    plain = colladaphy.read(data.getvalue())
    plain.load()
    assert not [f for f in plain.report if f.code == "load-force-field"]
    text = data.getvalue().decode()
    text = text.replace("<library_physics_scenes>", f"{FIELD}<library_physics_scenes>")
    head, _, tail = text.partition("<instance_physics_model")
    inside = '<instance_force_field url="#wind"/>'
    tail = tail.replace("<instance_rigid_body", f"{inside}<instance_rigid_body", 1)
    text = f"{head}{inside}<instance_physics_model{tail}"
    document = colladaphy.read(text.encode())
    loaded = document.load()
    told = [f for f in document.report if f.code == "load-force-field"]
    assert len(told) == 1 and told[0].message.startswith("2 force fields")
    assert told[0].line is not None and told[0].path is not None
    assert "instance_force_field" in told[0].path
    loaded.positions += 1
    document.update(loaded)
    out = io.BytesIO()
    document.write(out)
    assert out.getvalue().count(b"instance_force_field") == 2
