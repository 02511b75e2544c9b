"""Materials of what is seen: symbols and textures (COLLADA 1.5 §bind_material, §texture)."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import replace

from colladaphy.meaning import link_rules
from colladaphy.meaning.context import Context, NamedRows
from colladaphy.meaning.hits import Hit, listed
from colladaphy.meaning.inputs import PRIMITIVES, inputs_of
from colladaphy.meaning.semantics import meant_by
from colladaphy_schema.rows import Rows

__all__ = ["CHECKS", "geometry_of"]


def symbols(context: Context) -> Iterator[Hit]:
    """Symbols that primitives do not have, or that are not bound; and vertex inputs."""
    elements = context.ordinals("bind_material")
    if not len(elements):
        return
    primitives = context.shared(_primitives)
    bound = context.shared(_bound)
    for element in elements.tolist():
        instance = int(context.parent[element])
        url = context.columns.attribute_of(instance, "url")
        # An instance of another kind of element is told of as such.
        wanted = context.name(instance).removeprefix("instance_")
        target = context.target(url)
        if target < 0 or context.name(target) != wanted:
            continue
        geometry = geometry_of(context, url)
        groups = primitives.get(geometry)
        if not groups:
            continue
        seen: dict[str, int] = {}
        strange: list[Hit] = []
        for material in bound.get(element, ()):
            symbol = context.columns.attribute_of(material, "symbol") or ""
            if symbol in seen:
                message = f"The symbol {symbol!r} is bound twice."
                yield Hit(link_rules.MATERIAL_TWICE, material, message, (seen[symbol],), "symbol")
                continue
            seen[symbol] = material
            if symbol not in groups:
                message = f"No primitive of {context.label(geometry)} has the material {symbol!r}."
                strange.append(
                    Hit(link_rules.MATERIAL_SYMBOL, material, message, (geometry,), "symbol")
                )
                continue
            yield from _vertex_inputs(context, material, groups[symbol])
        if len(strange) > 1 and len(strange) == len(seen):  # it is another geometry
            more = f" Nor has any those of {len(strange) - 1} more instances."
            strange = [replace(strange[0], message=strange[0].message + more)]
        yield from strange
        if not seen.keys() <= groups.keys():
            continue  # a symbol is misspelled, and that is told
        for symbol, rows in groups.items():
            if symbol and symbol not in seen:
                message = f"The material {symbol!r} of {context.label(geometry)} is not bound."
                yield Hit(link_rules.MATERIAL_UNBOUND, element, message, (rows[0],))


def _vertex_inputs(context: Context, material: int, primitives: list[int]) -> Iterator[Hit]:
    inputs = inputs_of(context)
    there: set[tuple[str, int]] = set()
    for primitive in primitives:
        for row in inputs.of(primitive):
            there.add((inputs.semantic(row), int(inputs.sets[row])))
            if inputs.semantic(row) == "VERTEX" and inputs.targets[row] >= 0:
                there.update((inputs.semantic(inner), -1)
                             for inner in inputs.of(int(inputs.targets[row])))  # fmt: skip
    # What is misspelled is told at the input.
    there |= {(meant, each) for semantic, each in there if (meant := meant_by(semantic))}
    semantics = {semantic for semantic, _ in there}
    for element in context.shared(_vertex_bindings).get(material, ()):
        semantic = context.columns.attribute_of(element, "input_semantic") or ""
        number = context.columns.attribute_of(element, "input_set")
        if semantic not in semantics:
            message = f"No input of the primitive has the semantic {semantic!r}."
            yield Hit(link_rules.VERTEX_INPUT, element, message, (primitives[0],), "input_semantic")
        elif number is not None:
            sets = {each for known, each in there if known == semantic}
            wanted = int(number)
            if wanted not in sets and not (-1 in sets and wanted == 0):
                message = f"The inputs {semantic} of the primitive have no set {wanted}."
                yield Hit(link_rules.VERTEX_INPUT, element, message, (primitives[0],), "input_set")


def geometry_of(context: Context, url: str | None, depth: int = 0) -> int:
    """The geometry that an instance shows, be it by a controller; -1 for none."""
    target = context.target(url)
    if target < 0 or depth > 8:
        return -1
    if context.name(target) == "geometry":
        return target
    if context.name(target) != "controller":
        return -1
    inner = context.first_children("skin", "morph").get(target, -1)
    if inner < 0:
        return -1
    return geometry_of(context, context.columns.attribute_of(inner, "source"), depth + 1)


def _primitives(context: Context) -> dict[int, dict[str, list[int]]]:
    """Primitives by geometry and material symbol."""
    found: defaultdict[int, defaultdict[str, list[int]]] = defaultdict(lambda: defaultdict(list))
    for name in PRIMITIVES:
        rows = context.rows(Rows, name)
        if not len(rows):
            continue
        assert rows.ordinals is not None
        around = context.ancestor(rows.ordinals, "geometry")
        for element, geometry, symbol in zip(
            rows.ordinals.tolist(), around.tolist(), context.texts(rows, "material"), strict=True
        ):
            found[geometry][symbol or ""].append(element)
    return {geometry: dict(symbols) for geometry, symbols in found.items()}


def _bound(context: Context) -> dict[int, list[int]]:
    """The instances of materials by the bind_material around them."""
    elements = context.ordinals("instance_material")
    found: defaultdict[int, list[int]] = defaultdict(list)
    around = context.ancestor(elements, "bind_material")
    for element, outer in zip(elements.tolist(), around.tolist(), strict=True):
        found[outer].append(element)
    return dict(found)


def _vertex_bindings(context: Context) -> dict[int, list[int]]:
    elements = context.ordinals("bind_vertex_input")
    found: defaultdict[int, list[int]] = defaultdict(list)
    for element in elements.tolist():
        found[int(context.parent[element])].append(element)
    return dict(found)


def textures(context: Context) -> Iterator[Hit]:
    """Textures without a sampler, or without coordinates."""
    # They stand in techniques, of effects.
    ordinals = context.every("texture")
    ordinals = ordinals[context.ancestor(ordinals, "technique", "extra") >= 0]
    if not len(ordinals):
        return
    rows = context.at(Rows, ordinals)
    assert rows.ordinals is not None
    effects = context.ancestor(rows.ordinals, "effect")
    profiles = context.ancestor(rows.ordinals, "profile_COMMON", "profile_GLES", "profile_GLES2")
    samplers = context.shared(_samplers)
    users = context.shared(_users)
    bindings = context.shared(_vertex_bindings)
    texts = (context.texts(rows, "texture"), context.texts(rows, "texcoord"))
    columns = zip(rows.ordinals.tolist(), effects.tolist(), profiles.tolist(), *texts, strict=True)
    for element, effect, profile, texture, texcoord in columns:
        if effect < 0:
            continue
        known = {*samplers.get(effect, ()), *samplers.get(profile, ())}
        if texture not in known:
            message = f"{texture!r} is no sampler of {context.label(effect)}."
            if known:
                message += f" There are: {listed(sorted(known))}."
            yield Hit(link_rules.TEXTURE_SAMPLER, element, message, (effect,), "texture")
            continue
        for material in users.get(effect, ()) if texcoord else ():
            there = {context.columns.attribute_of(each, "semantic")
                     for each in bindings.get(material, ())}  # fmt: skip
            if texcoord not in there:
                message = f"An instance of the material does not bind {texcoord!r}."
                yield Hit(link_rules.TEXTURE_COORDINATES, element, message, (material,), "texcoord")
                break


def _samplers(context: Context) -> dict[int, list[str]]:
    """The sids of parameters that are samplers, by the effect or profile around them."""
    rows = context.rows(NamedRows, "newparam")
    found: defaultdict[int, list[str]] = defaultdict(list)
    assert rows.ordinals is not None
    sids = dict(zip(rows.ordinals.tolist(), rows.sid, strict=True))
    for kind in ("1D", "2D", "3D", "CUBE", "RECT", "DEPTH", "_image", "_states"):
        for element in context.ordinals(f"sampler{kind}").tolist():
            parameter = int(context.parent[element])
            if sids.get(parameter):
                found[int(context.parent[parameter])].append(str(sids[parameter]))
    return dict(found)


def _users(context: Context) -> dict[int, list[int]]:
    """The instances of the materials of each effect."""
    effects: dict[int, int] = {}
    for reference in context.references("url", "instance_effect"):
        effects[int(context.parent[reference.element])] = context.target(reference.text)
    found: defaultdict[int, list[int]] = defaultdict(list)
    for reference in context.references("target", "instance_material"):
        effect = effects.get(context.target(reference.text), -1)
        if effect >= 0:
            found[effect].append(reference.element)
    return dict(found)


CHECKS = (symbols, textures)
