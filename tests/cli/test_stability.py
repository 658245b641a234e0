from __future__ import annotations

import importlib.util
import json
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def as_printed(tmp_path_factory):
    spec = importlib.util.spec_from_file_location("as_printed", ROOT / "examples" / "as_printed.py")
    script = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(script)
    path = tmp_path_factory.mktemp("printed") / "as-printed.xlsx"
    script.write(path)
    return path


def test_the_case_study(xlmc, case_study):
    outcome = xlmc("stability", case_study, "-n", "10000", "--cells")
    assert outcome.code == 0
    assert "Wrong" not in outcome.out
    assert "a run of 10,000, seed 999" in " ".join(outcome.out.split())
    assert "Model!D20" in outcome.out  # a cell that is neither forecast nor filter


def test_json(xlmc, as_printed):
    outcome = xlmc("stability", as_printed, "-n", "20000", "--seed", "3", "--json", "--quiet")
    assert outcome.code == 1
    result = json.loads(outcome.out)
    assert (result["trials"], result["seed"], result["unchecked"]) == (20_000, 3, [])
    assert [one["kind"] for one in result["findings"][:2]] == ["quadrant", "division"]
    (where,) = result["findings"][1]["where"]
    assert (where["assumption"], where["low"], where["units"]) == ("Nissan approach angle", 272, "°")
    assert len(result["cells"]) == 28
    assert {"amplification", "rounding", "excess", "through"} <= set(result["cells"][0])


def test_a_book_that_is_not_there(xlmc):
    outcome = xlmc("stability", "nothing.xlsx")
    assert outcome.code == 2
    assert "There is no such file" in outcome.err


def _words(text):
    """Numbers apart: the last digits that rounding leaves differ between processors."""
    return re.sub(r"\d[\d.]*(e[-+]?\d+)?", "#", " ".join(text.split()))


def test_the_equations_as_printed(xlmc, as_printed):
    """The documents show the output."""
    outcome = xlmc("stability", as_printed)
    assert outcome.code == 1
    assert "1 wrong, 1 doubtful" in outcome.out
    first, second = (
        outcome.out.index("1. Wrong: Model!C21 Nissan PDOF"),
        outcome.out.index("2. Doubtful: Model!C11 V2i"),
    )
    assert first < second
    assert "\nInstead:\n=180-MOD(180-(180+DEGREES(ATAN2(dV2x,dV2y))-alpha_2),360)" in outcome.out
    assert "Where: Nissan approach angle from 272 to" in outcome.out
    page = (ROOT / "docs" / "stability.md").read_text(encoding="utf-8")
    shown = page.partition("<!-- output of `xlmc stability as-printed.xlsx` -->\n```text\n")[2].partition("\n```")[0]
    assert "What cells amplify and lose" in shown
    assert _words(outcome.out).startswith(_words(shown))
