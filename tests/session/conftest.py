from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

SESSION = Path(__file__).resolve().parent
PLUGINS = {"example_profiles": "_hypothesis_pytestplugin"}
"""Plugin of this folder -> the installed one that it needs; others are not loaded, which is most of such a run."""


@pytest.fixture
def run_tests(tmp_path) -> Callable[..., tuple[int, str]]:
    """`run_tests(source, *arguments, plugin=…, **environment)`: the exit code and the output of pytest on these tests.

    They lie in `tmp_path / "project"`.
    """
    project = tmp_path / "project"
    project.mkdir()
    (project / "pytest.ini").write_text("[pytest]\n", encoding="utf-8")

    def run(source: str, *arguments: str, plugin: str, **environment: str) -> tuple[int, str]:
        (project / "test_given.py").write_text(source, encoding="utf-8")
        kept = {name: value for name, value in os.environ.items() if not name.startswith(("PYTEST", "HYPOTHESIS"))}
        plugins = [plugin, "no:cacheprovider", *([PLUGINS[plugin]] if plugin in PLUGINS else [])]
        plugins += ["xdist.plugin"] if "-n" in arguments else []
        command = [sys.executable, "-m", "pytest", *(f"-p{name}" for name in plugins), *arguments]
        where = kept | {"PYTHONPATH": os.pathsep.join([str(SESSION), *sys.path]), "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}
        where |= environment
        done = subprocess.run(command, cwd=project, env=where, capture_output=True, text=True, check=False, timeout=120)
        return done.returncode, done.stdout + done.stderr

    return run
