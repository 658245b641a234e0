"""docs/stress.md: every chart and table is there, is made by its command, and says what was measured at full size."""

from __future__ import annotations

import importlib.util
import json
import math
import re
from pathlib import Path

import pytest
from pictures import leave_out_layout

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "stress.md").read_text(encoding="utf-8")
PNG = b"\x89PNG\r\n"


@pytest.fixture(scope="module")
def stress():
    """The script, by its path."""
    spec = importlib.util.spec_from_file_location("script_stress", ROOT / "benchmarks" / "stress.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def results(stress, part):
    return json.loads((stress.RESULTS / f"stress-{part}.json").read_text(encoding="utf-8"))


def test_every_chart_stands_on_the_page_with_its_command(stress):
    shown = re.findall(r"!\[[^\]]+\]\(pictures/stress/([a-z]+)\.png\)\n\n`python benchmarks/stress\.py ([a-z]+)`", PAGE)
    assert sorted(shown) == sorted((name, part) for part, each in stress.PARTS.items() for name in each.pictures)
    for name, _ in shown:
        picture = (stress.PICTURES / f"{name}.png").read_bytes()
        assert picture.startswith(PNG)
        assert len(picture) < 200_000


def test_the_tables_are_those_of_the_results(stress):
    assert stress.page.filled(PAGE, stress.RESULTS) == PAGE
    assert PAGE.count("<!-- stress ") == len(stress.page.TABLES)


@pytest.mark.parametrize("part", ["counts", "correlations"])
def test_charts_are_drawn_from_the_results(stress, part, tmp_path, monkeypatch):
    leave_out_layout(monkeypatch)
    for path in stress.PARTS[part].draw(results(stress, part), tmp_path):
        assert path.read_bytes().startswith(PNG)
        assert path.stem in stress.PARTS[part].pictures


def test_a_part_at_a_small_size(stress, tmp_path, monkeypatch):
    """The few trials: what is measured, through JSON, to a picture."""
    leave_out_layout(monkeypatch)
    part = stress.PARTS["few"]
    result = json.loads(json.dumps(part.measure(500)))
    assert {cell["runs"] for cell in result["cells"]} == {1500 // 500}
    (path,) = part.draw(result, tmp_path)
    assert path.read_bytes().startswith(PNG)


def test_the_forms_of_the_page_keep_the_bound(stress):
    from stressing.forms import FORMS
    from stressing.rounding import BOUND, UNIT

    for name, sweep in results(stress, "forms").items():
        for cells in sweep["errors"].values():
            for form in FORMS:
                pairs = zip(cells[form.rewritten], sweep["conditions"][form.rewritten], strict=True)
                assert all(error < BOUND * UNIT * (1 + condition) for error, condition in pairs), (name, form.number)


def test_runs_that_ended_by_themselves_hold_the_truth(stress):
    """Full size: within 4 binomial standard errors of 95 %, and what skewed means lack besides; biased by less than
    0.15 of their error, or 0.3 where the forecast is very skewed. Adaptive: 94 % or more, but for chance."""
    result = results(stress, "stops")
    slack = {"normal": 0.0, "exponential": 0.01, "lognormal, σ 1": 0.035}
    for row in result["precise"]:
        assert row["ended"] == row["runs"] >= 600
        noise = 4 * math.sqrt(0.95 * 0.05 / row["runs"])
        if row["forecast"] in slack:
            assert row["held"] / row["ended"] > 0.95 - noise - slack[row["forecast"]], row
        assert abs(row["bias"]) < 0.3 + 4 * row["error of bias"]
    for row in result["stable"]:
        if row["least"] > 2:
            worst = min(row["within"]) / row["ended"]
            assert worst > 0.94 - 4 * math.sqrt(0.94 * 0.06 / row["ended"]), row
