"""What the scripts of pages compute, by node's own test runner."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest
from needed_programs import missing

SCRIPTS = sorted(Path(__file__).with_name("scripts").glob("*.test.mjs"))


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda each: each.stem)
def test_scripts_compute_what_they_should(script):
    if reason := missing("node"):
        pytest.skip(reason)
    done = subprocess.run(
        [shutil.which("node"), "--test", str(script)], capture_output=True, text=True, encoding="utf-8", check=False
    )
    assert done.returncode == 0, done.stdout
    assert "\n# fail 0" in done.stdout
    assert "\n# pass 0" not in done.stdout
