"""The names of the formats of reports; they can be listed without the modules that make them."""

from __future__ import annotations

__all__ = ["FORMATS"]

#: The formats by name, with what the help says of them. Each is made by the function `render` of
#: the module of its name in `reporters`.
FORMATS = {
    "full": "for people, with the source, why it matters and what to do",
    "concise": "a line a finding",
    "json": "everything, by a published schema (--json-schema)",
    "sarif": "SARIF 2.1.0, for code scanning",
    "github": "annotations of GitHub's workflows",
    "gitlab": "GitLab's code quality report",
    "junit": "JUnit XML, a suite a file",
}
