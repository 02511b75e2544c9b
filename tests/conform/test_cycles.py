"""What is instanced within itself is taken apart; what is only shared stays."""

from __future__ import annotations

import pytest
from lxml import etree
from tests.conform.documents import BOX, C, codes, kept, mended, physics

from colladaphy import read

RING = (
    '<node id="n1"><instance_node url="#n2"/></node>'
    '<node id="n2"><node id="n3"><instance_node url="#n4"/></node></node>'
    '<node id="n4"><node><instance_node url="{}"/></node></node>'
)


@pytest.mark.parametrize("url", ["#n1", "#n2", "#n3", "#n4"])
def test_rings_of_nodes_are_broken_once(url: str) -> None:
    root, findings = mended(physics(BOX, nodes=RING.format(url)))
    assert [finding.code for finding in findings] == ["repair-cycle"]
    assert kept(root).count("<instance_node") == 1
    assert len(read(etree.tostring(root)).load().bodies) == 1


def test_a_node_within_itself() -> None:
    nodes = '<node id="n1"><node id="n2"><instance_node url="#n1"/></node></node>'
    root, findings = mended(physics(BOX, nodes=nodes))
    assert codes(findings) == {"repair-cycle"}
    assert len(read(etree.tostring(root)).load().bodies) == 1


def test_nodes_that_are_shared_are_no_ring() -> None:
    nodes = (
        '<node id="n1"><instance_node url="#n2"/><instance_node url="#n2"/></node>'
        '<node id="n2"><instance_node url="#n3"/></node><node id="n3"/>'
    )
    assert mended(physics(BOX, nodes=nodes))[1] == []


def test_models_within_themselves() -> None:
    tree = physics(BOX, more='<instance_physics_model url="#inner"/>')
    library = tree.getroot().find(f".//{C}library_physics_models")
    inner = etree.fromstring(
        f'<x xmlns="{C[1:-1]}"><physics_model id="inner"><instance_physics_model url="#pm"/>'
        "</physics_model></x>"
    )[0]
    library.append(inner)
    root, findings = mended(tree)
    assert codes(findings) == {"repair-cycle"}
    assert len(read(etree.tostring(root)).load().bodies) == 1


def test_a_ring_of_models_is_cut_where_it_closes_seen_from_the_scene() -> None:
    """The scene instances the second model of the file, which holds the first."""
    body = '<rigid_body sid="x"><technique_common>' + BOX + "</technique_common></rigid_body>"
    more = '<instance_physics_model url="#entry" sid="back"/>'
    tree = physics(BOX, more=more)
    entry = etree.fromstring(
        f'<x xmlns="{C[1:-1]}"><physics_model id="entry">{body}<instance_physics_model url="#pm" '
        'sid="inner"><instance_rigid_body body="b1" target="#n1"><technique_common/>'
        "</instance_rigid_body></instance_physics_model></physics_model></x>"
    )[0]
    tree.getroot().find(f".//{C}library_physics_models").append(entry)
    tree.getroot().find(f".//{C}physics_scene/{C}instance_physics_model").set("url", "#entry")
    user = tree.getroot().find(f".//{C}physics_scene//{C}instance_rigid_body")
    user.set("body", "x")
    root, findings = mended(tree)
    assert codes(findings) == {"repair-cycle"}
    assert 'sid="back"' in kept(root)
    assert root.find(f".//{C}physics_model[@id='entry']/{C}instance_physics_model") is not None


def test_a_ring_of_nodes_is_cut_where_it_closes_seen_from_the_scene() -> None:
    tree = physics(BOX, nodes='<node id="n1"><instance_node url="#b"/></node>')
    nodes = etree.fromstring(
        f'<library_nodes xmlns="{C[1:-1]}"><node id="a"><instance_node url="#b" sid="back"/></node>'
        '<node id="b"><instance_node url="#a" sid="down"/></node></library_nodes>'
    )
    tree.getroot().insert(1, nodes)
    root, findings = mended(tree)
    assert codes(findings) == {"repair-cycle"}
    assert 'sid="back"' in kept(root)


def test_a_long_chain_needs_no_deep_stack() -> None:
    chain = "".join(
        f'<node id="n{i}"><instance_node url="#n{i + 1}"/></node>' for i in range(1, 5000)
    )
    tree = physics(BOX, nodes=f'{chain}<node id="n5000"><instance_node url="#n1"/></node>')
    root, findings = mended(tree)
    assert codes(findings) == {"repair-cycle"}
    assert kept(root).count("<instance_node") == 1
