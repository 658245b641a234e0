from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

import xlmc.montecarlo.statistics as xs


@pytest.fixture(name="columns", params=["trials", "weights", "replicates", "both"])
def _columns(request):
    rng = np.random.default_rng(1)
    x, w, ids = rng.gamma(3.0, size=400), rng.uniform(0.5, 2, 400), np.repeat(np.arange(8), 50)
    return {"trials": (x,), "weights": (x, w), "replicates": (x, None, ids), "both": (x, w, ids)}[request.param]


SINGLE = [
    "mean",
    "median",
    "mode",
    "standard_deviation",
    "variance",
    "skewness",
    "kurtosis",
    "coefficient_of_variation",
    "minimum",
    "maximum",
    "range_width",
    "mean_standard_error",
]


def test_holds_what_the_single_functions_say(columns):
    everything = xs.describe(*columns, threshold=3.0)
    assert everything.trials == 400
    for name in SINGLE:
        assert getattr(everything, name) == getattr(xs, name)(*columns), name
    assert everything.percentiles == xs.percentiles(columns[0], range(0, 101, 5), *columns[1:])
    assert everything.central == xs.central_interval(columns[0], 0.51, *columns[1:])
    assert everything.probability_above == xs.probability_above(columns[0], 3.0, *columns[1:])


def test_every_statistic_but_the_extremes_has_an_error_and_an_interval(columns):
    everything = xs.describe(*columns, threshold=3.0)
    for name in (*SINGLE, "probability_above"):
        estimate = getattr(everything, name)
        if name in ("minimum", "maximum", "range_width"):
            assert (estimate.error, estimate.interval) == (None, None)
        else:
            assert estimate.error > 0, name
            assert estimate.interval[0] < estimate.value < estimate.interval[1], name


def test_is_the_same_twice_to_the_last_bit(columns):
    assert xs.describe(*columns) == xs.describe(*columns)


def test_takes_its_settings():
    x = np.random.default_rng(2).normal(size=300)
    everything = xs.describe(x, percentiles=[2.5], central=0.9, threshold=None, confidence=0.8)
    assert everything.percentiles == {2.5: xs.percentile(x, 2.5, confidence=0.8)}
    assert everything.central == xs.central_interval(x, 0.9, confidence=0.8)
    assert everything.mean == xs.mean(x, confidence=0.8)
    assert everything.probability_above is None


def estimates_of(description):
    """Every estimate of a description, in a row."""
    for field in dataclasses.fields(description):
        value = getattr(description, field.name)
        if isinstance(value, xs.Estimate):
            yield value
        elif isinstance(value, tuple):
            yield from value
        elif isinstance(value, dict):
            yield from value.values()


@pytest.mark.parametrize("columns", [([],), ([], []), ([], None, []), ([1.0, 2.0], [0.0, 0.0])])
def test_no_trials_are_no_error(columns):
    everything = list(estimates_of(xs.describe(*columns, threshold=1.0)))
    assert len(everything) == 12 + 21 + 2 + 1
    assert all(math.isnan(each.value) and each.error is each.interval is None and each.n == 0 for each in everything)


@pytest.mark.parametrize(
    "columns",
    [
        ([1.0],),
        ([1.0], [2.0]),
        ([1.0, 2.0],),
        ([1.0, 2.0], [1.0, 1e-12]),
        ([1.0, 2.0], None, [0, 1]),
        ([1.0, 2.0], [1.0, 2.0], [0, 1]),
        ([0.1] * 50,),
        ([0.1] * 50, [1.0] * 50),
        ([0.1] * 50, None, [0, 1] * 25),
        ([0.0, 1.0] * 40,),
        ([1e300, -1e300, 3e299],),
        ([1e-310, 2e-310, 3e-310] * 20,),
        (list(range(100)), [1e-300] * 99 + [1.0]),
        (list(range(100)), [1e-25] * 99 + [1.0]),
    ],
)
def test_odd_samples_raise_no_warning_and_give_no_nonsense(columns):
    """Warnings are errors in these tests."""
    for each in estimates_of(xs.describe(*columns, threshold=0.5)):
        assert each.error is None or each.error >= 0
        assert each.interval is None or each.interval[0] <= each.value * (1 + 1e-9)


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_values_that_are_no_numbers_are_refused(bad):
    with pytest.raises(ValueError, match="finite"):
        xs.describe([1.0, bad])
