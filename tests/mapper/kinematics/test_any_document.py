"""Kinematics of any valid document are read, or said not to be, and never stop a load."""

from __future__ import annotations

import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.mapper.kinematics.robots import Arm, Segment, document

import colladaphy
from colladaphy.errors import ColladaError
from colladaphy.testing import covering_documents, documents


def load(data: bytes) -> None:
    try:
        world = colladaphy.read(data).load()
    except ColladaError:
        return
    for joint in world.joints:
        assert np.isfinite(np.concatenate([*joint.frame1, *joint.frame2])).all()


@settings(max_examples=100, deadline=None)
@given(documents(areas=["kinematics"]))
def test_any_valid_document(data: bytes) -> None:
    load(data)


@pytest.mark.parametrize("data", list(covering_documents()))
def test_documents_that_cover_the_schema(data: bytes) -> None:
    load(data)


_DATA = document(Arm([Segment(limits=(-10.0, 20.0)), Segment(kind="prismatic")]))
_NAMES = rb'(?:ref|axis|joint|url|node|target|symbol|sid)="([^"]+)"'
_REFERENCES = sorted(
    {*re.findall(_NAMES, _DATA), *re.findall(rb"<(?:SIDREF|param)>([^<]+)<", _DATA)}
)


@settings(max_examples=150, deadline=None)
@given(st.data())
def test_references_that_lead_elsewhere(draw: st.DataObject) -> None:
    # Each place holds another of the references: paths to others, to themselves, round in circles.
    changed = _DATA
    for _ in range(draw.draw(st.integers(1, 3))):
        old, new = (draw.draw(st.sampled_from(_REFERENCES)) for _ in range(2))
        places = [found.start() for found in re.finditer(re.escape(b'"' + old + b'"'), changed)]
        places += [found.start() for found in re.finditer(re.escape(b">" + old + b"<"), changed)]
        if places:
            at = draw.draw(st.sampled_from(places)) + 1
            changed = changed[:at] + new + changed[at + len(old) :]
    load(changed)
