"""How a World is written (thesis 5.4: what the writer may choose)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from colladaphy.world import Body

__all__ = ["WriteOptions"]


@dataclass(frozen=True, slots=True, kw_only=True)
class WriteOptions:
    """Choices of the writer; the defaults give the smallest file that reads back exactly."""

    shape_weight: Literal["mass", "density"] = "mass"
    """Whether a shape states its mass or its density (thesis 5.4)."""
    redundant: bool = False
    """Repeat mass and material of a body where its shapes state them, and limits that are the
    default, for software that looks only there (thesis 5.4)."""
    profile: Literal["compact", "full", "none"] = "compact"
    """What the pe profile holds: what the common profile cannot say exactly; all values, so that
    software that rounds the common profile does no harm; or nothing."""
    tessellate: bool = False
    """Write primitives as meshes, for readers that know no primitives; the pe profile keeps what
    they are."""
    group: Callable[[Body], str] | None = None
    """Names the physics model that a body belongs to; without it there is one model."""
    materials: Literal["used", "all"] = "used"
    """Which materials are written (thesis 5.4: those in use)."""
    kinematics: bool = False
    """Write joints as kinematics too, for readers that look for robots, such as OpenRAVE."""
    created: str = "1970-01-01T00:00:00Z"
    """Time of creation (xs:dateTime) in the asset; fixed, so that equal Worlds give equal files."""
    title: str | None = None
    """Title in the asset."""
