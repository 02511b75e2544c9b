"""MuJoCo as an engine: the general scene in three dimensions.

Every top-level body that can move is one MuJoCo body; fixed bodies are part of MuJoCo's world.
Joints are joints of MuJoCo's kinematic tree: what a joint locks is locked exactly, whatever the
forces. A joint that closes a loop of joints becomes an equality constraint, which gives way a
little. Contacts follow restitution and friction of each pair of materials (`contacts`); what
touches nothing moves by a method of fourth order (`stepping`).

Building the model takes a time that grows with the square of the number of bodies (seconds for
thousands); it is kept as long as only the motion of the World changes.
"""

import mujoco as mujoco  # so that an engine that cannot work fails on import

from colladaphy.engines.mujoco_engine.engine import MujocoEngine

__all__ = ["MujocoEngine"]
