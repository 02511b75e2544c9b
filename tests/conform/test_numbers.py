"""Numbers with commas, too many of them, tensors of six or nine, frames of mass without a place."""

from __future__ import annotations

import io
import re

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from lxml import etree
from tests.conform.documents import (
    ASSET,
    BOX,
    MESH,
    C,
    codes,
    document,
    kept,
    mended,
    physics,
    words,
)

import colladaphy
from colladaphy.conform.frames import transform_of
from colladaphy.conform.numerals import plain_numbers, spelled_number
from colladaphy.testing import worlds
from colladaphy.world import World, compare


@pytest.mark.parametrize(
    ("text", "count", "meant", "decimal"),
    [
        ("0 0 -9,81", 3, "0 0 -9.81", True),
        ("0,5 0,25 0,75", 3, "0.5 0.25 0.75", True),
        ("1,2 3,4 5,6", 3, "1.2 3.4 5.6", True),
        ("1,2 3,4 5,6", 6, "1 2 3 4 5 6", False),
        ("1,2,3", 3, "1 2 3", False),
        ("1, 2, 3", 3, "1 2 3", False),
        ("1 ,2 ,3", 3, "1 2 3", False),
        ("1,2 3", 3, "1 2 3", False),
        ("1,5, 2,5, 3,5", 3, "1.5 2.5 3.5", True),
        ("1,5;2,5;3,5", 3, "1.5 2.5 3.5", True),
        ("0.5,0.25,0.75", 3, "0.5 0.25 0.75", False),
        ("0,0,-10", 3, "0 0 -10", False),
        ("1,5", 1, "1.5", True),
        ("-,5e-3", 1, "-.5e-3", True),
        ("1,000.5", 1, "1000.5", True),
        ("1.234.567,5", 1, "1234567.5", True),
        ("2,000.5 1,000.5", 2, "2000.5 1000.5", True),
    ],
)
def test_a_comma_separates_only_where_the_tokens_need_it(
    text: str, count: int, meant: str, decimal: bool
) -> None:
    assert plain_numbers(text, count, count) == (meant, decimal)


@given(
    st.lists(st.decimals(-(10**6), 10**6, places=3), min_size=1, max_size=6),
    st.sampled_from([" ", "  ", "; ", ", ", "\n", " ,"]),
)
def test_decimal_commas_give_the_numbers_back(numbers: list, between: str) -> None:
    text = between.join(str(number).replace(".", ",") for number in numbers)
    new, decimal = plain_numbers(text, len(numbers), len(numbers))
    assert decimal
    assert [float(word) for word in new.split()] == [float(number) for number in numbers]


@given(
    st.lists(st.integers(-999, 999), min_size=1, max_size=6),
    st.sampled_from([",", ", ", " , ", ";"]),
)
def test_commas_between_whole_numbers_separate(numbers: list[int], between: str) -> None:
    text = between.join(map(str, numbers))
    new, decimal = plain_numbers(text, len(numbers), len(numbers))
    assert new.split() == [str(number) for number in numbers]
    assert not decimal


@pytest.mark.parametrize(
    ("text", "meant"),
    [("1e", "1"), ("-2.5E+", "-2.5"), ("1.5f", "1.5"), ("1d-3", "1e-3"), ("1.D2", "1.e2"),
     ("e5", None), ("1x", None), ("0x1f", None)],
)  # fmt: skip
def test_numbers_as_programs_write_them(text: str, meant: str | None) -> None:
    assert spelled_number(text) == meant


def test_decimal_commas_in_scalars_and_lists_are_warnings() -> None:
    body = (
        "<dynamic>true</dynamic><mass>1,5</mass><shape><density>2,5</density><box>"
        "<half_extents>0,5 0,25 0,75</half_extents></box>"
        "<translate>0,1 0 -0,2</translate></shape>"
    )
    scene = "<technique_common><gravity>0 0 -9,81</gravity><time_step>0,01</time_step>"
    tree = physics(
        body,
        scene=scene + "</technique_common>",
        nodes='<node id="n1"><translate>1,5 -2,75 3</translate><rotate>0 0 1 45,5</rotate></node>',
    )
    root, findings = mended(tree)
    for path, numbers in (
        ("mass", [1.5]), ("density", [2.5]), ("half_extents", [0.5, 0.25, 0.75]),
        ("shape/translate", [0.1, 0, -0.2]), ("gravity", [0, 0, -9.81]), ("time_step", [0.01]),
        ("node/translate", [1.5, -2.75, 3]), ("node/rotate", [0, 0, 1, 45.5]),
    ):  # fmt: skip
        assert [float(word) for word in words(root, path)] == numbers, path
    assert codes(findings) == {"repair-decimal-comma"}
    assert len(findings) == 8
    gravity = next(f for f in findings if f.message.startswith("<gravity>"))
    assert all(finding.severity == "warning" for finding in findings)
    assert "'0 0 -9,81'" in gravity.message


