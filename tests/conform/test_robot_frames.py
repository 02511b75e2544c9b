"""In whose space robots' shapes and mass frames are: what the shown geometry says."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from lxml import etree
from tests.conform.documents import ASSET, C, codes, document, mended, physics

from colladaphy.conform.frames import (
    Matrix,
    axis_angle,
    inverse,
    rotation,
    transform_of,
    translation,
)

CUBE = " ".join(f"{x} {y} {z}" for x in (-1, 1) for y in (-1, 1) for z in (-1, 1))
ROBOT = ASSET.replace(
    "<asset>", "<asset><contributor><authoring_tool>OpenRAVE</authoring_tool></contributor>"
)


def steps(matrix: Matrix) -> str:
    move = " ".join(repr(float(v)) for v in matrix[:3, 3])
    turn = " ".join(repr(float(v)) for v in axis_angle(matrix))
    return f"<translate>{move}</translate><rotate>{turn}</rotate>"


def geometry(name: str, points: str, extra: str = "") -> str:
    faces = "0 1 3 0 3 2 4 6 7 4 7 5 0 4 5 0 5 1 2 3 7 2 7 6 0 2 6 0 6 4 1 5 7 1 7 3"
    return (
        f'<geometry id="{name}"><mesh><source id="{name}-p"><float_array id="{name}-a" count="24">'
        f"{points}</float_array><technique_common>"
        f'<accessor source="#{name}-a" count="8" stride="3">'
        '<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>'
        f'</accessor></technique_common></source><vertices id="{name}-v"><input '
        f'semantic="POSITION" source="#{name}-p"/></vertices><triangles count="12"><input '
        f'semantic="VERTEX" source="#{name}-v" offset="0"/><p>{faces}</p></triangles></mesh>'
        f"{extra}</geometry>"
    )


def info(place: str, halves: str = "1 1 1") -> str:
    return (
        f'<extra type="geometry_info"><technique profile="OpenRAVE">{place}<box><half_extents>'
        f"{halves}</half_extents></box></technique></extra>"
    )


def robot(
    nodes: str, frames: list[tuple[str, str]], geometries: str, urls: tuple[str, ...] = ()
) -> etree._ElementTree:
    """Links l0, l1 … with these mass frames and places of their shapes."""
    bodies = "".join(
        f'<rigid_body sid="b{i}"><technique_common><mass>1</mass><mass_frame>{mass}</mass_frame>'
        f'<inertia>1 1 1</inertia><shape><instance_geometry url="#{(urls or "g" * 9)[i]}"/>{shape}'
        "</shape></technique_common></rigid_body>"
        for i, (mass, shape) in enumerate(frames)
    )
    instances = "".join(
        f'<instance_rigid_body body="b{i}" target="#l{i}"><technique_common/></instance_rigid_body>'
        for i in range(len(frames))
    )
    tree = physics(bodies=bodies, instances=instances, nodes=nodes, asset=ROBOT)
    tree.getroot().find(f".//{C}instance_physics_model").set("parent", "#model")
    library = document(f"<library_geometries>{geometries}</library_geometries>").getroot()[1]
    tree.getroot().insert(1, library)
    return tree


def places(root: etree._Element) -> list[tuple[Matrix, Matrix]]:
    return [
        (transform_of(body.find(f".//{C}mass_frame")), transform_of(body.find(f".//{C}shape")))
        for body in root.iter(C + "rigid_body")
    ]


USE = '<instance_geometry url="#g"/>'
ORIGIN = "<translate>0 0 0</translate>"


def test_the_models_frame_is_that_of_the_base_link() -> None:
    nodes = (
        f'<node id="model"><node id="l0"><translate>0 10 0</translate>{USE}<node id="l1">'
        f"<translate>0 -4 0</translate>{USE}</node></node></node>"
    )
    frame = "<translate>0 -4 0</translate>"
    tree = robot(nodes, [(ORIGIN, ORIGIN), (frame, frame)], geometry("g", CUBE))
    root, findings = mended(tree)
    for place in np.ravel(places(root)).reshape(-1, 4, 4):
        assert place == pytest.approx(np.eye(4))
    assert codes(findings) == {"convention-chosen", "convention-frames"}
    assert "the base link's" in findings[1].message


TURNS = st.tuples(*[st.floats(-1, 1)] * 3, st.floats(-180, 180)).filter(
    lambda t: np.linalg.norm(t[:3]) > 0.1
)
MOVES = st.tuples(*[st.floats(-9, 9)] * 3).filter(lambda t: np.linalg.norm(t) > 5)
PLACES = st.builds(lambda t, r: translation(t) @ rotation(r), MOVES, TURNS)


@given(PLACES, PLACES, PLACES, st.sampled_from(["model", "base", "body"]), st.booleans())
def test_whatever_the_space_the_shape_is_where_it_is_shown(
    top: Matrix, base: Matrix, link: Matrix, space: str, twice: bool
) -> None:
    own = translation((0, 0, 0.5)) @ rotation((1, 0, 0, 30))
    points = CUBE
    shown = own
    if twice:  # the vertices are in the link's frame, and the shape moves them once more
        cube = np.array(CUBE.split(), dtype=float).reshape(-1, 3)
        points = " ".join(repr(float(v)) for v in (cube @ own[:3, :3].T + own[:3, 3]).ravel())
        shown = np.eye(4)
    nodes = (
        f'<node id="model">{steps(top)}<node id="l0">{steps(base)}{USE.replace("#g", "#h")}'
        f'<node id="l1">{steps(link)}<node>{steps(shown)}{USE}</node></node></node></node>'
    )
    spaces = {"model": base @ link, "base": link, "body": np.eye(4)}
    start = {"model": base, "base": np.eye(4), "body": np.eye(4)}[space]
    frames = [(steps(start), steps(start)), (steps(spaces[space] @ own),) * 2]
    geometries = geometry("g", points, info(steps(own))) + geometry("h", CUBE)
    root, findings = mended(robot(nodes, frames, geometries, ("h", "g")))
    found = places(root)
    assert found[0][0] == pytest.approx(np.eye(4), abs=1e-6)
    assert found[0][1] == pytest.approx(np.eye(4), abs=1e-6)
    assert found[1][0] == pytest.approx(own, abs=1e-6)
    assert found[1][1] == pytest.approx(shown, abs=1e-6)
    assert "convention-frames-doubtful" not in codes(findings)


@pytest.mark.parametrize("shown", [True, False])
def test_a_geometry_is_not_placed_twice(shown: bool) -> None:
    """The vertices stand where the extra says that they were moved to."""
    points = "-.1 -.05 0 -.1 -.05 .2 -.1 .05 0 -.1 .05 .2 .1 -.05 0 .1 -.05 .2 .1 .05 0 .1 .05 .2"
    moved = "<translate>0 0 0.1</translate>"
    nodes = f'<node id="model"><node id="l0">{USE if shown else ""}</node></node>'
    geometries = geometry("g", points, info(moved, "0.1 0.05 0.1"))
    root, findings = mended(robot(nodes, [(ORIGIN, moved)], geometries))
    assert places(root)[0][1] == pytest.approx(np.eye(4))
    assert "1 of them stand where their link shows them" in findings[1].message


def test_a_geometry_that_was_not_moved_stays_where_its_shape_puts_it() -> None:
    moved = "<translate>0 0 0.1</translate>"
    nodes = f'<node id="model"><node id="l0"><node>{moved}{USE}</node></node></node>'
    geometries = geometry("g", CUBE, info(moved))
    root, _ = mended(robot(nodes, [(ORIGIN, moved)], geometries))
    assert places(root)[0][1] == pytest.approx(translation((0, 0, 0.1)))


def test_what_fits_no_reading_is_said() -> None:
    nodes = (
        f'<node id="model"><node id="l0"><translate>0 10 0</translate>{USE}<node id="l1">'
        f"<translate>0 -4 0</translate>{USE}</node></node></node>"
    )
    odd = "<translate>77 0 0</translate>"
    root, findings = mended(robot(nodes, [(odd, odd), (odd, odd)], geometry("g", CUBE)))
    doubts = [finding for finding in findings if finding.code == "convention-frames-doubtful"]
    assert len(doubts) == 2
    assert all("2 none" in finding.message for finding in doubts)
    # The meshes are shown, and stand there whatever the shape says.
    assert places(root)[0][1] == pytest.approx(np.eye(4))


def test_a_frame_a_hair_off_fits_and_the_nearest_does_not_win_from_afar() -> None:
    nodes = (
        f'<node id="model"><node id="l0"><translate>0 10 0</translate>{USE}<node id="l1">'
        f"<translate>0 -4 0</translate>{USE}</node></node></node>"
    )
    near = "<translate>0.001 -4 0</translate>"
    first = "<translate>0.001 0 0</translate>"
    root, findings = mended(robot(nodes, [(first, first), (near, near)], geometry("g", CUBE)))
    assert places(root)[1][1] == pytest.approx(translation((0.001, 0, 0)))
    assert "convention-frames-doubtful" not in codes(findings)


def test_frames_as_the_robot_is_shown() -> None:
    """A joint of 90 degrees: the frames were written at this pose."""
    nodes = (
        f'<node id="model"><node id="l0">{USE}<node id="l1"><translate>5 0 0</translate>'
        f'<rotate sid="j">0 0 1 90</rotate><node><translate>3 0 0</translate>{USE}</node></node>'
        "</node></node>"
    )
    joint = (
        '<instance_kinematics_scene url="#k"><bind_joint_axis target="model/l1/j"><axis><param>a'
        "</param></axis><value><float>90</float></value></bind_joint_axis>"
        "</instance_kinematics_scene>"
    )
    place = "<translate>5 3 0</translate><rotate>0 0 1 90</rotate>"
    tree = robot(nodes, [(ORIGIN, ORIGIN), (place, place)], geometry("g", CUBE))
    tree.getroot().find(C + "scene").append(document(joint).getroot()[1])
    root, findings = mended(tree)
    assert places(root)[1][1] == pytest.approx(translation((3, 0, 0)))
    assert "as it is shown" in findings[1].message
    assert inverse(places(root)[1][0])[:3, 3] == pytest.approx([-3, 0, 0])
