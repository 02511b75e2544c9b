"""Names of elements and attributes may be of any letters, in techniques and extras."""

from __future__ import annotations

import io

from lxml import etree

import colladaphy

DOCUMENT = """<COLLADA xmlns="http://www.collada.org/2008/03/COLLADASchema" version="1.5.0">
<asset><created>2000-01-01T00:00:00Z</created><modified>2000-01-01T00:00:00Z</modified></asset>
<library_physics_models><physics_model id="m"><rigid_body sid="b"><technique_common>
<mass>1</mass><shape><sphere><radius>1</radius></sphere></shape></technique_common>
<technique profile="pe"><pe:body xmlns:pe="urn:colladaphy:pe:1" slþeping="true"/></technique>
<technique profile="x"><größe xmlns="urn:x" länge="1">ü</größe></technique>
</rigid_body></physics_model></library_physics_models>
<library_physics_scenes><physics_scene id="s"><instance_physics_model url="#m">
<instance_rigid_body body="b" target="#n"><technique_common/></instance_rigid_body>
</instance_physics_model><technique_common/></physics_scene></library_physics_scenes>
<library_visual_scenes><visual_scene id="v"><node id="n"/></visual_scene></library_visual_scenes>
<scene><instance_physics_scene url="#s"/><instance_visual_scene url="#v"/></scene></COLLADA>"""


def test_they_are_validated_repaired_loaded_and_kept() -> None:
    data = DOCUMENT.encode()
    report = colladaphy.validate(data)
    assert [finding.code for finding in report.errors] == ["schema-unknown-attribute"]
    document = colladaphy.read(data, repair=True)
    assert document.tree.getroot() is not None  # is shown, and may be edited
    world = document.load()
    assert len(world.bodies) == 1
    document.update(world)
    stream = io.BytesIO()
    document.write(stream)
    again = etree.fromstring(stream.getvalue())
    (foreign,) = again.iter("{urn:x}größe")
    assert (foreign.get("länge"), foreign.text) == ("1", "ü")
    assert len(colladaphy.read(stream.getvalue()).load().bodies) == 1
