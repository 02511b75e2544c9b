"""Samplers: of images in 1.5, of surfaces in 1.4.1.

The 1.5 schema leaves a sampler in an effect empty; its image and its states are set where the
effect is instanced. In 1.4.1 the surface between sampler and image is set there instead.
"""

from __future__ import annotations

from typing import NamedTuple

from lxml import etree

from colladaphy.conform.downgrade import rules
from colladaphy.conform.downgrade.draft import Draft, local, tag15
from colladaphy.conform.lexical import name_from

__all__ = ["Sampler", "change_sampler", "image_id", "kept_samplers", "set_image", "set_states"]

_ALL_WRAPS = ("wrap_s", "wrap_t", "wrap_p")
_WRAPS = {"1D": 1, "2D": 2, "3D": 3, "CUBE": 3, "RECT": 2, "DEPTH": 2}
_MIP_SETTINGS = {"mip_max_level": ("mipmap_maxlevel", "0"), "mip_bias": ("mipmap_bias", "0.0")}
_FILTERS = ("minfilter", "magfilter", "mipfilter")
_WRAP_VALUES = ("NONE", "WRAP", "MIRROR", "CLAMP", "BORDER", "MIRROR_ONCE")
_FILTER_VALUES = (
    "NONE", "NEAREST", "LINEAR", "NEAREST_MIPMAP_NEAREST", "LINEAR_MIPMAP_NEAREST",
    "NEAREST_MIPMAP_LINEAR", "LINEAR_MIPMAP_LINEAR", "ANISOTROPIC",
)  # fmt: skip


class Sampler(NamedTuple):
    """A sampler of an effect: its kind ("2D") and the sid of the surface that was put under it."""

    kind: str
    surface: str


def image_id(instance: etree._Element | None) -> str:
    """The id of the image of this document that is instanced; empty where 1.4.1 cannot say it."""
    url = "" if instance is None else instance.get("url", "").strip()
    name = url.removeprefix("#")
    return name if name != url and name_from(name) == name else ""


def kept_samplers(effect: etree._Element) -> dict[str, etree._Element]:
    """Samplers with content, by sid, that were set aside on the way to 1.5."""
    return {
        param.get("sid", ""): sampler
        for technique in effect.iter(tag15("technique"))
        if technique.get("profile", "").startswith("colladaphy-")
        for param in technique.findall(tag15("newparam"))
        for sampler in param
        if local(sampler).startswith("sampler")
    }


def change_sampler(
    draft: Draft, param: etree._Element, sids: set[str], kept: dict[str, etree._Element]
) -> Sampler | None:
    """Put a surface under the sampler that `param` declares, if it declares one.

    The image and the settings are those of the sampler in `kept`, if there is one.
    """
    child = next((c for c in param if local(c).startswith("sampler")), None)
    if child is None:
        return None
    name, number = f"{param.get('sid')}-surface", 2
    while name in sids:
        name, number = f"{param.get('sid')}-surface-{number}", number + 1
    sids.add(name)
    sampler = Sampler(local(child).removeprefix("sampler"), name)
    holder = draft.make("newparam", attributes={"sid": name})
    surface = draft.make("surface", attributes={"type": sampler.kind})
    original = kept.get(param.get("sid", ""))
    image = None if original is None else original.find(tag15("instance_image"))
    surface.append(_start(draft, sampler.kind, image_id(image)))
    holder.append(surface)
    param.addprevious(holder)
    child.append(draft.make("source", name))
    if original is not None:
        said = {local(setting): setting for setting in original if _is_known(setting)}
        for setting, value in _settings(said, sampler.kind, []):
            child.append(draft.make(setting, value))
    return sampler


def _is_known(setting: etree._Element) -> bool:
    """Whether a setting that was set aside has a value that can be written."""
    name, value = local(setting), (setting.text or "").strip()
    if name in _ALL_WRAPS:
        return value in _WRAP_VALUES
    return name in _FILTERS and value in _FILTER_VALUES


def _start(draft: Draft, kind: str, image: str) -> etree._Element:
    """What a surface begins as: the image of an id, or nothing."""
    if not image:
        return draft.make("init_as_null")
    if kind in ("CUBE", "3D"):
        start = draft.make("init_cube" if kind == "CUBE" else "init_volume")
        start.append(draft.make("all", attributes={"ref": image}))
        return start
    return draft.make("init_from", image)


def set_image(
    draft: Draft, setparam: etree._Element, image: etree._Element, sampler: Sampler
) -> None:
    """Set the image of the surface where 1.5 sets the image of the sampler."""
    surface = draft.make("surface", attributes={"type": sampler.kind})
    surface.append(_start(draft, sampler.kind, image_id(image)))
    setparam.set("ref", sampler.surface)
    setparam.replace(image, surface)


def set_states(
    draft: Draft, setparam: etree._Element, states: etree._Element, sampler: Sampler
) -> None:
    """Set the whole sampler where 1.5 sets its states only."""
    settings = {local(child): child for child in states if local(child) not in ("", "extra")}
    lost: list[str] = []
    new = draft.make("sampler" + sampler.kind)
    new.append(draft.make("source", sampler.surface))
    for name, value in _settings(settings, sampler.kind, lost):
        new.append(draft.make(name, value))
    for extra in [child for child in states if local(child) == "extra"]:
        new.append(extra)
    if lost:
        message = f"1.4.1 has no {', '.join(lost)} like that for a <{local(new)}>."
        draft.note(rules.SAMPLER_CHANGED, states, message)
    setparam.replace(states, new)
    if lost:
        around = draft.make("setparam", attributes={"ref": setparam.get("ref", "")})
        around.append(states)
        draft.keep_copy(around, setparam)


def _settings(
    settings: dict[str, etree._Element], kind: str, lost: list[str]
) -> list[tuple[str, str]]:
    """The settings of 1.4.1 in their order; the names of those that say less go to `lost`."""
    new = [
        (wrap, _nearest(settings[wrap], "WRAP", {"MIRROR_ONCE": "MIRROR"}, lost))
        for wrap in _ALL_WRAPS[: _WRAPS[kind]]
        if wrap in settings
    ]
    for name in _FILTERS[: 2 if kind == "DEPTH" else 3]:
        # Where nothing is said, 1.4.1 means NONE and 1.5 means LINEAR.
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
    lost += [name for name in settings if _MIP_SETTINGS.get(name, (name, ""))[0] not in said]
    return new


def _nearest(
    setting: etree._Element, default: str, replacements: dict[str, str], lost: list[str]
) -> str:
    value = (setting.text or "").strip() or default
    if value in replacements:
        lost.append(local(setting))
    return replacements.get(value, value)
