"""Where the peers live: a virtual environment of the benchmark's own, which may be thrown away at any time."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

__all__ = ["HOME", "PEERS", "install", "missing", "python"]

HOME = Path(__file__).resolve().parent / ".peers"
PEERS = {"ironcalc": "ironcalc==0.9.*", "formualizer": "formualizer==0.13.*"}
"""Module -> what is installed, from PyPI."""


def python(home: Path = HOME) -> Path:
    """The environment's interpreter, whether it exists or not."""
    return home / ("Scripts/python.exe" if sys.platform == "win32" else "bin/python")


def install(home: Path = HOME) -> None:
    """Make the environment and install what is missing."""
    if not python(home).exists():
        subprocess.run([sys.executable, "-m", "venv", str(home)], check=True)
    wanted = [PEERS[name] for name in missing(home)]
    if wanted:
        subprocess.run([str(python(home)), "-m", "pip", "install", "-q", *wanted], check=True)


def missing(home: Path = HOME) -> list[str]:
    """The peers that cannot be imported."""
    if not python(home).exists():
        return list(PEERS)
    return [name for name in PEERS if not _imports(name, home)]


def _imports(name: str, home: Path) -> bool:
    return subprocess.run([str(python(home)), "-c", f"import {name}"], capture_output=True).returncode == 0
