from __future__ import annotations

import importlib.util
import json

import pytest

from tests.cli.conftest import ROOT


@pytest.fixture
def as_printed(tmp_path):
    spec = importlib.util.spec_from_file_location("as_printed", ROOT / "examples" / "as_printed.py")
    script = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(script)
    path = tmp_path / "as-printed.xlsx"
    script.write(path)
    return path
