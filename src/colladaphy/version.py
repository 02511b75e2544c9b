"""The version, for reports that name the tool that made them."""

from __future__ import annotations

__all__ = ["__version__"]

__version__ = "0.1.0"
