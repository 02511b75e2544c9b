"""How reports look: text for people, JSON for programs. No time stamps, sorted, repeatable."""

from colladaphy.validation.reporters.json import as_json
from colladaphy.validation.reporters.text import as_text, changes, summary

__all__ = ["as_json", "as_text", "changes", "summary"]
