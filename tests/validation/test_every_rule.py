"""Every rule is in the tests: those that no other test names are told here, and nearly told."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from importlib import import_module
from pathlib import Path
from typing import Any, Literal

import pytest
from lxml import etree
from tests.mapper.kinematics.robots import Arm, Segment, document

import colladaphy
from colladaphy.conform.exporting import export
from colladaphy.engines import selection
from colladaphy.engines.checkpoints import Checkpoints
from colladaphy.engines.rules import NOT_INSTALLED
from colladaphy.errors import ColladaError, EngineError
from colladaphy.findings import Finding, Rule
from colladaphy.validation.catalogue import rule_modules
from colladaphy.validation.mending import mend

TESTS = Path(__file__).resolve().parents[1]
BASE = (
    '<COLLADA xmlns="http://www.collada.org/2008/03/COLLADASchema" version="1.5.0">'
    "<asset><created>2010-01-01T00:00:00Z</created><modified>2010-01-01T00:00:00Z</modified>"
    "</asset></COLLADA>"
)
Told = Iterable[Finding]


def world() -> colladaphy.World:
    made = colladaphy.World(gravity=(0, -9.81, 0), up_axis="Y_UP")
    made.create_sphere(1, (0, 2, 0), 0.5, "oak")
    made.create_sphere(2, (3, 2, 0), 0.5, "oak")
    return made


def on_plane(*, solid: bool) -> Told:
    made = world()
    if solid:
        made.create_plane(3, (0, 1, 0), 0, "oak")
    else:
        made.create_box(3, (0, -1, 0), (50, 1, 1), "oak").fixed = True
    return colladaphy.Simulation(made, engine="pymunk").report


def moving_plane(*, fixed: bool) -> Told:
    made = world()
    made.create_plane(3, (0, 1, 0), 0, "oak")
    made.fixed[-1] = fixed  # a column, which is not looked at as the flag of a body is
    return colladaphy.Simulation(made, engine="pymunk").report


def chosen(engine: str) -> Told:
    return colladaphy.Simulation(world(), engine=engine).report


def resumed(folder: Path, *, broken: bool) -> Told:
    run = colladaphy.Simulation(world(), engine="pymunk")
    run.run(1)
    run.checkpoint(folder / "stop.dae")
    stopped = colladaphy.read(folder / "stop.dae").load()
    state = stopped.engine_state
    assert state is not None
    if broken:
        stopped.engine_state = type(state)(
            engine=state.engine, version=state.version, data=b"junk" + state.data
        )
    return colladaphy.Simulation(stopped, engine="pymunk").report


def robot(arm: Arm, *edits: tuple[str, str]) -> Told:
    text = document(arm).decode()
    for old, new in edits:
        assert old in text
        text = text.replace(old, new)
    read = colladaphy.read(text.encode())
    read.load()
    return read.report


FIXED = Segment(joint='<revolute sid="axis0"><axis>0 0 1</axis><limits><min>0</min><max>0</max>'
                      "</limits></revolute>")  # fmt: skip
WITHOUT = ('<instance_rigid_body body="b0" target="#n0"><technique_common/></instance_rigid_body>',
           "")  # fmt: skip
# The bodies are those of other nodes and have other names than the links.
STRANGE = [
    ('target="#base"', 'target="#other"'), ('target="#n0"', 'target="#another"'),
    ('<rigid_body sid="base" name="base">', '<rigid_body sid="x" name="x">'),
    ('body="base"', 'body="x"'), ('name="link 0"><technique', 'name="y"><technique'),
    ('sid="b0"', 'sid="y"'), ('body="b0"', 'body="y"'),
    ("</library_visual_scenes>", "</library_visual_scenes><library_nodes><node id='other'/>"
     "<node id='another'/></library_nodes>"),
]  # fmt: skip


def refused(call: Callable[[], object]) -> Told:
    try:
        call()
    except ColladaError as error:
        return error.findings
    return ()


def scene(id: str) -> Told:
    read = colladaphy.read(BASE.encode())
    read.add_scene(world(), id="first")
    return refused(lambda: read.add_scene(world(), id=id))


def named(name: str) -> Told:
    read = colladaphy.read(BASE.encode())
    read.add_scene(world(), id="first")
    return refused(lambda: read.scenes[name].load())


def union(*members: int) -> Told:
    made = world()
    return refused(lambda: made.create_union(9, [made.body(sid) for sid in members]))


def joint(first: int, second: int) -> Told:
    made = world()
    return refused(
        lambda: made.attach_hinge_joint(made.body(first), made.body(second), axis=(0, 0, 1))
    )


def as_world(content: str) -> Told:
    text = BASE.replace("</COLLADA>", f"{content}</COLLADA>")
    return mend(text.encode()).as_world(si=True, up_axis=None, kinematics=False).report


def no_engine(monkeypatch: pytest.MonkeyPatch, z: float) -> Told:
    """Where MuJoCo is not installed."""
    real = selection.create_engine

    def create(name: str, **options: Any) -> object:
        if name == "mujoco":
            raise EngineError(NOT_INSTALLED.at())
        return real(name, **options)

    with monkeypatch.context() as patch:
        patch.setattr(selection, "create_engine", create)
        made = world()
        made.create_sphere(3, (9, 2, 0), 0.5, "oak").linear_velocity = (0, 0, z)
        return refused(lambda: colladaphy.Simulation(made))


def exported(content: str, reader: Literal["bullet", "collada-1.4"]) -> Told:
    text = BASE.replace("</COLLADA>", f"{content}</COLLADA>")
    _, findings = export(etree.ElementTree(etree.fromstring(text.encode())), reader)
    return findings


def models(*, nested: bool, spin: float) -> str:
    body = (
        "<rigid_body sid='b'><technique_common><dynamic>true</dynamic><mass>1</mass><shape>"
        "<sphere><radius>1</radius></sphere></shape></technique_common></rigid_body>"
    )
    user = (
        "<instance_rigid_body body='b' target='#n'><technique_common>"
        f"<angular_velocity>{spin} 0 0</angular_velocity></technique_common></instance_rigid_body>"
    )
    inner = f"<instance_physics_model url='#inner'>{user}</instance_physics_model>"
    return (
        "<library_visual_scenes><visual_scene id='v'><node id='n'/></visual_scene>"
        "</library_visual_scenes><library_physics_models>"
        f"<physics_model id='inner'>{body}</physics_model>"
        f"<physics_model id='outer'>{inner}</physics_model></library_physics_models>"
        "<library_physics_scenes><physics_scene id='s'>"
        + (inner if not nested else "<instance_physics_model url='#outer'/>")
        + "<technique_common><gravity>0 0 -9.81</gravity></technique_common></physics_scene>"
        "</library_physics_scenes><scene><instance_physics_scene url='#s'/>"
        "<instance_visual_scene url='#v'/></scene>"
    )


def image(attribute: str) -> str:
    return (
        f"<library_images><image id='i'><init_from {attribute}><ref>a.png</ref></init_from>"
        "</image></library_images>"
    )


def evaluation(enable: str) -> str:
    return (
        f"<library_visual_scenes><visual_scene><node id='c'/><evaluate_scene enable='{enable}'>"
        "<render camera_node='#c'><layer>a</layer></render></evaluate_scene></visual_scene>"
        "</library_visual_scenes>"
    )


def checkpoints(folder: Path, *, stored: bool) -> Told:
    kept = Checkpoints(folder)
    kept.begin()
    if stored:
        run = colladaphy.Simulation(world(), engine="pymunk")
        run.run(1)
        run.checkpoint(kept.path(1))
    return refused(kept.newest)


def test_told_and_nearly_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    arm = Arm([Segment(), Segment()], bound=False)
    same_name = ('name="link 1"><technique', 'name="link 0"><technique')
    cases: list[tuple[str, Told, Told]] = [
        ("engine-plane-finite", on_plane(solid=True), on_plane(solid=False)),
        ("engine-moving-plane", refused(lambda: moving_plane(fixed=False)),
         moving_plane(fixed=True)),
        ("engine-chosen", chosen("auto"), chosen("pymunk")),
        ("engine-none", no_engine(monkeypatch, 1.0), no_engine(monkeypatch, 0.0)),
        ("engine-state-broken", resumed(tmp_path, broken=True), resumed(tmp_path, broken=False)),
        ("engine-checkpoint-none", checkpoints(tmp_path / "a", stored=False),
         checkpoints(tmp_path / "b", stored=True)),
        ("kinematics-no-bodies", robot(Arm([Segment()]), *STRANGE), robot(Arm([Segment()]))),
        ("kinematics-joint-empty", robot(Arm([FIXED]), WITHOUT), robot(Arm([FIXED]))),
        ("kinematics-link-unclear", robot(arm, same_name), robot(arm)),
        ("store-scene-id", scene("1st"), scene("second")),
        ("store-scene-id", scene("first"), scene("First")),
        ("store-content", refused(lambda: colladaphy.Document(3)),  # type: ignore[arg-type]
         refused(lambda: colladaphy.Document(colladaphy.read(BASE.encode()).root))),
        ("store-world-alone", as_world("<library_lights><light id='a'><technique_common><ambient>"
         "<color>1 1 1</color></ambient></technique_common></light></library_lights>"),
         as_world("")),
        ("downgrade-bullet-flattened", exported(models(nested=True, spin=0), "bullet"),
         exported(models(nested=False, spin=0), "bullet")),
        ("downgrade-bullet-radians", exported(models(nested=False, spin=9), "bullet"),
         exported(models(nested=False, spin=0), "bullet")),
        ("downgrade-image", exported(image("mips_generate='true'"), "collada-1.4"),
         exported(image(""), "collada-1.4")),
        ("downgrade-evaluate-scene", exported(evaluation("false"), "collada-1.4"),
         exported(evaluation("true"), "collada-1.4")),
        ("link-unknown-scene", named("third"), named("first")),
        ("physics-union-members", union(), union(1)),
        ("physics-union-members", union(1, 1), union(1, 2)),
        ("physics-joint-bodies", joint(1, 1), joint(1, 2)),
    ]  # fmt: skip
    for code, faulty, near in cases:
        assert code in {finding.code for finding in faulty}, code
        assert code not in {finding.code for finding in near}, code


def test_every_rule_is_named_in_a_test() -> None:
    """By its code, by the name of its constant, or, of Bullet's, by the end of its code."""
    files = [path for path in TESTS.rglob("*") if path.suffix in (".py", ".toml")]
    text = "".join(path.read_text("utf-8") for path in files)
    bullet = "".join(path.read_text("utf-8") for path in (TESTS / "conform").rglob("*.py"))
    for module in rule_modules():
        for name, rule in vars(import_module(module)).items():
            if isinstance(rule, Rule) and rule.code not in text:
                end = rule.code.removeprefix("downgrade-").removeprefix("bullet-")
                assert re.search(rf"\b{name}\b", text) or f'"{end}"' in bullet, rule.code
