"""Whether a body that is given belongs to a World."""

from __future__ import annotations

from colladaphy.world.body import Body
from colladaphy.world.rules import ARGUMENT, BODY_GONE, refuse
from colladaphy.world.storage import Storage

__all__ = ["sid_of", "sid_or_world"]


def sid_of(storage: Storage, body: Body) -> int:
    """The system id of a body that is alive in a World, or WorldError."""
    if not isinstance(body, Body):
        raise refuse(ARGUMENT, f"{body!r} is not a body.")
    if body._storage is not storage:
        raise refuse(BODY_GONE, f"{body!r} belongs to another World.")
    storage.locate(body.sid)
    return body.sid


def sid_or_world(storage: Storage, body: Body | None) -> int:
    """The same, or 0 for None, which stands for the world itself."""
    return 0 if body is None else sid_of(storage, body)
