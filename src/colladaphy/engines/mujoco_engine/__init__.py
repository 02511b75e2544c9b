"""MuJoCo as an engine: the general scene in three dimensions.

Every top-level body that can move is one MuJoCo body; fixed bodies are part of MuJoCo's world.
Joints are joints of MuJoCo's kinematic tree: what a joint locks is locked exactly, whatever the
forces. A joint that closes a loop of joints becomes an equality constraint, which gives way a
little. Contacts are soft too, as hard as the time step allows.
"""

import mujoco as mujoco  # so that an engine that cannot work fails on import

from colladaphy.engines.mujoco_engine.engine import MujocoEngine

__all__ = ["MujocoEngine"]
