"""How errors fall with trials: laws found again in runs that were made by them, and their closed forms."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest
from scipy import stats

from xlmc.analysis.studies.methods.curve import Rms, Runs, in_order, rms_of, slope_of
from xlmc.analysis.studies.methods.law import (
    Law,
    _exact_from,
    _fit_law,
    _law_of_independent,
    _law_with_floor,
    _trials_between,
)

KIND = ("x", "mean")
Z = 1.959964


def runs(budget, value, n=25, bias=0.0, spread=None, seconds=1.0):
    error = Rms(value, 0.0, bias, value if spread is None else spread, n)
    return Runs(budget, seconds, seconds, budget, {KIND: error}, {}, None)


def ladder(constant, slope, budgets=(100, 1_000, 10_000, 100_000), **options):
    return [runs(budget, constant * budget**slope, **options) for budget in budgets]


@pytest.mark.parametrize(
    ("law", "tolerance", "trials"),
    [
        (Law(2.0, -0.5, 10.0), 0.1, (Z * 2.0 / 0.1) ** 2),
        (Law(2.0, -1.0, 10.0), 0.1, Z * 2.0 / 0.1),
        (Law(2.0, -0.5, 5_000.0), 0.1, 5_000.0),  # the shortest run that it holds for
        (Law(0.0, -0.5, 70.0), 0.1, 70.0),
        (Law(2.0, -0.5, 10.0, floor=0.06), 0.1, (Z * 2.0 / 0.08) ** 2),  # 0.1² = 0.08² + 0.06²
        (Law(2.0, -0.5, 10.0, floor=0.1), 0.1, math.inf),
        (Law(2.0, -0.5, 10.0, floor=0.2), 0.1, math.inf),
        (Law(math.nan, -0.5, 10.0), 0.1, math.inf),
    ],
)
def test_trials_keep_the_tolerance(law, tolerance, trials):
    assert law.trials(tolerance) == pytest.approx(trials)
    if math.isfinite(trials) and trials > law.least:
        assert law.reach(trials) == pytest.approx(tolerance)


@pytest.mark.parametrize("slope", [-0.5, -0.8, -1.0, -1.4])
def test_a_steeper_law_is_found_again(slope):
    result = _fit_law(ladder(3.0, slope), KIND, 0.01, may_be_steeper=True)
    assert (result.constant, result.slope) == (pytest.approx(3.0), pytest.approx(slope))
    assert result.least == 100.0
    assert result.error == pytest.approx((4 * 2 * 24) ** -0.5 / -slope)


def test_slopes_have_limits():
    assert _fit_law(ladder(3.0, -2.0), KIND, 0.0, may_be_steeper=True).slope == -1.5
    assert _fit_law(ladder(3.0, -0.3), KIND, 0.0, may_be_steeper=True).slope == -0.5
    flat = _fit_law(ladder(3.0, -1.0), KIND, 0.0, may_be_steeper=False)
    assert flat.slope == -0.5
    logs = [math.log(3.0) - 0.5 * math.log(each) for each in (100, 1_000, 10_000, 100_000)]
    assert math.log(flat.constant) == pytest.approx(np.mean(logs))


@pytest.mark.parametrize(("errors", "steeper"), [(2.9, False), (3.1, True)])
def test_a_slope_counts_as_steeper_beyond_three_errors(errors, steeper):
    """The slope's error is that of a line through logarithms with variance 1/(2(n − 1)) each."""
    across = np.log([100.0, 1_000.0, 10_000.0, 100_000.0])
    error = (2 * 24 * np.sum((across - across.mean()) ** 2)) ** -0.5
    result = _fit_law(ladder(3.0, -0.5 - errors * error), KIND, 0.0, may_be_steeper=True)
    assert (result.slope < -0.5) is steeper


def test_runs_that_lie_on_no_line_give_the_need_between_their_neighbours():
    budgets, values = (100, 1_000, 10_000), (1.0, 1.0, 1e-3)
    lengths = [runs(budget, value) for budget, value in zip(budgets, values, strict=True)]
    result = _fit_law(lengths, KIND, 0.1, may_be_steeper=False)
    between = _trials_between(np.array(budgets, float), Z * np.array(values) / 0.1)
    assert result.trials(0.1) == pytest.approx(between)
    assert 1_000 < between < 10_000
    assert result.error == pytest.approx((2 * 24) ** -0.5 * 2)
    assert _fit_law(lengths, KIND, 0.0, may_be_steeper=False).trials(0.1) != pytest.approx(between)


