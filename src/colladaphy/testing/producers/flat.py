"""Files of COLLADA 1.4 from modellers and physics engines: bodies in their own space, few nested.

One writer, whose producers differ in what they say of themselves, in what they mean by their
numbers, and in their habits: what deviates from the standard.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from colladaphy.testing.markup import collada, dates, library, numbers, tag
from colladaphy.testing.producers.habits import Producer
from colladaphy.testing.producers.markup import (
    geometry,
    matrix_element,
    mesh,
    primitive,
    transforms,
)
from colladaphy.testing.producers.truth import Scene, Solid, matrix_of

__all__ = ["write"]


def write(scene: Scene, producer: Producer, quirks: frozenset[str]) -> bytes:
    """The file that the producer writes of a scene."""
    return _Writer(scene, producer, quirks | producer.always).document()


class _Writer:
    def __init__(self, scene: Scene, producer: Producer, quirks: frozenset[str]) -> None:
        self.scene = scene
        self.producer = producer
        self.quirks = quirks
        odd = "odd-names" in quirks
        self.names = [
            f"{number} of {link.name}" if odd else link.name
            for number, link in enumerate(scene.links)
        ]
        # A constraint binds bodies of one model.
        self.split = "split-models" in quirks and not scene.joints

    # --- the whole

    def document(self) -> bytes:
        parts = [
            self._asset(),
            library("geometries", *self._geometries()),
            *self._looks(),
            library("visual_scenes", tag("visual_scene", *self._nodes(), id="look")),
            self._materials(),
            library("physics_models", *self._models()),
            library("physics_scenes", self._scene()),
        ]
        if "empty-libraries" in self.quirks:
            parts.append(tag("library_cameras") + tag("library_images", "\n  "))
        physics = tag("instance_physics_scene", url="#physics")
        visual = tag("instance_visual_scene", url="#look")
        if "no-scene" not in self.quirks:
            misplaced = "misplaced-scene" in self.quirks
            parts.append(tag("scene", *((visual, physics) if misplaced else (physics, visual))))
        text = collada(self.producer.version, *parts)
        if "white-space" in self.quirks:
            text = text.replace(b"><", b">\n\t<")
        if "comments" in self.quirks:
            text = text.replace(b"<shape>", b"<shape><!-- a shape -->")
            text = text.replace(b"<mass>", b"<mass><!-- kg -->")
        return text

    def _asset(self) -> str:
        when = dates("2006-04-05T15:20:17" + ("" if "dates-without-zone" in self.quirks else "Z"))
        tool = self.producer.tool
        who = tag("contributor", tag("authoring_tool", tool)) if tool else ""
        unit = tag("unit", name="unit", meter=self.scene.unit)
        axis = tag("up_axis", self.scene.up_axis)
        if "unit-last" in self.quirks:
            return tag("asset", who, axis, unit, when)
        return tag("asset", who, when, unit, axis)

    def _solids(self) -> list[tuple[str, Solid]]:
        return [
            (f"shape{index}-{number}", solid)
            for index, link in enumerate(self.scene.links)
            for number, solid in enumerate(link.solids)
            if solid.kind == "mesh"
        ]

    def _geometries(self) -> list[str]:
        made = []
        form = next((q for q in ("polygons", "polylist") if q in self.quirks), "triangles")
        for id, solid in self._solids():
            digits = "2490374" if "digits" in self.quirks else None
            if "hull" in self.quirks:
                sign = "" if "hull-without-hash" in self.quirks else "#"
                hull = tag("convex_mesh", convex_hull_of=f"{sign}{id}-surface")
                made.append(tag("geometry", hull, id=id))
                made.append(geometry(f"{id}-surface", solid, primitive=form, digits=digits))
            else:
                made.append(geometry(id, solid, primitive=form, digits=digits))
        shown = Solid("mesh", (0.5, 0.5, 0.5))
        made.append(tag("geometry", mesh("look-mesh", shown), id="look-mesh"))
        return made

    def _looks(self) -> list[str]:
        if "effects" not in self.quirks:
            return []
        surface = tag(
            "newparam",
            tag("surface", tag("init_from", "wood"), tag("format", "A8R8G8B8"), type="2D"),
            sid="wood-surface",
        )
        sampler = tag(
            "newparam",
            tag("sampler2D", tag("source", "wood-surface")),
            sid="wood-sampler",
        )
        colour = tag("diffuse", tag("texture", texture="wood-sampler", texcoord="UV"))
        # Some exporters leave out the sid of the technique.
        sid = None if "no-effects-of-materials" in self.quirks else "common"
        technique = tag("technique", tag("lambert", colour), sid=sid)
        profile = tag("profile_COMMON", surface, sampler, technique)
        return [
            library("images", tag("image", tag("init_from", "wood.png"), id="wood")),
            library("effects", tag("effect", profile, id="wood-effect")),
            library("materials",
                    tag("material", tag("instance_effect", url="#wood-effect"), id="wood-look")),
        ]  # fmt: skip

    # --- nodes

    def _nodes(self) -> list[str]:
        return [self._node(i) for i, link in enumerate(self.scene.links) if link.parent is None]

    def _node(self, index: int) -> str:
        link = self.scene.links[index]
        inner = "".join(
            self._node(child)
            for child, other in enumerate(self.scene.links)
            if other.parent == index
        )
        place = transforms(link.steps)
        if "matrix-nodes" in self.quirks:
            place = matrix_element(matrix_of(link.steps))
        show = tag("instance_geometry", url="#look-mesh")
        if "missing-nodes" in self.quirks:
            return tag("node", place, show, id=f"{self.names[index]}-elsewhere")
        return tag("node", place, show, inner, id=f"{self.names[index]}-node")

    # --- materials

    def _values(self) -> str:
        static, dynamic, bounce = self.scene.friction
        return tag(
            "technique_common",
            tag("dynamic_friction", numbers([dynamic])),
            tag("restitution", numbers([bounce])),
            tag("static_friction", numbers([static])),
        )

    def _materials(self) -> str:
        if "inline-material" in self.quirks:
            return ""
        return library("physics_materials", tag("physics_material", self._values(), id="stuff"))

    def _material(self) -> str:
        if "inline-material" in self.quirks:
            return tag("physics_material", self._values())
        return tag("instance_physics_material", url="#stuff")

    # --- models

    def _model_name(self, index: int) -> str:
        return f"model{index}" if self.split else "model"

    def _models(self) -> list[str]:
        bodies = [self._body(index) for index in range(len(self.scene.links))]
        if self.split:
            return [
                tag("physics_model", body, id=self._model_name(index))
                for index, body in enumerate(bodies)
            ]
        joints = [self._joint(index) for index in range(len(self.scene.joints))]
        return [tag("physics_model", *bodies, *joints, id="model")]

    def _body(self, index: int) -> str:
        link = self.scene.links[index]
        numeric = "dynamic-as-number" in self.quirks
        moves = ("0", "1") if numeric else ("false", "true")
        if "capitals" in self.quirks and not numeric:
            moves = ("False", "True")
        dynamic = tag("dynamic", moves[not link.fixed])
        mass = tag("mass", numbers([link.mass]))
        frame = "" if not link.centre else tag("mass_frame", transforms(link.centre))
        inertia = "" if link.inertia is None else tag("inertia", numbers(link.inertia))
        shapes = "".join(
            self._shape(f"shape{index}-{number}", solid) for number, solid in enumerate(link.solids)
        )
        values = [dynamic, mass, frame, inertia, self._material(), shapes]
        if "dynamic-last" in self.quirks:
            values = [self._material(), shapes, dynamic, mass, frame, inertia]
        sid: str | None = self.names[index]
        if "no-sids" in self.quirks and self.split:
            sid = None
        technique = ""
        if self.producer.profile:
            inner = tag("linear_damping", "0.0625") + tag("params", tag("sleep", "true"))
            if self.producer.profile == "pe":
                inner = tag("uid", "7")
            technique = tag("technique", inner, profile=self.producer.profile)
        extra = ""
        if "extra-in-body" in self.quirks:
            extra = tag("extra", tag("technique", tag("colour", "red"), profile="ours"))
        common = tag("technique_common", *values)
        parts = (common, technique)
        if "technique-first" in self.quirks:
            parts = (technique, common)
        return tag("rigid_body", *parts, extra, sid=sid, name=link.name)  # fmt: skip

    def _shape(self, id: str, solid: Solid) -> str:
        if solid.kind == "mesh":
            made = tag("instance_geometry", url=f"#{id}")
            if "inline-mesh" in self.quirks:
                made = tag("mesh", made)
        else:
            if "half-heights" in self.quirks and solid.kind == "cylinder":
                solid = replace(solid, size=(solid.size[0], solid.size[1] / 2))
            made = primitive(solid, long="three-radii" in self.quirks, two_radii=True)
        if "radius-first" in self.quirks and solid.kind in ("cylinder", "capsule"):
            radius, height = solid.size
            made = tag(
                solid.kind,
                tag("radius", numbers([radius, radius])),
                tag("height", numbers([height])),
            )
        if "half-extends" in self.quirks:
            made = made.replace("half_extents", "half_extends")
        moved = transforms(solid.steps)
        hollow = tag("hollow", "true") if "hollow" in self.quirks else ""
        if "mass-in-shape" in self.quirks:  # shapes share the body's by these
            moved += tag("mass", numbers([2 * solid.volume]))
        first = "transform-first" in self.quirks
        return tag("shape", hollow, *((moved, made) if first else (made, moved)))

    # --- constraints

    def _reference(self, index: int | None) -> str:
        if index is None:
            return ""
        name = self.names[index]
        forms = {
            "reference-hash": f"#{name}",
            "reference-hash-path": f"#model/{name}",
            "reference-dot": f"./{name}",
            "reference-path": f"model/{name}",
        }
        return next((form for quirk, form in forms.items() if quirk in self.quirks), name)

    def _joint(self, index: int) -> str:
        joint = self.scene.joints[index]
        ends = []
        for name, body, steps in (
            ("ref_attachment", joint.first, joint.frames[0]),
            ("attachment", joint.second, joint.frames[1]),
        ):
            place = transforms(steps)
            if "attachment-matrix" in self.quirks:
                place = matrix_element(matrix_of(steps))
            label = name if "attachment-names" in self.quirks else None
            ends.append(tag(name, place, rigid_body=self._reference(body), name=label))
        if "second-attachment-first" in self.quirks:
            ends.reverse()
        turn = math.radians if self.producer.radians else float
        low, high = ([turn(value) for value in end] for end in joint.angular)
        if self.producer.mirrored:
            low, high = [0.0 - value for value in high], [0.0 - value for value in low]
        cone = self._limits("swing_cone_and_twist", [low, high])
        slide = self._limits("linear", [list(end) for end in joint.linear])
        linear_first = "linear-first" in self.quirks
        limits = tag("limits", *((slide, cone) if linear_first else (cone, slide)))
        spring = ""
        if "bounce-target" in self.quirks:
            values = tag("stiffness", "0") + tag("damping", "0") + tag("target_value", "0.5")
            spring = tag("spring", tag("angular", values))
        common = tag("technique_common", tag("enabled", "true"), limits, spring)
        return tag("rigid_constraint", *ends, common, sid=joint.name)

    def _limits(self, name: str, ends: list[list[float]]) -> str:
        low, high = ends
        if "free-as-min-over-max" in self.quirks or self.producer.radians:
            free = [math.isinf(value) for value in high]
            low = [1.0 if f else v for f, v in zip(free, low, strict=True)]
            high = [-1.0 if f else v for f, v in zip(free, high, strict=True)]
        return tag(name, tag("min", numbers(low)), tag("max", numbers(high)))

    # --- the physics scene

    def _scene(self) -> str:
        users = [self._user(index) for index in range(len(self.scene.links))]
        if self.split:
            models = [
                tag("instance_physics_model", user, url=f"#{self._model_name(index)}")
                for index, user in enumerate(users)
            ]
        else:
            inner = tag("technique_common") if "common-in-joints" in self.quirks else ""
            path = "model/" if "body-paths" in self.quirks else ""
            joints = [
                tag("instance_rigid_constraint", inner, constraint=path + joint.name)
                for joint in self.scene.joints
            ]
            models = [tag("instance_physics_model", *users, *joints, url="#model", sid="use")]
        values = ""
        if self.scene.gravity is not None:
            gravity = np.array(self.scene.gravity)
            if "gravity-in-metres" in self.quirks:
                gravity = gravity * self.scene.unit
            values += tag("gravity", numbers(np.round(gravity, 6).tolist()))
        if self.scene.time_step is not None:
            values += tag("time_step", numbers([self.scene.time_step]))
        common = tag("technique_common", values) if values else ""
        return tag("physics_scene", *models, common, id="physics")

    def _user(self, index: int) -> str:
        link = self.scene.links[index]
        turn = float if self.producer.radians_per_second else math.degrees
        values = ""
        if any(link.spin):
            values += tag("angular_velocity", numbers([turn(v) for v in link.spin]))
        if any(link.velocity):
            values += tag("velocity", numbers(link.velocity))
        inner = tag("technique_common", values)
        if "bare-instances" in self.quirks and not values:
            inner = ""
        body: str | None = self.names[index]
        if "body-paths" in self.quirks:
            body = f"{self._model_name(index)}/{body}"
        if "no-sids" in self.quirks and self.split:
            body = None
        return tag("instance_rigid_body", inner, body=body, target=f"#{self.names[index]}-node")
