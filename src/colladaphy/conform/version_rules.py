"""Rules of conform: the way from 1.4 to 1.5."""

from __future__ import annotations

from colladaphy.findings import Rule, Severity

__all__ = ["RULES"]

_INFO, _WARNING, _ERROR = Severity.INFO, Severity.WARNING, Severity.ERROR

VERSION = Rule(
    "upgrade-version",
    _INFO,
    "the document was COLLADA 1.4",
    "it is read as the same document in COLLADA 1.5",
    section="COLLADA 1.5 §COLLADA",
    why="everything after it has to know one version only",
)
SCHEMA_LOCATION = Rule(
    "upgrade-schema-location",
    _INFO,
    "the schema location named another version's schema",
    "it is only a hint and was removed",
    section="COLLADA 1.5 §COLLADA",
    why="validators would look for the wrong schema",
)
NAMESPACE_FIXED = Rule(
    "repair-namespace",
    _WARNING,
    "the COLLADA namespace was missing or unknown",
    "write the namespace of the version you mean",
    section="COLLADA 1.5 §COLLADA",
    why="without it, no program can tell that this is COLLADA",
)
VERSION_ATTRIBUTE = Rule(
    "repair-version",
    _INFO,
    "the version attribute did not fit the namespace",
    "the namespace decides",
    section="COLLADA 1.5 §COLLADA",
    why="programs that go by the attribute would read another version",
)
NOT_COLLADA = Rule(
    "repair-not-collada",
    _ERROR,
    "the document is not COLLADA",
    "its root must be <COLLADA>; nothing was changed",
    section="COLLADA 1.5 §COLLADA",
    why="there is nothing in it that could be mended",
)
TOO_WIDE = Rule(
    "repair-too-many-attributes",
    _ERROR,
    "an element has more attributes or declarations of namespaces than can be mended",
    "no such element is COLLADA's; nothing was changed",
    section="Namespaces in XML 1.0 §Declaring namespaces",
    why="to look through them takes longer the more there are, as in an attack",
)

RULES = (
    VERSION,
    SCHEMA_LOCATION,
    NAMESPACE_FIXED,
    VERSION_ATTRIBUTE,
    NOT_COLLADA,
    TOO_WIDE,
)
