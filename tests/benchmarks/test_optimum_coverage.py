"""Known optima are found, and the confidence that is stated holds, in a few runs of `optimum_coverage.py`."""

from __future__ import annotations

import pytest
from optimum_coverage import PROBLEMS, coverage, write

import xlmc


@pytest.mark.parametrize("name", PROBLEMS)
def test_known_optima_are_found(name, tmp_path):
    problem, path = PROBLEMS[name], tmp_path / "book.xlsx"
    write(problem, path)
    result = xlmc.load(path).optimise(
        maximise=problem.goal, subject_to=problem.requirements, trials=20_000, seed=4, runs=60
    )
    assert problem.optimum - problem.true(result.values) <= result.indifference
    assert result.confidence >= 0.8
    assert abs(result.estimate.value - problem.true(result.values)) < 4.5 * result.estimate.error
    assert result.trials < 100 * 20_000


def test_a_stated_confidence_holds(tmp_path):
    problem = PROBLEMS["newsvendor, whole numbers"]
    write(problem, tmp_path / "book.xlsx")
    stated, held = coverage(xlmc.load(tmp_path / "book.xlsx"), problem, 6)
    assert held >= stated - 1
    assert stated > 0