@pytest.mark.parametrize(
    ("reach", "trials"),
    [
        ((0.9, 0.8, 0.7), 100.0),  # all keep it
        ((2.0, 0.5, 0.4), 100.0 * 10.0**0.5),
        ((4.0, 2.0, 0.5), 1_000.0 * 10.0**0.5),
        ((0.5, 2.0, 0.25), 1_000.0 * 10.0 ** (1 / 3)),  # the last that misses it counts
        ((4.0, 3.0, 2.0), 10_000.0 * 4.0),  # as the square root beyond the longest
    ],
)
def test_trials_between_run_lengths(reach, trials):
    assert _trials_between(np.array([100.0, 1_000.0, 10_000.0]), np.array(reach)) == pytest.approx(trials)


def test_numbers_that_are_never_off():
    lengths = [runs(100, 1.0), runs(1_000, 0.0), runs(10_000, 0.0)]
    assert _exact_from(lengths, KIND) == 1_000.0
    assert _exact_from(lengths[:1], KIND) is None
    assert _exact_from([lengths[1], lengths[0]], KIND) is None
    result = _fit_law(lengths, KIND, 0.1, may_be_steeper=True)
    assert (result.constant, result.trials(1e-9)) == (0.0, 1_000.0)
    alone = [runs(100, 1.0, n=1), runs(1_000, 0.5, n=1)]
    assert math.isnan(_fit_law(alone, KIND, 0.1, may_be_steeper=True).constant)


@pytest.mark.parametrize("theory", [2.0, 2.5])
def test_of_independent_trials_theory_counts_unless_runs_contradict_it(theory):
    lengths = ladder(2.0, -0.5)
    assert _law_of_independent(lengths, KIND, theory, 0.1).constant == theory


@pytest.mark.parametrize("ratio", [0.4, 2.0])
def test_clear_contradictions_are_believed(ratio):
    result = _law_of_independent(ladder(2.0 * ratio, -0.5), KIND, 2.0, 0.1)
    assert result.constant == pytest.approx(2.0 * ratio)
    assert (result.slope, result.least) == (-0.5, 100.0)


def test_contradictions_are_those_of_chi_square():
    """With 24 degrees of freedom for each of four lengths, below a probability of 1e-5 on either side."""
    for probability, believed in ((2e-5, False), (0.5e-5, True)):
        for quantile in (stats.chi2.ppf(probability, 96), stats.chi2.isf(probability, 96)):
            ratio = math.sqrt(quantile / 96)
            result = _law_of_independent(ladder(2.0 * ratio, -0.5), KIND, 2.0, 0.1)
            assert (result.constant != 2.0) is believed


def studied(tolerance, own=0.0, comparisons=4):
    errors = {"x": SimpleNamespace(mean=own)}
    statistics = iter([True] * comparisons + [False] * 8)
    return SimpleNamespace(
        tolerance=lambda _: tolerance,
        varying=("x", "y"),
        converges=lambda *_: next(statistics),
        reference=SimpleNamespace(errors=errors),
    )


@pytest.mark.parametrize(("bias", "own"), [(0.0, 0.0), (0.5, 0.0), (0.5, 0.1), (-0.5, 0.2)])
def test_a_floor_is_bounded_by_the_longest_runs(bias, own):
    n, budget, spread, constant = 24, 10_000, 0.03, 2.0
    lengths = [runs(budget, 0.0, n=n, bias=bias, spread=spread)]
    result = _law_with_floor(studied(0.1, own), lengths, KIND, constant)
    rare = 0.05 / 4 / 4
    noise = constant**2 / budget
    extra = [math.sqrt(max(spread**2 * (n - 1) / stats.chi2.isf(p, n - 1) - noise, 0.0)) for p in (rare, 1.0 - rare)]
    chance = stats.t.isf(rare, n - 1) * math.hypot(spread / math.sqrt(n), own)
    assert result.floor_low == pytest.approx(math.hypot(max(abs(bias) - chance, 0.0), Z * extra[0]))
    assert result.floor_high == pytest.approx(math.hypot(abs(bias) + chance, Z * extra[1]))
    likely = math.sqrt(max(bias**2 - spread**2 / n - own**2, 0.0) + Z**2 * max(spread**2 - noise, 0.0))
    assert result.floor == pytest.approx(min(max(likely, result.floor_low), result.floor_high))
    assert (result.constant, result.slope, result.least) == (2.0, -0.5, 10_000)


