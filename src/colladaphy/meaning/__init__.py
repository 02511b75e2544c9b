"""Meaning: what is right and wrong in a document that is schema-valid, each rule written once.

A rule is a small function over columns that says at which elements it is not kept. `check` runs
all of them, by subject; what it does not report as an error can be loaded.
"""

from colladaphy.meaning.checking import SUBJECTS, check, hits_of
from colladaphy.meaning.hits import Hit, findings_of

__all__ = ["SUBJECTS", "Hit", "check", "findings_of", "hits_of"]
