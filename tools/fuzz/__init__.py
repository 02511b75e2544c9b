"""Fuzzing: the properties that must hold of anything, held to very many examples.

`python -m tools.fuzz` runs them in several processes, counts, and keeps what fails as a file in
tests/regressions, which the tests run for ever after.
"""
