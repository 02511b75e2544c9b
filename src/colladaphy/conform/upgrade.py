"""1.4 to 1.5: images and effects, whose elements changed their form."""

from __future__ import annotations

from lxml import etree

from colladaphy.conform import effect_rules
from colladaphy.conform.context import NS, Context, append, clone, insert, local, remove
from colladaphy.conform.lexical import name_from

__all__ = ["move_effect_images", "set_aside_profiles", "upgrade_images", "upgrade_samplers"]

PROFILE = "colladaphy-1.4"


def move_effect_images(context: Context) -> None:
    """Images inside effects move into the library of images, the only place that 1.5 has."""
    for image in context.all("image"):
        parent = image.getparent()
        if parent is None or local(parent) == "library_images":
            continue
        if not context.wants(effect_rules.EFFECT_IMAGE):
            continue
        if not image.get("id"):
            image.set("id", context.new_id(name_from(image.get("name") or "image")))
        message = f"<image> #{image.get('id')} in <{local(parent)}> moved into <library_images>"
        context.note(effect_rules.EFFECT_IMAGE, image, message)
        library = context.library("images")
        remove(image)
        append(library, image)


def upgrade_images(context: Context) -> None:
    """The location of an image stands in init_from/ref, its data in init_from/hex."""
    for image in context.all("image"):
        for init in image.iterchildren(NS + "init_from"):
            text = (init.text or "").strip()
            if len(init) or not context.wants(effect_rules.IMAGE):
                continue
            init.text = None
            init.append(context.make("ref", text))
            context.note(effect_rules.IMAGE, image, f"<init_from>{text} is now <init_from><ref>")
        for data in list(image.iterchildren(NS + "data")):
            if not context.wants(effect_rules.IMAGE):
                continue
            init = context.make("init_from")
            hexes = context.make("hex", data.text, format=image.get("format") or "unknown")
            init.append(hexes)
            insert(image, image.index(data), init)
            remove(data)
            context.note(effect_rules.IMAGE, image, "<data> is now <init_from><hex>")


def upgrade_samplers(context: Context) -> None:
    """Surfaces are gone in 1.5, and its samplers have no content in the schema.

    The sampler parameter stays, so that textures find it. What it sampled is kept beside it in an
    extra, as 1.5 means it (the image it instances) and as 1.4 wrote it.
    """
    for scope in context.all("profile_COMMON", "effect"):
        holders = [scope, *scope.iterchildren(NS + "technique")]
        surfaces: dict[str, etree._Element] = {}
        for holder in holders:
            for param in holder.iterchildren(NS + "newparam"):
                if param.find(NS + "surface") is not None:
                    surfaces[param.get("sid", "")] = param
        for holder in holders:
            for param in list(holder.iterchildren(NS + "newparam")):
                sampler = param.find(NS + "sampler2D")
                if sampler is not None and len(sampler) and context.wants(effect_rules.SAMPLER):
                    _empty_sampler(context, param, sampler, surfaces)
        for sid, param in surfaces.items():
            if context.wants(effect_rules.SURFACE):
                message = (
                    f"<newparam sid={sid!r}> is a surface, which 1.5 has not; kept in an extra"
                )
                context.note(effect_rules.SURFACE, param, message)
                context.stash(param, PROFILE)


def _empty_sampler(
    context: Context,
    param: etree._Element,
    sampler: etree._Element,
    surfaces: dict[str, etree._Element],
) -> None:
    source = (sampler.findtext(NS + "source") or "").strip()
    surface = surfaces.get(source)
    image = None if surface is None else surface.findtext(f"{NS}surface/{NS}init_from")
    kept = clone(param)
    inner = kept.find(NS + "sampler2D")
    if image and inner is not None:
        inner.insert(0, context.make("instance_image", url=f"#{image.strip()}"))
    holder = param.getparent()
    assert holder is not None
    context.place(holder, PROFILE).append(kept)
    sid = param.get("sid")
    shown = f"image #{image.strip()}" if image else f"surface {source!r}"
    message = f"sampler {sid!r} of the {shown}: its content is kept in an extra, as 1.5 allows none"
    context.note(effect_rules.SAMPLER, param, message)
    sampler.text = None
    for child in list(sampler):
        sampler.remove(child)


def set_aside_profiles(context: Context) -> None:
    """Shader profiles of 1.4 are built differently from those of 1.5: they are kept in an extra."""
    for effect in context.all("effect"):
        for name in ("profile_GLSL", "profile_CG", "profile_GLES"):
            for profile in list(effect.iterchildren(NS + name)):
                if context.wants(effect_rules.SHADER_PROFILE):
                    message = f"<{name}> of 1.4 is kept in an extra: 1.5 builds shaders otherwise"
                    context.note(effect_rules.SHADER_PROFILE, profile, message)
                    context.stash(profile, PROFILE)
        if not any(local(child).startswith("profile_") for child in effect):
            if not context.wants(effect_rules.SHADER_PROFILE):
                continue
            common, technique = context.make("profile_COMMON"), context.make("technique")
            technique.set("sid", "common")
            technique.append(context.make("constant"))
            common.append(technique)
            extras = [i for i, child in enumerate(effect) if local(child) == "extra"]
            insert(effect, extras[0] if extras else len(effect), common)
            message = "<effect> had no profile of 1.5 left; a <profile_COMMON> says nothing instead"
            context.note(effect_rules.SHADER_PROFILE, effect, message)
