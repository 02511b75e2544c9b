"""pymunk as an engine: scenes in which everything moves in one plane."""

from colladaphy.engines.pymunk_engine.engine import PymunkEngine

__all__ = ["PymunkEngine"]
