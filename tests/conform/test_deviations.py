"""A valid scene with any mixture of the deviations that real files have becomes valid again."""

from __future__ import annotations

from collections.abc import Callable

from hypothesis import given, settings
from hypothesis import strategies as st
from lxml import etree
from tests.conform.documents import BOX, MESH, NS_1_4, NS_1_5, C, document, mended, physics

Deviation = Callable[[etree._Element], None]


def valid() -> etree._ElementTree:
    solids = (
        "<shape><hollow>false</hollow><density>2</density><sphere><radius>1</radius></sphere>"
        "<translate>1 2 3</translate><rotate>0 0 1 30</rotate></shape>"
        "<shape><capsule><height>2</height><radius>1 1 1</radius></capsule></shape>"
        '<shape><instance_geometry url="#g"/></shape>'
    )
    body = (
        "<technique_common><dynamic>true</dynamic><mass>2</mass><mass_frame><translate>0 0 1"
        "</translate></mass_frame><inertia>1 1 1</inertia>{}</technique_common>"
    )
    bodies = "".join(
        f'<rigid_body sid="b{i}">{body.format(shapes)}</rigid_body>'
        for i, shapes in ((1, BOX), (2, solids))
    )
    joint = (
        '<rigid_constraint sid="j"><ref_attachment rigid_body="pm/b1"><translate>1 0 0</translate>'
        '</ref_attachment><attachment rigid_body="pm/b2"><rotate>0 1 0 5</rotate></attachment>'
        "<technique_common><enabled>true</enabled><limits><swing_cone_and_twist><min>0 0 0</min>"
        "<max>0 0 9</max></swing_cone_and_twist><linear><min>0 0 0</min><max>1 1 1</max></linear>"
        "</limits><spring><angular><stiffness>1</stiffness></angular></spring></technique_common>"
        "</rigid_constraint>"
    )
    instances = (
        '<instance_rigid_body body="b1" target="#n1"><technique_common><velocity>1 0 0</velocity>'
        "</technique_common></instance_rigid_body>"
        '<instance_rigid_body body="b2" target="#n2"><technique_common/></instance_rigid_body>'
        '<instance_rigid_constraint constraint="j"/>'
    )
    tree = physics(bodies=bodies, more=joint, instances=instances)
    geometry = document(
        f'<library_geometries><geometry id="g"><mesh>{MESH.format("g")}</mesh></geometry>'
        f'<geometry id="k"><mesh>{MESH.format("k")}</mesh></geometry>'
        '<geometry id="h"><convex_mesh convex_hull_of="#g"/></geometry></library_geometries>'
    ).getroot()[1]
    tree.getroot().insert(1, geometry)
    return tree


def drop(name: str) -> Deviation:
    """Leave out every element of this name."""

    def deviate(root: etree._Element) -> None:
        for element in list(root.iter(C + name)):
            parent = element.getparent()
            if parent is not None and element.getparent() is not root:
                parent.remove(element)

    return deviate


def bare(name: str) -> Deviation:
    """Take the content of every element of this name out of its technique_common."""

    def deviate(root: etree._Element) -> None:
        for element in root.iter(C + name):
            common = element.find(C + "technique_common")
            if common is not None:
                for child in list(common):
                    common.addprevious(child)
                element.remove(common)

    return deviate


def reverse(name: str) -> Deviation:
    """Turn the order of the children around."""

    def deviate(root: etree._Element) -> None:
        for element in list(root.iter(C + name)):
            element[:] = list(reversed(element))

    return deviate


def attribute(name: str, key: str, change: Callable[[str], str | None]) -> Deviation:
    """Change or leave out an attribute."""

    def deviate(root: etree._Element) -> None:
        for element in root.iter(C + name):
            value = change(element.get(key, ""))
            if value is not None:
                element.set(key, value)
            elif key in element.attrib:
                del element.attrib[key]

    return deviate


def text(name: str, change: Callable[[str], str]) -> Deviation:
    """Change the text."""

    def deviate(root: etree._Element) -> None:
        for element in root.iter(C + name):
            element.text = change(element.text or "")

    return deviate


def insert(name: str, content: str, index: int = 0) -> Deviation:
    """Put something into every element of this name."""

    def deviate(root: etree._Element) -> None:
        for element in list(root.iter(C + name)):
            element.insert(index, etree.fromstring(f'<w xmlns="{NS_1_5}">{content}</w>')[0])

    return deviate


