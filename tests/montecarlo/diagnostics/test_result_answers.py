"""One number of a forecast as a call such as `RiskPercentile` asks for it, against NumPy; None where there is none."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from scipy import stats
from simulated import simulated

from xlmc.montecarlo.diagnostics.result_answers import CRYSTAL_BALL_STATISTICS, _between, _statistic

N = 200


@pytest.fixture(scope="module")
def result(book):
    model = book({"A1": 0.5, "B1": "=A1^2"}, {"a": {"cell": "A1", "low": 0, "high": 1}}, {"x": "B1"})
    return simulated(model, trials=N, seed=1)["x"]


def _interval(share):
    """Student's end, which the skewness of the values moves by less than 1 %."""
    return lambda x: x.mean() + stats.t.ppf(0.5 + share / 2, N - 1) * x.std(ddof=1) / np.sqrt(N)


@pytest.mark.parametrize(
    ("what", "number", "expected"),
    [
        ("statistic", 0.0, None),
        ("statistic", 1.5, None),
        ("statistic", len(CRYSTAL_BALL_STATISTICS) + 1.0, None),
        ("percent", 0.0, np.min),
        ("percent", 30.0, lambda x: np.percentile(x, 30)),
        ("percent", 100.0, np.max),
        ("percent", -0.5, None),
        ("percent", 100.5, None),
        ("share", 0.3, lambda x: np.percentile(x, 30)),
        ("share", 1.0, np.max),
        ("share", 1.2, None),
        ("share from above", 0.3, lambda x: np.percentile(x, 70)),
        ("share from above", 0.0, np.max),
        ("certainty", 0.25, lambda x: np.mean(x <= 0.25)),
        ("certainty in percent", 0.25, lambda x: 100 * np.mean(x <= 0.25)),
        ("certainty from above", 0.25, lambda x: np.mean(x > 0.25)),
        ("trial", 1.0, lambda x: x[0]),
        ("trial", float(N), lambda x: x[-1]),
        ("trial", 0.0, None),
        ("trial", N + 1.0, None),
        ("trial", 1.5, None),
        ("confidence", 0.9, _interval(0.9)),
        ("confidence", 0.0, None),
        ("confidence", 1.0, None),
        ("confidence", 1.5, None),
        ("mean_absolute_deviation", None, lambda x: np.mean(np.abs(x - x.mean()))),
    ],
)
def test_numbers_of_a_forecast(result, what, number, expected):
    results = _statistic(result, SimpleNamespace(what=what, upper=True), number)
    tolerance = 0.01 if what == "confidence" else 1e-9
    assert results == (None if expected is None else pytest.approx(expected(result.values), rel=tolerance))


@pytest.mark.parametrize(
    ("lower", "upper", "percents", "expected"),
    [
        (0.1, 0.5, False, lambda x: (x >= 0.1) & (x <= 0.5)),
        (0.1, None, False, lambda x: x >= 0.1),
        (None, 0.5, False, lambda x: x <= 0.5),
        (0.25, 0.75, True, lambda x: (x >= np.percentile(x, 25)) & (x <= np.percentile(x, 75))),
        (0.0, 1.0, True, lambda x: x < np.inf),
        (None, 0.5, True, lambda x: x <= np.median(x)),
        (-0.1, 0.5, True, None),
        (0.5, 1.1, True, None),
        ("no number", 0.5, False, None),
        (0.1, "no number", False, None),
    ],
)
def test_a_part_of_the_values(result, lower, upper, percents, expected):
    limits = SimpleNamespace(lower=lower, upper=upper, percents=percents)
    results = _between(result, limits, lambda tree: tree if isinstance(tree, float) else None)
    if expected is None:
        assert results is None
    else:
        np.testing.assert_array_equal(results.values, result.values[expected(result.values)])
