"""An engine's own state in a World, tied to the World that it belongs to.

The bytes of `World.engine_state` begin with a line of ours::

    colladaphy-engine-state 2 <sha256 of the World, as hexadecimal digits> <options as JSON>\\n

and go on with the engine's bytes. The digest covers all that `colladaphy.world.compare` compares,
except the engine's state itself. It serves two ends: an edited World never gets the state of the
World before the edit, and a checkpoint that was damaged on its disk is recognised.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from colladaphy.engines.checkpoint_rules import (
    STATE_BROKEN,
    STATE_ENGINE,
    STATE_OPTIONS,
    STATE_STALE,
    STATE_VERSION,
)
from colladaphy.engines.digest import digest
from colladaphy.engines.options import Value

if TYPE_CHECKING:
    from colladaphy.findings import Finding
    from colladaphy.world import EngineState, World

__all__ = ["Unpacked", "pack", "recorded_digest", "recorded_options", "unpack"]

_MAGIC = b"colladaphy-engine-state 2 "
_DIGITS = 2 * hashlib.sha256().digest_size
_HEAD = len(_MAGIC) + _DIGITS
_MOST_OPTIONS = 10_000  # bytes


@dataclass(frozen=True, slots=True)
class Unpacked:
    """What `unpack` gives: the engine's bytes or None, and why it is None."""

    data: bytes | None
    findings: tuple[Finding, ...] = ()


def pack(
    world: World,
    engine: str,
    version: str,
    data: bytes = b"",
    options: Mapping[str, Value] | None = None,
) -> None:
    """Set `world.engine_state`; call it last, when everything else is stored in `world`."""
    from colladaphy.world import EngineState

    chosen = json.dumps(dict(options or {}), sort_keys=True, separators=(",", ":"))
    head = _MAGIC + f"{digest(world)} {chosen}\n".encode("ascii")
    world.engine_state = EngineState(engine=engine, version=version, data=head + data)


def unpack(
    world: World, engine: str, version: str, options: Mapping[str, Value] | None = None
) -> Unpacked:
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
    recorded, chosen = recorded_digest(state), recorded_options(state)
    if recorded is None or chosen is None:
        return Unpacked(None, (STATE_BROKEN.at(),))
    if chosen != dict(options or {}):
        message = f"The state was stored with {_told(chosen)}; {_told(options or {})} goes on."
        return Unpacked(None, (STATE_OPTIONS.at(message=message),))
    if recorded != digest(world):
        return Unpacked(None, (STATE_STALE.at(),))
    return Unpacked(state.data[state.data.index(b"\n") + 1 :])


def _told(options: Mapping[str, Value]) -> str:
    return ", ".join(f"{name}={value}" for name, value in sorted(options.items())) or "no options"


def recorded_digest(state: EngineState) -> str | None:
    """The digest of the World at the time of `pack`; None if the state is not made by `pack`."""
    head = state.data[: _HEAD + 1]
    if not head.startswith(_MAGIC) or not head.endswith(b" ") or len(head) != _HEAD + 1:
        return None
    return head[len(_MAGIC) : -1].decode("ascii", "replace")


def recorded_options(state: EngineState) -> dict[str, Value] | None:
    """The options of the engine at the time of `pack`; None if they cannot be understood."""
    end = state.data.find(b"\n", _HEAD, _HEAD + _MOST_OPTIONS)
    if end < 0:
        return None
    try:
        options = json.loads(state.data[_HEAD + 1 : end])
    except ValueError:
        return None
    if not isinstance(options, dict):
        return None
    plain = all(isinstance(value, (str, int, float, bool)) for value in options.values())
    return options if plain else None
