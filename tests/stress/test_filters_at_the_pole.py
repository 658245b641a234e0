"""A filter on a ratio whose denominator is 0 in some trials: e_t as the sheet divides it, and without the division."""

from __future__ import annotations

import numpy as np
import pytest
from simulated import simulated

ACROSS = {"cell": "A1", "low": -2.0, "high": 2.0}
WHOLE = {"cell": "A2", "distribution": "Discrete Uniform", "low": -2.0, "high": 2.0}
CELLS = {
    "A1": 0.5,
    "A2": 1.0,
    "B1": "=A1/A2",
    "B2": "=AND(A2<>0,SIGN(A2)*A1>=0,SIGN(A2)*A1<=0.25*ABS(A2))",
    "B3": "=AND(SIGN(A2)*A1>=0,SIGN(A2)*A1<=0.25*ABS(A2))",
    "B4": "=A1+1",
}
"""Separation, closing, their ratio; the same filter multiplied out, and as it must not be."""

TRIALS = 20_000


@pytest.fixture(scope="module")
def runs(book):
    def run(**filter_):
        return simulated(book(CELLS, {"s": ACROSS, "c": WHOLE}, {"kept": "B4"}, {"e": filter_}), TRIALS, 5)

    return {
        "divided": run(cell="B1", at_least=0.0, at_most=0.25),
        "multiplied": run(cell="B2"),
        "0 forgotten": run(cell="B3"),
    }


def test_both_accept_the_same_trials(runs):
    np.testing.assert_array_equal(runs["divided"].trial_index, runs["multiplied"].trial_index)
    assert 0 < runs["divided"].accepted < TRIALS


def test_the_division_loses_trials_to_errors_and_says_so(runs):
    """A fifth of the closing speeds is 0: rejected either way, but by an error where the sheet divides."""
    assert runs["multiplied"].error_trials == 0
    assert runs["multiplied"].warnings == []
    assert abs(runs["divided"].error_trials / TRIALS - 0.2) < 4 * np.sqrt(0.16 / TRIALS)
    assert "lost to errors" in runs["divided"].warnings[0]


def test_sign_alone_accepts_what_has_no_closing_speed(runs):
    """SIGN(0) is 0, and 0 is neither below nor above 0: a filter multiplied out must ask for a denominator too."""
    wrong = np.setdiff1d(runs["0 forgotten"].trial_index, runs["divided"].trial_index)
    assert abs(wrong.size / TRIALS - 0.2) < 4 * np.sqrt(0.16 / TRIALS)
