from __future__ import annotations

import gc
import weakref

import numpy as np
import pytest

from xlmc.montecarlo.columns import Folder
from xlmc.outputs import filter_effect as module
from xlmc.outputs.document.content.assumptions import assumption_remarks
from xlmc.outputs.filter_effect import (
    DRAWN,
    draws_of_prior,
    filter_effect,
    filter_effect_of,
    marginal,
    shapes,
    shapes_of,
)

RANDOM = np.random.default_rng(11)


def test_shift_and_narrowing_are_those_of_the_marginals():
    prior, accepted = RANDOM.normal(10.0, 2.0, 50_000), RANDOM.normal(11.0, 1.0, 20_000)
    result = filter_effect(prior, accepted)
    assert result.shift.value == pytest.approx((accepted.mean() - prior.mean()) / prior.std(ddof=1))
    assert result.narrowing.value == pytest.approx(accepted.std(ddof=1) / prior.std(ddof=1))
    assert abs(result.shift.value - 0.5) < 4 * result.shift.error
    assert abs(result.narrowing.value - 0.5) < 4 * result.narrowing.error


def test_errors_are_what_other_seeds_would_change():
    runs = [filter_effect(RANDOM.normal(0.0, 2.0, 900), RANDOM.normal(1.0, 1.0, 300)) for _ in range(200)]
    for pick in (lambda run: run.shift, lambda run: run.narrowing):
        spread = np.std([pick(run).value for run in runs], ddof=1)
        stated = np.mean([pick(run).error for run in runs])
        assert stated == pytest.approx(spread, rel=4 / np.sqrt(2 * len(runs)))


def test_marginals_leave_out_draws_that_are_errors():
    result = marginal(np.array([1.0, np.nan, 3.0]))
    assert (result.trials, result.mean.value) == (2, 2.0)
    assert list(result.percentiles) == [5.0, 50.0, 95.0]


@pytest.mark.parametrize(
    ("prior", "accepted"), [([2.0] * 9, [2.0] * 3), ([], []), ([1.0], [1.0]), ([1.0, 2.0, 3.0], [])]
)
def test_where_there_is_nothing_to_compare_there_is_no_number(prior, accepted):
    result = filter_effect(np.array(prior), np.array(accepted))
    assert np.isnan(result.shift.value)
    assert np.isnan(result.narrowing.value)
    assert result.shift.error is None
    assert result.narrowing.error is None


def test_a_single_accepted_trial_has_a_shift_without_an_error():
    result = filter_effect(np.array([1.0, 2.0, 3.0]), np.array([3.0]))
    assert (result.shift.value, result.shift.error) == (pytest.approx(1.0), None)
    assert np.isnan(result.narrowing.value)


def test_without_filters_each_assumption_is_sorted_once(make, monkeypatch, package_of):
    sorted_columns = []
    monkeypatch.setattr(module, "marginal", lambda *given: sorted_columns.append(given) or marginal(*given))
    assumptions = [make.uniform("a", "A1", 0.0, 1.0), make.uniform("b", "A2", 0.0, 1.0)]
    run = make.simulate({"A1": 0.5, "A2": 0.5, "B1": "=A1+A2"}, assumptions, [make.forecast("sum", "B1")])
    package_of(run)
    assert len(sorted_columns) == 2
    assert filter_effect_of(run, "a").accepted.mean == filter_effect_of(run, "a").prior.mean
    assert len(sorted_columns) == 3


@pytest.mark.parametrize(("count", "messages"), [(DRAWN, 20_000), (DRAWN + 1, 10_000), (DRAWN + 20, 9_000)])
def test_of_many_assumptions_fewer_draws_before_filtering_are_summarised(make, monkeypatch, count, messages):
    monkeypatch.setattr(module, "_MOST_DRAWS", 10_000 * (DRAWN + 1) + 5)
    monkeypatch.setattr(module, "_FEWEST_DRAWS", 9_000)
    cells = {f"A{k}": 0.5 for k in range(1, count + 1)} | {"B1": f"=SUM(A1:A{count})"}
    assumptions = [make.uniform(f"a{k}", f"A{k}", 0.0, 1.0) for k in range(1, count + 1)]
    run = make.simulate(cells, assumptions, [make.forecast("sum", "B1")], trials=20_000)
    result = filter_effect_of(run, "a1")
    assert result.prior == marginal(run.prior["a1"][:messages])
    assert result.prior.trials == draws_of_prior(run) == messages
    assert result.accepted.trials == 20_000
    assert any(f"he first {messages:,} trials" in each for each in assumption_remarks(run))


@pytest.mark.parametrize("missing", [False, True])
def test_draws_on_disk_have_the_same_marginal_as_in_memory(missing):
    values = np.where(np.arange(5_000) % 7 == 3, np.nan, RANDOM.random(5_000)) if missing else RANDOM.random(5_000)
    folder = Folder()
    folder.append("draws", [values])
    assert marginal(folder.array("draws", values.dtype)) == marginal(values)


def test_what_is_known_of_an_assumption_does_not_hold_the_run(make):
    run = make.simulate(
        {"A1": 0.5, "B1": "=A1"}, [make.uniform("a", "A1", 0.0, 1.0)], [make.forecast("y", "B1")], trials=100
    )
    result, gone = filter_effect_of(run, "a"), weakref.ref(run)
    del run
    gc.collect()
    assert gone() is None
    assert result.prior.trials == result.accepted.trials == 100


@pytest.mark.parametrize("weighted", [False, True])
@pytest.mark.parametrize(
    "draw",
    [
        lambda n: RANDOM.normal(5.0, 2.0, n),
        lambda n: RANDOM.integers(0, 25, n) / 24.0,
        lambda n: np.round(RANDOM.uniform(0.0, 3.0, n), 1),
        lambda n: 1e9 + RANDOM.uniform(0.0, 1e-3, n),
        lambda n: np.where(RANDOM.random(n) < 0.1, np.nan, RANDOM.lognormal(0.0, 2.0, n)),
    ],
    ids=["normal", "on the edges", "rounded", "far from 0", "tailed, some without a number"],
)
def test_shapes_count_each_draw_in_the_bin_that_holds_it(draw, weighted):
    accepted = draw(2_000)
    prior, weights = np.concatenate([accepted[:500], draw(1_000)]), RANDOM.random(2_000) if weighted else None
    result = shapes(prior, accepted, weights)
    known = ~np.isnan(accepted)
    w = np.ones(known.sum()) if weights is None else weights[known]
    counted, last = [], result.edges.size - 2
    for index, (low, high) in enumerate(zip(result.edges, result.edges[1:], strict=False)):
        inside = (accepted[known] >= low) & ((accepted[known] < high) | ((index == last) & (accepted[known] == high)))
        counted.append(w[inside].sum() / w.sum())
    assert result.accepted == pytest.approx(counted, rel=1e-12)


def test_shapes_are_of_the_first_assumptions_and_made_once(make, monkeypatch):
    count = DRAWN + 2
    cells = {f"A{k}": 0.5 for k in range(1, count + 1)} | {"B1": f"=SUM(A1:A{count})"}
    assumptions = [make.uniform(f"a{k}", f"A{k}", 0.0, 1.0) for k in range(1, count + 1)]
    run = make.simulate(cells, assumptions, [make.forecast("sum", "B1")], trials=200)
    assert shapes_of(run, f"a{DRAWN}") is shapes_of(run, f"a{DRAWN}") is not None
    assert shapes_of(run, f"a{DRAWN + 1}") is None
