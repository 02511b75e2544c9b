"""What is measured: the ways to read and to write a World of spheres, or of another kind."""

from __future__ import annotations

from collections.abc import Callable
from io import BytesIO
from pathlib import Path

STOCK = ("xsdata parse", "xsdata serialize")
STEPS = ("parse", "load", "store", "schema", "validate", *STOCK)
KIND_STEPS = ("parse", "gate", "load", "schema", "validate", "store")


def document(count: int, kind: str = "spheres") -> bytes:
    """The file of a World of a kind of KINDS."""
    from tools.bench.kinds import KINDS

    return KINDS[kind].document(count)


def steps_of(kind: str) -> tuple[str, ...]:
    """The steps that tell kinds apart; there is nothing to store of a file that was edited."""
    from tools.bench.kinds import KINDS

    return KIND_STEPS if KINDS[kind].edit is None else KIND_STEPS[:-1]


def prepare(step: str, file: Path, kind: str = "spheres") -> Callable[[], object]:
    """A step of STEPS as a function of nothing, with everything it needs already there."""
    if step == "parse":
        from lxml import etree

        return lambda: etree.parse(str(file))
    data = file.read_bytes()
    if step in STOCK:
        return _stock(step, data)
    if step == "gate":
        from colladaphy.gate import is_valid_text

        return lambda: is_valid_text(data)

    if step == "schema":
        from lxml import etree

        from colladaphy.gate.schema import compiled

        schema = compiled()
        return lambda: schema.validate(etree.fromstring(data))

    import colladaphy

    if step == "validate":
        return lambda: colladaphy.validate(data)
    if step == "load":
        return lambda: colladaphy.read(data).load()

    from tools.bench.kinds import KINDS

    options = KINDS[kind].write_options
    world = colladaphy.read(data).load()
    return lambda: colladaphy.write(world, BytesIO(), options=options)


def _stock(step: str, data: bytes) -> Callable[[], object]:
    from xsdata.formats.dataclass.context import XmlContext
    from xsdata.formats.dataclass.parsers import XmlParser
    from xsdata.formats.dataclass.serializers import XmlSerializer

    import colladaphy_schema
    from colladaphy_schema import Collada

    colladaphy_schema.load_all()
    context = XmlContext()
    parser = XmlParser(context=context)
    if step == "xsdata parse":
        return lambda: parser.from_bytes(data, Collada)
    root = parser.from_bytes(data, Collada)
    serializer = XmlSerializer(context=context)
    return lambda: serializer.render(root)
