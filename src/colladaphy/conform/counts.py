"""Counts of arrays and accessors that are not those of the values there (COLLADA 1.5 §accessor)."""

from __future__ import annotations

from lxml import etree

from colladaphy.conform import reference_rules
from colladaphy.conform.context import NS, Context, local

__all__ = ["mend_counts"]


def mend_counts(context: Context) -> None:
    """The count of an array is that of its values, the count of an accessor that of its rows.

    An accessor may leave values out, but not reach beyond them; its stride is at least the number
    of its parameters.
    """
    for source in context.all("source"):
        arrays = {}
        for array in source:
            if local(array).endswith("_array"):
                values = len(_text(array).split())
                arrays[array.get("id", "")] = values
                _set(context, array, "count", values, "it holds so many values")
        for accessor in source.iterfind(f"{NS}technique_common/{NS}accessor"):
            values = arrays.get(accessor.get("source", "").removeprefix("#"), -1)
            if values >= 0:
                _mend(context, accessor, values)


def _mend(context: Context, accessor: etree._Element, values: int) -> None:
    numbers = [_whole(accessor.get(key, default)) for key, default in _DEFAULTS]
    count, stride, offset = numbers
    if count is None or stride is None or offset is None:
        return
    width = sum(1 for _ in accessor.iterchildren(NS + "param"))
    if "stride" not in accessor.attrib and width > 1:
        stride = width
        _set(context, accessor, "stride", stride, f"a row has {width} parameters")
    if count * stride + offset > values:
        rows = max(0, (values - offset) // max(1, stride))
        why = f"the array has {values} values, in rows of {stride}"
        _set(context, accessor, "count", rows, why)


_DEFAULTS = (("count", "0"), ("stride", "1"), ("offset", "0"))


def _whole(text: str) -> int | None:
    text = text.strip()
    return int(text) if text.isdecimal() and len(text) < 18 else None


def _text(element: etree._Element) -> str:
    """The text around comments."""
    if not len(element):
        return element.text or ""
    return (element.text or "") + "".join(child.tail or "" for child in element)


def _set(context: Context, element: etree._Element, key: str, value: int, why: str) -> None:
    old = element.get(key)
    if (old is None and key == "count") or old == str(value):
        return  # what is missing is added where elements are completed
    if old is not None and _whole(old) == value:
        return
    if context.wants(reference_rules.COUNT):
        element.set(key, str(value))
        message = f"{key} of <{local(element)}> was {old or 'missing'}, is now {value}: {why}"
        context.note(reference_rules.COUNT, element, message)
