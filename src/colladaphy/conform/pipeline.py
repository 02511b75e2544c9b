"""The order in which a document is upgraded, repaired and translated."""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import replace

import numpy as np
from lxml import etree

from colladaphy.conform import (
    bodies,
    form_rules,
    inertias,
    references,
    scenes,
    shapes,
    structure,
    targets,
    upgrade,
    version_rules,
)
from colladaphy.conform.commas import mend_commas
from colladaphy.conform.context import Context
from colladaphy.conform.conventions import translate
from colladaphy.conform.conventions.units import free_limits, still_springs
from colladaphy.conform.counts import mend_counts
from colladaphy.conform.cycles import break_cycles
from colladaphy.conform.dangling import set_aside_dangling
from colladaphy.conform.escapes import mend_escapes, mend_suffixes
from colladaphy.conform.identifiers import mend_ids, mend_sids
from colladaphy.conform.normalise import drop_foreign_types, normalise
from colladaphy.conform.numerals import may_lack_digits
from colladaphy.conform.placing import split_matrices
from colladaphy.conform.profiles import mend_profiles
from colladaphy.conform.scaled_nodes import apply_scales
from colladaphy.conform.trace import Trace
from colladaphy.conform.versions import copy_as_1_5, detect_version, note_version
from colladaphy.conform.windings import mend_windings
from colladaphy.findings import Finding
from colladaphy.gate import is_valid_text

__all__ = ["conform"]

_WIDEST = 4096
_WIDE = etree.XPath(f"(//*[@*[{_WIDEST + 1}]])[1]")
_Step = Callable[[Context], None]
_UPGRADE: tuple[_Step, ...] = (
    mend_ids,
    upgrade.move_effect_images,
    upgrade.upgrade_images,
    upgrade.upgrade_samplers,
    upgrade.set_aside_profiles,
)
# Names come first: what follows refers to them, and libxml2 remembers ids it has once seen.
_NAMES: tuple[_Step, ...] = (mend_ids, mend_sids)
_SPELLING: tuple[_Step, ...] = (mend_escapes, mend_suffixes)
# Only an invalid document needs these.
_FORM: tuple[_Step, ...] = (
    structure.correct_names,
    structure.house_strays,
    structure.wrap_children,
    mend_commas,
    shapes.lift_inline_meshes,
    shapes.extend_capsule_radii,
    shapes.mend_radii,
    shapes.split_shapes,
    shapes.drop_empty_shapes,
    split_matrices,
    inertias.diagonalise_inertia,
    inertias.drop_empty_mass_frames,
    bodies.name_bodies,
    bodies.wrap_bare_instances,
    bodies.complete_constraints,
)
_REFERENCES: tuple[_Step, ...] = (
    references.mend_urls,
    scenes.mend_scenes,
    scenes.complete_scene,
    targets.mend_inputs,
    mend_counts,
    targets.mend_parents,
    targets.mend_targets,
    break_cycles,
    references.complete_instances,
    references.mend_instances,
    references.mend_attachments,
    free_limits,
    still_springs,
)
# What is moved into extras can no longer be referred to.
_MOVED = frozenset(
    rule.code
    for rule in (
        form_rules.UNEXPECTED_ELEMENT,
        form_rules.UNREADABLE_VALUE,
        form_rules.INCOMPLETE_ELEMENT,
    )
)
# Shapes are assumed before a convention is chosen, and solids converted after: Blender's are read
# otherwise than the standard's.
_REST: tuple[_Step, ...] = (
    shapes.convert_tapered,
    structure.drop_empty_bindings,
    structure.give_geometries_content,
    structure.drop_empty_libraries,
    normalise,
    drop_foreign_types,
)


def conform(
    tree: etree._ElementTree,
    *,
    file: str | None = None,
    convention: str = "auto",
    only: Collection[str] | None = None,
    trace: Trace | None = None,
) -> tuple[etree._ElementTree, list[Finding]]:
    """Schema-valid COLLADA 1.5 that means what `tree` meant, and a finding for every change.

    `tree` itself is not touched. `convention` names whose reading of the standard the document
    follows (see `colladaphy.conform.conventions`); "auto" finds out, "none" takes the standard's.
    `only` limits the changes to rules of these codes. A second run changes nothing. `trace` is
    told where the elements of the copy come from.
    """
    version = detect_version(tree)
    if version is None:
        finding = version_rules.NOT_COLLADA.at(tree.getroot(), file=file)
        return tree, [finding]
    if (wide := _too_wide(tree)) is not None:
        return tree, [wide if file is None else replace(wide, file=file)]
    twin, far_lines = copy_as_1_5(tree)
    origin = "colladaphy-1.4" if version.startswith("1.4") else "colladaphy-repair"
    context = Context(twin.getroot(), file=file, only=only, origin=origin)
    context.far_lines = far_lines
    if trace is not None:
        trace.begin(twin.getroot())
        context.trace = trace
    note_version(context, tree.getroot(), version)
    with np.errstate(all="ignore"):  # odd numbers are the file's, and end where they are checked
        _run(context, twin, version, convention)
    context.findings.sort(key=lambda finding: finding.line or 0)
    return twin, context.findings


def _too_wide(tree: etree._ElementTree) -> Finding | None:
    """An error where an element has so many attributes that each change of one takes long."""
    root = tree.getroot()
    if (count := len(root.nsmap)) > _WIDEST:
        message = f"The root declares {count} namespaces; the limit is {_WIDEST}."
        return version_rules.TOO_WIDE.at(root, message)
    found = _WIDE(tree)
    for element in found if isinstance(found, list) else ():
        assert isinstance(element, etree._Element)
        count = len(element.attrib)
        message = f"An element has {count} attributes; the limit is {_WIDEST}."
        return version_rules.TOO_WIDE.at(element, message)
    return None


def _run(context: Context, twin: etree._ElementTree, version: str, convention: str) -> None:
    steps = [*_SPELLING, *(_UPGRADE if version.startswith("1.4") else ()), *_NAMES]
    for step in steps:
        step(context)
    data = etree.tostring(twin, encoding="UTF-8")
    form_is_right = is_valid_text(data) and not may_lack_digits(data)
    for step in () if form_is_right else _FORM:
        step(context)
    for step in _REFERENCES:
        step(context)
    if not form_is_right:
        bodies.give_shapes(context)
    translate(context, convention)
    for step in () if form_is_right else _REST:
        step(context)
    mend_profiles(context, valid=form_is_right)
    if any(finding.code in _MOVED for finding in context.findings):
        context.forget_ids()
        for step in _REFERENCES:
            step(context)
    set_aside_dangling(context)
    apply_scales(context)
    mend_windings(context)
    inertias.place_mass_frames(context)
