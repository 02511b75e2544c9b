"""Robots as OpenRAVE, ROS's urdf_to_collada and OpenHRP3 write them: COLLADA 1.5, never valid.

Mass frames and shapes are in the space of the model's root node with all joints at zero; the
nodes hang in each other, or in a library of nodes that the scene instances; kinematics, motion
and the binds between them stand beside the physics.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from hypothesis import strategies as st

from colladaphy.testing.markup import collada, dates, library, numbers, tag
from colladaphy.testing.producers.markup import (
    geometry,
    matrix_element,
    primitive,
    steps_of,
    transforms,
)
from colladaphy.testing.producers.truth import Link, Scene, Solid, matrix_of

QUIRKS = (
    "asset-order",
    "bare-instances",
    "binds",
    "body-paths",
    "contact-extra",
    "digits",
    "empty-kinematics",
    "empty-libraries",
    "empty-technique-sids",
    "library-root-moved",
    "matrix-mass-frame",
    "moved-joints",
    "no-shapes",
    "no-time-zone",
    "nodes-in-library",
    "order-of-libraries",
    "profile",
    "shape-transform-first",
    "vertices-ids",
)
TOOLS = {"openrave": "OpenRAVE", "ros": "URDF Collada Writer", "openhrp3": "OpenHRP3"}


@st.composite
def robots(draw: st.DrawFn, kinds: tuple[str, ...] = ("mesh",)) -> Scene:
    """A chain or tree of links, each of which shows what it is made of."""
    links = []
    for number in range(draw(st.integers(2, 5))):
        near = st.integers(-200, 200).map(lambda n: n / 1000)
        far = st.sampled_from([-1.5, -0.9, 0.7, 1.1])
        steps = (
            ("translate", (draw(far), draw(near), draw(far))),
            ("rotate", (0.0, 0.0, 1.0, float(draw(st.integers(-180, 180))))),
            ("rotate", (1.0, 0.0, 0.0, float(draw(st.integers(-180, 180))))),
        )
        made = []
        for _ in range(draw(st.integers(1, 2))):
            kind = draw(st.sampled_from(kinds))
            sides = {"box": 3, "mesh": 3, "sphere": 1, "cylinder": 2, "capsule": 2}[kind]
            size = tuple(draw(st.integers(50, 300)) / 1000 for _ in range(sides))
            shift = ("translate", (draw(near), draw(near), draw(near)))
            made.append(Solid(kind, size, (shift, ("rotate", (0.0, 1.0, 0.0, 30.0)))))
        middle = made[0].steps[0][1]
        x, y, z = (draw(st.integers(1, 50)) / 1000 for _ in range(3))
        links.append(
            Link(
                name=f"rigid{number}",
                steps=steps,
                solids=tuple(made),
                mass=draw(st.integers(1, 9000)) / 100,
                centre=(("translate", middle), ("rotate", (0.6, 0.0, 0.8, 40.0))),
                inertia=(round(y + z, 6), round(x + z, 6), round(x + y, 6)),
                parent=draw(st.integers(0, number - 1)) if number else None,
            )
        )
    root = (("translate", (3.0, -4.0, 0.5)), ("rotate", (0.0, 0.0, 1.0, 90.0)))
    return Scene(tuple(links), root=draw(st.sampled_from([(), root])))


def meant(scene: Scene, quirks: frozenset[str]) -> Scene:
    """The scene as it is shown: with the joints turned, where the file has them so."""
    if "moved-joints" not in quirks:
        return scene
    links = [replace(link, joint=25.0 * index) for index, link in enumerate(scene.links)]
    return replace(scene, links=tuple(links))


def write(scene: Scene, producer: str, quirks: frozenset[str]) -> bytes:
    """The file that the producer writes of a robot."""
    libraries = [
        _visuals(scene, quirks),
        library("geometries", *_geometries(scene, quirks)),
        _effects(scene, quirks),
        _kinematics(scene, quirks),
        _scenes(scene, quirks),
        library("physics_models", tag("physics_model", *_bodies(scene, quirks), id="pmodel0")),
    ]
    if "order-of-libraries" in quirks:
        libraries.reverse()
    if "empty-libraries" in quirks:
        libraries.append(tag("library_joints") + tag("library_physics_materials", id="none"))
    kinematic = tag("instance_kinematics_scene", *_binds(scene, quirks), url="#kscene")
    effect = tag(
        "scene",
        tag("instance_physics_scene", url="#pscene"),
        tag("instance_visual_scene", url="#vscene"),
        kinematic,
    )
    extra = ""
    if "profile" in quirks:
        technique = tag("technique", tag("sensor", tag("value", "sonar")), profile="OpenRAVE")
        extra = tag("extra", technique, id="sensors", type="library_sensors")
    return collada("1.5.0", _asset(producer, quirks), *libraries, effect, extra)


def _asset(producer: str, quirks: frozenset[str]) -> str:
    contributor = tag("contributor", tag("authoring_tool", TOOLS[producer]))
    when = "2013-02-01T10:00:00+0900" if "no-time-zone" in quirks else "2013-02-01T10:00:00Z"
    unit, axis = tag("unit", name="meter", meter="1"), tag("up_axis", "Z_UP")
    if "asset-order" in quirks:
        return tag("asset", contributor, axis, tag("subject", "robot"), unit, dates(when))
    return tag("asset", contributor, dates(when), tag("subject", "robot"), unit, axis)


def _shown(scene: Scene, index: int) -> str:
    """What a link shows: its solids, in nodes of their own where they are moved."""
    shown = []
    for number, solid in enumerate(scene.links[index].solids):
        use = tag("instance_geometry", url=f"#g{index}_{number}")
        shown.append(tag("node", transforms(solid.steps), use, name="geometry"))
    return "".join(shown)


def _node(scene: Scene, index: int, quirks: frozenset[str]) -> str:
    inner = "".join(
        _node(scene, child, quirks)
        for child, link in enumerate(scene.links)
        if link.parent == index
    )
    angle = scene.links[index].joint
    axis = tag("rotate", numbers((0, 0, 1, angle)), sid=f"node_joint{index}_axis0")
    return tag(
        "node",
        transforms(scene.links[index].steps),
        axis,
        _shown(scene, index),
        inner,
        id=f"node{index}",
        sid=f"node{index}",
        name=scene.links[index].name,
    )


def _visuals(scene: Scene, quirks: frozenset[str]) -> str:
    tops = "".join(_node(scene, i, quirks) for i, link in enumerate(scene.links) if not i)
    assert all(link.parent is not None for link in scene.links[1:])
    nodes = ""
    place = transforms(scene.root)
    if "nodes-in-library" in quirks:
        inner = place if "library-root-moved" in quirks else ""
        place = "" if inner else place
        nodes = library("nodes", tag("node", inner, tops, id="v1", name="robot"))
        tops = tag("instance_node", url="#v1")
    root = tag("node", place, tops, id="visual0", sid="visual0", name="robot")
    return library("visual_scenes", tag("visual_scene", root, id="vscene")) + nodes


def _geometries(scene: Scene, quirks: frozenset[str]) -> list[str]:
    found = []
    for index, link in enumerate(scene.links):
        for number, solid in enumerate(link.solids):
            found.append(
                geometry(
                    f"g{index}_{number}",
                    Solid("mesh", solid.size if len(solid.size) == 3 else (0.1, 0.1, 0.1)),
                    vertices="vertices" if "vertices-ids" in quirks else None,
                    digits="2490374" if "digits" in quirks else None,
                )
            )
    return found


def _effects(scene: Scene, quirks: frozenset[str]) -> str:
    sid = "" if "empty-technique-sids" in quirks else "common"
    colour = tag("diffuse", tag("color", "0.25 0.5 0.75 1"))
    effects = "".join(
        tag("effect", tag("profile_COMMON", tag("technique", tag("phong", colour), sid=sid)),
            id=f"e{index}")
        for index in range(len(scene.links))
    )  # fmt: skip
    materials = "".join(
        tag("material", tag("instance_effect", url=f"#e{index}"), id=f"m{index}")
        for index in range(len(scene.links))
    )
    return library("effects", effects) + library("materials", materials)


def _kinematics(scene: Scene, quirks: frozenset[str]) -> str:
    joints = "".join(
        tag(
            "joint",
            tag(
                "revolute",
                tag("axis", "0 0 1"),
                tag("limits", tag("min", "-90"), tag("max", "90")),
                sid="axis0",
            ),
            sid=f"joint{index}",
            name=f"joint{index}",
        )
        for index in range(1, len(scene.links))
    )
    links = "".join(
        tag("attachment_full", tag("link", sid=f"link{index}"), joint=f"kmodel0/joint{index}")
        for index in range(1, len(scene.links))
    )
    model = tag(
        "kinematics_model",
        tag("technique_common", joints, tag("link", links, sid="link0")),
        id="kmodel0",
    )
    axes = "".join(
        tag(
            "axis_info",
            tag("active", tag("bool", "true")),
            tag("locked", tag("bool", "false")),
            sid=f"info{index}",
            axis=f"kmodel0/joint{index}/axis0",
        )
        for index in range(1, len(scene.links))
    )
    if "empty-kinematics" in quirks:
        axes = ""
    instance = tag(
        "instance_kinematics_model",
        tag("newparam", tag("SIDREF", "robot0_kinematics/kmodel0_inst"), sid="robot0_inst"),
        url="#kmodel0",
        sid="kmodel0_inst",
    )
    kinematics = tag("kinematics", instance, tag("technique_common", axes))
    speeds = "".join(
        tag("axis_info", tag("speed", tag("float", "2.5")), axis=f"robot0_kinematics/info{index}")
        for index in range(1, len(scene.links))
    )
    if "empty-kinematics" in quirks:
        speeds = ""
    motion = tag(
        "motion",
        tag("instance_articulated_system", url="#robot0_kinematics"),
        tag("technique_common", speeds),
    )
    kscene = tag(
        "kinematics_scene",
        tag("instance_articulated_system", url="#robot0_motion", sid="robot0_motion_inst"),
        id="kscene",
    )
    return (
        library("kinematics_models", model)
        + library(
            "articulated_systems",
            tag("articulated_system", motion, id="robot0_motion"),
            tag("articulated_system", kinematics, id="robot0_kinematics"),
        )
        + library("kinematics_scenes", kscene)
    )


def _binds(scene: Scene, quirks: frozenset[str]) -> list[str]:
    if not quirks & {"binds", "moved-joints"}:
        return []
    model = tag("bind_kinematics_model", tag("param", "kscene_inst"), node="visual0/node0")
    axes = [
        tag(
            "bind_joint_axis",
            tag("axis", tag("param", f"kscene_joint{index}")),
            tag("value", tag("float", "0")),
            target=f"node0/node{index}/node_joint{index}_axis0",
        )
        for index in range(1, len(scene.links))
    ]
    return [model, *axes]


def _scenes(scene: Scene, quirks: frozenset[str]) -> str:
    inner = "" if "bare-instances" in quirks else tag("technique_common")
    path = "pmodel0/" if "body-paths" in quirks else ""
    users = "".join(
        tag("instance_rigid_body", inner, body=f"{path}{link.name}", target=f"#node{index}")
        for index, link in enumerate(scene.links)
    )
    model = tag(
        "instance_physics_model", users, url="#pmodel0", sid="pmodel0_inst", parent="#visual0"
    )
    gravity = tag("technique_common", tag("gravity", numbers(scene.gravity or (0, 0, 0))))
    return library("physics_scenes", tag("physics_scene", model, gravity, id="pscene"))


def _bodies(scene: Scene, quirks: frozenset[str]) -> list[str]:
    found = []
    for index, link in enumerate(scene.links):
        place = scene.place_in_model(index)
        if {"nodes-in-library", "library-root-moved"} <= quirks:
            place = matrix_of(scene.root) @ place
        frame = place @ matrix_of(link.centre or ())
        rigid = transforms(steps_of(frame))
        shapes = ""
        if "no-shapes" not in quirks:
            shapes = "".join(
                _shape(f"g{index}_{number}", solid, place, quirks)
                for number, solid in enumerate(link.solids)
            )
        values = (
            tag("dynamic", "true"),
            tag("mass", numbers([link.mass])),
            tag("mass_frame", matrix_element(frame) if "matrix-mass-frame" in quirks else rigid),
            tag("inertia", numbers(link.inertia or (1, 1, 1))),
            shapes,
        )
        extra = ""
        if "contact-extra" in quirks:
            technique = tag("technique", tag("contact", tag("mu", "0.75")), profile="OpenRAVE")
            extra = tag("extra", technique, type="contact")
        found.append(
            tag("rigid_body", tag("technique_common", *values), extra, sid=link.name,
                name=link.name)
        )  # fmt: skip
    return found


def _shape(id: str, solid: Solid, place: np.ndarray, quirks: frozenset[str]) -> str:
    moved = transforms(steps_of(place @ matrix_of(solid.steps)))
    made = tag("instance_geometry", url=f"#{id}") if solid.kind == "mesh" else primitive(solid)
    if "shape-transform-first" in quirks:
        return tag("shape", moved, made)
    return tag("shape", made, moved)
