"""What runs a World in time: the protocol of engines, the engines, runs and checkpoints."""

from colladaphy.engines.checkpoints import Checkpoints, read_checkpoint
from colladaphy.engines.diagnostics import (
    Summary,
    angular_momentum,
    kinetic_energy,
    momentum,
    potential_energy,
)
from colladaphy.engines.digest import digest
from colladaphy.engines.events import ContactEvent
from colladaphy.engines.observers import Observer, Trajectory
from colladaphy.engines.protocol import Capabilities, Contact, Engine, Steerable
from colladaphy.engines.selection import ENGINES, choose, create_engine, engine_names
from colladaphy.engines.simulation import DEFAULT_TIME_STEP, Simulation
from colladaphy.engines.streaming import ZarrTrajectory

__all__ = [
    "DEFAULT_TIME_STEP",
    "ENGINES",
    "Capabilities",
    "Checkpoints",
    "Contact",
    "ContactEvent",
    "Engine",
    "Observer",
    "Simulation",
    "Steerable",
    "Summary",
    "Trajectory",
    "ZarrTrajectory",
    "angular_momentum",
    "choose",
    "create_engine",
    "digest",
    "engine_names",
    "kinetic_energy",
    "momentum",
    "potential_energy",
    "read_checkpoint",
]
