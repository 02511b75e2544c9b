"""The pytest plugin: ``pytest --colladaphy-profile nightly`` sets how much hypothesis tries.

It is loaded by its entry point wherever colladaphy is installed beside pytest, and does nothing
unless the option is given: it stands apart from colladaphy.testing, which needs hypothesis.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pytest

__all__ = ["PROFILES", "pytest_addoption", "pytest_configure"]

PROFILES: dict[str, dict[str, Any]] = {
    "quick": {"max_examples": 20, "phases": ("explicit", "reuse", "generate")},
    "ci": {"max_examples": 100, "derandomize": True, "print_blob": True},
    "nightly": {"max_examples": 5000},
}
"""Settings of hypothesis by profile. Examples of documents take their time: none has a deadline."""

_PREFIX = "colladaphy-"


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the option to pytest."""
    group = parser.getgroup("colladaphy", "property-based tests with colladaphy.testing")
    group.addoption(
        "--colladaphy-profile",
        choices=sorted(PROFILES),
        help="How much hypothesis tries: quick (20 examples a test, not shrunk), ci (100, the same "
        "every time) or nightly (5,000). Tests with settings of their own keep these.",
    )


def pytest_configure(config: pytest.Config) -> None:
    """Load the profile that was asked for, for hypothesis in this process."""
    name = config.getoption("--colladaphy-profile")
    if name is not None:
        _load(name)


def _load(name: str) -> None:
    from hypothesis import HealthCheck, Phase, settings

    chosen = dict(PROFILES[name])
    if "phases" in chosen:
        chosen["phases"] = [Phase[phase] for phase in chosen["phases"]]
    settings.register_profile(
        _PREFIX + name,
        settings.get_profile("default"),
        deadline=None,
        suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
        **chosen,
    )
    settings.load_profile(_PREFIX + name)
