from __future__ import annotations

import contest
import pytest
import rates
from cases import cases
from contest import CellPlace, Task
from hypothesis import given
from hypothesis import strategies as st
from one_contestant import _real

from xlmc.address import Cell


class Clock:
    """A run that costs `fixed` seconds and `each` a trial, on a clock of its own."""

    def __init__(self, fixed, each):
        self.now, self.fixed, self.each, self.runs = 0.0, fixed, each, []

    def __call__(self):
        return self.now

    def run(self, trials):
        self.runs.append(trials)
        self.now += self.fixed + self.each * trials


@given(st.integers(1, 40_000), st.floats(1e-9, 1e-2), st.floats(0.01, 3))
def test_measured_finds_the_rate(fewest, each, seconds):
    clock = Clock(0.0, each)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(contest, "perf_counter", clock)
        rate, trials = contest.measured(clock.run, fewest, seconds)
    assert rate == pytest.approx(1 / each, rel=1e-6)
    assert all(count % fewest == 0 for count in clock.runs)
    assert trials == clock.runs[-1]
    assert trials == fewest or trials * each < 2 * seconds


@pytest.mark.parametrize(("each", "runs"), [(1e-3, contest.REPEATS), (10.0, 1)])
def test_a_slow_contestant_runs_once(each, runs, monkeypatch):
    clock = Clock(0.0, each)
    monkeypatch.setattr(contest, "perf_counter", clock)
    contest.measured(clock.run, 1_000 if each < 1 else 1, 1.0)
    assert len(clock.runs) == runs


@given(st.integers(1, 1_048_576), st.integers(1, 16_384))
def test_places_print_as_cells(row, column):
    assert str(CellPlace("Model", row, column)) == str(Cell("Model", row, column))


TASK = Task("skid", "", [], [CellPlace("A", 1, 1), CellPlace("A", 2, 27)], [], [], 0.0)


def test_forecasts_that_differ_are_told_with_their_cell():
    truth = [[1.0, 2.0], [3.0, 0.0]]
    assert rates.differing(TASK, truth, truth) == []
    assert rates.differing(TASK, [[1.0 + 1e-10, 2.0]], truth) == []
    (said,) = rates.differing(TASK, [[1.0, 2.0], [3.0, 1e-12]], truth)
    assert said.startswith("A!AA2 in check trial 2")
    assert len(rates.differing(TASK, [[None, 2.1]], truth)) == 2


@cases("value", [True, "3", None, float("nan"), float("inf")])
def test_only_real_numbers_are_answers(value):
    assert _real(value) is None


def test_numbers_are_answers():
    assert (_real(3), _real(2.5)) == (3.0, 2.5)