def test_only_run_lengths_that_could_show_a_floor_at_the_tolerance_are_looked_at():
    """1.96·2/√n is at most 0.1 from 1,537 trials on."""
    short, long = runs(1_000, 0.0, bias=9.0, spread=5.0), runs(2_000, 0.0, bias=0.5, spread=0.04)
    result = _law_with_floor(studied(0.1), [short, long], KIND, 2.0)
    alone = _law_with_floor(studied(0.1), [long], KIND, 2.0)
    assert (result.floor, result.floor_low, result.floor_high) == (alone.floor, alone.floor_low, alone.floor_high)
    both = _law_with_floor(studied(0.2), [short, long], KIND, 2.0)
    assert both.floor_high > result.floor_high
    assert math.isnan(_law_with_floor(studied(0.1), [runs(100, 1.0, n=1)], KIND, 2.0).constant)


@pytest.mark.parametrize(
    ("errors", "reference", "value", "bias", "spread"),
    [
        ([3.0, -4.0, 1.0], 0.0, math.sqrt(13.0), 0.0, math.sqrt(13.0)),
        ([10.0, 10.1, 9.9], 0.0, math.sqrt(0.01 + 100.0 - 0.01 / 3), 10.0, 0.1),  # a mean error beyond chance
        ([10.0, 10.1, 9.9], 3.0, 0.1, 10.0, 0.1),  # which the reference's own error explains
        ([10.0, 10.1, 9.9], 2.0, math.sqrt(0.01 + 100.0 - 0.01 / 3 - 4.0), 10.0, 0.1),
        ([2.0, math.nan, 4.0], 0.0, math.sqrt(2.0), 3.0, math.sqrt(2.0)),
    ],
)
def test_root_mean_squares(errors, reference, value, bias, spread):
    result = rms_of(errors, reference)
    assert (result.value, result.bias, result.spread) == pytest.approx((value, bias, spread))
    count = np.count_nonzero(~np.isnan(errors))
    assert result.n == count
    assert result.error == pytest.approx(value / math.sqrt(2 * (count - 1)))
    low, high = result.interval
    assert low == pytest.approx(value * math.sqrt((count - 1) / stats.chi2.ppf(0.975, count - 1)))
    assert high == pytest.approx(value * math.sqrt((count - 1) / stats.chi2.ppf(0.025, count - 1)))


def test_a_single_answer_is_known_as_well_as_the_reference():
    result = rms_of([-2.0], 0.5)
    assert (result.value, result.error, result.bias, result.n) == (2.0, 0.5, -2.0, 1)
    assert result.interval == pytest.approx((2.0 - 0.5 * Z, 2.0 + 0.5 * Z))
    assert rms_of([0.1], 0.5).interval == pytest.approx((0.0, 0.1 + 0.5 * Z))
    assert rms_of([math.nan]).n == 0


@pytest.mark.parametrize(
    ("x", "y", "weights", "slope"),
    [
        ([1, 100], [3, 0.3], None, -0.5),
        ([1, 10, 100], [1, 1, 0.01], [1, 0, 1], -1.0),
        ([1, 10, 100], [1, 0.1, 1], [1, 1, 0], -1.0),
        ([1, 10, 100], [1, 0, 0.01], None, -1.0),  # a 0 has no logarithm
        ([1, 1.49], [1, 0.5], None, math.nan),
        ([1, 1.5], [1, 1.5], None, 1.0),
        ([1], [1], None, math.nan),
    ],
)
def test_slopes_in_logarithms(x, y, weights, slope):
    assert slope_of(x, y, weights) == pytest.approx(slope, nan_ok=True)


def test_times_never_fall_as_runs_grow():
    lengths = [runs(n, 1.0, seconds=s) for n, s in ((10, 3.0), (20, 1.0), (30, math.nan), (40, 2.0), (50, math.nan))]
    assert [each.seconds for each in in_order(lengths)] == pytest.approx([1.0, 1.0, 2.0, 2.0, math.nan], nan_ok=True)
