"""What a document holds: as it stands in the file, and as a World could hold it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from lxml import etree

from colladaphy.conform import rules as conform_rules
from colladaphy.errors import ColladaError
from colladaphy.findings import Finding
from colladaphy.links import rules as link_rules
from colladaphy.mapper import rules as mapper_rules
from colladaphy.source import Limits, Parsed, Source, parse

if TYPE_CHECKING:
    from colladaphy.document import Document, Scene
    from colladaphy.world import World

__all__ = ["describe", "skipped_bodies"]

_SHAPES = frozenset(
    {
        "box", "capsule", "convex_mesh", "cylinder", "instance_geometry", "mesh", "plane",
        "sphere", "tapered_capsule", "tapered_cylinder",
    }
)  # fmt: skip
_COUNTED = (
    "physics_scene",
    "physics_model",
    "rigid_body",
    "rigid_constraint",
    "physics_material",
    "force_field",
    "instance_physics_scene",
    "instance_physics_model",
    "instance_rigid_body",
    "instance_rigid_constraint",
)
_SKIPPED = frozenset(rule.code for rule in (mapper_rules.BODY_SKIPPED, mapper_rules.BAD_VALUE))
_SET_ASIDE = frozenset({conform_rules.DANGLING_INSTANCE.code, link_rules.MISSING.code,
                        link_rules.WRONG_TYPE.code, link_rules.CYCLE.code})  # fmt: skip
_LEFT_OUT = frozenset(rule.code for rule in (mapper_rules.EMPTY_SHAPE, mapper_rules.NO_GEOMETRY))
_UNLINKED = frozenset(
    rule.code
    for rule in (
        mapper_rules.CONSTRAINT_SKIPPED,
        mapper_rules.CONSTRAINT_FAULTY,
        mapper_rules.JOINT_UNMAPPED,
    )
)


def describe(
    source: Source, *, convention: str = "auto", limits: Limits | None = None
) -> dict[str, Any]:
    """Facts about a document of any version, as plain values.

    ``document`` counts what the file says, and lists the robots, which are its kinematics models;
    ``scenes`` lists its physics scenes with their models;
    ``world`` counts what could be loaded of the instantiated scenes, and lists what was skipped
    and why. A file that cannot be mended has no ``scenes`` and no ``world``, but ``problems``.
    Raises InputError and XmlError as `colladaphy.read` does.
    """
    from colladaphy.conform import detect_version

    parsed = parse(source, limits or Limits(), mend=True)
    root = parsed.tree.getroot()
    asset = _child(root, "asset")
    unit = _child(asset, "unit")
    axis = _child(asset, "up_axis")
    facts: dict[str, Any] = {
        "path": parsed.file,
        "version": detect_version(parsed.tree),
        "unit": {
            "name": "meter" if unit is None else unit.get("name", "meter"),
            "meter": 1.0 if unit is None else _number(unit.get("meter", "1")),
        },
        "up_axis": "Y_UP" if axis is None else (axis.text or "Y_UP").strip(),
        "authoring_tools": [
            tool.text.strip() for tool in root.iter("{*}authoring_tool") if tool.text
        ],
        "document": _count(root),
        "scenes": None,
        "world": None,
        "problems": [],
    }
    try:
        document = _mended(parsed, convention)
        facts["scenes"] = [_scene(scene) for scene in document.scenes]
        world = document.load()
    except ColladaError as error:
        facts["problems"] = [str(finding) for finding in error.findings] or [str(error)]
        return facts
    facts["world"] = _world(world, document.report.findings)
    return facts


def _mended(parsed: Parsed, convention: str) -> Document:
    from colladaphy.document.api import document_of

    return document_of(parsed, repair=True, convention=convention)


def _count(root: etree._Element) -> dict[str, Any]:
    """Counts of the file as it stands, of any version and however broken."""
    names: Counter[str] = Counter()
    shapes: Counter[str] = Counter()
    profiles: Counter[str] = Counter()
    for element in root.iter(etree.Element):
        name = _local(element)
        names[name] += 1
        if name == "shape":
            shapes.update(kind for child in element if (kind := _local(child)) in _SHAPES)
        elif name == "technique":
            profiles[element.get("profile") or ""] += 1
    libraries: Counter[str] = Counter()
    for library in root.iterchildren(etree.Element):
        if (name := _local(library)).startswith("library_"):
            libraries[name] += sum(
                1 for child in library.iterchildren(etree.Element) if _is_entry(child)
            )
    profiles.pop("", None)
    return {
        "elements": sum(names.values()),
        **{name: names[name] for name in _COUNTED},
        "shape": names["shape"],
        "shapes": dict(sorted(shapes.items())),
        "robots": [_robot(model) for model in root.iter("{*}kinematics_model")],
        "libraries": dict(sorted(libraries.items())),
        "techniques": dict(sorted(profiles.items())),
    }


def _robot(model: etree._Element) -> dict[str, Any]:
    """Counts of a kinematics model, whose joints may stand in a library."""
    names = Counter(map(_local, model.iter(etree.Element)))
    return {
        "id": model.get("id"),
        "name": model.get("name"),
        "links": names["link"],
        "joints": names["attachment_full"] + names["attachment_start"],
    }


def _scene(scene: Scene) -> dict[str, Any]:
    return {
        "id": scene.id,
        "name": scene.name,
        "is_instantiated": scene.is_instantiated,
        "gravity": scene.gravity,
        "time_step": scene.time_step,
        "models": [
            {
                "id": model.id,
                "sid": model.sid,
                "bodies": model.body_count,
                "constraints": model.constraint_count,
            }
            for model in scene.models
        ],
    }


def _world(world: World, findings: list[Finding]) -> dict[str, Any]:
    from colladaphy.world import Kind

    bodies = Counter(Kind(int(kind)).name.lower() for kind in world.kinds)
    members = Counter(Kind(int(kind)).name.lower() for kind in world.member_columns.kinds)
    joints = Counter(joint.kind.name.lower() for joint in world.joints)
    skipped = skipped_bodies(findings)
    unlinked = [finding for finding in findings if finding.code in _UNLINKED]
    return {
        "bodies": len(world.bodies),
        "kinds": dict(sorted(bodies.items())),
        "unions": bodies["union"] + members["union"],
        "members": dict(sorted(members.items())),
        "fixed": int(world.fixed.sum()),
        "joints": dict(sorted(joints.items())),
        "materials": sorted(material.name for material in world.materials),
        "skipped_bodies": [_reason(finding) for finding in skipped],
        "skipped_shapes": [_reason(finding) for finding in findings if finding.code in _LEFT_OUT],
        "skipped_constraints": [_reason(finding) for finding in unlinked],
    }


def skipped_bodies(findings: Iterable[Finding]) -> list[Finding]:
    """Those findings of reading and loading that say that a body is not in the World."""
    return [
        finding
        for finding in findings
        if finding.code in _SKIPPED
        or (finding.code in _SET_ASIDE and "instance_rigid_body" in (finding.path or ""))
    ]


def _reason(finding: Finding) -> dict[str, Any]:
    return {
        "code": finding.code,
        "message": finding.message,
        "line": finding.line,
        "path": finding.path,
    }


def _is_entry(element: etree._Element) -> bool:
    return _local(element) not in {"asset", "extra"}


def _child(element: etree._Element | None, name: str) -> etree._Element | None:
    if element is None:
        return None
    return next((child for child in element if _local(child) == name), None)


def _local(element: etree._Element) -> str:
    tag = element.tag
    return tag.rpartition("}")[2] if isinstance(tag, str) else ""


def _number(text: str) -> float | None:
    try:
        return float(text)
    except ValueError:
        return None
