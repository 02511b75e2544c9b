"""The World: rigid bodies after the pe engine, in numpy columns."""

from colladaphy.world import rotations
from colladaphy.world.attaching import FREE, LOCKED
from colladaphy.world.body import Body
from colladaphy.world.columns import BodyColumns, JointColumns, MemberColumns
from colladaphy.world.compare import compare
from colladaphy.world.joints import Joint
from colladaphy.world.kinds import JointKind, Kind
from colladaphy.world.materials import Material, MaterialPair, PairOverride
from colladaphy.world.meshes import Mesh
from colladaphy.world.storage import EngineState
from colladaphy.world.world import World

__all__ = [
    "FREE",
    "LOCKED",
    "Body",
    "BodyColumns",
    "EngineState",
    "Joint",
    "JointColumns",
    "JointKind",
    "Kind",
    "Material",
    "MaterialPair",
    "MemberColumns",
    "Mesh",
    "PairOverride",
    "World",
    "compare",
    "rotations",
]
