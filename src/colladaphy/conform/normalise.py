"""The generic repair: make every element fit its content model, and lose nothing.

It works from the leaves up. Whatever does not fit is reordered, respelled or completed where the
schema says how; what has no place moves into an extra. Rules that know more than the schema (what
a value means, what a reference was) have run before.
"""

from __future__ import annotations

from dataclasses import replace

from lxml import etree

from colladaphy.conform import form_rules
from colladaphy.conform.assumptions import assumed_attribute
from colladaphy.conform.context import NS, Context, local
from colladaphy.conform.grammar import (
    XSI,
    Attribute,
    ComplexType,
    Declaration,
    SimpleType,
    root_declaration,
    stated_type,
)
from colladaphy.conform.lexical import is_valid, mend
from colladaphy.conform.numerals import plain_numbers
from colladaphy.conform.plan import Plan, Pool, set_children
from colladaphy.findings import Rule
from colladaphy.gate import gate

__all__ = ["drop_foreign_types", "normalise"]


def normalise(context: Context) -> None:
    """Make the document schema-valid, as far as the wanted rules allow."""
    _Normaliser(context).run()


_MANY = 16


class _Normaliser:
    def __init__(self, context: Context) -> None:
        self.context = context
        self.hopeless: dict[etree._Element, str] = {}
        self.stated: set[etree._Element] = set()

    def run(self) -> None:
        """Handle every standard element, children before parents."""
        order = [(self.context.root, root_declaration())]
        for position, (element, declaration) in enumerate(order):
            kind = stated_type(element, declaration.type)
            if kind is not None and XSI + "type" in element.attrib:
                self.stated.add(element)
                order[position] = (element, replace(declaration, type=kind))
            kind = kind or declaration.type
            if isinstance(kind, ComplexType):
                for child in element.iterchildren(tag=etree.Element):
                    known = kind.children.get(local(child))
                    if known is not None and child.tag == known.tag:
                        order.append((child, known))
        for element, declaration in reversed(order):
            if isinstance(declaration.type, SimpleType):
                self._plain(element, declaration, declaration.type)
            else:
                self._complex(element, declaration, declaration.type)

    # -- elements -----------------------------------------------------------------------------

    def _plain(self, element: etree._Element, declaration: Declaration, kind: SimpleType) -> None:
        found = [(str(name), str(value)) for name, value in element.attrib.items()]
        self._unknown_attributes(element, found)
        self._only_text(element)
        self._value(element, declaration, kind)

    def _complex(
        self, element: etree._Element, declaration: Declaration, kind: ComplexType
    ) -> None:
        self._attributes(element, kind)
        if kind.anything:
            if kind.name == "technique_type":
                self._stray_text(element)
            return
        if kind.value is not None:
            self._only_text(element)
            self._value(element, declaration, kind.value)
        else:
            self._stray_text(element)
            self._content(element, kind)
            if kind.content is None and element.text and not element.text.strip():
                element.text = None  # not even white space may stand in an empty type

    def _only_text(self, element: etree._Element) -> None:
        for child in list(element.iterchildren(tag=etree.Element)):
            self._unexpected(child, element)

    def _stray_text(self, element: etree._Element) -> None:
        holders = [element.text, *(child.tail for child in element)]
        if not any(text and text.strip() for text in holders):
            return
        if not self.context.wants(form_rules.UNEXPECTED_TEXT):
            return
        text = " ".join(" ".join(holders_text.split()) for holders_text in holders if holders_text)
        element.text = None
        for child in element:
            child.tail = None
        self.context.note(
            form_rules.UNEXPECTED_TEXT, element, f"text {_short(text)} moved into an extra"
        )
        self.context.keep(element, "text", value=_xml_text(text))

    def _value(self, element: etree._Element, declaration: Declaration, kind: SimpleType) -> None:
        text = element.text or ""
        if len(element):  # comments: the value is the text around them
            text += "".join(child.tail or "" for child in element)
        if not text and declaration.default is not None:
            return
        if is_valid(text, kind):
            return
        mended, less = mend(text, kind)
        name = local(element)
        rule = _rule_of(text, kind, less=less)
        if mended is not None and self.context.wants(rule):
            self._set_text(element, mended)
            message = f"<{name}> was {_short(text)}, is now {_short(mended)}"
            self.context.note(rule, element, message + _cut(text, mended, less=less))
            if less:
                self.context.keep(element, "value", value=_xml_text(text))
        elif mended is None and self.context.wants(form_rules.UNREADABLE_VALUE):
            if declaration.default is None:
                self.hopeless[element] = f"its value {_short(text)} is no {kind.name}"
                return
            self._set_text(element, None)
            message = (
                f"<{name}> was {_short(text)}, which is no {kind.name}; "
                f"the default {declaration.default} is assumed"
            )
            self.context.note(form_rules.UNREADABLE_VALUE, element, message)
            self.context.keep(element, "value", value=_xml_text(text))

    @staticmethod
    def _set_text(element: etree._Element, text: str | None) -> None:
        element.text = text
        for child in element:
            child.tail = None

    def _unexpected(self, child: etree._Element, parent: etree._Element) -> None:
        if not self.context.wants(form_rules.UNEXPECTED_ELEMENT):
            return
        message = f"<{local(child)}> has no place in <{local(parent)}>; moved into an extra"
        self.context.note(form_rules.UNEXPECTED_ELEMENT, child, message)
        self.context.stash(child)

    # -- attributes ---------------------------------------------------------------------------

    def _attributes(self, element: etree._Element, kind: ComplexType) -> None:
        unknown: list[tuple[str, str]] = []
        for key, value in element.attrib.items():
            name = str(key)
            known = kind.attributes.get(name)
            if known is None:
                unknown.append((name, str(value)))
            elif not is_valid(str(value), known.type):
                self._attribute_value(element, known, str(value))
        self._unknown_attributes(element, unknown)
        for attribute in kind.attributes.values():
            if attribute.required and attribute.name not in element.attrib:
                self._missing_attribute(element, attribute)

    def _unknown_attributes(self, element: etree._Element, found: list[tuple[str, str]]) -> None:
        """Move attributes into an extra, in a time that grows with their number."""
        found = [pair for pair in found if not self._is_about_the_schema(element, pair[0])]
        if not found or not self.context.wants(form_rules.UNKNOWN_ATTRIBUTE):
            return
        if len(found) < _MANY:
            for name, _ in found:
                del element.attrib[name]
        else:  # each search for one goes through those before it
            names = {name for name, _ in found}
            rest = [(str(k), str(v)) for k, v in element.attrib.items() if str(k) not in names]
            element.attrib.clear()
            element.attrib.update(rest)
        label = f"of <{local(element)}> moved into an extra"
        for name, value in found:
            message = f"attribute {_clip(name)}={_short(value)} {label}"
            self.context.note(form_rules.UNKNOWN_ATTRIBUTE, element, message)
        self.context.keep_all(
            element, "attribute", [{"name": name, "value": value} for name, value in found]
        )

    def _is_about_the_schema(self, element: etree._Element, name: str) -> bool:
        if name == XSI + "type":
            return element in self.stated
        return name in (XSI + "schemaLocation", XSI + "noNamespaceSchemaLocation")

    def _attribute_value(self, element: etree._Element, known: Attribute, value: str) -> None:
        mended, less = mend(value, known.type)
        label = f"attribute {known.name} of <{local(element)}>"
        if mended is not None:
            rule = _rule_of(value, known.type, less=less)
            if not self.context.wants(rule):
                return
            element.set(known.name, mended)
            message = f"{label} was {_short(value)}, is now {_short(mended)}"
            self.context.note(rule, element, message + _cut(value, mended, less=less))
        elif self.context.wants(form_rules.UNREADABLE_VALUE):
            del element.attrib[known.name]
            message = f"{label} was {_short(value)}, which is no {known.type.name}; removed"
            self.context.note(form_rules.UNREADABLE_VALUE, element, message)
        if (less or mended is None) and value.strip():
            self.context.keep(element, "attribute", name=known.name, value=value)

    def _missing_attribute(self, element: etree._Element, attribute: Attribute) -> None:
        if not self.context.wants(form_rules.MISSING_ATTRIBUTE):
            return
        found = assumed_attribute(self.context, element, attribute.name)
        if found is None:
            self.hopeless[element] = f"it has no attribute {attribute.name}"
            return
        value, why = found
        element.set(attribute.name, value)
        message = f"<{local(element)}> had no attribute {attribute.name}; {value!r} assumed: {why}"
        self.context.note(form_rules.MISSING_ATTRIBUTE, element, message)

    # -- content models -----------------------------------------------------------------------

    def _content(self, element: etree._Element, kind: ComplexType) -> None:
        kids = list(element.iterchildren(tag=etree.Element))
        for child in kids:
            known = kind.children.get(local(child))
            if known is None or child.tag != known.tag:
                self._unexpected(child, element)
            elif child in self.hopeless:
                self._hopeless(child, element)
        kids = list(element.iterchildren(tag=etree.Element))
        names = [local(child) for child in kids]
        if kind.matches(names) or not self._known(names, kind):
            return
        self._arrange(element, kind, kids)

    @staticmethod
    def _known(names: list[str], kind: ComplexType) -> bool:
        return all(name in kind.children for name in names)

    def _hopeless(self, child: etree._Element, parent: etree._Element) -> None:
        why = self.hopeless[child]
        rule = (
            form_rules.UNREADABLE_VALUE
            if why.startswith("its value")
            else form_rules.INCOMPLETE_ELEMENT
        )
        if not self.context.wants(rule):
            return
        self.context.note(rule, child, f"<{local(child)}>: {why}; moved into an extra")
        self.context.stash(child)

    def _arrange(
        self, element: etree._Element, kind: ComplexType, kids: list[etree._Element]
    ) -> None:
        pool: Pool = {}
        for child in kids:
            pool.setdefault(local(child), []).append(child)
        assert kind.content is not None or not pool
        plan = Plan(self.context, element)
        if kind.content is not None:
            plan.take(kind.content, pool)
        if plan.missing is not None:
            self.hopeless[element] = f"it has no <{plan.missing}>"
            return
        for left in [child for rest in pool.values() for child in rest]:
            self._unexpected(left, element)
        if any(child.getparent() is not element for child in kids if child in plan.order):
            return
        for made in plan.made:
            if self.context.wants(form_rules.MISSING_ELEMENT):
                why = plan.made[made]
                message = f"<{local(element)}> had no <{local(made)}>; added{why}"
                self.context.note(form_rules.MISSING_ELEMENT, element, message)
            else:
                plan.order.remove(made)
        self._reorder(element, plan.order)

    def _reorder(self, element: etree._Element, order: list[etree._Element]) -> None:
        stashed = [child for child in element.iterchildren(NS + "extra") if child not in set(order)]
        order = [*order, *stashed]
        before = list(element.iterchildren(tag=etree.Element))
        kept = [child for child in order if child.getparent() is element]
        if before != kept:
            if not self.context.wants(form_rules.CHILD_ORDER):
                order = before
            else:
                message = (
                    f"children of <{local(element)}> were {_names(before)}, are now {_names(kept)}"
                )
                self.context.note(form_rules.CHILD_ORDER, element, message)
        if before == order:
            return
        set_children(element, order)


