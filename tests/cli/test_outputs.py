"""No file is lost: what convert and repair write, and what they refuse to write."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.cli.test_commands import OLD, VALID, Runner
from tests.mapper.documents import body, collada, instance, model, scene, simple

from colladaphy.cli import run
from colladaphy.source import pack, parse

BOTH = pytest.mark.parametrize("command", ["convert", "repair"])
BROKEN = b"<COLLADA"


@pytest.fixture
def cli(capfd: pytest.CaptureFixture[str]) -> Runner:
    return Runner(capfd)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    made = tmp_path / "in"
    (made / "deep").mkdir(parents=True)
    (made / ".hidden").mkdir()
    for name in ("a.dae", "b.dae", "deep/c.DAE", ".hidden/x.dae"):
        (made / name).write_bytes(OLD)
    (made / "notes.txt").write_text("no document")
    return made


def files(folder: Path) -> dict[str, bytes]:
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


def is_new(path: Path) -> bool:
    return parse(path).tree.getroot().get("version") == "1.5.0"


@BOTH
def test_two_files_of_a_pattern_are_two_inputs(cli: Runner, folder: Path, command: str) -> None:
    before = files(folder)
    result = cli(command, folder / "a.dae", folder / "b.dae")
    assert result.code == 2 and "exists" in result.err
    assert files(folder) == before
    assert cli(command, folder / "a.dae", folder / "b.dae", folder / "deep" / "c.DAE").code == 2
    assert files(folder) == before


@BOTH
def test_out_of_one_input_may_not_exist_unless_forced(
    cli: Runner, folder: Path, command: str
) -> None:
    source, target = folder / "a.dae", folder / "out.dae"
    assert cli(command, source, target).code == 0
    assert is_new(target) and source.read_bytes() == OLD
    target.write_bytes(b"mine")
    assert cli(command, source, target).code == 2
    assert target.read_bytes() == b"mine"
    assert cli(command, source, target, "--force").code == 0
    assert is_new(target)
    target.write_bytes(b"mine")
    assert cli(command, source, "-o", target).code == 0
    assert is_new(target)


@BOTH
@pytest.mark.parametrize("way", ["same", "link", "hard link", "option", "folder"])
def test_an_input_is_never_the_output_by_chance(
    cli: Runner, folder: Path, command: str, way: str
) -> None:
    source, link = folder / "a.dae", folder / "link.dae"
    if way == "link":
        link.symlink_to(source)
    elif way == "hard link":
        link.hardlink_to(source)
    before = files(folder)
    arguments: list[object] = {
        "same": [source, source, "--force"],
        "link": [source, link, "--force"],
        "hard link": [source, link, "--force"],
        "option": [source, "-o", source],
        "folder": [source, folder / "b.dae", "-o", folder],
    }[way]
    result = cli(command, *arguments)
    assert result.code == 2 and "--in-place" in result.err
    assert files(folder) == before


@BOTH
def test_in_place_keeps_what_was_there(cli: Runner, folder: Path, command: str) -> None:
    source = folder / "a.dae"
    (folder / "a.dae.bak").write_bytes(b"mine")
    assert cli(command, source, "--in-place").code == 0
    assert is_new(source)
    assert (folder / "a.dae.bak").read_bytes() == b"mine"
    assert (folder / "a.dae.bak2").read_bytes() == OLD
    # There is nothing left to change, and so nothing is written.
    before = source.stat().st_mtime_ns
    assert cli(command, source, "--in-place").code == 0
    assert source.stat().st_mtime_ns == before and not (folder / "a.dae.bak3").exists()
    assert cli(command, folder / "b.dae", "--in-place", "--no-backup").code == 0
    assert is_new(folder / "b.dae") and not (folder / "b.dae.bak").exists()
    assert cli(command, source, "--in-place", "-o", folder / "new.dae").code == 2


@BOTH
def test_a_folder_goes_through_with_its_folders(
    cli: Runner, folder: Path, tmp_path: Path, command: str
) -> None:
    out = tmp_path / "out"
    out.mkdir()
    before = files(folder)
    (folder / "b.dae").write_bytes(BROKEN)
    result = cli(command, folder, "-o", out)
    assert result.code == 1, result.err
    assert sorted(files(out)) == ["a.dae", "deep/c.DAE"]
    assert is_new(out / "a.dae") and is_new(out / "deep" / "c.DAE")
    assert "3 documents: 2 " in result.err.splitlines()[-2]
    assert "b.dae" in result.err.splitlines()[-1]
    assert files(folder) == before | {"b.dae": BROKEN}
    # What exists is not replaced unasked.
    (out / "a.dae").write_bytes(b"mine")
    refused = cli(command, folder, "-o", out)
    assert refused.code == 2 and "--force" in refused.err
    assert (out / "a.dae").read_bytes() == b"mine"
    assert cli(command, folder, "-o", out, "--force").code == 1
    assert is_new(out / "a.dae")


@BOTH
def test_several_files_in_place(cli: Runner, folder: Path, command: str) -> None:
    (folder / "b.dae").write_bytes(BROKEN)
    result = cli(command, folder / "a.dae", folder / "b.dae", folder / "none.dae", "--in-place")
    assert result.code == 2
    assert is_new(folder / "a.dae") and (folder / "b.dae").read_bytes() == BROKEN
    assert not (folder / "b.dae.bak").exists()
    assert "3 documents: 1 " in result.err and "none.dae" in result.err


@BOTH
def test_two_documents_are_never_one_file(
    cli: Runner, folder: Path, tmp_path: Path, command: str
) -> None:
    (folder / "deep" / "a.dae").write_bytes(OLD)
    result = cli(command, folder / "a.dae", folder / "deep" / "a.dae", "-o", f"{tmp_path}/new/")
    assert result.code == 2 and "both" in result.err
    assert not (tmp_path / "new").exists()


@BOTH
@pytest.mark.parametrize("name", ["x.usda", "x.urdf", "x.dea", "x", "x.dae.bak"])
def test_names_that_say_another_format_are_refused(
    cli: Runner, folder: Path, command: str, name: str
) -> None:
    for arguments in ([folder / name], ["-o", folder / name]):
        result = cli(command, folder / "a.dae", *arguments)
        assert result.code == 2
        assert not (folder / name).exists()


@BOTH
def test_a_folder_that_is_new_is_made(cli: Runner, folder: Path, command: str) -> None:
    assert cli(command, folder / "a.dae", "-o", f"{folder}/new/").code == 0
    assert is_new(folder / "new" / "a.dae")
    several = cli(command, folder / "a.dae", folder / "b.dae", "-o", folder / "one.dae")
    assert several.code == 2 and not (folder / "one.dae").exists()


def test_a_dry_run_writes_nothing(cli: Runner, folder: Path) -> None:
    before = files(folder)
    result = cli("repair", folder, "--dry-run")
    assert result.code == 0 and "upgrade-version" in result.err
    assert cli("repair", folder / "a.dae", "--dry-run", "--in-place").code == 2
    assert files(folder) == before


# --- losses


def bodies(*radii: str) -> bytes:
    shape = "<shape><mass>1</mass><sphere><radius>{}</radius></sphere></shape>"
    return collada(
        model(*(body(f"b{at}", shape.format(radius)) for at, radius in enumerate(radii))),
        scene(*(instance(f"b{at}") for at in range(len(radii)))),
    )


def test_bodies_that_are_lost_are_said_last(cli: Runner, tmp_path: Path) -> None:
    source = tmp_path / "in.dae"
    source.write_bytes(bodies("1", "0", "2", "0"))
    result = cli("convert", source, tmp_path / "out.dae")
    assert result.code == 0
    *reasons, last = result.err.splitlines()
    assert last.endswith("warning: 2 of 4 bodies cannot be loaded.")
    assert [reason.split("'")[1] for reason in reasons] == ["b1", "b3"]
    assert cli("convert", source, "-o", tmp_path / "out.dae", "--strict").code == 1
    source.write_bytes(bodies("1", "2"))
    assert cli("convert", source, "-o", tmp_path / "out.dae", "--strict").err == ""


def test_an_empty_world_is_an_error(cli: Runner, tmp_path: Path) -> None:
    source = tmp_path / "in.dae"
    source.write_bytes(bodies("0", "0"))
    result = cli("convert", source, tmp_path / "out.dae")
    assert result.code == 1
    last = "error: The World is empty: none of its 2 bodies can be loaded."
    assert result.err.splitlines()[-1].endswith(last)
    assert (tmp_path / "out.dae").exists()


def test_a_scene_that_nothing_instances_is_no_error(cli: Runner, tmp_path: Path) -> None:
    source = tmp_path / "in.dae"
    source.write_bytes(bodies("1").replace(b'<instance_physics_scene url="#s"/>', b""))
    none = cli("convert", "--convention", "none", source, tmp_path / "out.dae")
    assert none.code == 0


def test_info_counts_bodies_as_bodies(cli: Runner, tmp_path: Path) -> None:
    flat = "<shape><mass>1</mass><sphere><radius>0</radius></sphere></shape>"
    source = tmp_path / "in.dae"
    source.write_bytes(
        collada(model(body("a", flat * 3), body("b")), scene(instance("a") + instance("b")))
    )
    said = cli("info", source).out
    assert "skipped bodies: 1\n" in said and "skipped shapes: 3\n" in said


# --- files that are referred to


def cart(folder: Path) -> Path:
    """A document in a folder, with a model in another one below and an image."""
    wheel = simple().replace(b"2008/03/COLLADASchema", b"2008/03/COLLADASchema")
    (folder / "parts" / "more").mkdir(parents=True)
    (folder / "parts" / "wheel.dae").write_bytes(
        wheel.replace(
            b"</physics_model>",
            b'<instance_physics_model url="more/bolt.dae#m"/></physics_model>',
        )
    )
    (folder / "parts" / "more" / "bolt.dae").write_bytes(simple())
    (folder / "wood nut.png").write_bytes(b"PNG")
    image = '<image id="i"><init_from><ref>wood%20nut.png</ref></init_from></image>'
    document = collada(
        model(body()),
        scene(
            '<instance_physics_model url="parts/wheel.dae#m">'
            f"{instance('b', 'parts/wheel.dae#n')}</instance_physics_model>"
        ),
    ).replace(b"<library_physics_models>", f"<library_images>{image}</library_images>"
              "<library_physics_models>".encode())  # fmt: skip
    (folder / "cart.dae").write_bytes(document)
    return folder / "cart.dae"


COMPANIONS = ["parts/more/bolt.dae", "parts/wheel.dae", "wood nut.png"]


@BOTH
def test_what_is_referred_to_goes_along_to_another_folder(
    cli: Runner, tmp_path: Path, command: str
) -> None:
    source = cart(tmp_path / "in")
    before = files(tmp_path / "in")
    out = tmp_path / "out"
    out.mkdir()
    result = cli(command, source, out / "new.dae")
    assert result.code == 0 and result.err.count("io-companion-taken") == 3
    assert sorted(files(out)) == ["new.dae", *COMPANIONS]
    assert run(["info", str(out / "new.dae")]) == 0
    assert "bodies: 1 " in cli("info", out / "new.dae").out
    assert files(tmp_path / "in") == before
    # Again, they are there already; another file of such a name is nobody's to replace.
    assert "io-companion" not in cli(command, source, "-o", out / "new.dae").err
    (out / "wood nut.png").write_bytes(b"mine")
    assert "io-companion-left" in cli(command, source, "-o", out / "new.dae").err
    assert (out / "wood nut.png").read_bytes() == b"mine"


@BOTH
def test_what_is_referred_to_goes_into_an_archive_and_out_of_it(
    cli: Runner, tmp_path: Path, command: str
) -> None:
    source = cart(tmp_path / "in")
    assert cli(command, source, tmp_path / "cart.zae").code == 0
    parsed = parse(tmp_path / "cart.zae")
    assert parsed.archive is not None and set(COMPANIONS) < set(parsed.archive.names)
    out = tmp_path / "out"
    out.mkdir()
    assert cli(command, tmp_path / "cart.zae", out / "new.dae").code == 0
    assert sorted(files(out)) == ["new.dae", *COMPANIONS]
    assert "bodies: 1 " in cli("info", out / "new.dae").out


def test_old_documents_that_are_referred_to_are_converted_too(cli: Runner, tmp_path: Path) -> None:
    source = cart(tmp_path / "in")
    bolt = tmp_path / "in" / "parts" / "more" / "bolt.dae"
    bolt.write_bytes(OLD)
    (tmp_path / "out").mkdir()
    cli("convert", source, tmp_path / "out" / "new.dae")
    assert is_new(tmp_path / "out" / "parts" / "more" / "bolt.dae")


@BOTH
def test_what_cannot_go_along_is_said_with_its_line(
    cli: Runner, tmp_path: Path, command: str
) -> None:
    source = cart(tmp_path / "in")
    (tmp_path / "in" / "wood nut.png").unlink()
    (tmp_path / "out").mkdir()
    result = cli(command, source, tmp_path / "out" / "new.dae")
    (line,) = [line for line in result.err.splitlines() if "io-reference-missing" in line]
    assert "cart.dae:1" in line and "wood%20nut.png" in line


def test_archives_keep_what_they_hold(cli: Runner, tmp_path: Path) -> None:
    source = tmp_path / "in.zae"
    source.write_bytes(pack(VALID, name="x/a.dae", others={"x/not-referred-to.png": b"png"}))
    assert cli("convert", source, tmp_path / "out.zae").code == 0
    archive = parse(tmp_path / "out.zae").archive
    assert archive is not None and "x/not-referred-to.png" in archive.names


# --- units, axes, kinematics, limits


CENTIMETRES = collada(
    model(body()),
    scene(
        instance(values="<velocity>100 200 300</velocity>"), values="<gravity>0 -981 0</gravity>"
    ),
    '<node id="n"><translate>400 500 600</translate></node><node id="k"><instance_light url="#l"/>'
    "</node>",
    unit='<unit name="centimeter" meter="0.01"/>',
    up_axis="X_UP",
).replace(
    b"<library_physics_models>",
    b'<library_lights><light id="l"><technique_common><ambient><color>1 1 1</color></ambient>'
    b"</technique_common></light></library_lights><library_physics_models>",
)


def test_si_and_up_axis(cli: Runner, tmp_path: Path) -> None:
    import json

    import colladaphy

    source, out = tmp_path / "in.dae", tmp_path / "out.dae"
    source.write_bytes(CENTIMETRES)
    asked = ["--si", "--up-axis", "Z_UP"]
    facts = json.loads(cli("info", source, "--format", "json", *asked).out)["world"]
    assert facts["unit"]["meter"] == 1.0 and facts["up_axis"] == "Z_UP"
    assert facts["reach"] == [[-5.0, -6.0, 4.0]] * 2 and facts["gravity"] == [9.81, 0.0, 0.0]
    plain = json.loads(cli("info", source, "--format", "json").out)["world"]
    assert plain["unit"]["meter"] == 0.01 and plain["reach"] == [[400.0, 500.0, 600.0]] * 2
    converted = cli("convert", source, out, *asked)
    assert converted.code == 0 and "<library_lights> was left out" in converted.err
    simulated = tmp_path / "end.dae"
    run = cli("simulate", source, simulated, "--steps", 0, "--engine", "mujoco", *asked)
    assert run.code == 0 and "World alone" in run.err
    for file in (out, simulated):
        document = colladaphy.read(file)
        assert document.unit[1] == 1.0 and document.up_axis == "Z_UP"
        (made,) = document.load().bodies
        assert made.position.tolist() == [-5.0, -6.0, 4.0]
        assert made.linear_velocity.tolist() == [-2.0, -3.0, 1.0]
        assert made.dimensions[0] == 0.01


def test_losses_are_counted_once(cli: Runner, tmp_path: Path) -> None:
    source = tmp_path / "in.dae"
    source.write_bytes(bodies("1", "0"))
    result = cli("convert", source, tmp_path / "out.dae", "--up-axis", "Y_UP")
    assert result.err.splitlines()[-1].endswith("warning: 1 of 2 bodies cannot be loaded.")


def test_kinematics_are_an_option(cli: Runner, tmp_path: Path) -> None:
    import colladaphy
    from colladaphy.world import World

    world = World()
    ends = [world.create_box(uid, (2 * uid, 0, 0), (1, 1, 1), "iron") for uid in (1, 2)]
    world.attach_hinge_joint(*ends, axis=(0, 0, 1))
    source, out = tmp_path / "in.dae", tmp_path / "out.dae"
    colladaphy.write(world, source)
    assert b"kinematics" not in source.read_bytes()
    assert cli("convert", source, out, "--kinematics").code == 0
    assert b"<kinematics_model" in out.read_bytes()
    assert "robot" in cli("info", out).out
    assert [joint.kind for joint in colladaphy.read(out).load().joints] == [world.joints[0].kind]


def test_simulate_takes_limits_and_conventions(cli: Runner, tmp_path: Path) -> None:
    source, out = tmp_path / "in.dae", tmp_path / "out.dae"
    long = b"<!--" + b"x" * 11_000_000 + b"--></COLLADA>"
    source.write_bytes(simple().replace(b"</COLLADA>", long))
    arguments = ["simulate", source, out, "--engine", "mujoco", "--steps", 4,
                 "--checkpoint-every", 2]  # fmt: skip
    refused = cli(*arguments)
    assert refused.code == 1 and "--limit text=" in refused.err
    assert cli(*arguments, "--limit", "text=12000000").code == 0
    # The checkpoints hold all of IN, and are read within the same limits.
    more = [*arguments, "--resume", "--limit", "text=12000000"]
    assert cli(*more).code == 0
    source.write_bytes(OLD)
    assert cli("simulate", source, "--steps", 0, "--engine", "mujoco").code == 1
    mended = cli("simulate", source, "--steps", 0, "--engine", "mujoco", "--convention", "none")
    assert mended.code == 0


def test_merging_makes_a_document_that_stands_alone(cli: Runner, tmp_path: Path) -> None:
    import colladaphy
    from colladaphy.world import compare

    source = cart(tmp_path / "in")
    (tmp_path / "in" / "parts" / "tin.png").write_bytes(b"PNG")
    wheel = tmp_path / "in" / "parts" / "wheel.dae"
    image = b'<library_images><image id="i"><init_from><ref>tin.png</ref></init_from></image>'
    wheel.write_bytes(
        wheel.read_bytes().replace(
            b"<library_physics_models>", image + b"</library_images><library_physics_models>", 1
        )
    )
    before = colladaphy.read(source).load()
    out = tmp_path / "out"
    out.mkdir()
    result = cli("convert", source, out / "new.dae", "--merge")
    assert result.code == 0 and result.err.count("io-companion-merged") == 2
    assert sorted(files(out)) == ["new.dae", "parts/tin.png", "wood nut.png"]
    document = colladaphy.read(out / "new.dae")
    assert compare(before, document.load()) == [] and len(before.bodies) == 1
    assert document.related == [] and not document.report.errors
    assert b".dae" not in (out / "new.dae").read_bytes()
    ids = [e.get("id") for e in document.tree.iter("{*}physics_model", "{*}node", "{*}image")]
    assert len(set(ids)) == len(ids) == 8


def test_what_cannot_be_merged_stays_referred_to(cli: Runner, tmp_path: Path) -> None:
    source = cart(tmp_path / "in")
    (tmp_path / "in" / "parts" / "more" / "bolt.dae").unlink()
    result = cli("convert", source, tmp_path / "new.dae", "--merge")
    assert result.code == 0 and "io-reference-missing" in result.err
    assert b'url="parts/more/bolt.dae#m"' in (tmp_path / "new.dae").read_bytes()
    assert "bodies: 1 " in cli("info", tmp_path / "new.dae").out
    (tmp_path / "in" / "parts" / "wheel.dae").unlink()
    result = cli("convert", source, tmp_path / "other.dae", "--merge")
    assert result.err.count("io-reference-missing") == 1  # not once for each way to look for it
