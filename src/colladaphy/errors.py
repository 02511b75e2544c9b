"""The one family of exceptions: every error carries the findings that led to it."""

from __future__ import annotations

from collections.abc import Iterable

from colladaphy.findings import Finding

__all__ = [
    "ColladaError",
    "ConfigurationError",
    "DocumentError",
    "EngineError",
    "InputError",
    "OutputError",
    "SchemaError",
    "WorldError",
    "XmlError",
]


class ColladaError(Exception):
    """Root of all errors of colladaphy.

    `findings` says where, what and what to do next; the text of the exception is their list.
    """

    def __init__(self, message: str | Finding | Iterable[Finding], *more: Finding) -> None:
        self.findings: tuple[Finding, ...]
        if isinstance(message, str):
            self.findings = more
            text = "\n".join([message, *(f"  {finding}" for finding in more)])
        else:
            first = (message,) if isinstance(message, Finding) else tuple(message)
            self.findings = first + more
            text = "\n".join(str(finding) for finding in self.findings)
        super().__init__(text)


class InputError(ColladaError, OSError):
    """The input cannot be opened or read: missing, a folder, no permission, over a limit."""


class OutputError(ColladaError, OSError):
    """The output cannot be written; what was there before is untouched."""


class ConfigurationError(ColladaError, ValueError):
    """A configuration or a baseline that cannot be read, or says what there is not."""


class XmlError(ColladaError, ValueError):
    """The input is not well-formed XML, or uses what is refused (a DOCTYPE, too deep a tree)."""


class SchemaError(ColladaError, ValueError):
    """The document is not schema-valid COLLADA 1.5."""


class DocumentError(ColladaError, ValueError):
    """The document is schema-valid, but its references or its physics make no sense."""


class WorldError(ColladaError, ValueError):
    """A value that a World cannot hold: a radius that is not positive, a body of another World."""


class EngineError(ColladaError, RuntimeError):
    """An engine cannot run this World, or is not installed."""
