"""Ids that the schema allows and a World cannot hold."""

from __future__ import annotations

import io
import re

import pytest

import colladaphy
from colladaphy.world import World


@pytest.mark.parametrize("number", [2**63 - 1, 2**63, -(2**63) - 1, 10**40])
def test_an_id_of_any_size_loads(number: int) -> None:
    world = World()
    box = world.create_box(7, (0, 0, 0), (1, 1, 1), "iron")
    ball = world.create_sphere(8, (0, 0, 3), 1, "iron")
    union = world.create_union(9, [box, ball])
    world.attach_fixed_joint(union, world.create_sphere(5, (9, 0, 0), 1, "iron"), uid=6)
    stream = io.BytesIO()
    colladaphy.write(world, stream)
    data = re.sub(rb' uid="\d+"', f' uid="{number}"'.encode(), stream.getvalue())
    assert data != stream.getvalue()
    document = colladaphy.read(data)
    again = document.load()
    fits = number < 2**63 and number >= -(2**63)
    assert [body.uid for body in again.bodies] == [number if fits else 0] * 2
    assert [joint.uid for joint in again.joints] == [number if fits else 0]
    codes = [finding.code for finding in document.report]
    assert codes == ([] if fits else ["load-id-large"] * 3)
    assert all(finding.line for finding in document.report)
