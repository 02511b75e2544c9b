"""Documents: reading and writing them, and following their references."""

import logging

from colladaphy.document.api import read, write
from colladaphy.document.document import Document, Target
from colladaphy.document.scenes import Model, Models, Scene, Scenes
from colladaphy.mapper import Prefer

# Who wants the log configures it; without that nothing is printed.
logging.getLogger("colladaphy").addHandler(logging.NullHandler())

__all__ = [
    "Document",
    "Model",
    "Models",
    "Prefer",
    "Scene",
    "Scenes",
    "Target",
    "read",
    "write",
]
