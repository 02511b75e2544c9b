"""What must hold of anything at all: a result or an error of our own, in time and memory."""

from __future__ import annotations

import io
import random
from typing import Any

from hypothesis import strategies as st

import colladaphy
from colladaphy import ColladaError, World
from colladaphy.source import pack
from colladaphy.testing import (
    BrokenDocument,
    broken_documents,
    hostile_inputs,
    mutants,
    worlds,
)
from tools.fuzz.registry import note, of

__all__ = ["survives"]


def survives(data: Any) -> None:
    """Everything that reads takes it or refuses it with an error of the one family."""
    report = colladaphy.validate(io.BytesIO(data))
    for repair in (False, True):
        try:
            document = colladaphy.read(data, repair=repair)
        except ColladaError as error:
            assert error.findings
            assert repair or not report.valid
            continue
        try:
            world = document.load()
        except ColladaError as error:
            assert error.findings
            assert repair or not report.valid
            continue
        stream = io.BytesIO()
        document.write(stream, check=False)
        colladaphy.read(stream.getvalue())
        stream = io.BytesIO()
        colladaphy.write(world, stream)


def _seeds() -> st.SearchStrategy[int]:
    return st.integers(0, 2**32)


def _bytes() -> st.SearchStrategy[bytes]:
    return st.binary(max_size=200) | st.text(max_size=100).map(str.encode) | st.lists(
        st.sampled_from([
            b"<COLLADA", b' xmlns="http://www.collada.org/2008/03/COLLADASchema"', b">", b"</",
            b"/>", b"<", b"<!--", b"-->", b"<![CDATA[", b"]]>", b"<?xml version='1.0'?>", b"&",
            b"<!DOCTYPE a [", b"<!ENTITY e 'x'>", b"]>", b"&e;", b"\xff\xfe", b"\x00",
            b' version="1.5.0"', b"asset", b"created", b"1", b"\xe2\x80\xa8", b" ", b"\xc3", b"PK",
        ])
    ).map(b"".join)  # fmt: skip


@of(_bytes)
def anything_bytes(data: bytes) -> None:
    """Bytes."""
    survives(data)


@of(mutants, weight=2)
def anything_mutants(document: bytes) -> None:
    """Documents a few changes away from valid."""
    survives(note(document))


def _damaged(world: World, seed: int) -> bytes:
    stream, chance = io.BytesIO(), random.Random(seed)
    colladaphy.write(world, stream)
    data = bytearray(stream.getvalue())
    for _ in range(chance.randint(1, 4)):
        place = chance.randrange(len(data) + 1)
        span = chance.choice((1, 1, 2, 8, 64, 500))
        match chance.randrange(5):
            case 0:
                del data[place:]
            case 1:
                data[place : place + span] = b""
            case 2:
                data[place:place] = data[place : place + span]
            case 3:
                data[place : place + 1] = bytes([chance.randrange(256)])
            case _:
                other = chance.randrange(len(data) + 1)
                data[place:place] = data[other : other + span]
    return bytes(data)


def _archived(world: World, seed: int) -> bytes:
    stream, chance = io.BytesIO(), random.Random(seed)
    colladaphy.write(world, stream)
    data = bytearray(pack(stream.getvalue(), name="a.dae", others={"b.png": b"\0" * 20}))
    for _ in range(chance.randint(1, 3)):
        data[chance.randrange(len(data))] = chance.randrange(256)
    if chance.random() < 0.2:
        del data[chance.randrange(len(data)) :]
    return bytes(data)


@of(lambda: st.builds(_damaged, worlds(), _seeds()), weight=2)
def anything_damaged(data: bytes) -> None:
    """Files of Worlds, truncated, with bytes that flipped, that are gone, that are there twice."""
    survives(data)


@of(lambda: st.builds(_archived, worlds(), _seeds()))
def anything_archived(data: bytes) -> None:
    """Archives whose bytes are damaged."""
    survives(data)


@of(hostile_inputs, weight=2)
def anything_at_all(data: bytes) -> None:
    """What attacks a reader, and what guidance by coverage found."""
    survives(data)


@of(lambda: broken_documents(errors=True), weight=2)
def anything_broken(document: BrokenDocument) -> None:
    """A document with a fault is told as that, and refused, mended or loaded without it."""
    found = {finding.code for finding in colladaphy.validate(document.data)}
    assert document.rule in found
    survives(note(document.data))
