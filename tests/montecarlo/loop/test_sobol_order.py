"""Which assumptions take the first dimensions of Sobol points, where it is plain which of them matter most."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from xlmc.montecarlo.loop.sobol_order import _COMPARED, _largest_correlations, _score, plan_sampling
from xlmc.montecarlo.statistics import rank_correlation

GIVEN = {
    name: {"cell": cell, "low": 0, "high": 1} for name, cell in {"a": "A1", "b": "A2", "c": "A3", "d": "A4"}.items()
}
CELLS = {"A1": 0.5, "A2": 0.5, "A3": 0.5, "A4": 0.5, "B2": "=A4>1"}


@pytest.mark.parametrize(
    ("formula", "filters", "expected"),
    [
        ("=A1+4*A2-2*A3", {}, "bca"),
        ("=A1+2*A2-4*A3", {}, "cba"),
        ("=4*A1+A2", {"f": {"cell": "A3", "below": 0.1}}, "cab"),  # the filter narrows it
        ("=4*A1+A2", {"f": {"cell": "A3", "above": 0.9}}, "cab"),
        ("=A1+2*A2+3*A3", {"f": "B2"}, "abcd"),  # no trial is accepted: as in the workbook
        ("=SQRT(A1-0.5)+2*A2+0.5*A3", {}, "bac"),  # errors count for nothing
    ],
)
def test_those_that_matter_come_first(book, formula, filters, expected):
    model = book({**CELLS, "B1": formula}, GIVEN, {"x": "B1"}, filters)
    plan = plan_sampling(model, SimpleNamespace(sampling="sobol", trials=1000, seed=3))
    assert plan.order == tuple(expected)


def test_other_methods_have_no_order(book):
    model = book({**CELLS, "B1": "=A1"}, GIVEN, {"x": "B1"})
    assert not plan_sampling(model, SimpleNamespace(sampling="mc", trials=1000, seed=3)).order


X = np.array([-3.0, -1.0, 1.0, 3.0])
"""Mean 0 and standard deviation √5."""


@pytest.mark.parametrize(
    ("prior", "accepted", "forecasts", "expected"),
    [
        (X, X, [], 0.0),
        (X, X + 1.0, [], 1 / np.sqrt(5)),  # moved
        (X, X - 1.0, [], 1 / np.sqrt(5)),
        (X, X / 2, [], 0.5),  # narrowed
        (X, X / 2 + 2.0, [], 2 / np.sqrt(5)),  # both: the larger counts
        (X, X, [X**3], 1.0),
        (X, X, [-X, X[[1, 0, 3, 2]]], 1.0),
        (X, X, [X[[1, 0, 3, 2]]], 0.6),  # Spearman: 1 - 6·4/(4·15)
        (X, X, [np.array([np.nan, 1.0, 3.0, 2.0])], 0.5),  # 1 - 6·2/(3·8), without the error
        (np.array([np.nan, *X]), X + 1.0, [], 1 / np.sqrt(5)),
        (X, X, [np.ones(4)], 0.0),
        (X, X[:2], [np.ones(2)], 2 / np.sqrt(5)),
        (X, X[:1], [X[:1]], 0.0),
        (np.ones(4), np.ones(4), [X], 0.0),
    ],
)
def test_scores(prior, accepted, forecasts, expected):
    assert _score(prior, accepted, _largest_correlations({"a": accepted}, forecasts)["a"]) == pytest.approx(
        expected, rel=1e-12
    )


def test_correlations_with_all_forecasts_are_those_with_each_alone():
    random = np.random.default_rng(2)
    accepted = {"a": random.random(5_000), "b": random.integers(0, 5, 5_000) * 1.0, "c": np.ones(5_000)}
    holes = np.where(random.random(5_000) < 0.3, np.nan, accepted["a"] ** 2)
    noise = random.normal(size=5_000)
    forecasts = [accepted["a"] + noise, accepted["b"] - accepted["a"], holes, np.ones(5_000), np.full(5_000, np.nan)]
    for name, draws in accepted.items():
        alone = []
        for forecast in forecasts:
            numbers = np.flatnonzero(~np.isnan(forecast))[:_COMPARED]
            alone.append(abs(rank_correlation(draws[numbers], forecast[numbers]).value))
        expected = np.nanmax([*alone, 0.0])
        assert _largest_correlations(accepted, forecasts)[name] == expected