def test_decimal_commas_come_before_what_counts_numbers() -> None:
    solids = (
        "<shape><sphere><radius>1,5</radius></sphere></shape>"
        "<shape><capsule><height>2,5</height><radius>0,5 0,5</radius></capsule></shape>"
        "<mass_frame><matrix>1,0 0 0 0,5 0 1 0 0 0 0 1 0 0 0 0 1</matrix></mass_frame>"
    )
    root, _ = mended(physics(solids, version="1.4.1"))
    assert words(root, "sphere/radius") == ["1.5"]
    assert words(root, "capsule/radius") == ["0.5", "0.5", "0.5"]
    assert words(root, "mass_frame/translate") == ["0.5", "0", "0"]


def test_decimal_commas_in_attributes() -> None:
    asset = ASSET.replace("</asset>", '<unit name="inch" meter="0,0254"/></asset>')
    root, findings = mended(document("", asset=asset))
    assert next(root.iter(C + "unit")).get("meter") == "0.0254"
    assert codes(findings) == {"repair-decimal-comma"}


def test_the_count_of_an_array_says_what_its_commas_are() -> None:
    mesh = MESH.format("g").replace("0 0 0 1 0 0 0 1 0 0 0 1", "0,5 " * 12)
    pairs = MESH.format("k").replace("0 0 0 1 0 0 0 1 0 0 0 1", "0,5 " * 6)
    tree = document(
        f'<library_geometries><geometry id="g"><mesh>{mesh}</mesh></geometry>'
        f'<geometry id="k"><mesh>{pairs}</mesh></geometry></library_geometries>'
    )
    root, findings = mended(tree)
    arrays = [array.text.split() for array in root.iter(C + "float_array")]
    assert arrays == [["0.5"] * 12, ["0", "5"] * 6]
    assert codes(findings) == {"repair-decimal-comma", "repair-lexical-form"}


def test_what_is_cut_off_is_a_warning_with_its_values() -> None:
    body = "<mass>1</mass>" + BOX.replace("1 2 3", "1 2 3 4.5 -6")
    root, findings = mended(physics(body))
    assert words(root, "half_extents") == ["1", "2", "3"]
    assert codes(findings) == {"repair-surplus-values"}
    assert findings[0].severity == "warning"
    assert "4.5 -6" in findings[0].message
    assert "1 2 3 4.5 -6" in kept(root)


PE = 'xmlns:pe="urn:colladaphy:pe:1"'


def profiled(content: str) -> etree._ElementTree:
    """A scene whose body has this in the pe profile."""
    profile = f'<technique profile="pe">{content}</technique>'
    return physics(
        bodies=f'<rigid_body sid="b1"><technique_common>{BOX}</technique_common>{profile}'
        "</rigid_body>"
    )


@pytest.mark.parametrize(("text", "new"), [("1,5", "1.5"), ("1.5e", "1.5"), ("1.5f", "1.5")])
def test_numbers_of_the_profile_are_mended_too(text: str, new: str) -> None:
    root, findings = mended(profiled(f"<pe:body {PE}><pe:mass>{text}</pe:mass></pe:body>"))
    assert [mass.text for mass in root.iter("{*}mass")] == [new]
    assert codes(findings) == {"repair-lexical-form"}


@pytest.mark.parametrize(
    "content",
    [f"<pe:body {PE}><pe:mass>heavy</pe:mass></pe:body>", f'<pe:body {PE} uid="one"/>',
     f"<pe:corpse {PE}/>", f"<pe:body {PE}><pe:lungs/></pe:body>"],
)  # fmt: skip
def test_a_faulty_profile_is_set_aside_and_the_document_goes_on(content: str) -> None:
    root, findings = mended(profiled(content))
    assert list(root.iter("{urn:colladaphy:pe:1}*")) == []
    assert content.split()[0][1:] in kept(root)
    assert codes(findings) == {"repair-faulty-profile"}
    assert words(root, "half_extents") == ["1", "2", "3"]


def test_unfinished_exponents() -> None:
    root, findings = mended(physics("<mass>1.5e</mass>" + BOX))
    assert words(root, "mass") == ["1.5"]
    assert codes(findings) == {"repair-lexical-form"}


# -- tensors


def tensor_of(root: etree._Element) -> tuple[np.ndarray, np.ndarray]:
    """Centre and inertia (3, 3) in the frame of the body, by the textbook."""
    common = root.find(f".//{C}rigid_body/{C}technique_common")
    frame = transform_of(common.find(C + "mass_frame"))
    moments = [float(word) for word in common.findtext(C + "inertia").split()]
    return frame[:3, 3], frame[:3, :3] @ np.diag(moments) @ frame[:3, :3].T


