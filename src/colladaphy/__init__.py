"""Strict COLLADA 1.5 Physics for Python.

Read, check, mend, convert, simulate and archive rigid body scenes. Names are imported when they
are first used, so that ``import colladaphy`` costs next to nothing.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from colladaphy.version import __version__

if TYPE_CHECKING:
    from colladaphy.document import Document as Document
    from colladaphy.document import read as read
    from colladaphy.document import write as write
    from colladaphy.engines import Simulation as Simulation
    from colladaphy.errors import ColladaError as ColladaError
    from colladaphy.errors import DocumentError as DocumentError
    from colladaphy.errors import EngineError as EngineError
    from colladaphy.errors import InputError as InputError
    from colladaphy.errors import OutputError as OutputError
    from colladaphy.errors import SchemaError as SchemaError
    from colladaphy.errors import WorldError as WorldError
    from colladaphy.errors import XmlError as XmlError
    from colladaphy.findings import Finding as Finding
    from colladaphy.findings import Report as Report
    from colladaphy.findings import Severity as Severity
    from colladaphy.mapper import WriteOptions as WriteOptions
    from colladaphy.source import Limits as Limits
    from colladaphy.validation import validate as validate
    from colladaphy.world import World as World
    from colladaphy.world import compare as compare


_HOME = {
    "ColladaError": "errors",
    "Document": "document",
    "DocumentError": "errors",
    "EngineError": "errors",
    "Finding": "findings",
    "InputError": "errors",
    "Limits": "source",
    "OutputError": "errors",
    "Report": "findings",
    "SchemaError": "errors",
    "Severity": "findings",
    "Simulation": "engines",
    "World": "world",
    "WorldError": "errors",
    "WriteOptions": "mapper",
    "XmlError": "errors",
    "compare": "world",
    "read": "document",
    "validate": "validation",
    "write": "document",
}

__all__ = ["__version__", *_HOME]


def __getattr__(name: str) -> Any:
    home = _HOME.get(name)
    if home is None:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(f"{__name__}.{home}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *_HOME})
