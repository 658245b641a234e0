"""A browser counts from the table; here the same is done in Python and compared with the trials themselves."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.columns import column_store
from xlmc.report.page.ranks import ALL_VALUES, MOST_VALUES, most_values, rank_table

values = st.lists(st.one_of(st.floats(-1e6, 1e6), st.integers(-3, 3).map(float)), min_size=1, max_size=300)


def positions(table):
    """Trials below each value, and up to it."""
    steps = np.column_stack([table.counts, np.append(table.gaps, 0)]).ravel()
    reached = np.concatenate([[0], np.cumsum(steps)])
    return reached[:-1:2], reached[1::2]


@given(values, st.integers(2, 50), st.lists(st.floats(allow_infinity=True), max_size=3))
def test_every_value_of_a_table_counts_exactly(trials, most, marks):
    x = np.sort(trials)
    table = rank_table(x, most, marks)
    below, upto = positions(table)
    assert np.all(np.diff(table.values) > 0)
    assert below.tolist() == np.searchsorted(x, table.values, "left").tolist()
    assert upto.tolist() == np.searchsorted(x, table.values, "right").tolist()
    assert upto[-1] == x.size
    assert set(x[[0, -1]]) <= set(table.values)
    assert {mark for mark in marks if np.isfinite(mark)} <= set(table.values)


@given(values)
def test_few_trials_are_all_there(trials):
    table = rank_table(np.sort(trials), len(trials) + 1)
    assert table.exact
    assert np.repeat(table.values, table.counts).tolist() == np.sort(trials).tolist()


@given(st.integers(2, 5000), st.integers(2, 300))
def test_gaps_are_less_than_their_part_of_the_trials(trials, most):
    table = rank_table(np.arange(trials, dtype=float), most)
    assert table.gaps.size == 0 or table.gaps.max() < max((trials - 1) / (most - 1), 1)
    assert table.values.size <= max(most, 1)


def test_many_whole_numbers_are_exact():
    x = np.sort(np.random.default_rng(1).poisson(40, 100_000).astype(float))
    table = rank_table(x, 2000, [40.5])
    assert table.exact
    assert table.values.size < 100
    assert table.counts[table.values == 40.5] == 0


def test_trials_on_disk_give_the_same_table(make, monkeypatch):
    assumptions = [make.uniform("a", "A1", 0.0, 1.0, base=0.5)]
    run = make.simulate({"A1": 0.5, "B1": "=A1*2"}, assumptions, [make.forecast("x", "B1")], trials=5000)
    in_memory = rank_table(run["x"].sample.x, 100, [1.0])
    monkeypatch.setattr(column_store, "IN_MEMORY", 0)
    on_disk = rank_table(run.model.simulate()["x"].sample.x, 100, [1.0])
    for name in ("values", "counts", "gaps"):
        assert getattr(in_memory, name).tolist() == getattr(on_disk, name).tolist()


@pytest.mark.parametrize(("forecasts", "most"), [(0, MOST_VALUES), (1, MOST_VALUES), (8, 6250), (40, 1250)])
def test_forecasts_share_the_page(forecasts, most):
    assert most_values(forecasts) == most
    assert forecasts * most <= ALL_VALUES