def _rule_of(text: str, kind: SimpleType, *, less: bool) -> Rule:
    """What kind of change it is to mend this text."""
    if less:
        return form_rules.SURPLUS_VALUES
    primitive = kind.primitive if kind.item is None else kind.item.primitive
    low, high = (1, 1) if kind.item is None else kind.length or (0, 1 << 30)
    if primitive in ("double", "float") and plain_numbers(text, low, high)[1]:
        return form_rules.DECIMAL_COMMA
    return form_rules.LEXICAL_FORM


def _cut(text: str, mended: str, *, less: bool) -> str:
    """What was left out, in words."""
    if not less:
        return ""
    words, _ = plain_numbers(text)
    return f"; left out: {_short(' '.join(words.split()[len(mended.split()) :]))}"


def _clip(name: str) -> str:
    return name if len(name) <= 60 else name[:57] + "…"


def _names(elements: list[etree._Element]) -> str:
    names = [local(element) for element in elements]
    return ", ".join(names if len(names) <= 12 else [*names[:11], f"… ({len(names)} in all)"])


def _short(text: str) -> str:
    text = " ".join(text.split())
    return repr(text if len(text) <= 60 else text[:57] + "…")


def _xml_text(text: str) -> str:
    return " ".join(text.split())


def drop_foreign_types(context: Context) -> None:
    """An xsi:type inside of a technique that the schema cannot follow makes a document invalid."""
    name = XSI + "type"
    stating = [
        element
        for technique in context.root.iter(NS + "technique")
        for element in technique.iterdescendants(etree.Element)
        if name in element.attrib
    ]
    if not stating or not gate(context.root.getroottree()):
        return
    for element in dict.fromkeys(stating):
        # An effect's own techniques have no profile, but may be kept in one that has.
        above = element.iterancestors(NS + "technique")
        technique = next((found for found in above if found.get("profile") is not None), None)
        if technique is None or not context.wants(form_rules.UNKNOWN_ATTRIBUTE):
            continue
        value = str(element.attrib.pop(name))
        message = f"xsi:type={_short(value)} of <{local(element)}> names no type of the schema"
        context.note(form_rules.UNKNOWN_ATTRIBUTE, element, message)
        context.keep(technique, "attribute", name=name, value=value)
