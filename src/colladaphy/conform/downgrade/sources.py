"""Arrays: 1.4.1 has names where 1.5 has tokens and sid references (§source)."""

from __future__ import annotations

import re

from lxml import etree

from colladaphy.conform.downgrade import rules
from colladaphy.conform.downgrade.draft import Draft, local, tag15
from colladaphy.conform.lexical import name_from

__all__ = ["change_arrays"]

_MEMBER = re.compile(r"(?:\.[^./()]+|(?:\(\d+\))+)$")


def change_arrays(draft: Draft) -> None:
    """Write arrays of tokens and sid references as names, as skins of 1.4.1 have them."""
    for array in draft.all("token_array", "SIDREF_array"):
        old = (array.text or "").split()
        if local(array) == "SIDREF_array":
            # 1.4.1 looks a joint up by its sid below the skeleton: the end of the path.
            new = [_MEMBER.sub("", item.rpartition("/")[2]) for item in old]
        else:
            new = old
        if all(name_from(item) == item for item in new):
            message = f"The <{local(array)}> {array.get('id')!r} is now a Name_array."
            draft.note(rules.ARRAY_CHANGED, array, message)
            if new != old:
                draft.keep_copy(_plain_copy(draft, array), array)
            array.tag = tag15("Name_array")
            array.text = " ".join(new)
            _change_params(array)
        else:
            message = f"The items of the <{local(array)}> {array.get('id')!r} are no names."
            draft.note(rules.ARRAY_KEPT, array, message)
            draft.keep(array)


def _plain_copy(draft: Draft, array: etree._Element) -> etree._Element:
    return draft.make(local(array), array.text, {str(k): str(v) for k, v in array.attrib.items()})


def _change_params(array: etree._Element) -> None:
    source = array.getparent()
    if source is None:
        return
    for param in source.iterfind(f"{tag15('technique_common')}/*/{tag15('param')}"):
        if param.get("type", "").lower() in ("token", "sidref"):
            param.set("type", "name")
