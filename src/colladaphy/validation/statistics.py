"""What a document holds: as it stands in the file, and as a World could hold it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

import numpy as np
from lxml import etree
from numpy.typing import NDArray

from colladaphy.conform import reference_rules as conform_rules
from colladaphy.errors import ColladaError
from colladaphy.findings import Finding
from colladaphy.links import rules as link_rules
from colladaphy.links.names import COLLADA, PE, c, local_name
from colladaphy.mapper import rules as mapper_rules
from colladaphy.source import Limits, Loaded, Parsed, Source, load, parse_loaded
from colladaphy_schema.core_columns import AssetTypeRows, TechniqueTypeRows
from colladaphy_schema.rows import Rows

if TYPE_CHECKING:
    from colladaphy.columns.reading import Document as Columns
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
    source: Source,
    *,
    convention: str = "auto",
    limits: Limits | None = None,
    si: bool = False,
    up_axis: str | None = None,
) -> dict[str, Any]:
    """Facts about a document of any version, as plain values.

    ``document`` counts what the file says, and lists the robots, which are its kinematics models;
    ``scenes`` lists its physics scenes with their models;
    ``world`` counts what could be loaded of the instantiated scenes, and lists what was skipped
    and why; it is in the document's unit and axes, unless `si` asks for metres or `up_axis` for
    another one. A file that cannot be mended has no ``scenes`` and no ``world``, but ``problems``.
    Raises InputError and XmlError as `colladaphy.read` does.
    """
    from colladaphy.document.api import settled_document

    loaded = load(source, limits or Limits())
    settled = settled_document(loaded, convention)
    if settled is None:
        parsed = parse_loaded(loaded, mend=True)
        return _with_world(_facts(parsed), lambda: _mended(parsed, convention), si, up_axis)
    document, columns = settled
    facts = _facts_of_columns(loaded, document, columns)
    return _with_world(facts, lambda: document, si, up_axis)


def _facts(parsed: Parsed) -> dict[str, Any]:
    """What a tree says, of any version and however broken."""
    from colladaphy.conform import detect_version

    root = parsed.tree.getroot()
    asset = _child(root, "asset")
    unit = _child(asset, "unit")
    axis = _child(asset, "up_axis")
    return {
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
    }


def _facts_of_columns(loaded: Loaded, document: Document, columns: Columns) -> dict[str, Any]:
    """The same of a valid document of plain bodies, without a tree."""
    name, meter = document.unit
    assets = columns.rows(AssetTypeRows, c("asset"))
    tools = [tool.strip() for tool in assets.contributor.authoring_tool if tool and tool.strip()]
    names = {local_name(tag): count for tag, count in columns.names().items()
             if tag.startswith(f"{{{COLLADA}}}")}  # fmt: skip
    techniques = columns.rows(TechniqueTypeRows, c("technique")).profile

    def elements(tag: str) -> NDArray[Any]:
        found = columns.rows(Rows, c(tag)).ordinals
        assert found is not None
        return found

    entries = columns.index.parent
    libraries: dict[str, int] = {}
    shapes: Counter[str] = Counter()
    within = elements("shape")
    for tag in sorted(names):
        if tag.startswith("library_"):
            inner = np.isin(entries, elements(tag))
            left_out = (inner[elements(other)].sum() for other in ("asset", "extra"))
            libraries[tag] = int(inner.sum()) - sum(map(int, left_out))
        elif tag in _SHAPES:
            found = int(np.isin(entries[elements(tag)], within).sum())
            shapes.update({tag: found} if found else {})
    return {
        "path": loaded.file,
        "version": "1.5.0",
        "unit": {"name": name, "meter": meter},
        "up_axis": document.up_axis,
        "authoring_tools": tools,
        "document": {
            "elements": len(columns.index),
            **{tag: names.get(tag, 0) for tag in _COUNTED},
            "shape": names.get("shape", 0),
            "shapes": dict(sorted(shapes.items())),
            "robots": [],
            "libraries": dict(sorted(libraries.items())),
            "techniques": dict(sorted(Counter(techniques).items())),
        },
    }


def _with_world(
    facts: dict[str, Any], read: Callable[[], Document], si: bool, up_axis: str | None
) -> dict[str, Any]:
    """The facts with the scenes, and with the World that comes of them."""
    facts |= {"scenes": None, "world": None, "problems": []}
    try:
        document = read()
        facts["scenes"] = [_scene(scene) for scene in document.scenes]
        world = document.load(si=si, up_axis=up_axis)
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
    elements = 0
    for element in root.iter(etree.Element):
        elements += 1
        if element.tag.startswith(f"{{{PE}}}"):
            continue  # the profile says again what is counted already
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
        "elements": elements,
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
    positions, solid = world.positions, world.kinds != int(Kind.PLANE)
    with np.errstate(over="ignore"):  # told as infinite
        mass = float(world.masses.sum())
    return {
        "unit": {"name": world.unit_name, "meter": world.unit_meter},
        "up_axis": world.up_axis,
        "gravity": world.gravity.tolist(),
        "mass": mass,
        "reach": [positions[solid].min(axis=0).tolist(), positions[solid].max(axis=0).tolist()]
        if solid.any()
        else None,
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
