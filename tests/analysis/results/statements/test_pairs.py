from __future__ import annotations

import math
from collections import Counter
from types import SimpleNamespace

import numpy as np
import pytest

from xlmc.analysis.results.statements import pairs
from xlmc.analysis.results.statements.pairs import pairs_of
from xlmc.excel.address import Cell
from xlmc.montecarlo import statistics
from xlmc.montecarlo.definitions.definitions import Forecast
from xlmc.montecarlo.loop.forecast_result import ForecastResult


def run_of(columns, replicate=None, **more):
    """What pairs need of a run: columns `(m,)` by name, all in mph unless told otherwise."""
    forecasts = [Forecast(n, Cell("S", 1, 1), Cell("S", 1, 1), **({"units": "mph"} | more.get(n, {}))) for n in columns]
    columns = {name: np.asarray(values, float) for name, values in columns.items()}
    results = {f.name: ForecastResult(f, lambda f=f: columns[f.name], Counter()) for f in forecasts}
    return SimpleNamespace(
        model=SimpleNamespace(forecasts=forecasts), forecasts=columns, results=results, replicate=replicate
    )


@pytest.fixture(scope="module")
def columns():
    rng = np.random.default_rng(7)
    first = rng.normal(20.0, 2.0, 4000)
    result = {"a": first, "b": 0.6 * first + rng.normal(8.0, 1.6, 4000)}
    result["a"][::17], result["b"][::13] = math.nan, math.nan
    return result


def test_a_pair_is_counted_where_both_are_numbers(columns):
    (pair,) = pairs_of(run_of(columns, a={"threshold": 21.0}))
    known = ~np.isnan(columns["a"]) & ~np.isnan(columns["b"])
    a, b = columns["a"][known], columns["b"][known]
    middle = pair.limits[1]
    assert pair.limits[0] == 21.0
    assert middle == pytest.approx(np.nanmedian(columns["b"]), abs=0.05)
    assert middle == round(middle, 2)
    assert pair.thresholds == (True, False)
    assert pair.trials == known.sum()
    assert pair.both_above == statistics.proportion(int(np.sum((a > 21.0) & (b > middle))), a.size)
    assert pair.either_above == statistics.proportion(int(np.sum((a > 21.0) | (b > middle))), a.size)
    assert pair.first_greater == statistics.proportion(int(np.sum(a > b)), a.size)
    assert pair.correlation == statistics.rank_correlation(a, b)


def test_replicates_give_the_errors_of_shares_of_replicates(columns):
    replicate = np.arange(4000) // 250
    (pair,) = pairs_of(run_of(columns, replicate))
    known = ~np.isnan(columns["a"]) & ~np.isnan(columns["b"])
    greater = columns["a"][known] > columns["b"][known]
    assert pair.first_greater.value == greater.mean()
    expected = statistics.share(greater, None, replicate[known])
    assert pair.first_greater.error == pytest.approx(expected.error, rel=1e-9)
    assert pair.correlation == statistics.rank_correlation(columns["a"][known], columns["b"][known], replicate[known])


def test_only_like_units_are_compared(columns):
    (pair,) = pairs_of(run_of(columns, b={"units": "ft"}))
    assert pair.first_greater is None
    (pair,) = pairs_of(run_of(columns, a={"units": ""}, b={"units": ""}))
    assert pair.first_greater is None


def test_one_forecast_has_no_pair_and_many_have_no_more_than_asked(columns):
    assert pairs_of(run_of({"a": columns["a"]})) == []
    many = {f"f{n}": columns["a"] + n for n in range(7)}
    result = pairs_of(run_of(many))
    assert len(result) == pairs.PAIRS
    assert [(pair.first.name, pair.second.name) for pair in result[:2]] == [("f0", "f1"), ("f0", "f2")]
    assert len(pairs_of(run_of(many), most=3)) == 3


def test_forecasts_that_are_never_numbers_together_make_no_pair():
    assert pairs_of(run_of({"a": [1.0, math.nan], "b": [math.nan, 2.0]})) == []
    assert pairs_of(run_of({"a": [], "b": []})) == []


def test_the_correlation_takes_the_first_trials_and_says_how_many(columns, monkeypatch):
    monkeypatch.setattr(pairs, "_RANKED", 500)
    (pair,) = pairs_of(run_of(columns))
    a, b = columns["a"][:500], columns["b"][:500]
    known = ~np.isnan(a) & ~np.isnan(b)
    assert pair.ranked == known.sum()
    assert pair.correlation == statistics.rank_correlation(a[known], b[known])
    assert pair.trials > pair.ranked


def test_a_forecast_that_does_not_vary_is_in_no_pair(columns):
    still = np.full(4000, 7.0)
    assert pairs_of(run_of({"a": columns["a"], "still": still})) == []
