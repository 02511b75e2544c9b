"""The XSD gate: what passes it is schema-valid COLLADA 1.5, pe profile included.

`gate` says everything that is wrong with a tree. `accepts` and `is_valid_text` only tell from the
bytes whether anything is, in half the time.
"""

from colladaphy.gate.faults import gate
from colladaphy.gate.schema import schema_folder
from colladaphy.gate.text import accepts, is_valid, is_valid_text

__all__ = ["accepts", "gate", "is_valid", "is_valid_text", "schema_folder"]
