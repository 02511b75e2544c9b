"""Worlds that go on: what a run or an editor may change in one."""

from __future__ import annotations

from random import Random

from colladaphy.world import EngineState, World


def change(changed: World, random: Random) -> None:
    """Change poses, velocities, forces, clock and engine state; bodies and joints go."""
    for moved in changed.bodies:
        if random.random() < 0.5:
            moved.position = [random.uniform(-9, 9) for _ in range(3)]
        if random.random() < 0.5:
            moved.rotate(random.random(), random.random(), random.random())
        if random.random() < 0.5:
            moved.linear_velocity = [random.uniform(-9, 9) for _ in range(3)]
            moved.angular_velocity = [random.uniform(-9, 9) for _ in range(3)]
        if random.random() < 0.3:
            moved.force, moved.sleeping = (1.0, 2.0, random.random()), True
        if random.random() < 0.2:
            moved.fixed = not moved.fixed
        if random.random() < 0.2:
            changed.destroy(moved)
    if len(changed.joints) and random.random() < 0.3:
        changed.destroy_joint(changed.joints[0])
    changed.time, changed.step_count = random.random(), 7
    changed.engine_state = EngineState("one", "2", random.randbytes(9))
