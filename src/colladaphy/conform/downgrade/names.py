"""Names: any text in 1.5, an NCName in 1.4.1."""

from __future__ import annotations

from colladaphy.conform.downgrade import rules
from colladaphy.conform.downgrade.draft import Draft, local
from colladaphy.conform.lexical import name_from

__all__ = ["change_names"]


def change_names(draft: Draft) -> None:
    """Replace what an NCName cannot hold in every name but that of a unit."""
    for element in draft.everything():
        name = element.get("name")
        if name is None or local(element) == "unit":
            continue
        new = name_from(name)
        if new != name:
            message = f"The name {name!r} of <{local(element)}> became {new!r}."
            draft.note(rules.NAME_CHANGED, element, message)
            element.set("name", new)
