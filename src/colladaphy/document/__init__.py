"""Documents: reading and writing them, and following their references."""

from colladaphy.document.api import read, write
from colladaphy.document.document import Document, Prefer
from colladaphy.document.references import Target
from colladaphy.document.scenes import Model, Models, Scene, Scenes

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
