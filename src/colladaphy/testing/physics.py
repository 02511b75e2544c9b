"""Documents of physics that are valid and mean something."""

from __future__ import annotations

import io

from hypothesis import strategies as st
from lxml import etree

from colladaphy.document import write
from colladaphy.mapper import WriteOptions
from colladaphy.testing.changes import apply
from colladaphy.testing.changing.editing import EDITS
from colladaphy.testing.changing.rewriting import REWRITES
from colladaphy.testing.changing.spelling import SERIALIZATIONS, serialized
from colladaphy.testing.composing.whole import compose
from colladaphy.testing.making.scalars import several
from colladaphy.testing.worlds import worlds
from colladaphy.world import World

__all__ = ["physics_documents"]


def physics_documents(*, profiles: bool = True, oddities: bool = True) -> st.SearchStrategy[bytes]:
    """Valid COLLADA 1.5 documents whose scenes in effect hold bodies.

    Their links lead somewhere and their values are those of bodies. Most are made of structures
    that no writer of ours makes: nested and repeated models, nodes within nodes and in libraries,
    parents of models, values overridden at the instance, bodies that several instances share,
    several scenes, in effect or not. With `profiles` some come from a World, with its pe profile,
    which fits the common profile or, where that was edited since, does not. With `oddities` all
    may have comments, extras, techniques of other profiles, numbers spelled oddly, other encodings.
    """
    composed = _composed()
    sources = st.one_of(composed, composed, _written()) if profiles else composed
    return sources if not oddities else sources.flatmap(_odd)


@st.composite
def _composed(draw: st.DrawFn) -> bytes:
    return compose(draw, set())


_options = st.builds(
    WriteOptions,
    shape_weight=st.sampled_from(["mass", "density"]),
    redundant=st.booleans(),
    profile=st.sampled_from(["full", "compact", "full", "none"]),
    kinematics=st.booleans(),
)


@st.composite
def _written(draw: st.DrawFn) -> bytes:
    world: World = draw(worlds(max_bodies=4, extreme=False, physical=True))
    stream = io.BytesIO()
    write(world, stream, options=draw(_options))
    if draw(st.booleans()):
        return stream.getvalue()
    root = etree.fromstring(stream.getvalue())  # and what somebody made of it since
    several(draw, 1, 3, lambda draw: apply(draw, root, EDITS))
    return serialized(root, "plain")


@st.composite
def _odd(draw: st.DrawFn, data: bytes) -> bytes:
    if not draw(st.booleans()):
        return data
    root = etree.fromstring(data)
    several(draw, 0, 4, lambda draw: apply(draw, root, REWRITES))
    return serialized(root, draw(st.sampled_from(SERIALIZATIONS)))
