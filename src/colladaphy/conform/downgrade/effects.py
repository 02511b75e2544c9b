"""Effects: samplers of images become samplers of surfaces (§profile_COMMON, §sampler2D)."""

from __future__ import annotations

from lxml import etree

from colladaphy.conform.downgrade import rules
from colladaphy.conform.downgrade.draft import Draft, detach, local, tag15

__all__ = ["change_effects"]

_ALL_WRAPS = ("wrap_s", "wrap_t", "wrap_p")
_WRAPS = {"1D": 1, "2D": 2, "3D": 3, "CUBE": 3, "RECT": 2, "DEPTH": 2}
_KINDS = {"sampler" + kind: kind for kind in _WRAPS}
_MIP_SETTINGS = {"mip_max_level": ("mipmap_maxlevel", "0"), "mip_bias": ("mipmap_bias", "0.0")}
_FILTERS = ("minfilter", "magfilter", "mipfilter")


def change_effects(draft: Draft) -> None:
    """Carry over profile_COMMON, the parameters and the instances of effects."""
    for effect in draft.all("effect"):
        if not any(local(child).startswith("profile_") for child in effect):
            _add_profile(draft, effect)
        sids = {param.get("sid", "") for param in effect.iter(tag15("newparam"))}
        for param in list(effect.iter(tag15("newparam"))):
            for child in list(param):
                if local(child) in _KINDS:
                    _change_sampler(draft, param, child, sids)
    for transparent in draft.all("transparent"):
        _change_opaque(draft, transparent)
    for texture in draft.all("texture"):
        _join_extras(draft, texture)
    for setparam in draft.all("setparam"):
        value = next((c for c in setparam if isinstance(c.tag, str)), None)
        if value is not None and local(value) in ("sampler_image", "sampler_states"):
            message = f"COLLADA 1.4.1 cannot set a <{local(value)}>; it is kept."
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


def _change_sampler(
    draft: Draft, param: etree._Element, sampler: etree._Element, sids: set[str]
) -> None:
    kind = _KINDS[local(sampler)]
    settings = {local(child): child for child in sampler if local(child) != "extra"}
    surface = _add_surface(draft, param, settings.get("instance_image"), kind, sids)
    original = draft.make(local(sampler))
    lost: list[str] = []
    new = [("source", surface)]
    new += [
        (wrap, _nearest(settings[wrap], "WRAP", {"MIRROR_ONCE": "MIRROR"}, lost))
        for wrap in _ALL_WRAPS[: _WRAPS[kind]]
        if wrap in settings
    ]
    for name in _FILTERS[: 2 if kind == "DEPTH" else 3]:
        # Nothing is NONE in 1.4.1 and LINEAR in 1.5.
        value = "LINEAR"
        if name in settings:
            value = _nearest(settings[name], "LINEAR", {"ANISOTROPIC": "LINEAR"}, lost)
        new.append((name, value))
    if kind != "DEPTH":
        if "border_color" in settings:
            new.append(("border_color", settings["border_color"].text or ""))
        for name, (renamed, default) in _MIP_SETTINGS.items():
            if name in settings:
                new.append((renamed, (settings[name].text or "").strip() or default))
    said = {name for name, _ in new}
    for name, child in settings.items():
        renamed = _MIP_SETTINGS.get(name, (name, ""))[0]
        if name and name != "instance_image" and renamed not in said:
            lost.append(name)
        detach(child)
        if name in lost:
            original.append(child)
    for position, (name, value) in enumerate(new):
        sampler.insert(position, draft.make(name, value))
    if lost:
        message = f"1.4.1 has no {', '.join(lost)} like that on a <{local(sampler)}>."
        draft.note(rules.SAMPLER_CHANGED, sampler, message)
        draft.keep_copy(original, param)


def _nearest(
    setting: etree._Element, default: str, replacements: dict[str, str], lost: list[str]
) -> str:
    value = (setting.text or "").strip() or default
    if value in replacements:
        lost.append(local(setting))
    return replacements.get(value, value)


def _add_surface(
    draft: Draft,
    param: etree._Element,
    instance: etree._Element | None,
    kind: str,
    sids: set[str],
) -> str:
    """A surface of the sampler's image before the sampler; the sid of the surface."""
    name, number = f"{param.get('sid')}-surface", 2
    while name in sids:
        name, number = f"{param.get('sid')}-surface-{number}", number + 1
    sids.add(name)
    holder = draft.make("newparam", attributes={"sid": name})
    surface = etree.SubElement(holder, tag15("surface"), type=kind)
    url = "" if instance is None else instance.get("url", "")
    if url.startswith("#"):
        if kind in ("CUBE", "3D"):
            start = etree.SubElement(
                surface, tag15("init_cube" if kind == "CUBE" else "init_volume")
            )
            etree.SubElement(start, tag15("all"), ref=url[1:])
        else:
            etree.SubElement(surface, tag15("init_from")).text = url[1:]
    else:
        etree.SubElement(surface, tag15("init_as_null"))
        if instance is not None:
            message = f"The surface of {param.get('sid')!r} is empty: its image is in another file."
            draft.note(rules.SAMPLER_CHANGED, instance, message)
            draft.keep_copy(draft.make("instance_image", attributes={"url": url}), param)
    param.addprevious(holder)
    return name


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
            draft.keep_copy(detach(extra), extras[0])
        else:
            detach(extra)
