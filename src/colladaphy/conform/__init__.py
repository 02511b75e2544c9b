"""conform: the door through which the world's files come in.

`conform` turns a foreign document into schema-valid COLLADA 1.5 with the standard's own meaning:
1.4 is upgraded, deviations are repaired, and what a producer meant differently (frames, units,
references) is rewritten. Every change is a finding. What cannot stay is kept in an extra.

References of the result have one form each:

- ``instance_rigid_body/@body`` and ``instance_rigid_constraint/@constraint``: the plain sid of a
  body or constraint in the instanced physics model (the schema allows nothing else there);
- ``attachment/@rigid_body`` and ``ref_attachment/@rigid_body``: ``model-id/sid``, an address as
  the standard's SID addressing has it (an id, then sids), with the sid of an instance between
  (``model-id/instance-sid/sid``) for a body of a model instanced in the model; ``#node-id`` for a
  visual node; and ``""`` for the world.

Content that conform made up or moved is marked in the namespace ``urn:colladaphy:conform:1``:
``moved``, ``text``, ``value`` and ``attribute`` hold what had no place, ``assumed`` marks a shape
that the file did not give (``from="visual"``: it is the geometry that the body's node shows;
``from="nothing"``: it is the hull of nothing, and only makes the document valid), and
``convention`` in an extra of the document says whose meaning was translated, so that nothing is
translated twice. Its ``digits`` are the significant digits that converted values had in the file:
what is compared with them is to be compared no more exactly.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from colladaphy.conform.pipeline import conform as conform
    from colladaphy.conform.versions import detect_version as detect_version

# Valid documents are read without the many modules that mend others.
_HOME = {"conform": "pipeline", "detect_version": "versions"}

__all__ = ["conform", "detect_version"]


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
