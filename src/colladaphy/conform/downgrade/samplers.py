"""Samplers: of images in 1.5, of surfaces in 1.4.1.

The 1.5 schema leaves a sampler in an effect empty; its image and its states are set where the
effect is instanced. In 1.4.1 the surface between sampler and image is set there instead.
"""

from __future__ import annotations

from typing import NamedTuple

from lxml import etree

from colladaphy.conform.downgrade import rules
from colladaphy.conform.downgrade.draft import Draft, local

__all__ = ["Sampler", "change_sampler", "set_image", "set_states"]

_ALL_WRAPS = ("wrap_s", "wrap_t", "wrap_p")
_WRAPS = {"1D": 1, "2D": 2, "3D": 3, "CUBE": 3, "RECT": 2, "DEPTH": 2}
_MIP_SETTINGS = {"mip_max_level": ("mipmap_maxlevel", "0"), "mip_bias": ("mipmap_bias", "0.0")}
_FILTERS = ("minfilter", "magfilter", "mipfilter")


class Sampler(NamedTuple):
    """A sampler of an effect: its kind ("2D") and the sid of the surface that was put under it."""

    kind: str
    surface: str


def change_sampler(draft: Draft, param: etree._Element, sids: set[str]) -> Sampler | None:
    """Put a surface under the sampler that `param` declares, if it declares one."""
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
    surface.append(draft.make("init_as_null"))
    holder.append(surface)
    param.addprevious(holder)
    child.append(draft.make("source", name))
    return sampler


def set_image(
    draft: Draft, setparam: etree._Element, image: etree._Element, sampler: Sampler
) -> None:
    """Set the image of the surface where 1.5 sets the image of the sampler."""
    name = image.get("url", "").strip()[1:]
    surface = draft.make("surface", attributes={"type": sampler.kind})
    if sampler.kind in ("CUBE", "3D"):
        start = draft.make("init_cube" if sampler.kind == "CUBE" else "init_volume")
        start.append(draft.make("all", attributes={"ref": name}))
        surface.append(start)
    else:
        surface.append(draft.make("init_from", name))
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
