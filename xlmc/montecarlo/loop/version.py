"""The version of xlmc: runs name it, and processes that share one must have the same."""

from __future__ import annotations

import re
from pathlib import Path

__all__ = ["__version__"]


def _version() -> str:
    """Return the version that `pyproject.toml` states: of a checkout from that file, else as it was installed."""
    project = Path(__file__).parents[3] / "pyproject.toml"
    if project.is_file():
        match = re.search(r'^name = "xlmc"\nversion = "([^"]+)"$', project.read_text(encoding="utf-8"), re.MULTILINE)
        if match is not None:
            return match[1]
    from importlib.metadata import version

    return version("xlmc")


__version__ = _version()
