"""The thesis's listings as documents: as they are printed there, and as they would be valid."""

from __future__ import annotations

from colladaphy.links.names import COLLADA

__all__ = ["LISTING_2", "listing_3", "listing_4", "listing_5"]

_TIMES = "<created>2011-01-01T00:00:00Z</created><modified>2011-01-01T00:00:00Z</modified>"


def _document(content: str) -> bytes:
    start = f'<COLLADA xmlns="{COLLADA}" version="1.5.0"><asset>{_TIMES}</asset>'
    return f"{start}{content}</COLLADA>".encode()


_MUSTARD = """
<physics_material id="Mustard"><technique_common>
  <dynamic_friction>0.7</dynamic_friction><restitution>1.0</restitution>
  <static_friction>0.8</static_friction>
</technique_common></physics_material>
"""

LISTING_2 = _document(f"""
<library_physics_materials>{_MUSTARD}</library_physics_materials>
<library_physics_models><physics_model id="Model01">
  <rigid_body sid="Body01"><technique_common>
    <dynamic>true</dynamic>
    <shape><box><half_extents>2 2 1.4</half_extents></box>
      <translate>0 10.5 0</translate><mass>1.0</mass></shape>
    <mass>2.0</mass><instance_physics_material url="#Mustard"/>
  </technique_common></rigid_body>
  <rigid_body sid="Body02"><technique_common>
    <dynamic>false</dynamic>
    <shape><sphere><radius>2 2 3</radius></sphere><mass>1.0</mass></shape>
    <instance_physics_material url="#Mustard"/>
  </technique_common></rigid_body>
  <rigid_constraint sid="Joint01">
    <attachment rigid_body="Model01/Body01"/><ref_attachment rigid_body="Model01/Body02"/>
    <technique_common><interpenetrate>false</interpenetrate><limits><linear>
      <min>-20 -20 -20</min><max>20 20 20</max></linear></limits></technique_common>
  </rigid_constraint>
</physics_model></library_physics_models>
<library_physics_scenes><physics_scene name="Main_scene" id="Scene01">
  <instance_physics_model url="#Model01">
    <instance_rigid_body body="Model01/Body01" target="#Node01"><technique_common>
      <angular_velocity>0 0.238 0</angular_velocity><mass>3.0</mass>
    </technique_common></instance_rigid_body>
    <instance_rigid_body body="Model01/Body02" target="#Node02"><technique_common/>
    </instance_rigid_body>
    <instance_rigid_constraint constraint="Model01/Joint01"><technique_common/>
    </instance_rigid_constraint>
  </instance_physics_model>
  <technique_common><gravity>0 -9.81 0</gravity></technique_common>
</physics_scene></library_physics_scenes>
<library_visual_scenes><visual_scene id="Visual_Scene01">
  <node id="Node01"/><node id="Node02"/>
</visual_scene></library_visual_scenes>
<scene><instance_physics_scene url="#Scene01"/></scene>
""")


def _one_body(common: str, technique: str, materials: str = "") -> bytes:
    library = (
        f"<library_physics_materials>{materials}</library_physics_materials>" if materials else ""
    )
    return _document(f"""{library}
<library_physics_models><physics_model id="m"><rigid_body sid="b">
  <technique_common>{common}</technique_common>{technique}
</rigid_body></physics_model></library_physics_models>
<library_physics_scenes><physics_scene id="s"><instance_physics_model url="#m">
  <instance_rigid_body body="b" target="#n"><technique_common/></instance_rigid_body>
</instance_physics_model><technique_common/></physics_scene></library_physics_scenes>
<library_visual_scenes><visual_scene id="v"><node id="n"/></visual_scene></library_visual_scenes>
<scene><instance_physics_scene url="#s"/></scene>""")


def listing_3(
    equation: str = "0 0 1 -2",
    normal: str = "0 0 1",
    anchor: str = "5 6 2",
    displacement: str = "<displacement>2</displacement>",
) -> bytes:
    """A plane with normal, anchor and displacement in the custom profile."""
    return _one_body(
        f"<shape><plane><equation>{equation}</equation></plane></shape>",
        f'<technique profile="pe"><shape><plane><normal>{normal}</normal>'
        f"<anchor>{anchor}</anchor>{displacement}</plane></shape></technique>",
    )


def _box(x: float, step: str = "") -> str:
    place = f"<translate>{x} 0 0</translate>{step}"
    return f"<shape><mass>2</mass><box><half_extents>1 1 1</half_extents></box>{place}</shape>"


def listing_4(uids: tuple[int, int] = (7, 8)) -> bytes:
    """A union that holds a box and a union of two more boxes, moved by ten as a whole."""
    common = _box(0) + _box(10) + _box(16)
    technique = (
        f'<technique profile="pe"><union><uid>{uids[0]}</uid>{_box(0)}'
        f"<union><uid>{uids[1]}</uid><translate>10 0 0</translate>{_box(0)}{_box(6)}</union>"
        "</union></technique>"
    )
    return _one_body(common, technique)


def listing_5() -> bytes:
    """A material with extra values."""
    mustard = """
<physics_material id="Material_06" name="Mustard"><technique_common>
  <dynamic_friction>0.1</dynamic_friction><restitution>0.4</restitution>
  <static_friction>0.5</static_friction></technique_common>
  <extra><technique profile="pe"><density>1.2</density><poisson_ratio>0.2</poisson_ratio>
  <young_modulus>1</young_modulus><stiffness>8</stiffness><damping_normal>0</damping_normal>
  <damping_tangential>0</damping_tangential></technique></extra></physics_material>"""
    return _one_body(
        '<instance_physics_material url="#Material_06"/>'
        "<shape><sphere><radius>1</radius></sphere></shape>",
        "",
        mustard,
    )
