"""Rows of evidence_case.py with fewer trials, and that a wrong expectation is seen."""

from __future__ import annotations

import pytest

from xlmc.montecarlo.model.loading import load


@pytest.fixture(scope="module")
def bench():
    import evidence_case

    return evidence_case


@pytest.fixture(scope="module")
def model(bench):

    return load(bench.BOOK)


def test_rows_of_the_case_study_are_as_an_independent_program_found_them(bench, model):
    for index in (1, 5, 9):  # a normal error, a strained one, two items
        row = bench.ROWS[index]
        judged = bench.found(model, row, 30_000)
        assert judged.past > 2_500
        assert list(bench.faults(row, judged)) == []
    wrong = row._replace(kept=".54", ratio="1.31", verdict="independent")
    assert [each.partition(":")[0] for each in bench.faults(wrong, judged)] == ["kept", "ratio", "verdict"]
