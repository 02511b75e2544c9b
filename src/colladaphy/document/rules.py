"""What can be noticed while a World is written back into its document."""

from __future__ import annotations

from colladaphy.findings import Rule, Severity

__all__ = ["RULES"]

_WARNING = Severity.WARNING
_INFO = Severity.INFO

NODE = Rule(
    "store-node-added",
    _INFO,
    "A body got a node of its own, as the one that it is bound to cannot be moved for it alone.",
    "Bind each body to a node that no other body has, and that is instanced once.",
    "COLLADA 1.5 §instance_rigid_body",
    why="If the old node were moved, something else would move with it.",
)
COPIED = Rule(
    "store-copied",
    _INFO,
    "What describes a body describes others too, or stands in another document; as the body is "
    "different now, it is described by a copy.",
    None,
    "thesis 3.3",
    why="To change what is shared would change the others too.",
)
INEXACT = Rule(
    "store-inexact",
    _WARNING,
    "The document does not read back as exactly the World that was written into it.",
    "Write the World as a document of its own: colladaphy.write(world, ...).",
    section="colladaphy.Document.update",
    why="A run that is resumed from it goes on a little differently.",
)
ALONE = Rule(
    "store-world-alone",
    _WARNING,
    "The World was written as a document of its own, without what else the document held.",
    "Without --si, --up-axis and --kinematics, all of the document is kept.",
    section="colladaphy convert",
    why="In another unit or other axes, only bodies and joints are known to be right.",
)
RELEASED = Rule(
    "store-kinematics-released",
    _INFO,
    "The scene's kinematics were taken out of effect, as they have a joint that is gone.",
    "The other joints are rigid_constraints now; what put the kinematics into effect is kept in an "
    "extra of the scene.",
    section="COLLADA 1.5 §instance_kinematics_scene",
    why="Read again, the kinematics would make the joint again.",
)
RULES = (NODE, COPIED, INEXACT, ALONE, RELEASED)
