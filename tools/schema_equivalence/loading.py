"""Loads a schema offline: our stubs answer the two imports of COLLADA that go to the web."""

import warnings
from pathlib import Path

import xmlschema

ROOT = Path(__file__).resolve().parents[2]
OURS = ROOT / "schema" / "collada-1.5" / "collada.xsd"
OFFICIAL = Path("/usr/lib/opencollada/collada_schema_1_5.xsd")
"""Where Debian's opencollada-tools installs the official schema."""

STUBS = {
    "http://www.w3.org/Math/XMLSchema/mathml2/mathml2.xsd": ROOT / "schema/stubs/mathml.xsd",
    "http://www.w3.org/2001/xml.xsd": ROOT / "schema/stubs/xml.xsd",
}


class SchemaError(Exception):
    """A schema that cannot be read, is not valid, or uses what this tool does not compare."""


def load(path: Path) -> xmlschema.XMLSchema10:
    """The schema of a file with all it includes and imports. Raises SchemaError."""
    if not path.is_file():
        raise SchemaError(f"{path}: no such file")
    locations = {uri: stub.as_uri() for uri, stub in STUBS.items()}
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")  # an import that cannot be resolved is only a warning
            return xmlschema.XMLSchema10(
                str(path), uri_mapper=lambda uri: locations.get(uri, uri), allow="local"
            )
    except (xmlschema.XMLSchemaException, SyntaxError, Warning, OSError) as error:
        raise SchemaError(f"{path}: {error}") from error
