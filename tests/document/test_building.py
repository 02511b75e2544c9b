"""Documents made of dataclasses by hand, and what is found in them."""

from __future__ import annotations

import io

import pytest
from xsdata.models.datatype import XmlDateTime

import colladaphy
from colladaphy_schema import (
    AssetType,
    Collada,
    ColladaScene,
    InstancePhysicsModelType,
    InstanceRigidBodyType,
    InstanceRigidBodyTypeTechniqueCommon,
    InstanceWithExtraType,
    LibraryPhysicsModelsType,
    LibraryPhysicsScenesType,
    LibraryVisualScenesType,
    NodeType,
    PhysicsModelType,
    PhysicsSceneType,
    PhysicsSceneTypeTechniqueCommon,
    RigidBodyType,
    RigidBodyTypeTechniqueCommon,
    RigidBodyTypeTechniqueCommonShape,
    SphereType,
    TargetableFloatType,
    TranslateType,
    VersionEnum,
    VisualSceneType,
)

NOW = XmlDateTime(2020, 1, 2, 3, 4, 5)


def _built() -> Collada:
    """A ball of two kilograms, one metre above the origin."""
    shape = RigidBodyTypeTechniqueCommonShape()
    shape.sphere = SphereType(radius=0.5)
    common = RigidBodyTypeTechniqueCommon(mass=TargetableFloatType(value=2.0), shape=[shape])
    model = PhysicsModelType(
        id="model", rigid_body=[RigidBodyType(sid="ball", technique_common=common)]
    )
    instance = InstancePhysicsModelType(
        url="#model",
        instance_rigid_body=[
            InstanceRigidBodyType(
                body="ball",
                target="#node",
                technique_common=InstanceRigidBodyTypeTechniqueCommon(velocity=[1, 0, 0]),
            )
        ],
    )
    scene = PhysicsSceneType(
        id="scene",
        instance_physics_model=[instance],
        technique_common=PhysicsSceneTypeTechniqueCommon(),
    )
    node = NodeType(id="node", choice=[TranslateType(sid="place", value=[0, 0, 1])])
    return Collada(
        version=VersionEnum.VALUE_1_5_0,
        asset=AssetType(created=NOW, modified=NOW),
        choice=[
            LibraryPhysicsModelsType(physics_model=[model]),
            LibraryPhysicsScenesType(physics_scene=[scene]),
            LibraryVisualScenesType(visual_scene=[VisualSceneType(id="visual", node=[node])]),
        ],
        scene=ColladaScene(
            instance_physics_scene=[InstanceWithExtraType(url="#scene")],
            instance_visual_scene=InstanceWithExtraType(url="#visual"),
        ),
    )


def _written(document: colladaphy.Document) -> bytes:
    target = io.BytesIO()
    document.write(target)
    return target.getvalue()


def test_a_document_of_dataclasses_loads_and_is_written() -> None:
    document = colladaphy.Document(_built())
    (ball,) = document.load().bodies
    assert ball.mass == 2.0 and ball.dimensions[0] == 0.5
    assert ball.position.tolist() == [0, 0, 1] and ball.linear_velocity.tolist() == [1, 0, 0]
    (again,) = colladaphy.read(_written(document)).load().bodies
    assert again.position.tolist() == [0, 0, 1]


def test_what_is_found_is_edited_in_place() -> None:
    document = colladaphy.Document(_built())
    body = document.find("#model/ball")
    assert body is document.root.library_physics_models[0].physics_model[0].rigid_body[0]
    body.technique_common.shape[0].sphere.radius = 3.0
    document.find("node/place").value = [0, 0, 5]
    (ball,) = colladaphy.read(_written(document)).load().bodies
    assert ball.dimensions[0] == 3.0 and ball.position.tolist() == [0, 0, 5]


@pytest.mark.parametrize("reference", ["#nothing", "#model/nothing", "#node/ball", "model/"])
def test_what_is_not_there_is_not_found(reference: str) -> None:
    document = colladaphy.Document(_built())
    with pytest.raises(colladaphy.DocumentError):
        document.find(reference)


def test_what_the_schema_has_not_is_refused_and_nothing_is_written() -> None:
    root = _built()
    root.library_physics_models[0].physics_model[0].rigid_body[0].technique_common.shape.clear()
    document = colladaphy.Document(root)
    target = io.BytesIO()
    with pytest.raises(colladaphy.SchemaError, match="technique_common"):
        document.write(target)
    assert target.getvalue() == b""


@pytest.mark.parametrize("value", ["#nothing", "#model"])
def test_what_validate_calls_invalid_is_refused_and_nothing_is_written(value: str) -> None:
    document = colladaphy.Document(_built())
    document.root.scene.instance_physics_scene[0].url = value
    target = io.BytesIO()
    with pytest.raises(colladaphy.DocumentError, match=value):
        document.write(target)
    assert target.getvalue() == b""


def test_what_is_not_to_be_checked_is_written() -> None:
    document = colladaphy.Document(_built())
    document.find("#model/ball").technique_common.mass.value = -1.0
    target = io.BytesIO()
    document.write(target, check=False)
    assert not colladaphy.validate(target.getvalue()).valid


def test_negative_mass_is_refused() -> None:
    document = colladaphy.Document(_built())
    document.find("#model/ball").technique_common.mass.value = -1.0
    with pytest.raises(colladaphy.DocumentError, match="mass"):
        document.write(io.BytesIO())


@pytest.mark.parametrize("content", [None, 3, "<COLLADA/>", b"<COLLADA/>", SphereType(radius=1)])
def test_a_document_is_made_of_nothing_else(content: object) -> None:
    with pytest.raises(colladaphy.DocumentError, match=type(content).__name__):
        colladaphy.Document(content)  # type: ignore[arg-type]
