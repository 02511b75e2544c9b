"""What the meaning of a document does not depend on, and what it is."""

from __future__ import annotations

import io
import random
import re
from pathlib import Path

from hypothesis import strategies as st
from lxml import etree
from tests.mapper.reference import Reference
from tests.mapper.test_instances import check as agrees
from tests.mapper.test_instances import documents as nested

import colladaphy
from colladaphy import World, compare
from colladaphy.testing import worlds
from tools.fuzz.properties.documents import valid_loads
from tools.fuzz.registry import note, of

__all__: list[str] = []

_NUMBER = re.compile(rb"(?<=[> ])-?[0-9][0-9.e+-]*(?=[< ])")
_REFERENCE = re.compile(rb'(?<=")#?[A-Za-z]+[0-9]+(?=")')
_ODD = (b"0", b"-1", b"NaN", b"INF", b"-INF", b"1e999", b"1e-320", b"1e308", b"")
_BASES = sorted((Path(__file__).parents[3] / "tests" / "meaning" / "bases").glob("*.dae"))
NS = "{http://www.collada.org/2008/03/COLLADASchema}"


def _seeds() -> st.SearchStrategy[int]:
    return st.integers(0, 2**32)


def _edited(data: bytes, seed: int) -> bytes:
    """With numbers and references replaced by others, and by such as have no meaning."""
    chance = random.Random(seed)
    for _ in range(chance.randint(1, 3)):
        pattern = chance.choice((_NUMBER, _NUMBER, _REFERENCE))
        found = list(pattern.finditer(data))
        if found:
            place = chance.choice(found)
            others = [*_ODD] if pattern is _NUMBER else [m.group() for m in found] + [b"#none", b""]
            data = data[: place.start()] + chance.choice(others) + data[place.end() :]
    return data


def _written(world: World) -> bytes:
    stream = io.BytesIO()
    colladaphy.write(world, stream)
    return stream.getvalue()


def _edited_worlds() -> st.SearchStrategy[bytes]:
    return st.builds(_edited, worlds(extreme=False).map(_written), _seeds())


def _edited_bases() -> st.SearchStrategy[bytes]:
    bases = st.sampled_from(_BASES).map(Path.read_bytes)
    return st.builds(_edited, bases, _seeds())


@of(_edited_worlds, weight=2)
def edited_worlds_load(document: bytes) -> None:
    """What validation calls valid, loading takes; Worlds whose numbers and references changed."""
    valid_loads(note(document))


@of(_edited_bases, weight=2)
def edited_bases_load(document: bytes) -> None:
    """What validation calls valid, loading takes; the bases of the rules, changed."""
    valid_loads(note(document))


@of(nested, weight=2)
def loads_as_the_reference(document: bytes) -> None:
    """Loading says what a slow reading with matrices says."""
    agrees(colladaphy.read(note(document)).load(), Reference(document))


@of(nested, _seeds)
def order_of_libraries(document: bytes, seed: int) -> None:
    """The order of libraries, and of what is in them by id, means nothing."""
    root, chance = etree.fromstring(document), random.Random(seed)
    libraries = [child for child in root if "library_" in str(child.tag)]
    chance.shuffle(libraries)
    scene = root.find(f"{NS}scene")
    assert scene is not None
    for library in libraries:
        scene.addprevious(library)
        if library.tag in (f"{NS}library_physics_models", f"{NS}library_nodes"):
            parts = list(library)
            chance.shuffle(parts)
            library.extend(parts)
    other = colladaphy.read(note(etree.tostring(root))).load()
    assert compare(colladaphy.read(document).load(), other) == []


@of(nested)
def renamed_ids(document: bytes) -> None:
    """Ids mean what refers to them, and nothing else."""
    root = etree.fromstring(document)
    names = {
        each.get("id"): f"é-{number}" for number, each in enumerate(root.iter()) if each.get("id")
    }
    for element in root.iter(etree.Element):
        for key, value in element.attrib.items():
            if key == "id":
                element.set(key, names[value])
            elif value.startswith("#") and value[1:] in names:
                element.set(key, "#" + names[value[1:]])
    other = colladaphy.read(note(etree.tostring(root, encoding="UTF-8"))).load()
    assert compare(colladaphy.read(document).load(), other) == []
