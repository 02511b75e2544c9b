"""Checking documents: the catalogue of rules, the stages, the reporters.

The package is named for the noun so that ``colladaphy.validate`` can be the function: a
subpackage of that name would take its place as soon as something imports it.
"""
