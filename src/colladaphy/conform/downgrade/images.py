"""Images: 1.4.1 has a file or bytes, 1.5 also surfaces to render to (§image)."""

from __future__ import annotations

from lxml import etree

from colladaphy.conform.downgrade import rules
from colladaphy.conform.downgrade.draft import Draft, detach, local, tag15

__all__ = ["change_images"]


def change_images(draft: Draft) -> None:
    """Write each image as its file or its bytes; keep the rest in its extra."""
    for image in draft.all("image"):
        if "sid" in image.attrib:
            message = f"COLLADA 1.4.1 has no sid={image.get('sid')!r} on <image>; it is kept."
            draft.note(rules.ATTRIBUTE_KEPT, image, message)
            draft.keep_attributes(image, "sid")
        for child in image.findall(tag15("renderable")):
            draft.note(rules.ELEMENT_KEPT, child, "COLLADA 1.4.1 has no <renderable>; it is kept.")
            draft.keep(child)
        _change(draft, image)


def _change(draft: Draft, image: etree._Element) -> None:
    made = next((c for c in image if local(c).startswith(("init_from", "create_"))), None)
    start = made if made is None or local(made) == "init_from" else _first_level(made)
    new = draft.make("init_from")
    if start is not None:
        for data in start:
            if local(data) == "ref":
                new.text = data.text
            elif local(data) == "hex":
                new.tag = tag15("data")
                new.text = data.text
                image.set("format", data.attrib["format"])
    if made is None:
        asset = image.find(tag15("asset"))
        image.insert(0 if asset is None else image.index(asset) + 1, new)
        message = f"The image {image.get('id')!r} has no content, which 1.4.1 asks for."
        draft.note(rules.IMAGE_KEPT, image, message)
        return
    made.addprevious(new)
    new.tail = made.tail
    if local(made) == "init_from" and "mips_generate" not in made.attrib:
        detach(made)
        return
    size = made.find(tag15("size_exact"))
    if size is not None:
        image.set("width", size.attrib["width"])
        image.set("height", size.attrib["height"])
    message = f"Of the image {image.get('id')!r} 1.4.1 keeps the file or the bytes and the size."
    draft.note(rules.IMAGE_KEPT, image, message)
    draft.keep(made)


def _first_level(made: etree._Element) -> etree._Element | None:
    """What fills the first level of the first image of a flat surface; else nothing does."""
    if local(made) != "create_2d":
        return None
    for start in made.findall(tag15("init_from")):
        if int(start.attrib["mip_index"]) == 0 == int(start.get("array_index", "0")):
            return start
    return None
