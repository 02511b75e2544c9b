"""Which file of the schema declares which type, and which types derive from which."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

from lxml import etree

from colladaphy.gate import schema_folder

__all__ = ["Areas", "areas"]

XS = "{http://www.w3.org/2001/XMLSchema}"


@dataclass
class Areas:
    """The areas of the schema, one a file."""

    includes: dict[str, list[str]] = field(default_factory=dict)
    """For every area, the areas that it builds on directly."""
    of_type: dict[str, str] = field(default_factory=dict)
    """For every global type, its area."""
    derived: dict[str, list[str]] = field(default_factory=dict)
    """For every type, the complex types that name it as their base."""

    def closure(self, names: Iterable[str]) -> frozenset[str]:
        """The areas named and all that they build on. Raises ValueError for an unknown name."""
        found: set[str] = set()
        waiting = list(names)
        while waiting:
            name = waiting.pop()
            if name not in self.includes:
                raise ValueError(
                    f"no area {name!r} in the schema; there are {', '.join(sorted(self.includes))}"
                )
            if name not in found:
                found.add(name)
                waiting += self.includes[name]
        return frozenset(found)

    def descendants(self, name: str) -> list[str]:
        """The complex types derived from a type, in any number of steps."""
        direct = self.derived.get(name, [])
        return direct + [below for child in direct for below in self.descendants(child)]


@cache
def areas() -> Areas:
    """The areas of COLLADA 1.5, read from the schema files."""
    found = Areas()
    for path in sorted((schema_folder() / "collada-1.5").glob("*.xsd")):
        schema = etree.parse(path).getroot()
        found.includes[path.stem] = [
            Path(node.get("schemaLocation", "")).stem for node in schema.iter(f"{XS}include")
        ]
        for kind in schema.iterchildren(f"{XS}simpleType", f"{XS}complexType"):
            name = kind.get("name", "")
            found.of_type[name] = path.stem
            if kind.tag == f"{XS}complexType":
                for step in kind.iterfind(f"*/{XS}extension"):
                    found.derived.setdefault(step.get("base", ""), []).append(name)
                for step in kind.iterfind(f"*/{XS}restriction"):
                    found.derived.setdefault(step.get("base", ""), []).append(name)
    return found
