"""The kinds of bodies and joints."""

from __future__ import annotations

from enum import IntEnum

__all__ = ["JointKind", "Kind"]


class Kind(IntEnum):
    """What a body is made of (thesis 2.1); the numbers are stored in the `kinds` column."""

    SPHERE = 0
    BOX = 1
    CAPSULE = 2
    CYLINDER = 3
    PLANE = 4
    ELLIPSOID = 5
    MESH = 6
    UNION = 7
    EMPTY = 8
    """No shape at all: mass and inertia alone, which nothing collides with."""


class JointKind(IntEnum):
    """What the limits of a joint amount to (thesis 2.2); derived, never stored."""

    FIXED = 0
    HINGE = 1
    SLIDER = 2
    BALL = 3
    GENERAL = 4