DEVIATIONS: dict[str, Deviation] = {
    "instance without technique_common": bare("instance_rigid_body"),
    "digits out of range": attribute("float_array", "digits", lambda _: "2490384"),
    "duplicate ids": attribute("vertices", "id", lambda _: "vertices"),
    "same id as another element": attribute("geometry", "id", lambda _: "n1"),
    "asset out of order": reverse("asset"),
    "asset with a stray comment": insert("asset", "<comments>c</comments>"),
    "asset without dates": drop("created"),
    "no shapes": drop("shape"),
    "no boxes": drop("box"),
    "scene without technique_common": bare("physics_scene"),
    "mesh in a shape": insert("shape", f"<mesh>{MESH.format('m')}</mesh>"),
    "sphere of three radii": text("radius", lambda value: "2 2 2"),
    "sphere of three different radii": text("radius", lambda value: "2 3 4"),
    "capsule of two radii": text("radius", lambda value: "2 3"),
    "scene out of order": reverse("scene"),
    "empty library": insert("COLLADA", "<library_lights/>", 1),
    "body out of order": reverse("technique_common"),
    "shape out of order": reverse("shape"),
    "limits out of order": reverse("limits"),
    "sids that are paths": attribute("rigid_body", "sid", lambda sid: f"model/{sid}"),
    "bodies that are paths": attribute("instance_rigid_body", "body", lambda sid: f"pm/{sid}"),
    "no sids": attribute("rigid_body", "sid", lambda _: None),
    "empty sids": attribute("rigid_body", "sid", lambda _: ""),
    "one sid for all": attribute("rigid_body", "sid", lambda _: "b1"),
    "no bodies": attribute("instance_rigid_body", "body", lambda _: None),
    "no targets": attribute("instance_rigid_body", "target", lambda _: None),
    "targets without #": attribute("instance_rigid_body", "target", lambda url: url.lstrip("#")),
    "attachments with #": attribute("attachment", "rigid_body", lambda path: f"#{path}"),
    "attachments as sids": attribute("attachment", "rigid_body", lambda p: p.rpartition("/")[2]),
    "names on attachments": attribute("attachment", "name", lambda _: "left"),
    "no attachment": drop("ref_attachment"),
    "constraint without technique_common": bare("rigid_constraint"),
    "time zone without colon": text("modified", lambda _: "2017-03-15T05:23:02.000000+0100"),
    "true as True": text("dynamic", lambda _: "True"),
    "foreign infinity": text("max", lambda _: "1.#INF 1.#INF 1.#INF"),
    "commas": text("half_extents", lambda _: "1.0f, 2.0f, 3.0f"),
    "misspelt half_extents": insert("box", "<half_extends>1 2 3</half_extends>"),
    "matrix in a shape": insert("shape", "<matrix>1 0 0 1 0 1 0 2 0 0 1 3 0 0 0 1</matrix>"),
    "matrix in an attachment": insert(
        "attachment", "<matrix>0 -1 0 0 1 0 0 0 0 0 1 0 0 0 0 1</matrix>"
    ),
    "mass_frame without transforms": drop("translate"),
    "inertia as a matrix": text("inertia", lambda _: "1 0 0 0 2 0.5 0 0.5 3"),
    "ids with blanks": attribute("node", "id", lambda name: f"the node {name}"),
    "hulls without #": attribute("convex_mesh", "convex_hull_of", lambda _: "g"),
    "no asset": lambda root: root.remove(root[0]),
    "no version": lambda root: root.attrib.pop("version") and None,
    "loose text": text("physics_model", lambda _: " loose "),
    "an element nobody knows": insert("rigid_body", '<wheel rim="17"><tyre/></wheel>'),
    "a model within the asset": insert("asset", '<physics_model id="stray"/>'),
    "a body in the document itself": insert("COLLADA", '<physics_model id="stray2"/>', 1),
}


@given(
    chosen=st.lists(st.sampled_from(sorted(DEVIATIONS)), min_size=1, max_size=8, unique=True),
    old=st.booleans(),
)
@settings(max_examples=150)
def test_any_mixture_of_deviations_is_repaired(chosen: list[str], old: bool) -> None:
    tree = valid()
    for name in chosen:
        DEVIATIONS[name](tree.getroot())
    if old:
        text_of = etree.tostring(tree).replace(NS_1_5.encode(), NS_1_4.encode())
        tree = etree.ElementTree(etree.fromstring(text_of.replace(b"1.5.0", b"1.4.1")))
    root, findings = mended(tree)
    assert findings
    assert len(list(root.iter(C + "rigid_body"))) == 2
    assert len(list(root.iter(C + "instance_rigid_body"))) == 2


def test_the_scene_without_deviations_is_left_alone() -> None:
    assert mended(valid())[1] == []
