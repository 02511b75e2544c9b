"""Large documents without the records that are faulty, and these records without the rest.

To mend a copy takes many times as long as the check. Instead the smallest records around what is
faulty are taken out of one, and nothing is said about what they have a part in. Faults of form are
looked at in these alone.
"""

from __future__ import annotations

from copy import deepcopy
from dataclasses import dataclass
from typing import Any

from lxml import etree

from colladaphy.conform.context import local
from colladaphy.validation.copies import Copy
from colladaphy.validation.touched import Touched, holds_others, taken_out

__all__ = ["Part", "only", "without"]

_RECORDS = ("instance_rigid_body", "instance_rigid_constraint")


def without(whole: Copy, faulty: set[etree._Element]) -> tuple[Copy, Touched]:
    """A copy of the document without the records around some elements, and what that changes."""
    outermost = _records(faulty)
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


@dataclass(frozen=True, slots=True)
class Part:
    """The records around some elements, in copies of what they stand in."""

    copy: Copy
    twins: dict[etree._Element, etree._Element]
    """The elements of the copy, by those of the document."""
    inner: frozenset[int]
    """The numbers of the elements in the records, which are there as a whole."""


def only(whole: Copy, faulty: set[etree._Element], most: int) -> Part | None:
    """The records around some elements without the rest; None if they have more than `most`."""
    outermost, inner = _records(faulty), 0
    for record in outermost:
        inner += sum(1 for _ in record.iter(etree.Element))
        if inner > most:
            return None
    root = whole.tree.getroot()
    if root in outermost:
        return None
    shell = _shell(root, None)
    twins, kept, numbers = {root: shell}, set(), [whole.by_element[root]]
    for record in sorted(outermost, key=whole.by_element.__getitem__):
        around = shell
        for outer in reversed(list(record.iterancestors())):
            if outer not in twins:
                twins[outer] = _shell(outer, around)
                numbers.append(whole.by_element[outer])
            around = twins[outer]
        twin = deepcopy(record)
        around.append(twin)
        for mine, copied in zip(record.iter(etree.Element), twin.iter(etree.Element), strict=True):
            twins[mine] = copied
            kept.add(whole.by_element[mine])
            numbers.append(whole.by_element[mine])
    return Part(Copy(etree.ElementTree(shell), numbers), twins, frozenset(kept))


def _shell(element: etree._Element, around: etree._Element | None) -> etree._Element:
    """An element without what is in it, as the last of another one."""
    names: Any = element.nsmap
    shell = element.makeelement(element.tag, nsmap=names)
    for key, value in element.attrib.items():
        shell.set(key, value)
    if around is not None:
        around.append(shell)
    return shell


def _records(faulty: set[etree._Element]) -> set[etree._Element]:
    """The outermost records around some elements."""
    records = {_record(element) for element in faulty}
    return {record for record in records
            if not any(above in records for above in record.iterancestors())}  # fmt: skip


def _record(element: etree._Element) -> etree._Element:
    """The smallest part of the document that can be understood without the rest, or be left out."""
    # Profiles have ids of their own, and are of what they stand in.
    techniques = [above for above in element.iterancestors() if local(above) == "technique"]
    record = techniques[-1] if techniques else element
    while (above := record.getparent()) is not None:
        if record.get("id") or record.get("sid") or local(record) in _RECORDS:
            break
        if holds_others(local(above)):
            break
        record = above
    return record
