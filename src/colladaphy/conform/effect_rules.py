"""Rules of conform: images and effects."""

from __future__ import annotations

from colladaphy.findings import Rule, Severity

__all__ = ["RULES"]

_INFO, _WARNING = Severity.INFO, Severity.WARNING

EFFECT_IMAGE = Rule(
    "upgrade-effect-image",
    _INFO,
    "an image stood inside an effect",
    "1.5 has images in their library only",
    section="COLLADA 1.5 §image",
    why="an image inside an effect is not valid in 1.5",
)
IMAGE = Rule(
    "upgrade-image",
    _INFO,
    "an image's source is written otherwise in 1.5",
    "its location or data is unchanged",
    section="COLLADA 1.5 §init_from",
    why="the image would not be found",
)
SAMPLER = Rule(
    "upgrade-sampler",
    _INFO,
    "a sampler's content has no place in 1.5's schema",
    "it is kept in an extra of the profile",
    section="COLLADA 1.5 §sampler2D",
    why="it would not be valid in 1.5",
)
SURFACE = Rule(
    "upgrade-surface",
    _INFO,
    "a surface has no place in 1.5",
    "it is kept in an extra of the profile",
    section="COLLADA 1.5 §sampler2D",
    why="it would not be valid in 1.5",
)
SHADER_PROFILE = Rule(
    "upgrade-shader-profile",
    _WARNING,
    "a shader profile of 1.4 is built otherwise in 1.5",
    "it is kept whole in an extra of the effect",
    section="COLLADA 1.5 §effect",
    why="it would not be valid in 1.5",
)

RULES = (
    EFFECT_IMAGE,
    IMAGE,
    SAMPLER,
    SURFACE,
    SHADER_PROFILE,
)
