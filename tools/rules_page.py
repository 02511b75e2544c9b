"""The page of all findings' codes, made from the catalogue.

``python -m tools.rules_page`` writes docs/rules.md; ``--check`` fails where it is out of date.
"""

from __future__ import annotations

import argparse
import sys
from itertools import groupby
from pathlib import Path

from colladaphy.findings import Rule
from colladaphy.validation.catalogue import own_rules
from colladaphy.validation.tellers import TELLERS, tellers

PAGE = Path(__file__).resolve().parent.parent / "docs" / "rules.md"
HEAD = """# Codes of findings

Made from the catalogue by `python -m tools.rules_page`. A code is never reused for something else.
Only findings of severity error make a document invalid.
"""


def page() -> str:
    """The page's text, one table a stage."""
    parts = [HEAD, "Told by:\n", *(f"- {use}: {what}" for use, what in TELLERS.items())]
    for stage, rules in groupby(own_rules(), key=lambda rule: rule.stage):
        parts.append(
            f"\n## {stage}\n\n"
            "| code | severity | what it means | why | what to do | source | told by |"
        )
        parts.append("|---|---|---|---|---|---|---|")
        parts.extend(map(row, rules))
    return "\n".join(parts) + "\n"


def row(rule: Rule) -> str:
    cells = (f"`{rule.code}`", str(rule.severity), rule.summary, rule.why, rule.hint,
             rule.section, ", ".join(tellers(rule.code)))  # fmt: skip
    return "| " + " | ".join((cell or "").replace("|", "\\|") for cell in cells) + " |"


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="python -m tools.rules_page", description=__doc__)
    parser.add_argument("--check", action="store_true", help="only say whether it is up to date")
    check = parser.parse_args(arguments).check
    text = page()
    if not check:
        PAGE.parent.mkdir(exist_ok=True)
        PAGE.write_text(text, "utf-8")
        return 0
    if PAGE.exists() and PAGE.read_text("utf-8") == text:
        return 0
    print(f"{PAGE.name} is out of date: run 'python -m tools.rules_page'", file=sys.stderr)
    return 1


if __name__ == "__main__":
    sys.exit(main())
