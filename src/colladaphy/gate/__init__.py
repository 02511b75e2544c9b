"""The XSD gate: what passes it is schema-valid COLLADA 1.5, pe profile included.

`gate` says everything that is wrong with a tree; `is_valid_text` only tells whether the text of a
document is valid, in half the time.
"""

from colladaphy.gate.faults import gate
from colladaphy.gate.schema import schema_folder
from colladaphy.gate.text import is_valid, is_valid_text

__all__ = ["gate", "is_valid", "is_valid_text", "schema_folder"]
