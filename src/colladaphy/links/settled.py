"""Telling at once that a valid document needs no mending.

`conform` looks at a tree in many ways. Most documents that it meets again and again are plain
worlds (bodies of primitives, their nodes, joints between them), and of those one look at the
columns tells whether any of its steps would find something. What is not sure to be settled goes
the long way; a test holds that the long way changes nothing in what is.
"""

from __future__ import annotations

import re
from functools import cached_property
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.distinct import distinct
from colladaphy.columns.reading import Document
from colladaphy.conform.conventions import Clues, faults_of_others, recognised
from colladaphy.conform.profiles import known_tops
from colladaphy.links.names import PE, c
from colladaphy_schema.core_columns import AssetTypeRows
from colladaphy_schema.physics_columns import RigidConstraintTypeRows
from colladaphy_schema.rows import Rows

__all__ = ["is_settled"]

Array = NDArray[Any]
Values = list[bytes | None]

_PLAIN: Final = frozenset(
    c(name)
    for name in (
        "COLLADA", "asset", "contributor", "author", "author_email", "author_website",
        "authoring_tool", "comments", "copyright", "created", "modified", "keywords", "revision",
        "subject", "title", "unit", "up_axis", "extra", "technique", "technique_common",
        "library_physics_materials", "physics_material", "dynamic_friction", "restitution",
        "static_friction", "library_physics_models", "physics_model", "rigid_body", "dynamic",
        "mass", "mass_frame", "inertia", "translate", "rotate", "shape", "hollow", "density",
        "instance_physics_material", "box", "half_extents", "sphere", "radius", "capsule", "height",
        "cylinder", "plane", "equation", "rigid_constraint", "ref_attachment", "attachment",
        "enabled", "interpenetrate", "limits", "linear", "swing_cone_and_twist", "min", "max",
        "spring", "angular", "stiffness", "damping", "target_value", "library_physics_scenes",
        "physics_scene", "instance_physics_model", "instance_rigid_body", "angular_velocity",
        "velocity", "instance_rigid_constraint", "gravity", "time_step", "library_visual_scenes",
        "visual_scene", "library_nodes", "node", "scene", "instance_physics_scene",
        "instance_visual_scene",
    )
)  # fmt: skip
"""Elements of plain worlds. Others (meshes, scales, kinematics, effects, …) go the long way."""
_NO_NAME = re.compile(r"(?m)^(?![^\W\d][\w.\-]*$)")
_OTHER_VERSION = b"2005/11/COLLADASchema"


def is_settled(columns: Document, convention: str = "auto") -> bool:
    """Whether `conform` would change nothing in a document that the gate accepts, for sure."""
    names = columns.names()
    if convention not in ("auto", "none") or faults_of_others():
        return False
    if not all(name in _PLAIN or name.startswith(f"{{{PE}}}") for name in names):
        return False
    if _OTHER_VERSION in columns.index.data:  # in a hint where the schema lies
        return False
    seen = _Seen(columns)
    return (
        seen.has_plain_names()
        and seen.has_a_scene(names)
        and seen.has_plain_profiles(names)
        and seen.leads_everywhere()
        and seen.binds_bodies()
        and seen.has_whole_frames()
        and seen.has_plain_limits()
        and (convention == "none" or seen.is_nobodys())
    )


