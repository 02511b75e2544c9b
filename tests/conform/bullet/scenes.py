"""Physics scenes of COLLADA 1.5 of every kind that a World can hold, as XML."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from hypothesis import strategies as st

NS15 = "http://www.collada.org/2008/03/COLLADASchema"
Draw = Callable[[st.SearchStrategy[Any]], Any]

coordinate = st.floats(-20, 20).map(lambda x: round(x, 4) + 0.0)
size = st.floats(0.125, 4).map(lambda x: round(x, 4))
degrees = st.one_of(st.sampled_from([0.0, 90.0, -90.0, 180.0]), st.floats(-360, 360))
AXES = ["1 0 0", "0 1 0", "0 0 1", "1 1 0", "1 -2 0.5"]


def text(*values: float) -> str:
    return " ".join(repr(value) for value in values)


@st.composite
def step(draw: Draw) -> str:
    if draw(st.booleans()):
        return f"<translate>{text(*(draw(coordinate) for _ in range(3)))}</translate>"
    return f"<rotate>{draw(st.sampled_from(AXES))} {draw(degrees)!r}</rotate>"


steps = st.lists(step(), max_size=3).map("".join)
plain_steps = st.sampled_from(
    ["", "", "<rotate>0 0 1 -90</rotate>", "<translate>1 2 3</translate>"]
)


@st.composite
def geometry(draw: Draw, plane: bool = True) -> str:
    kinds = ["box", "sphere", "capsule", "cylinder", *(["plane"] if plane else [])]
    a, b = draw(size), draw(size)
    match draw(st.sampled_from(kinds)):
        case "box":
            return f"<box><half_extents>{text(a, b, draw(size))}</half_extents></box>"
        case "sphere":
            return f"<sphere><radius>{a!r}</radius></sphere>"
        case "capsule":
            return f"<capsule><height>{a!r}</height><radius>{text(b, b, b)}</radius></capsule>"
        case "cylinder":
            return f"<cylinder><height>{a!r}</height><radius>{text(b, b)}</radius></cylinder>"
        case _:
            normal = draw(st.sampled_from(["0 0 1", "0 0 2", "0.5 -1 2", "0 1 0"]))
            return f"<plane><equation>{normal} {draw(coordinate)!r}</equation></plane>"


@st.composite
def shape(draw: Draw, plane: bool) -> str:
    weight = draw(st.sampled_from(["", "", "<mass>2</mass>", "<density>0.5</density>"]))
    inner = draw(st.one_of(plain_steps, steps))
    return f"<shape>{weight}{draw(geometry(plane))}{inner}</shape>"


@st.composite
def common(draw: Draw, plane: bool) -> str:
    dynamic = draw(st.sampled_from(["", "<dynamic>true</dynamic>", "<dynamic>0</dynamic>"]))
    mass = draw(st.sampled_from(["", "<mass>3.5</mass>"]))
    frame = draw(st.sampled_from(["", "", "steps"]))
    if frame:
        frame = draw(steps) or "<translate>0 0.5 0</translate>"
        frame = f"<mass_frame>{frame}</mass_frame><inertia>1 2 2.5</inertia>"
    shapes = "".join(draw(st.lists(shape(plane), min_size=1, max_size=3)))
    return f"<technique_common>{dynamic}{mass}{frame}{shapes}</technique_common>"


limit = st.sampled_from(
    [("0", "0"), ("-INF", "INF"), ("1", "-1"), ("-30.5", "45"), ("0", "90"), ("-2", "-1")]
)


@st.composite
def limits(draw: Draw) -> str:
    parts = ""
    for name in ("swing_cone_and_twist", "linear"):
        if draw(st.booleans()):
            pairs = [draw(limit) for _ in range(3)]
            low, high = (" ".join(pair[i] for pair in pairs) for i in range(2))
            ends = draw(st.sampled_from([f"<min>{low}</min><max>{high}</max>", "<min/><max/>", ""]))
            parts += f"<{name}>{ends}</{name}>"
    return draw(st.sampled_from([f"<limits>{parts}</limits>", ""]))


@st.composite
def model(draw: Draw, name: str, attach: tuple[str, ...]) -> tuple[str, list[str], list[str]]:
    """The content of a model, the sids of its bodies and of its constraints."""
    count = draw(st.integers(1, 3))
    sids = [f"b{i}" for i in range(count)]
    bodies = "".join(
        f'<rigid_body sid="{sid}" name="body {sid}">{draw(common(plane=True))}</rigid_body>'
        for sid in sids
    )
    constraints, names = "", []
    for i in range(draw(st.integers(0, 2)) if count > 1 else 0):
        first, second = draw(st.permutations(sids))[:2]
        form = draw(st.sampled_from(attach)).replace("MODEL", name)
        names.append(f"c{i}")
        constraints += (
            f'<rigid_constraint sid="c{i}">'
            f'<ref_attachment rigid_body="{form}{first}">{draw(steps)}</ref_attachment>'
            f'<attachment rigid_body="{form}{second}">{draw(steps)}</attachment>'
            f"<technique_common>{draw(limits())}</technique_common></rigid_constraint>"
        )
    return bodies + constraints, sids, names


class Nodes:
    """Nodes for bodies: at the top, below others, in a library behind an instance."""

    def __init__(self, draw: Draw) -> None:
        self.draw, self.count = draw, 0
        self.top, self.library = "", ""

    def new(self) -> str:
        self.count += 1
        name = f"n{self.count}"
        visual = self.draw(st.sampled_from(["", '<instance_geometry url="#cube"/>']))
        moves = self.draw(st.one_of(plain_steps, steps))
        scale = self.draw(st.sampled_from(["", "", "", "<scale>2 2 2</scale>"]))
        child = f"<node><translate>1 0 0</translate>{visual}</node>" if visual else ""
        node = f'<node id="{name}">{moves}{scale}{visual}{child}</node>'
        match self.draw(st.sampled_from(["top", "top", "below", "deep", "library"])):
            case "top":
                self.top += node
            case "below":
                self.top += f"<node>{self.draw(steps)}{node}</node>"
            case "deep":
                self.top += (
                    f"<node>{self.draw(steps)}<matrix>0 -1 0 1 1 0 0 2 0 0 1 3 0 0 0 1</matrix>"
                    f"<node><scale>3 3 3</scale>{self.draw(steps)}{node}</node></node>"
                )
            case _:
                self.library += node
                self.top += f'<node>{self.draw(steps)}<instance_node url="#{name}"/></node>'
        return name


VECTOR = ["", "<{0}/>", "<{0}>1 -2 3</{0}>", "<{0}>0 90 0</{0}>"]


@st.composite
def scenes(draw: Draw) -> bytes:
    nodes = Nodes(draw)

    def users(sids: list[str], constraints: list[str]) -> str:
        bodies = ""
        for sid in sids:
            said = draw(st.sampled_from(VECTOR)).format("angular_velocity")
            said += draw(st.sampled_from(VECTOR)).format("velocity")
            said += draw(st.sampled_from(["", "", "<dynamic/>", "<dynamic>false</dynamic>"]))
            said += draw(st.sampled_from(["", "", "<mass>7</mass>"]))
            if draw(st.integers(0, 9)) == 0:
                said += draw(shape(plane=False))
            bodies += (
                f'<instance_rigid_body body="{sid}" target="#{nodes.new()}">'
                f"<technique_common>{said}</technique_common></instance_rigid_body>"
            )
        return bodies + "".join(
            f'<instance_rigid_constraint constraint="{name}"/>' for name in constraints
        )

    inner, inner_sids, inner_names = draw(model("inner", ("", "./", "inner/")))
    outer, outer_sids, outer_names = draw(model("outer", ("", "./", "outer/")))
    nested = draw(st.booleans())
    if nested:
        outer += (
            '<instance_physics_model url="#inner" sid="part">'
            f"{users(inner_sids, inner_names)}</instance_physics_model>"
        )
    instances = "".join(
        f'<instance_physics_model url="#outer">{users(outer_sids, outer_names)}'
        "</instance_physics_model>"
        for _ in range(draw(st.integers(1, 1 if nested else 2)))
    )
    gravity = draw(st.sampled_from(["", "<gravity>0 0 -9.81</gravity>"]))
    other = (
        '<physics_scene id="other"><technique_common><gravity>1 1 1</gravity></technique_common>'
        "</physics_scene>"
    )
    second = draw(st.sampled_from(["", other]))
    library = f"<library_nodes>{nodes.library}</library_nodes>" if nodes.library else ""
    document = (
        f'<COLLADA xmlns="{NS15}" version="1.5.0"><asset><created>2024-01-01T00:00:00Z</created>'
        "<modified>2024-01-01T00:00:00Z</modified></asset>"
        f'<library_physics_models><physics_model id="inner">{inner}</physics_model>'
        f'<physics_model id="outer">{outer}</physics_model></library_physics_models>{library}'
        f'<library_visual_scenes><visual_scene id="v">{nodes.top}</visual_scene>'
        "</library_visual_scenes><library_physics_scenes>"
        f'<physics_scene id="s">{instances}<technique_common>{gravity}</technique_common>'
        f"</physics_scene>{second}</library_physics_scenes>"
        '<scene><instance_physics_scene url="#s"/><instance_visual_scene url="#v"/></scene>'
        "</COLLADA>"
    )
    return document.encode()
