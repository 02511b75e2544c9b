"""The work of a check grows with the document, whatever is wrong with it and however often."""

from __future__ import annotations

import sys
from collections.abc import Callable
from types import FrameType
from typing import Any

import pytest

import colladaphy

HEAD = (
    '<COLLADA xmlns="http://www.collada.org/2008/03/COLLADASchema" version="1.5.0"><asset>'
    "<created>2010-01-01T00:00:00Z</created><modified>2010-01-01T00:00:00Z</modified></asset>"
)
BODY = (
    '<rigid_body sid="{sid}"><technique_common>{mass}<shape><sphere><radius>1</radius></sphere>'
    "</shape></technique_common></rigid_body>"
)


def nodes(record: str) -> Callable[[int], str]:
    def document(count: int) -> str:
        content = "".join(record.format(n=n) for n in range(count))
        return f"{HEAD}<library_nodes>{content}</library_nodes></COLLADA>"

    return document


def bodies(record: str, instance: str = "") -> Callable[[int], str]:
    def document(count: int) -> str:
        content = "".join(record.format(n=n) for n in range(count))
        users = "".join(instance.format(n=n) for n in range(count))
        return (
            f'{HEAD}<library_physics_models><physics_model id="m">{content}</physics_model>'
            '</library_physics_models><library_physics_scenes><physics_scene id="s">'
            f'<instance_physics_model url="#m">{users}</instance_physics_model><technique_common/>'
            "</physics_scene></library_physics_scenes></COLLADA>"
        )

    return document


KINDS = {
    "dangling": nodes('<node id="n{n}"><instance_node url="#none{n}"/></node>'),
    "other case": nodes('<node id="n{n}"><instance_node url="#N{n}"/></node>'),
    "no hash": nodes('<node id="n{n}"><instance_camera url="n{n}"/></node>'),
    "other type": nodes('<node id="n{n}"><instance_camera url="#n{n}"/></node>'),
    "same id": nodes('<node id="n"/>'),
    "value": nodes('<node id="n{n}"><translate>a{n} 0 0</translate></node>'),
    "element": nodes('<node id="n{n}"><wrong{n}/></node>'),
    "order": nodes('<node id="n{n}"><node/><translate>0 0 0</translate></node>'),
    "attribute": nodes('<node id="n{n}" wrong="{n}"/>'),
    "same sid": bodies(BODY.format(sid="b", mass="")),
    "negative mass": bodies(BODY.format(sid="b{n}", mass="<mass>-1</mass>")),
    "lost body": bodies(
        BODY.format(sid="b{n}", mass=""),
        '<instance_rigid_body body="x{n}" target="#n"><technique_common/></instance_rigid_body>',
    ),
}


def work(data: bytes) -> int:
    """Lines of Python that a check takes, turns of loops included."""
    lines = 0

    def step(frame: FrameType, event: str, argument: Any) -> Any:
        nonlocal lines
        lines += event == "line"
        return step

    before = sys.gettrace()
    sys.settrace(step)
    try:
        report = colladaphy.validate(data)
    finally:
        sys.settrace(before)
    assert len(report) > 0
    return lines


@pytest.mark.parametrize("kind", KINDS)
def test_work_grows_with_the_document(kind: str) -> None:
    few, many = (KINDS[kind](count).encode() for count in (250, 1000))
    colladaphy.validate(few)  # what is made once
    assert work(many) < 5.0 * work(few)
