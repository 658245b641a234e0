"""The guide's pictures are those that the script makes, and small."""

from __future__ import annotations

import importlib.util
import re
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
GUIDE = (ROOT / "docs" / "guide.md").read_text(encoding="utf-8")
FOLDER = ROOT / "docs" / "pictures"
SHOWN = re.findall(r"!\[([^\]]+)\]\(pictures/(\S+)\.png\)", GUIDE)
OF_THE_GUIDE = [path for path in FOLDER.glob("*.png") if not path.stem.startswith("live-")]
MOST_BYTES = 150_000


@pytest.fixture(scope="module")
def script():
    pytest.importorskip("PIL")
    spec = importlib.util.spec_from_file_location("make_pictures", ROOT / "docs" / "make_pictures.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


def test_every_picture_is_shown_once_and_every_one_shown_exists():
    names = [name for _, name in SHOWN]
    assert sorted(names) == sorted(path.stem for path in OF_THE_GUIDE)
    assert GUIDE.count("![") == len(names)


@pytest.mark.parametrize("path", sorted(FOLDER.glob("*.png")), ids=lambda path: path.stem)
def test_a_picture_is_a_small_png(path):
    data = path.read_bytes()
    assert data.startswith(b"\x89PNG\r\n\x1a\n")
    assert len(data) < MOST_BYTES


def test_the_script_makes_these_pictures(script):
    assert sorted(script.CUTS) == sorted(path.stem for path in OF_THE_GUIDE)


def test_a_place_is_found_by_the_texts_on_the_page(script):
    words = list(
        script._words(
            '<word xMin="1" yMin="20" xMax="2" yMax="30">Trials</word>'
            '<word xMin="1" yMin="50" xMax="2" yMax="60">Trials</word>'
            '<word xMin="1" yMin="70" xMax="2" yMax="80">R&amp;D</word>'
        )
    )
    assert [word.text for word in words] == ["Trials", "R&D"]
    assert script._find(words, "Trials").top == 50
    assert script._find(words, "R&").top == 70
    assert script._find(words, "Trials of") is None
