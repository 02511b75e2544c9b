"""Walks two schemas together, over pairs of types, each pair once."""

from collections import deque
from typing import Any

import xmlschema

from tools.schema_equivalence import simple_types
from tools.schema_equivalence.automata import Automaton, Label, short, walk_together
from tools.schema_equivalence.derivation import ancestors, control
from tools.schema_equivalence.report import Comparison


def compare(
    ours: xmlschema.XMLSchema10, official: xmlschema.XMLSchema10, *, names: bool = False
) -> Comparison:
    """Compares two schemas of one target namespace.

    With ``names`` every global type must exist on both sides under the same name and be equal, and
    elements must be declared with types of the same name: what ``xsi:type`` can tell apart, and
    what no element uses, is compared too.
    """
    walk = _Walk(names)
    namespace = official.target_namespace
    if walk.found.expect("schema", "target namespace", ours.target_namespace, namespace):
        walk.globals(ours.maps, official.maps, namespace)
        walk.run()
    return walk.found


class _Walk:
    def __init__(self, names: bool) -> None:
        self.found = Comparison()
        self._names = names
        self._seen: set[tuple[int, int]] = set()
        self._queue: deque[tuple[Any, Any, str]] = deque()

    def globals(self, ours: Any, official: Any, namespace: str) -> None:
        tables = [("element", ours.elements, official.elements, self._element)]
        tables.append(("attribute", ours.attributes, official.attributes, self._attribute))
        if self._names:
            tables.append(("type", ours.types, official.types, self._types))
        for kind, mine, theirs, pair in tables:
            all_names = {name for name in (*mine, *theirs) if _namespace(name) == namespace}
            for name in sorted(all_names):
                path = f"{kind} {name.rpartition('}')[2]}"
                if self.found.expect(path, "global", name in mine, name in theirs):
                    pair(mine[name], theirs[name], path)

    def run(self) -> None:
        while self._queue:
            self._type(*self._queue.popleft())

    def _types(self, ours: Any, official: Any, path: str) -> None:
        if (id(ours), id(official)) not in self._seen:
            self._seen.add((id(ours), id(official)))
            self._queue.append((ours, official, path))

    def _type(self, ours: Any, official: Any, path: str) -> None:
        self.found.counts["types"] += 1
        if simple_types.is_builtin(ours) and simple_types.is_builtin(official):
            self.found.expect(path, "type", ours.name, official.name)
            return
        if ours.name and official.name:
            self.found.expect(path, "derivation", ancestors(ours), ancestors(official))
            self.found.expect(path, "final", control(ours.final), control(official.final))
        if not self.found.expect(path, "content", _content_kind(ours), _content_kind(official)):
            return
        if ours.is_simple():
            self._simple(ours, official, path)
            return
        self.found.expect(path, "abstract", bool(ours.abstract), bool(official.abstract))
        self.found.expect(path, "block", control(ours.block), control(official.block))
        self._attributes(ours.attributes, official.attributes, path)
        if ours.has_simple_content():
            self._simple(ours.content, official.content, path)
        else:
            self._content(Automaton(ours.content), Automaton(official.content), path)

    def _simple(self, ours: Any, official: Any, path: str) -> None:
        self.found.expect(
            path,
            "simple type",
            simple_types.signature(ours, self._names),
            simple_types.signature(official, self._names),
        )

    def _attributes(self, ours: Any, official: Any, path: str) -> None:
        for name in sorted({*ours, *official}, key=str):
            mine, theirs = ours.get(name), official.get(name)
            here = f"{path}/@{'*' if name is None else name}"
            if not self.found.expect(here, "declared", mine is not None, theirs is not None):
                continue
            if name is None:
                self.found.expect(here, "wildcard", _wildcard(mine), _wildcard(theirs))
                continue
            self.found.expect(here, "use", mine.use, theirs.use)
            self._attribute(mine, theirs, here)

    def _attribute(self, ours: Any, official: Any, path: str) -> None:
        self.found.counts["attributes"] += 1
        self._values(ours, official, path)
        self._types(ours.type, official.type, path)

    def _values(self, ours: Any, official: Any, path: str) -> None:
        for aspect in ("default", "fixed"):
            mine, theirs = (
                simple_types.value(side.type, getattr(side, aspect)) for side in (ours, official)
            )
            # In one type's value space; a difference of the types themselves is found with them.
            self.found.expect(path, aspect, mine, theirs)

    def _content(self, ours: Automaton, official: Automaton, path: str) -> None:
        meetings: dict[tuple[int, int], Label] = {}
        for word, mine, theirs, my_steps, their_steps in walk_together(ours, official):
            self.found.counts["states"] += 1
            where = f"after children [{word}]"
            may_end = ours.is_final(mine), official.is_final(theirs)
            same_end = self.found.expect(path, f"{where} may end", *may_end)
            allowed = set(my_steps), set(their_steps)
            if not (self.found.expect(path, f"{where} allowed next", *allowed) and same_end):
                break  # what follows a difference differs too
            for found in my_steps.keys() & their_steps.keys():
                for position in my_steps[found]:
                    for other in their_steps[found]:
                        meetings[position, other] = found
        done: set[tuple[int, int]] = set()
        for (position, other), found in sorted(meetings.items()):
            pair = ours.particles[position], official.particles[other]
            key = id(pair[0]), id(pair[1])
            if found[0] == "element" and key not in done:
                done.add(key)
                self._element(*pair, f"{path}/{short(found)}")

    def _element(self, ours: Any, official: Any, path: str) -> None:
        self.found.counts["elements"] += 1
        ours, official = ours.ref or ours, official.ref or official
        for aspect in ("nillable", "abstract"):
            mine, theirs = (bool(getattr(side, aspect)) for side in (ours, official))
            self.found.expect(path, aspect, mine, theirs)
        for aspect in ("block", "final"):
            mine_set, theirs_set = (control(getattr(side, aspect)) for side in (ours, official))
            self.found.expect(path, aspect, mine_set, theirs_set)
        heads = (side.substitution_group for side in (ours, official))
        self.found.expect(path, "substitution group", *heads)
        self.found.expect(path, "identity constraints", _identities(ours), _identities(official))
        self._values(ours, official, path)
        if self._names:
            self.found.expect(path, "name of the type", ours.type.name, official.type.name)
        self._types(ours.type, official.type, path)


def _namespace(name: str) -> str:
    return name[1:].partition("}")[0] if name.startswith("{") else ""


def _content_kind(declared: Any) -> str:
    if declared.is_simple():
        return "simple type"
    if declared.has_simple_content():
        return "simple content"
    return "mixed" if declared.mixed else "elements"


def _wildcard(wildcard: Any) -> tuple[frozenset[str], str]:
    return frozenset(wildcard.namespace), wildcard.process_contents


def _identities(element: Any) -> frozenset[tuple[Any, ...]]:
    return frozenset(
        (
            type(constraint).__name__,
            constraint.name,
            constraint.selector.path,
            tuple(field.path for field in constraint.fields),
            getattr(getattr(constraint, "refer", None), "name", None),
        )
        for constraint in element.identities
    )
