"""What every test shares: hypothesis profiles and the folder of real files."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, Phase, settings

ROOT = Path(__file__).resolve().parent.parent
CORPUS = ROOT.parent / "shared" / "corpus"
OFFICIAL_SCHEMA = Path("/usr/lib/opencollada/collada_schema_1_5.xsd")

_slow_is_fine = [HealthCheck.too_slow, HealthCheck.data_too_large]
settings.register_profile("dev", deadline=None, suppress_health_check=_slow_is_fine)
# Continuous integration repeats the same examples, so that a red run means a change for the worse.
# There are thousands of tests, so that each takes fewer; "nightly" takes many.
settings.register_profile(
    "ci", settings.get_profile("dev"), max_examples=25, derandomize=True, print_blob=True
)
settings.register_profile(
    "quick",
    settings.get_profile("dev"),
    max_examples=20,
    phases=[Phase.explicit, Phase.reuse, Phase.generate],
)
settings.register_profile("nightly", settings.get_profile("dev"), max_examples=2000)
settings.load_profile(
    os.environ.get("HYPOTHESIS_PROFILE") or ("ci" if os.environ.get("CI") else "dev")
)


def need(path: Path, what: str) -> Path:
    """`path`, or a skip with a reason; a failure where CI is set, which must have everything."""
    if path.exists():
        return path
    if os.environ.get("CI"):
        pytest.fail(f"{what} is missing at {path}, and CI must not pass without it")
    pytest.skip(f"{what} is not at {path}")


@pytest.fixture(scope="session")
def corpus_dir() -> Path:
    """The folder of real third-party files, which is not part of the project."""
    return need(CORPUS, "the corpus of real files")


@pytest.fixture(scope="session")
def corpus_facts(corpus_dir: Path) -> dict[str, Any]:
    """Independent counts of the corpus, by file name."""
    facts: dict[str, Any] = json.loads((corpus_dir / "facts.json").read_text("utf-8"))
    return facts


@pytest.fixture(scope="session")
def official_schema() -> Path:
    """The published COLLADA 1.5 schema, as Debian's opencollada-tools installs it."""
    return need(OFFICIAL_SCHEMA, "the official schema (Debian package opencollada-tools)")
