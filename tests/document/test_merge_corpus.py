"""Real files are carried through: one mass changes, and one line of the canonical form with it."""

from __future__ import annotations

import difflib
from pathlib import Path
from typing import Any

from lxml import etree

import colladaphy
from colladaphy.document.merge import merge
from colladaphy.errors import ColladaError
from colladaphy_schema.codec import decode_document
from colladaphy_schema.physics import LibraryPhysicsModelsType


def masses(root: Any) -> list[Any]:
    return [
        body.technique_common.mass
        for library in root.choice
        if isinstance(library, LibraryPhysicsModelsType)
        for model in library.physics_model
        for body in model.rigid_body
        if body.technique_common.mass is not None
    ]


def lines(tree: etree._ElementTree) -> list[str]:
    return etree.tostring(tree, method="c14n").decode().replace("><", ">\n<").splitlines()


def test_one_mass_of_every_readable_file(corpus_dir: Path) -> None:
    changed = 0
    for path in sorted(corpus_dir.glob("*.dae")):
        try:
            tree = colladaphy.read(path, repair=True).tree
        except ColladaError:
            continue
        root = decode_document(tree)
        assert merge(tree, root) is tree
        found = masses(root)
        if not found:
            continue
        mass = found[len(found) // 2]
        mass.value += 1.5
        result = merge(tree, root)
        assert decode_document(result) == root
        differences = [
            line
            for line in difflib.unified_diff(lines(tree), lines(result), n=0, lineterm="")
            if line[:1] in "+-" and line[:3] not in ("+++", "---")
        ]
        assert [line[0] for line in differences] == ["-", "+"], path.name
        assert all("mass" in line for line in differences), path.name
        changed += 1
    assert changed >= 10
