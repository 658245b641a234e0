"""The bar of `band_coverage.py`, its committed result, and its closed forms."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from band_coverage import PROBLEMS, RESULTS, faults, measure

PAGE = Path(__file__).resolve().parents[2] / "docs" / "uncertainty.md"


def test_the_committed_result_meets_the_bar_and_stands_on_the_page():
    records = json.loads(RESULTS.read_text(encoding="utf-8"))
    assert records.keys() == {problem.name for problem in PROBLEMS}
    assert faults(records) == []
    page = PAGE.read_text(encoding="utf-8")
    for shares in records.values():
        for number, share in shares.items():
            assert f"| {number} | {100 * share:.1f} % |" in page


def test_a_band_that_holds_too_seldom_or_too_often_is_a_fault():
    assert faults({"x": {"mean": 0.90}}) == []
    assert faults({"x": {"mean": 0.85}, "y": {"mean": 0.95}}) == [
        "x: the band of the mean holds the truth in 85.0%",
        "y: the band of the mean holds the truth in 95.0%",
    ]


@pytest.mark.parametrize("problem", PROBLEMS, ids=lambda each: each.name)
def test_a_few_runs_hold_their_truths(problem):
    assert all(share >= 0.5 for share in measure(problem, runs=8, outer=60, inner=400).values())
    truth = problem.truth(np.random.default_rng(1))
    assert truth == problem.truth(np.random.default_rng(1))
