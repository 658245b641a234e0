"""Shares of variance where a forecast jumps or bends inside a class, against closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest
from simulated import simulated

from xlmc.analysis.studies.sensitivity import sensitivities
from xlmc.analysis.studies.sensitivity.explained import _beside_neighbours, _Fit, explained
from xlmc.analysis.studies.sensitivity.given_data import explained_share
from xlmc.analysis.studies.sensitivity.pull_errors import Units
from xlmc.analysis.studies.sensitivity.ranked import Ranked


def found(x, y):
    return explained(Ranked.of(x), y, Units.of(x.size))


def holds(given, truth):
    low, high = given.share.interval
    return low - 1e-9 <= truth <= high + 1e-9


@pytest.mark.parametrize("n", [3_000, 30_000])
@pytest.mark.parametrize("q", [0.5, 0.9, 0.97, 0.99])
def test_a_step_explains_all(q, n):
    x = np.random.default_rng(1).random(n)
    given = found(x, (x > q).astype(float))
    assert holds(given, 1.0)
    assert given.share.value > 1.0 - 5e-4 - 4.0 / (n * min(q, 1.0 - q))  # one class of 8 trials holds the jump


@pytest.mark.parametrize("q", [0.5, 0.9, 0.97, 0.99])
def test_a_step_in_noise(q):
    """A jump of variance 1 and noise of variance 1/4."""
    rng = np.random.default_rng(2)
    x = rng.random(20_000)
    given = found(x, (x > q) / math.sqrt(q * (1.0 - q)) + 0.5 * rng.normal(size=x.size))
    assert holds(given, 0.8)


@pytest.mark.parametrize("periods", [5, 10, 40])
def test_a_sine_of_many_periods(periods):
    rng = np.random.default_rng(3)
    x = rng.random(20_000)
    given = found(x, np.sin(2.0 * np.pi * periods * x) + 0.7 * rng.normal(size=x.size))
    assert holds(given, 0.5 / 0.99)
    assert not given.at_least


def test_what_no_classes_follow_is_called_a_lower_bound():
    """1,000 periods in 10,000 trials: ten trials a period, and classes of eight."""
    rng = np.random.default_rng(4)
    x = rng.random(10_000)
    given = found(x, np.sin(2_000.0 * np.pi * x) + 0.3 * rng.normal(size=x.size))
    assert given.at_least
    assert given.share.interval[0] < 0.5 / 0.59


@pytest.mark.parametrize("share", [0.0, 0.3, 0.7])
def test_smooth_forecasts_keep_their_classes(share):
    """In most runs; the interval is at most 1.3 times as long, and no words stand in."""
    rng, kept, message, widths = np.random.default_rng(5), 0, 0, []
    for _ in range(40):
        x, other = rng.random((2, 4_000))
        y = math.sqrt(share) * x + math.sqrt(1.0 - share) * other
        given, before = found(x, y), explained_share(Ranked.of(x), y, Units.of(x.size))
        kept, message = kept + given.coarse_enough, message + given.at_least
        widths.append(np.ptp(given.share.interval) / np.ptp(before.interval))
    assert kept >= 32
    assert message <= 2
    assert np.median(widths) < 1.3


def test_few_values_need_no_finer_classes():
    rng = np.random.default_rng(6)
    x = rng.integers(0, 5, 6_000).astype(float)
    given = found(x, x**2 + rng.normal(size=x.size))
    between = np.var(np.arange(5.0) ** 2)
    assert abs(given.share.value - between / (between + 1.0)) < 4.0 * given.share.error
    assert given.coarse_enough


UNIFORM = {"low": 0, "high": 1}
NORMAL = {"distribution": "Normal", "mean": 0, "std_dev": 1}


@pytest.mark.parametrize(
    ("formula", "ends", "truth"),
    [
        ("=IF(A1>0.97,10,0)+A2*0.1", UNIFORM, 2.91 / (2.91 + 0.01 / 12)),
        ("=IF(A1>0.99,1,0)+0*A2", UNIFORM, 1.0),
        ("=EXP(1.5*A1)*(1+0.3*A2)", NORMAL, (math.exp(2.25) - 1.0) / (math.exp(2.25) * 1.09 - 1.0)),
    ],
    ids=["step-97", "yes-or-no-99", "exponential"],
)
@pytest.mark.parametrize("sampling", ["mc", "lhs", "sobol"])
def test_in_a_workbook(book, formula, ends, truth, sampling):
    model = book(
        {"A1": 0.5, "A2": 0.5, "B1": formula}, {n: {"cell": f"A{n[1]}", **ends} for n in ("x1", "x2")}, {"y": "B1"}
    )
    run = simulated(model, trials=100_000, seed=1, sampling=sampling)
    (first, *_) = sensitivities(run)["y"].influences
    assert first.assumption == "x1"
    low, high = first.explained.interval
    assert low <= truth <= high + 1e-9
    assert first.explained.value == pytest.approx(truth, abs=0.03)


@pytest.mark.parametrize("rung", [0, -1], ids=["coarse", "of eight trials"])
@pytest.mark.parametrize("spread", [1.0, 0.5])
def test_of_noise_alone_nothing_is_explained_and_its_fourth_power_is_right_on_average(rung, spread):
    """Normal noise of variance σ² about lines: E of the estimate of σ⁴ is σ⁴, and of the share 1 - σ²."""
    rng, n = np.random.default_rng(3), 256
    ranked = Ranked.of(np.arange(n, dtype=float))
    classes = ranked.ladder[rung]
    line = np.sqrt(1.0 - spread**2) * np.linspace(-1.0, 1.0, n) * math.sqrt(3.0)
    fits = [_Fit(classes, line + spread * rng.normal(size=n)) for _ in range(4_000)]
    fourth, left = (np.array(each) for each in zip(*((fit.fourth, fit.left.sum()) for fit in fits), strict=True))
    assert abs(fourth.mean() - spread**4) < 4 * fourth.std() / math.sqrt(fourth.size)
    assert abs(left.mean() / (n - classes.freedom) - spread**2) < 4 * left.std() / math.sqrt(left.size) / (
        n - classes.freedom
    )
    value = np.array([fit.value for fit in fits])
    assert abs(value.mean() - (1.0 - spread**2 * (n - 1) / n)) < 4 * value.std() / math.sqrt(value.size)


def test_neighbours_in_rank_explain_what_is_smooth_and_no_noise():
    """A trial less the mean of its neighbours has 3/2 of the variance of noise (Gasser et al. 1986)."""
    rng = np.random.default_rng(4)
    result = [_beside_neighbours(rng.normal(size=500)) for _ in range(2_000)]
    assert abs(np.mean(result)) < 4 * np.std(result) / math.sqrt(2_000)
    # its variance: 35/9 - 2 above that of the variance itself, whose own is 2/n
    assert np.var(result) * 500 == pytest.approx(35 / 9, rel=0.15)
    assert _beside_neighbours(np.linspace(-1, 1, 50)) == pytest.approx(1.0)
    assert _beside_neighbours(np.array([1.0, -1.0])) == -math.inf
    assert _beside_neighbours(np.array([1.0, 0.0, -1.0])) == pytest.approx(1.0)
