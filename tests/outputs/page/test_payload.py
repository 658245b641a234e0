from __future__ import annotations

import json

import numpy as np
import pytest
from fewer_sheets import leave_out_fits
from hypothesis import given
from hypothesis import strategies as st
from simulated import simulated

from xlmc.montecarlo.columns import column_store
from xlmc.outputs.histogram import figures_of
from xlmc.outputs.page.payload import ALL_VALUES, MOST_VALUES, most_values, payload, payload_text, rank_table

EVIL = "</script><img src=x onerror=alert(1)>&amp;<!--\u2028"


def test_the_trials_are_those_of_the_run(run, payload_of):
    results = payload_of(run)
    assert [each["name"] for each in results["forecasts"]] == list(run.results)
    for each in results["forecasts"]:
        result = run[each["name"]]
        counts = np.ones(len(each["values"]), int) if each["counts"] is None else each["counts"]
        assert np.repeat(each["values"], counts).tolist() == result.sample.x.tolist()
        assert each["gaps"] is None
        assert each["trials"] == result.values.size
        low, high = result.central()
        assert (each["range"]["low"], each["range"]["high"]) == (low.value, high.value)
        assert each["range"]["share"] == 0.51


def test_bins_are_those_of_the_sheet(run, book, payload_of):
    sheet = book["Bins"]
    result = payload_of(run)["forecasts"]
    for number, each in enumerate(result):
        rows = sheet.iter_rows(min_row=6, min_col=7 * number + 1, max_col=7 * number + 6, values_only=True)
        rows = [row for row in rows if isinstance(row[1], (int, float))]
        assert each["bins"]["edges"] == [*(row[1] for row in rows), rows[-1][2]]
        assert each["bins"]["counts"] == [row[5] for row in rows]
        assert sum(each["bins"]["counts"]) + each["bins"]["below"] + each["bins"]["above"] == each["trials"]


def test_marks_and_overlays(run, payload_of):
    result = payload_of(run)
    area, difference = result["forecasts"]
    assert [mark["label"] for mark in area["marks"]] == ["Mean", "Base case", "Threshold"]
    assert [mark["value"] for mark in area["marks"]] == [run["area"].mean.value, 16.0, 16.0]
    assert [mark["label"] for mark in difference["marks"]] == ["Mean", "Base case"]
    assert result["overlays"] == [[0, 1]]  # both in ft


@pytest.mark.parametrize("name", ["none_accepted", "one_accepted"])
def test_few_trials_make_few_charts(request, payload_of, name):
    result = payload_of(request.getfixturevalue(name))
    assert [each["trials"] for each in result["forecasts"]] == ([] if name == "none_accepted" else [1])
    assert result["overlays"] == []


def test_a_large_run_has_gaps_but_exact_ends(make, payload_of, monkeypatch):
    leave_out_fits(monkeypatch)
    cells = {"A1": 0.5, "B1": "=A1*A1", "B2": "=A1*3"}
    forecasts = [make.forecast("square", "B1", threshold=0.3), make.forecast("triple", "B2")]
    run = make.simulate(cells, [make.uniform("a", "A1", 0.0, 1.0, base=0.5)], forecasts, trials=50_000)
    each = payload_of(run)["forecasts"][0]
    result = run["square"]
    assert len(each["values"]) == 20_003
    assert max(each["gaps"]) <= 2
    for end in (each["range"]["low"], each["range"]["high"], 0.3):
        index = each["values"].index(end)
        upto = sum(each["gaps"][:index]) + sum(each["counts"][: index + 1])
        assert upto == np.count_nonzero(result.values <= end)


def test_nothing_in_it_can_end_the_script(make):
    forecasts = [make.forecast(EVIL, "B1", units=EVIL)]
    run = make.simulate({"A1": 0.5, "B1": "=A1"}, [make.uniform("a", "A1", 0.0, 1.0)], forecasts, trials=50)
    figures = figures_of(run)
    text = payload_text(run, figures)
    assert not set("<>&\u2028\u2029") & set(text)
    assert json.loads(text) == payload(run, figures)
    assert json.loads(text)["forecasts"][0]["name"] == EVIL


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
    on_disk = rank_table(simulated(run.model)["x"].sample.x, 100, [1.0])
    for name in ("values", "counts", "gaps"):
        assert getattr(in_memory, name).tolist() == getattr(on_disk, name).tolist()


@pytest.mark.parametrize(("forecasts", "most"), [(0, MOST_VALUES), (1, MOST_VALUES), (8, 6250), (40, 1250)])
def test_forecasts_share_the_page(forecasts, most):
    assert most_values(forecasts) == most
    assert forecasts * most <= ALL_VALUES


def test_only_the_first_forecasts_have_fitted_curves(make, monkeypatch):
    monkeypatch.setattr("xlmc.outputs.page.payload.MOST_FITTED", 2)
    cells = {"A1": 0.5, "B1": "=A1", "B2": "=A1*2", "B3": "=A1*3"}
    forecasts = [make.forecast(f"answer {k}", f"B{k}") for k in (1, 2, 3)]
    run = make.simulate(cells, [make.uniform("a", "A1", 0.0, 1.0)], forecasts, trials=500)
    assert [bool(each["fits"]) for each in payload(run, figures_of(run))["forecasts"]] == [True, True, False]
