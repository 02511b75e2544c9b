"""Effects: profile_COMMON and what instances of effects set (§profile_COMMON, §instance_effect)."""

from __future__ import annotations

from lxml import etree

from colladaphy.conform.downgrade import rules
from colladaphy.conform.downgrade.draft import Draft, detach, local, tag15
from colladaphy.conform.downgrade.samplers import (
    Sampler,
    change_sampler,
    image_id,
    kept_samplers,
    set_image,
    set_states,
)

__all__ = ["change_effects"]


def change_effects(draft: Draft) -> None:
    """Carry over profile_COMMON, the parameters and the instances of effects."""
    samplers: dict[tuple[str, str], Sampler] = {}
    for effect in draft.all("effect"):
        if not any(local(child).startswith("profile_") for child in effect):
            _add_profile(draft, effect)
        holders = (effect, *effect.findall(tag15("profile_COMMON")))
        params = [param for holder in holders for param in holder.findall(tag15("newparam"))]
        sids = {param.get("sid", "") for param in params}
        kept = kept_samplers(effect)
        for param in params:
            sampler = change_sampler(draft, param, sids, kept)
            if sampler is not None:
                samplers[effect.get("id", ""), param.get("sid", "")] = sampler
    for instance in draft.all("instance_effect"):
        url = instance.get("url", "").strip().removeprefix("#")
        for setparam in instance.findall(tag15("setparam")):
            _change_setparam(draft, setparam, samplers.get((url, setparam.get("ref", "").strip())))
    for transparent in draft.all("transparent"):
        _change_opaque(draft, transparent)
    for texture in draft.all("texture"):
        _join_extras(draft, texture)


def _change_setparam(draft: Draft, setparam: etree._Element, sampler: Sampler | None) -> None:
    value = next((child for child in setparam if isinstance(child.tag, str)), None)
    name = "" if value is None else local(value)
    if value is None or name not in ("sampler_image", "sampler_states"):
        return
    if sampler is not None and name == "sampler_states":
        set_states(draft, setparam, value, sampler)
    elif sampler is not None and image_id(value):
        set_image(draft, setparam, value, sampler)
    else:
        message = f"COLLADA 1.4.1 cannot set this <{name}>; it is kept."
        draft.note(rules.ELEMENT_KEPT, setparam, message)
        draft.keep(setparam)


def _add_profile(draft: Draft, effect: etree._Element) -> None:
    profile = draft.make("profile_COMMON")
    technique = etree.SubElement(profile, tag15("technique"), sid="common")
    etree.SubElement(technique, tag15("constant"))
    last = [c for c in effect if local(c) in ("asset", "annotate", "newparam")]
    effect.insert(effect.index(last[-1]) + 1 if last else 0, profile)
    message = f"The effect {effect.get('id')!r} has no profile that 1.4.1 has; it got an empty one."
    draft.note(rules.EMPTY_PROFILE, effect, message)


def _change_opaque(draft: Draft, transparent: etree._Element) -> None:
    """A_ZERO and RGB_ONE, by equal result (§transparent): only grey colours have one."""
    mode = transparent.get("opaque", "A_ONE").strip()
    if mode in ("A_ONE", "RGB_ZERO"):
        return
    color = transparent.find(tag15("color"))
    parts = [] if color is None else (color.text or "").split()
    if color is not None and mode == "A_ZERO":
        color.text = " ".join([parts[3]] * 4)
        new = "RGB_ZERO"
    elif color is not None and len({float(part) for part in parts[:3]}) == 1:
        color.text = " ".join([*parts[:3], parts[0]])
        new = "A_ONE"
    else:
        message = f"A transparency with opaque={mode!r} has no equal in 1.4.1; it is kept."
        draft.note(rules.OPAQUE_KEPT, transparent, message)
        draft.keep(transparent)
        return
    transparent.set("opaque", new)
    message = f"A transparency with opaque={mode!r} became the equal {new!r}."
    draft.note(rules.OPAQUE_CHANGED, transparent, message)


def _join_extras(draft: Draft, texture: etree._Element) -> None:
    """A texture of 1.4.1 has one extra: the techniques of all go to the first."""
    extras = texture.findall(tag15("extra"))
    for extra in extras[1:]:
        message = "COLLADA 1.4.1 has one <extra> in a <texture>; this one joined the first."
        draft.note(rules.ELEMENT_KEPT, extra, message)
        for technique in extra.findall(tag15("technique")):
            extras[0].append(technique)
        if len(extra) or extra.attrib:
            draft.keep(extra)
        else:
            detach(extra)
