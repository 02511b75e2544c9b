"""Large documents without the records that are faulty, to look at what is behind their faults.

To mend a copy takes many times as long as the check. Instead the smallest records around what is
faulty are taken out of one, and nothing is said about what they have a part in.
"""

from __future__ import annotations

from copy import deepcopy

from lxml import etree

from colladaphy.conform.context import local
from colladaphy.validation.copies import Copy
from colladaphy.validation.touched import Touched, holds_others, taken_out

__all__ = ["without"]

_RECORDS = ("instance_rigid_body", "instance_rigid_constraint")


def without(whole: Copy, faulty: set[etree._Element]) -> tuple[Copy, Touched]:
    """A copy of the document without the records around some elements, and what that changes."""
    records = {_record(element) for element in faulty}
    outermost = {record for record in records
                 if not any(above in records for above in record.iterancestors())}  # fmt: skip
    gone = {whole.by_element[inner] for record in outermost for inner in record.iter(etree.Element)}
    tops = {whole.by_element[record] for record in outermost}
    done = taken_out(whole, tops, gone)
    twin = deepcopy(whole.tree)
    removed = [
        element
        for number, element in enumerate(twin.iter(etree.Element))
        if number in tops and element.getparent() is not None
    ]
    for element in removed:
        parent = element.getparent()
        assert parent is not None
        parent.remove(element)
    numbers = [number for number in whole.numbers if number not in gone]
    return Copy(twin, numbers), done


def _record(element: etree._Element) -> etree._Element:
    """The smallest part of the document that can be understood without the rest, or be left out."""
    record = element
    while (above := record.getparent()) is not None:
        if record.get("id") or record.get("sid") or local(record) in _RECORDS:
            break
        if holds_others(local(above)):
            break
        record = above
    return record