class _Seen:
    """What the steps of `conform` look at, by column."""

    def __init__(self, columns: Document) -> None:
        self.columns = columns
        self.parent = columns.index.parent

    def elements(self, name: str) -> Array:
        """The elements of a name (n,), as numbers in the document."""
        found = self.columns.rows(Rows, c(name)).ordinals
        assert found is not None
        return found

    def values(self, elements: Array, attribute: str) -> Values | None:
        """An attribute of elements as it is written; None where that is not plain."""
        rows = Rows(len(elements), owners=len(elements), origin=self.columns, ordinals=elements)
        there, ranges = self.columns.ranges(rows, attribute)
        texts = ranges.joined(10).split(b"\n")[:-1]
        if len(texts) != len(ranges):
            return None
        if there is None:
            return list(texts)
        made: Values = [None] * len(elements)
        for row, text in zip(there.tolist(), texts, strict=True):
            made[row] = text
        return made

    @cached_property
    def ids(self) -> dict[bytes, int]:
        """Elements by `#` and the id."""
        elements, texts = self.columns.with_attribute("id")
        return {
            f"#{text}".encode(): element
            for text, element in zip(texts, elements.tolist(), strict=True)
        }

    def has_plain_names(self) -> bool:
        """Ids and sids are names, as they are written, and each is there once."""
        for attribute in ("id", "sid"):
            elements, texts = self.columns.with_attribute(attribute)
            raw = self.values(elements, attribute)
            if (
                raw is None
                or b"\n".join(value or b"" for value in raw) != "\n".join(texts).encode()
            ):
                return False
            if texts and _NO_NAME.search("\n".join(texts)):
                return False
            scope = self.parent[elements].tolist() if attribute == "sid" else [0] * len(texts)
            if len(set(zip(scope, texts, strict=True))) < len(texts):
                return False
        return True

    def has_a_scene(self, names: dict[str, int]) -> bool:
        """Where there is a physics scene, one is in effect."""
        return c("physics_scene") not in names or c("instance_physics_scene") in names

    def has_plain_profiles(self, names: dict[str, int]) -> bool:
        """Techniques hold the pe profile, which begins as its schema has it, and nothing else."""
        columns = self.columns
        extras = self.values(self.elements("extra"), "type")
        if extras is None or any(value is not None for value in extras):
            return False
        ours = [name for name in names if name.startswith(f"{{{PE}}}")]
        codes = [code for name in ours for code in columns.codes_of(name)]
        inside = np.isin(columns.index.codes, codes)
        techniques = np.isin(columns.index.codes, columns.codes_of(c("technique")))
        below = techniques[self.parent] & (self.parent >= 0)
        if not bool(np.all(inside[below])):
            return False
        tops = np.flatnonzero(inside & ~(inside[self.parent] & (self.parent >= 0)))
        known = [code for name in known_tops() for code in columns.codes_of(name)]
        return bool(np.all(np.isin(columns.index.codes[tops], known)) and np.all(below[tops]))

    def leads_everywhere(self) -> bool:
        """References by id lead to what they must lead to, and are written as references."""
        return (
            self._leads("instance_physics_scene", "url", "physics_scene")
            and self._leads("instance_visual_scene", "url", "visual_scene")
            and self._leads("instance_physics_material", "url", "physics_material")
            and self._leads("instance_physics_model", "url", "physics_model")
            and self._leads("instance_physics_model", "parent", "node", needed=False)
            and self._leads("instance_rigid_body", "target", "node")
        )

    def _leads(self, name: str, attribute: str, kind: str, *, needed: bool = True) -> bool:
        texts = self.values(self.elements(name), attribute)
        if texts is None:
            return False
        codes = set(self.columns.codes_of(c(kind)))
        there = self.columns.index.codes
        found = {text: self.ids.get(text, -1) for text in set(texts) if text is not None}
        if needed and None in texts:
            return False
        targets = np.array(list(found.values()), np.int64)
        return bool(np.all(targets >= 0)) and set(distinct(there[targets]).tolist()) <= codes

    def binds_bodies(self) -> bool:
        """Instances and attachments name bodies and constraints of their models by plain sids."""
        outer = self.elements("instance_physics_model")
        scenes = self.columns.codes_of(c("physics_scene"))
        urls = self.values(outer, "url") or []
        if not bool(np.all(np.isin(self.columns.index.codes[self.parent[outer]], scenes))):
            return False  # models in models
        model_of = {
            instance: self.ids.get(url or b"", -1)
            for instance, url in zip(outer.tolist(), urls, strict=True)
        }
        bodies = self._members("rigid_body")
        users = self._users("instance_rigid_body", "body", model_of)
        if bodies is None or users is None or not {key[1:] for key in users} <= bodies:
            return False
        constraints = self._members("rigid_constraint")
        bound = self._users("instance_rigid_constraint", "constraint", model_of)
        if constraints is None or bound is None or not {key[1:] for key in bound} <= constraints:
            return False
        if bound and len(set(users)) < len(users):
            return False  # which of the same bodies is meant?
        return self._attaches(bodies)

    def _members(self, name: str) -> set[tuple[int, bytes]] | None:
        elements = self.elements(name)
        sids = self.values(elements, "sid")
        if sids is None:
            return None
        models = self.parent[elements].tolist()
        return {(model, sid or b"") for model, sid in zip(models, sids, strict=True)}

    def _users(
        self, name: str, attribute: str, model_of: dict[int, int]
    ) -> list[tuple[int, int, bytes]] | None:
        """The instance of the model, the model, and the sid that each instance names."""
        elements = self.elements(name)
        sids = self.values(elements, attribute)
        if sids is None or None in sids:
            return None
        around = self.parent[elements].tolist()
        return [(at, model_of.get(at, -1), sid or b"")
                for at, sid in zip(around, sids, strict=True)]  # fmt: skip

    def _attaches(self, bodies: set[tuple[int, bytes]]) -> bool:
        model_ids = {element: id[1:] for id, element in self.ids.items()}
        for name in ("ref_attachment", "attachment"):
            elements = self.elements(name)
            texts = self.values(elements, "rigid_body")
            if texts is None:
                return False
            models = self.parent[self.parent[elements]].tolist()
            for model, text in zip(models, texts, strict=True):
                if not text:  # the world
                    continue
                head, _, sid = text.partition(b"/")
                if head != model_ids.get(model) or (model, sid) not in bodies:
                    return False
        return True

    def has_whole_frames(self) -> bool:
        """A frame of mass that turns says where it is."""
        frames = self.elements("mass_frame")
        turned = self.parent[self.elements("rotate")]
        moved = self.parent[self.elements("translate")]
        return bool(np.all(~np.isin(frames, turned) | np.isin(frames, moved)))

    def has_plain_limits(self) -> bool:
        """No limits are free by being turned round, no spring without stiffness has a target."""
        rows = self.columns.rows(RigidConstraintTypeRows, c("rigid_constraint"))
        if not len(rows):
            return True
        limits, spring = rows.technique_common.limits, rows.technique_common.spring
        for group in (limits.linear, limits.swing_cone_and_twist):
            low, high = np.full((len(group), 3), np.nan), np.full((len(group), 3), np.nan)
            low[group.min.owner], high[group.max.owner] = group.min.value, group.max.value
            if bool(np.any(low > high)):
                return False
        for part in (spring.linear, spring.angular):
            stiff, target = np.full(len(part), np.nan), np.zeros(len(part))
            stiff[part.stiffness.owner] = part.stiffness.value
            target[part.target_value.owner] = part.target_value.value
            if bool(np.any((stiff == 0.0) & ~np.isfinite(target))):
                return False
        return True

    def is_nobodys(self) -> bool:
        """Nothing says that the document is read otherwise than the standard has it."""
        who = self.columns.rows(AssetTypeRows, c("asset")).contributor
        tools, authors = (
            "; ".join(filter(None, (" ".join((text or "").split()) for text in texts)))
            for texts in (who.authoring_tool, who.author)
        )
        profiles = self.values(self.elements("technique"), "profile")
        models = self.values(self.elements("physics_model"), "id")
        if profiles is None or models is None:
            return False
        clues = Clues(tools, _decoded(profiles), _decoded(models), None, bare_pe=False,
                      authors=authors)  # fmt: skip
        return not recognised(clues)


def _decoded(values: Values) -> frozenset[str]:
    return frozenset(value.decode() for value in set(values) if value is not None)
