"""Checking documents: the stages, the catalogue of rules, the reporters.

The package is named for the noun so that ``colladaphy.validate`` can be the function: a
subpackage of that name would take its place as soon as something imports it.
"""

from colladaphy.validation.catalogue import all_rules, find_rule
from colladaphy.validation.stages import validate

__all__ = ["all_rules", "find_rule", "validate"]
