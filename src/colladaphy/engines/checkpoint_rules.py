"""Findings about what is kept of a run: states, checkpoints, trajectories."""

from __future__ import annotations

from colladaphy.findings import Rule, Severity

__all__ = ["RULES"]

STATE_ENGINE = Rule(
    "engine-state-engine",
    Severity.WARNING,
    "The checkpoint was made by another engine: the run goes on from poses and velocities.",
    "Resume with the same engine to go on exactly.",
    section="thesis 6.1",
    why="The run goes on a little differently than it would have.",
)
STATE_VERSION = Rule(
    "engine-state-version",
    Severity.WARNING,
    "The checkpoint was made by another version of the engine: the run goes on from poses and "
    "velocities.",
    "Install the same version to go on exactly.",
    section="thesis 6.1",
    why="The run goes on a little differently than it would have.",
)
STATE_OPTIONS = Rule(
    "engine-state-options",
    Severity.WARNING,
    "The checkpoint was made with other options of the engine: the run goes on from poses and "
    "velocities.",
    "Resume with the same options to go on exactly.",
    section="thesis 6.1",
    why="The run goes on a little differently than it would have.",
)
STATE_NO_ENGINE = Rule(
    "engine-state-no-engine",
    Severity.ERROR,
    "The engine that wrote the checkpoint is not there.",
    "Hand over that engine to go on exactly, or name another one to go on from the World.",
    section="thesis 6.1",
    why="Without the engine, its state says nothing.",
)
STATE_STALE = Rule(
    "engine-state-stale",
    Severity.WARNING,
    "The World was changed after its engine's state was stored: the run goes on from the World.",
    "This is as it should be if the World was edited.",
    section="thesis 6.2.1",
    why="The engine's state would undo what was edited.",
)
STATE_BROKEN = Rule(
    "engine-state-broken",
    Severity.WARNING,
    "The stored state of the engine cannot be understood: the run goes on from the World.",
    "Check where the file comes from.",
    section="thesis 6.1",
    why="The run goes on a little differently than it would have.",
)
CHECKPOINT_BROKEN = Rule(
    "engine-checkpoint-broken",
    Severity.WARNING,
    "A checkpoint is not whole.",
    "It is passed over; remove it when it is not needed to find out what happened.",
    section="thesis 6.1",
    why="What was stored at that step is lost.",
)
CHECKPOINT_NONE = Rule(
    "engine-checkpoint-none",
    Severity.ERROR,
    "There is no checkpoint that is whole.",
    "Name the folder that --checkpoint-dir named, or start anew without --resume.",
    section="thesis 6.1",
    why="There is nothing to go on from.",
)
CHECKPOINT_STATELESS = Rule(
    "engine-checkpoint-stateless",
    Severity.ERROR,
    "The file is a scene, but no checkpoint: it holds no state of an engine.",
    "Start from it without --resume.",
    section="thesis 6.1",
    why="A run that is resumed must go on exactly.",
)
CHECKPOINT_OTHER_RUN = Rule(
    "engine-checkpoint-other-run",
    Severity.ERROR,
    "The folder holds the checkpoints of a run already.",
    "Go on with that run (--resume), or name another folder.",
    section="thesis 6.1",
    why="The checkpoints of two runs in one folder could not be told apart.",
)
TRAJECTORY = Rule(
    "engine-trajectory",
    Severity.ERROR,
    "A trajectory cannot hold this World.",
    "Begin another trajectory when bodies come or go.",
    section="colladaphy docs/engines.md §Trajectories",
    why="Rows of different bodies would stand in one column.",
)

RULES = (
    STATE_ENGINE,
    STATE_VERSION,
    STATE_OPTIONS,
    STATE_NO_ENGINE,
    STATE_STALE,
    STATE_BROKEN,
    CHECKPOINT_BROKEN,
    CHECKPOINT_NONE,
    CHECKPOINT_STATELESS,
    CHECKPOINT_OTHER_RUN,
    TRAJECTORY,
)
