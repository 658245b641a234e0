"""Known optima are found, and the confidence that is stated holds, in a few runs of `optimum_coverage.py`."""

from __future__ import annotations

import pytest
from optimum_coverage import PROBLEMS, coverage, write

import xlmc


@pytest.mark.parametrize("name", PROBLEMS)
def test_known_optima_are_found(name, tmp_path):
    problem, path = PROBLEMS[name], tmp_path / "book.xlsx"
    write(problem, path)
    found = xlmc.load(path).optimise(
        maximise=problem.goal, subject_to=problem.requirements, trials=20_000, seed=4, runs=60
    )
    assert problem.optimum - problem.true(found.values) <= found.indifference
    assert found.confidence >= 0.8
    assert abs(found.found.value - problem.true(found.values)) < 4.5 * found.found.error
    assert found.trials < 100 * 20_000


def test_a_stated_confidence_holds(tmp_path):
    problem = PROBLEMS["newsvendor, whole numbers"]
    write(problem, tmp_path / "book.xlsx")
    stated, held = coverage(xlmc.load(tmp_path / "book.xlsx"), problem, 6)
    assert held >= stated - 1
    assert stated > 0
