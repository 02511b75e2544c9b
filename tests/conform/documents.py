"""Small documents of our own for the tests of conform, and what must hold of every run."""

from __future__ import annotations

from lxml import etree

from colladaphy.conform import conform
from colladaphy.findings import Finding
from colladaphy.gate import gate

NS_1_5 = "http://www.collada.org/2008/03/COLLADASchema"
NS_1_4 = "http://www.collada.org/2005/11/COLLADASchema"
C = f"{{{NS_1_5}}}"
ASSET = (
    "<asset><created>2020-01-02T03:04:05Z</created>"
    "<modified>2020-01-02T03:04:05Z</modified></asset>"
)


def parse(text: str) -> etree._ElementTree:
    return etree.ElementTree(etree.fromstring(text.encode()))


def document(content: str, *, version: str = "1.5.0", asset: str = ASSET) -> etree._ElementTree:
    """A document of this version with `content` after its asset."""
    namespace = NS_1_5 if version.startswith("1.5") else NS_1_4
    return parse(f'<COLLADA xmlns="{namespace}" version="{version}">{asset}{content}</COLLADA>')


def physics(
    body: str = "",
    *,
    bodies: str | None = None,
    more: str = "",
    instances: str | None = None,
    scene: str = "<technique_common><gravity>0 0 -9.81</gravity></technique_common>",
    nodes: str = '<node id="n1"/><node id="n2"/>',
    version: str = "1.5.0",
    asset: str = ASSET,
) -> etree._ElementTree:
    """A whole physics scene around the technique_common of one body (or around `bodies`)."""
    if bodies is None:
        bodies = f'<rigid_body sid="b1"><technique_common>{body}</technique_common></rigid_body>'
    if instances is None:
        instances = (
            '<instance_rigid_body body="b1" target="#n1"><technique_common/></instance_rigid_body>'
        )
    return document(
        f'<library_visual_scenes><visual_scene id="vs">{nodes}</visual_scene>'
        f"</library_visual_scenes>"
        f'<library_physics_models><physics_model id="pm">{bodies}{more}</physics_model>'
        f"</library_physics_models>"
        f'<library_physics_scenes><physics_scene id="ps">'
        f'<instance_physics_model url="#pm">{instances}</instance_physics_model>{scene}'
        f"</physics_scene></library_physics_scenes>"
        f'<scene><instance_physics_scene url="#ps"/><instance_visual_scene url="#vs"/></scene>',
        version=version,
        asset=asset,
    )


BOX = "<shape><box><half_extents>1 2 3</half_extents></box></shape>"
MESH = (
    '<source id="{0}-p"><float_array id="{0}-a" count="12">'
    "0 0 0 1 0 0 0 1 0 0 0 1</float_array><technique_common>"
    '<accessor source="#{0}-a" count="4" stride="3"><param name="X" type="float"/>'
    '<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common>'
    '</source><vertices id="{0}-v"><input semantic="POSITION" source="#{0}-p"/></vertices>'
    '<triangles count="4"><input semantic="VERTEX" source="#{0}-v" offset="0"/>'
    "<p>0 2 1 0 1 3 1 2 3 0 3 2</p></triangles>"
)


def mended(
    tree: etree._ElementTree, *, convention: str = "auto", only: tuple[str, ...] | None = None
) -> tuple[etree._Element, list[Finding]]:
    """The root of the conformed document, after checking what must hold of every run."""
    before = etree.tostring(tree)
    result, findings = conform(tree, convention=convention, only=only)
    assert etree.tostring(tree) == before, "the original was changed"
    if only is None:
        assert gate(result) == []
    again, more = conform(result, convention=convention, only=only)
    assert more == [], "a second run found more to change"
    assert etree.tostring(again) == etree.tostring(result)
    assert all(finding.path and finding.message and finding.hint for finding in findings)
    return result.getroot(), findings


def codes(findings: list[Finding]) -> set[str]:
    return {finding.code for finding in findings}


def words(root: etree._Element, path: str) -> list[str]:
    """The numbers or words of the element at `path` (local names, from anywhere)."""
    found = root.find(".//" + "/".join(C + step for step in path.split("/")))
    assert found is not None, path
    return (found.text or "").split()


def names(root: etree._Element, path: str) -> list[str]:
    """The local names of the children of the element at `path`."""
    found = root.find(".//" + "/".join(C + step for step in path.split("/")))
    assert found is not None, path
    return [etree.QName(child).localname for child in found]


def kept(root: etree._Element) -> str:
    """Everything that conform put into extras, as text."""
    extras = root.iter(C + "technique")
    return "".join(
        etree.tostring(technique, encoding="unicode")
        for technique in extras
        if str(technique.get("profile", "")).startswith("colladaphy")
    )
