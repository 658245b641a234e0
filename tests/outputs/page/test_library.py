"""The charting library is shipped as its authors made it."""

from __future__ import annotations

import hashlib
import re
import tomllib
from importlib.resources import files
from pathlib import Path

import pytest

FOLDER = files("xlmc.outputs.page") / "uplot"
ROOT = Path(__file__).resolve().parents[3]
SUMS = {
    "uPlot.iife.min.js": "19c8d4c6ad88929a79f4ae49d6f7161566dfd0ba3d15cc495e974f787eb78f1f",
    "uPlot.min.css": "df630c6a8d6f8eeaff264b50f73ce5b114f646ffd9a0bb74f049b0a00135fa04",
    "LICENSE": "8f989229699b4fe2f1a0432d0e9edc338a8a911e250e2d1b01ecd770a5f5b1bd",
}


@pytest.mark.parametrize("name", SUMS)
def test_its_files_are_unmodified(name):
    assert hashlib.sha256((FOLDER / name).read_bytes()).hexdigest() == SUMS[name]


def test_the_note_says_which_it_is():
    note = (FOLDER / "README.md").read_text(encoding="utf-8")
    version = re.search(r"\(v([\d.]+)\)", (FOLDER / "uPlot.iife.min.js").read_text(encoding="utf-8")[:200])
    assert version is not None
    assert f"uPlot {version[1]}" in note
    assert dict(re.findall(r"`(?:dist/)?([\w.]+)` \| `(\w{64})`", note)) == SUMS


def test_nothing_in_the_room_is_kept_from_the_wheel():
    build = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["hatch"]["build"]
    assert build["targets"]["wheel"]["packages"] == ["xlmc"]
    assert build["exclude"] == ["__pycache__", "*.pyc"]