@pytest.mark.parametrize(
    ("text", "tensor"),
    [
        ("0.5 0.4 0.3 0.05 0 0", [[0.5, 0.05, 0], [0.05, 0.4, 0], [0, 0, 0.3]]),
        ("5 4 3 0.1 0.2 0.3", [[5, 0.1, 0.2], [0.1, 4, 0.3], [0.2, 0.3, 3]]),
        ("5 0.1 0.2 4 0.3 3", [[5, 0.1, 0.2], [0.1, 4, 0.3], [0.2, 0.3, 3]]),  # URDF's order
        ("5 0 1 0 4 0 1 0 3", [[5, 0, 1], [0, 4, 0], [1, 0, 3]]),
    ],
)
def test_tensors_of_six_and_nine_numbers_lose_nothing(text: str, tensor: list) -> None:
    frame = "<mass_frame><translate>0 0 1</translate></mass_frame>"
    root, findings = mended(physics(f"<mass>1</mass>{frame}<inertia>{text}</inertia>{BOX}"))
    centre, found = tensor_of(root)
    assert centre == pytest.approx([0, 0, 1])
    assert found == pytest.approx(np.array(tensor), abs=1e-12)
    assert codes(findings) == {"repair-inertia-matrix"}
    assert text in findings[0].message


@given(
    st.lists(st.floats(0.1, 1), min_size=3, max_size=3),
    st.lists(st.floats(-1, 1), min_size=3, max_size=3),
)
def test_any_tensor_that_a_body_can_have_comes_through(squares: list, axis: list) -> None:
    assume(np.linalg.norm(axis) > 0.1)
    x, y, z = squares
    turn = np.linalg.qr(np.column_stack([axis, (1, 0.3, 0.2), (0.1, 1, -0.4)]))[0]
    tensor = turn @ np.diag([y + z, x + z, x + y]) @ turn.T
    tensor = (tensor + tensor.T) / 2
    six = " ".join(repr(float(tensor[i])) for i in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)))
    frame = "<mass_frame><translate>1 2 3</translate></mass_frame>"
    root, _ = mended(physics(f"<mass>1</mass>{frame}<inertia>{six}</inertia>{BOX}"))
    assert tensor_of(root)[1] == pytest.approx(tensor, abs=1e-9)


def test_a_tensor_without_a_frame_is_about_the_shapes_centre_of_mass() -> None:
    shapes = "".join(
        f"<shape><mass>{m}</mass><box><half_extents>1 1 1</half_extents></box>"
        f"<translate>{x} 0 0</translate></shape>"
        for m, x in ((1, 2), (3, 6))
    )
    root, _ = mended(physics(f"<mass>4</mass><inertia>5 4 3 0.1 0 0</inertia>{shapes}"))
    assert tensor_of(root)[0] == pytest.approx([5, 0, 0])


# -- frames without a place


@pytest.mark.parametrize("shapes", [1, 2])
def test_a_frame_that_only_turns_is_at_the_origin_and_says_so(shapes: int) -> None:
    shape = BOX.replace("</shape>", "<translate>5 0 0</translate></shape>")
    frame = "<mass_frame><rotate>0 0 1 90</rotate></mass_frame>"
    root, findings = mended(
        physics(f"<mass>3</mass>{frame}<inertia>1 2 2.5</inertia>{shape * shapes}")
    )
    assert words(root, "mass_frame/translate") == ["0", "0", "0"]
    assert tensor_of(root)[1] == pytest.approx(np.diag([2, 1, 2.5]))
    assert codes(findings) == {"repair-mass-frame-origin"}


def test_frames_that_conform_writes_say_where_they_are() -> None:
    matrix = "0 -1 0 0 1 0 0 0 0 0 1 0 0 0 0 1"
    root, _ = mended(
        physics(f"<mass>1</mass><mass_frame><matrix>{matrix}</matrix></mass_frame>{BOX}")
    )
    assert words(root, "mass_frame/translate") == ["0", "0", "0"]


@settings(max_examples=15, deadline=None)
@given(worlds(), st.integers(1, 30))
def test_numbers_are_read_around_comments(world: World, length: int) -> None:
    """Also where one stands in the midst of a number, in anything that repair looks at."""
    stream = io.BytesIO()
    colladaphy.write(world, stream)

    def cut(found: re.Match[bytes]) -> bytes:
        text = found.group(1)
        pieces = (text[at : at + length] for at in range(0, len(text), length))
        return b">" + b"<!-- x --><?y?>".join(pieces) + b"<"

    data = re.sub(rb">([^<&]{2,400})<", cut, stream.getvalue())
    assert compare(world, colladaphy.read(data, repair=True).load()) == []
