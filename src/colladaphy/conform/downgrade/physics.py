"""Physics: the few places where 1.5 says more than 1.4.1 (§rigid_body, §capsule)."""

from __future__ import annotations

from colladaphy.conform.downgrade import rules
from colladaphy.conform.downgrade.draft import Draft, local, tag15

__all__ = ["change_physics"]


def change_physics(draft: Draft) -> None:
    """Two radii for a capsule, no ids on rigid bodies, no default for an empty `dynamic`."""
    for capsule in draft.all("capsule"):
        radius = capsule.find(tag15("radius"))
        if radius is None:
            continue
        first, along, third = (radius.text or "").split()
        if not float(first) == float(along) == float(third):
            message = (
                f"The capsule's radii {first}, {along} and {third} became {first} and {third}."
            )
            draft.note(rules.CAPSULE_RADIUS, capsule, message)
        radius.text = f"{first} {third}"
    _change_ids(draft)
    for dynamic in draft.all("dynamic"):
        if not (dynamic.text or "").strip():
            dynamic.text = "true"


def _change_ids(draft: Draft) -> None:
    sids: dict[str, str] = {}
    for body in draft.all("rigid_body"):
        if "id" in body.attrib:
            name = body.get("id", "").strip()
            sids[name] = body.get("sid", "").strip()
            message = f"The id {name!r} of the rigid body {body.get('sid')!r} is kept in its extra."
            draft.note(rules.BODY_ID, body, message)
            draft.keep_attributes(body, "id")
    for attachment in draft.all("ref_attachment", "attachment"):
        sid = sids.get(attachment.get("rigid_body", "").strip().removeprefix("#"))
        if sid is not None and "#" in attachment.get("rigid_body", ""):
            message = f"The <{local(attachment)}> names the body by its sid {sid!r}, not its id."
            draft.note(rules.BODY_ID, attachment, message)
            attachment.set("rigid_body", sid)
