"""Listing 1 of the thesis: a ground plane, a tilted box, and two spheres joined by a fixed joint.

Run it with ``python examples/listing1.py [OUT.dae]``. The scene is not planar, so that it needs
MuJoCo: ``pip install 'colladaphy[mujoco]'``.
"""

import sys

import colladaphy


def listing1() -> colladaphy.World:
    """The scene as the thesis sets it up (2.3)."""
    world = colladaphy.World(gravity=(-0.1, 0, 0))

    # A ground plane through the origin with the normal (1, 0, 0), made of copper, immovable.
    plane = world.create_plane(1, (1, 0, 0), 0, "copper")
    plane.fixed = True

    # A box of oak with sides of length 2 around (1, 0, 0), turned by 0.2 about the x axis.
    box = world.create_box(1, (1, 0, 0), (2, 2, 2), "oak")
    box.rotate(0.2, 0, 0)

    # Two spheres of iron that are held together.
    sphere1 = world.create_sphere(1, (2, 4, 0), 0.5, "iron")
    sphere2 = world.create_sphere(1, (2, 5, 1), 0.5, "iron")
    world.attach_fixed_joint(sphere1, sphere2, uid=1)
    sphere1.linear_velocity = (0, -0.4, 0)
    return world


def main() -> None:
    """Run 100 steps of 0.5 and write the result."""
    world = listing1()
    simulation = colladaphy.Simulation(world, dt=0.5)
    print(simulation.run(100))
    for body in world.bodies:
        print(body, body.position.round(3).tolist())
    colladaphy.write(world, sys.argv[1] if len(sys.argv) > 1 else "listing1.dae")


if __name__ == "__main__":
    main()
