from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Mapping
from pathlib import Path

import pytest

SESSION = Path(__file__).resolve().parent
NEEDED = {"example_profiles": ["_hypothesis_pytestplugin"]}
"""Plugin of this folder -> the installed ones that it needs; others are not loaded, which is most of such a run."""


@pytest.fixture(scope="session")
def run_tests() -> Callable[..., tuple[int, str]]:
    """`run_tests(folder, {"test_a.py": source}, *arguments, plugins=…, **environment)`: pytest's code and output."""

    def run(
        folder: Path, sources: Mapping[str, str], *arguments: str, plugins: list[str], **environment: str
    ) -> tuple[int, str]:
        (folder / "pytest.ini").write_text("[pytest]\n", encoding="utf-8")
        for name, source in sources.items():
            (folder / name).write_text(source, encoding="utf-8")
        kept = {name: value for name, value in os.environ.items() if not name.startswith(("PYTEST", "HYPOTHESIS"))}
        loaded = ["no:cacheprovider", *plugins, *(name for plugin in plugins for name in NEEDED.get(plugin, ()))]
        loaded += ["xdist.plugin"] if "-n" in arguments else []
        command = [sys.executable, "-m", "pytest", *(f"-p{name}" for name in loaded), *arguments]
        where = kept | {"PYTHONPATH": os.pathsep.join([str(SESSION), *sys.path]), "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}
        where |= environment
        done = subprocess.run(command, cwd=folder, env=where, capture_output=True, text=True, check=False, timeout=120)
        return done.returncode, done.stdout + done.stderr

    return run
