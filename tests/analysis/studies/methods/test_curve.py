"""Root mean square errors, slopes and times of runs, by hand."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest
from scipy import stats

from xlmc.analysis.studies.methods.answer import STATISTICS
from xlmc.analysis.studies.methods.curve import NORMAL_95, Curve, Rms, Runs, in_order, rms_of, runs_of, slope_of

NAN = math.nan


def test_errors_without_more_than_chance_are_their_spread():
    rms = rms_of([3.0, -4.0, 1.0, NAN])
    assert (rms.value, rms.spread) == pytest.approx((math.sqrt(13),) * 2)  # (9 + 16 + 1)/2
    assert (rms.bias, rms.n) == (0, 3)
    assert rms.error == pytest.approx(math.sqrt(13) / 2)  # over √(2 · 2)


def test_a_mean_error_beyond_chance_counts():
    rms = rms_of([9.0, 10.0, 11.0])
    chance = 1 / 3
    assert rms.value == pytest.approx(math.sqrt(1 + 100 - chance))
    assert rms.error == pytest.approx(rms.value / 2)
    known = rms_of([9.0, 10.0, 11.0], 2.0)
    assert known.value == pytest.approx(math.sqrt(1 + 100 - chance - 4))
    assert rms_of([9.0, 10.0, 11.0], 3.0).value == pytest.approx(1)  # the reference's error explains it


@pytest.mark.parametrize(("bias", "counts"), [(4 / math.sqrt(3) - 0.01, False), (4 / math.sqrt(3) + 0.01, True)])
def test_four_standard_errors_are_more_than_chance(bias, counts):
    assert (rms_of(np.array([-1.0, 0.0, 1.0]) + bias).value > 1) is counts


def test_one_answer_and_none():
    one = rms_of([-2.0], 0.5)
    assert (one.value, one.error, one.bias, one.n) == (2, 0.5, -2, 1)
    assert math.isnan(one.spread)
    assert one.interval == pytest.approx((2 - NORMAL_95 * 0.5, 2 + NORMAL_95 * 0.5))
    assert rms_of([0.1], 0.5).interval[0] == 0
    none = rms_of([NAN, NAN])
    assert none.n == 0
    assert math.isnan(none.value)
    assert rms_of([1.0], NAN).error == 0


@pytest.mark.parametrize("n", [2, 10])
def test_the_interval_of_a_spread_is_that_of_chi_squared(n):
    interval = Rms(3.0, 0.1, 0.0, 3.0, n).interval
    assert interval == pytest.approx([3 * math.sqrt((n - 1) / stats.chi2(n - 1).ppf(p)) for p in (0.975, 0.025)])
    assert Rms(0.0, NAN, 0.0, 0.0, n).interval == (0, 0)


def test_slopes():
    assert slope_of([1, 10, 100], [3, 0.95, 0.3]) == pytest.approx(-0.5, abs=1e-3)
    assert slope_of([1, 4, 16], [8.0, 4.0, 2.0]) == pytest.approx(-0.5)
    assert slope_of([1, 1.5], [2.0, 3.0]) == pytest.approx(1)
    assert math.isnan(slope_of([1, 1.49], [2.0, 3.0]))
    assert math.isnan(slope_of([1, 10], [0.0, 3.0]))
    assert slope_of([1, 3, 10], [0.0, 3.0, 10.0]) == pytest.approx(1)  # one without an error is left out
    weighted = np.polyfit(np.log([1, 3, 10]), np.log([5.0, 3.0, 2.0]), 1, w=np.sqrt([1, 2, 7]))[0]
    assert slope_of([1, 3, 10], [5.0, 3.0, 2.0], [1, 2, 7]) == pytest.approx(weighted)


def runs(seconds, budget=100, n=5, share=0.1, *, converged=True):
    errors = {("x", "mean"): Rms(1.0, 0.1, 0.0, 1.0, n), ("y", "mean"): Rms(1.0, 0.1, 0.0, 1.0, 1)}
    shares = dict.fromkeys(STATISTICS, share)
    return Runs(budget, seconds, seconds, 2.0 * budget, errors, shares, None, converged=converged)


@pytest.mark.parametrize(
    ("seconds", "expected"),
    [
        ((1.0, 2.0, 3.0), [1, 2, 3]),
        ((1.0, 5.0, 3.0), [1, 3, 3]),
        ((4.0, 5.0, 3.0), [3, 3, 3]),
        ((4.0, NAN, 3.0), [3, 3, 3]),
        ((4.0, 5.0, NAN), [4, 5, NAN]),
    ],
)
def test_a_longer_run_takes_no_less_time(seconds, expected):
    assert [each.seconds for each in in_order([*map(runs, seconds)])] == pytest.approx(expected, nan_ok=True)


def test_the_slope_of_a_curve_is_that_of_its_converged_runs():
    lengths = (
        runs(0.1, 1, share=9.0, converged=False),
        runs(1.0, 10, n=1, share=4.0),
        runs(10.0, 100, n=5, share=1.0),
        runs(100.0, 1000, n=9, share=0.4),
    )
    curve = Curve(None, lengths, 0.0, (), {})
    wanted = np.polyfit(np.log([1, 10, 100]), np.log([4.0, 1.0, 0.4]), 1, w=np.sqrt([1, 4, 8]))[0]
    for against in ("seconds", "evaluations", "budget"):
        assert curve.slope("mean", against) == pytest.approx(wanted)
    assert curve.converged == lengths[1:]
    assert curve.answers
    few = Curve(None, lengths[:1], 0.0, (), {})
    assert few.converged == lengths[:1]
    assert not Curve(None, (runs(1.0, share=NAN),), 0.0, (), {}).answers


def answer(**given):
    return SimpleNamespace(**{**dict.fromkeys(STATISTICS, 0.0), **given})


def result(mean, seconds, evaluations, acceptance=0.5, effective=None):
    return SimpleNamespace(
        answers={"x": answer(mean=mean)}, seconds=seconds, evaluations=evaluations, acceptance=acceptance,
        effective=effective,
    )  # fmt: skip


@pytest.fixture
def reference():
    return SimpleNamespace(
        answers={"x": answer(mean=10.0)},
        errors={"x": answer()},
        widths={"x": 4.0},
        acceptance=SimpleNamespace(value=0.5),
        asks=lambda name, statistic: statistic == "mean",
    )


def test_runs_of_one_length(reference):
    made = runs_of(40, [result(9.0, 3.0, 10), result(11.0, 1.0, 30), result(10.0, 2.5, 40)], reference)
    assert (made.seconds, made.usual, made.evaluations) == (1, 2.5, 30)
    assert made.errors["x", "mean"].value == pytest.approx(1)
    assert made.shares["mean"] == pytest.approx(0.25)
    assert math.isnan(made.shares[next(each for each in STATISTICS if each != "mean")])
    assert made.acceptance.value == 0
    assert (made.effective, made.failed, made.converged) == (None, 0, True)
    assert not runs_of(39, [result(9.0, 3.0, 10)], reference).converged  # 19.5 accepted trials


def test_runs_that_fail(reference):
    made = runs_of(40, [result(NAN, NAN, 10, None, 4.0), result(11.0, NAN, 30, None, 8.0)], reference)
    assert (made.failed, made.effective, made.acceptance) == (1, 6, None)
    assert math.isnan(made.seconds)
    assert math.isnan(made.usual)
    assert made.errors["x", "mean"].n == 1


def test_shares_are_root_mean_squares_over_forecasts(reference):
    reference.answers = {name: answer() for name in "xyz"}
    reference.errors = {name: answer() for name in "xyz"}
    reference.widths = {"x": 1.0, "y": 2.0, "z": 0.0}
    one = SimpleNamespace(
        answers={"x": answer(mean=3.0), "y": answer(mean=8.0), "z": answer(mean=1.0)},
        seconds=1.0, evaluations=1, acceptance=None, effective=None,
    )  # fmt: skip
    assert runs_of(100, [one], reference).shares["mean"] == pytest.approx(math.sqrt((9 + 16) / 2))
