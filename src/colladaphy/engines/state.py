"""An engine's own state in a World, tied to the World that it belongs to.

The bytes of `World.engine_state` begin with a line of ours::

    colladaphy-engine-state 1 <sha256 of the World, as hexadecimal digits>\\n

and go on with the engine's bytes. The digest covers all that `colladaphy.world.compare` compares,
except the engine's state itself. It serves two ends: an edited World never gets the state of the
World before the edit, and a checkpoint that was damaged on its disk is recognised.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from typing import TYPE_CHECKING

from colladaphy.engines.digest import digest
from colladaphy.engines.rules import STATE_BROKEN, STATE_ENGINE, STATE_STALE, STATE_VERSION

if TYPE_CHECKING:
    from colladaphy.findings import Finding
    from colladaphy.world import EngineState, World

__all__ = ["Unpacked", "pack", "recorded_digest", "unpack"]

_MAGIC = b"colladaphy-engine-state 1 "
_DIGITS = 2 * hashlib.sha256().digest_size
_HEAD = len(_MAGIC) + _DIGITS + 1


@dataclass(frozen=True, slots=True)
class Unpacked:
    """What `unpack` gives: the engine's bytes or None, and why it is None."""

    data: bytes | None
    findings: tuple[Finding, ...] = ()


def pack(world: World, engine: str, version: str, data: bytes = b"") -> None:
    """Set `world.engine_state`; call it last, when everything else is stored in `world`."""
    from colladaphy.world import EngineState

    head = _MAGIC + digest(world).encode("ascii") + b"\n"
    world.engine_state = EngineState(engine=engine, version=version, data=head + data)


def unpack(world: World, engine: str, version: str) -> Unpacked:
    """The bytes that `engine` packed into `world`, if they are still good for both."""
    state = world.engine_state
    if state is None:
        return Unpacked(None)
    if state.engine != engine:
        message = f"The state was stored by {state.engine} {state.version}; {engine} goes on."
        return Unpacked(None, (STATE_ENGINE.at(message=message),))
    if state.version != version:
        message = f"The state was stored by {engine} {state.version}; {engine} {version} goes on."
        return Unpacked(None, (STATE_VERSION.at(message=message),))
    recorded = recorded_digest(state)
    if recorded is None:
        return Unpacked(None, (STATE_BROKEN.at(),))
    if recorded != digest(world):
        return Unpacked(None, (STATE_STALE.at(),))
    return Unpacked(state.data[_HEAD:])


def recorded_digest(state: EngineState) -> str | None:
    """The digest of the World at the time of `pack`; None if the state is not made by `pack`."""
    head = state.data[:_HEAD]
    if len(head) != _HEAD or not head.startswith(_MAGIC) or not head.endswith(b"\n"):
        return None
    return head[len(_MAGIC) : -1].decode("ascii", "replace")
