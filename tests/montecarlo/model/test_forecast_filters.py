"""Filters of some forecasts only, against the same conditions computed with NumPy."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from simulated import simulated

from xlmc.analysis.results.record import make_record
from xlmc.excel.address import parse_address
from xlmc.montecarlo.definitions.definitions import Filter
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.outputs.json_document import document

CELLS = {"A1": 0.5, "B1": "=A1*10", "B2": "=A1+1", "B3": "=1/MAX(A1-0.9,0)", "C1": "=1/MAX(0.2-A1,0)", "C2": "=A1<0.8"}
INPUTS = {"u": {"cell": "A1", "low": 0.0, "high": 1.0}}
FORECASTS = {"ten": "B1", "one": "B2", "odd": "B3"}
TRIALS = 4_000


def own(name, address, *forecasts, **limits):
    cell = parse_address(address, "S")
    return Filter(name, cell, cell, only_for=forecasts, because="seen", **limits)


OWN = (
    own("low", "B1", "ten", at_least=3.0),
    own("high", "B1", "ten", at_most=9.0),
    own("both", "C2", "one", "odd"),
    own("never", "C1", "one", above=0.0),
)


@pytest.fixture(scope="module")
def model(book):
    plain = book(CELLS, INPUTS, FORECASTS, {"most": {"cell": "A1", "below": 0.95}})
    return CompiledModel(plain.workbook, replace(plain.definitions, forecast_filters=OWN), plain.path)


@pytest.fixture(scope="module")
def run(model):
    return simulated(model, TRIALS)


def test_a_trial_is_discarded_for_its_forecast_alone_and_counted_by_name(model, run):
    u = model.sampler(999, TRIALS).draw(0)["u"]
    u = u[u < 0.95]
    assert run.accepted == u.size
    np.testing.assert_array_equal(run.forecasts["ten"], np.where((u >= 0.3) & (u <= 0.9), 10 * u, np.nan))
    np.testing.assert_array_equal(run.forecasts["one"], np.where(u < 0.2, u + 1, np.nan))
    assert run.discards == {
        "ten": Counter(low=np.count_nonzero(10 * u < 3), high=np.count_nonzero(10 * u > 9)),
        "one": Counter(both=np.count_nonzero(u >= 0.8), never=0),
        "odd": Counter(both=np.count_nonzero(u >= 0.8)),
    }
    between = np.count_nonzero((u >= 0.2) & (u < 0.8))
    assert run.faults["one"] == Counter({"error in a filter of its own": between})
    assert run.faults["odd"] == Counter({"#DIV/0!": np.count_nonzero(u < 0.8)})
    assert run.error_trials == np.count_nonzero(u < 0.8)
    assert run["ten"].values.size == np.count_nonzero((u >= 0.3) & (u <= 0.9))


def test_engines_blocks_and_threads_do_not_matter(model, run):
    for more in ({"engine": "jit"}, {"jobs": 2}, {"scheduler": "processes", "jobs": 2}):
        again = simulated(model, TRIALS, **more)
        assert again.discards == run.discards
        for name, values in run.forecasts.items():
            np.testing.assert_array_equal(again.forecasts[name], values)


LIMITS = st.dictionaries(st.sampled_from(("at_least", "at_most", "above", "below")), st.floats(0, 9), max_size=2)
FILTERS = st.fixed_dictionaries(
    {
        "cell": st.sampled_from(("A1", "B1", "B2", "B1", "B2", "C2", "C3")),
        "only_for": st.lists(st.sampled_from([*FORECASTS]), unique=True, max_size=3).map(tuple),
        "limits": LIMITS,
    }
)


@settings(max_examples=12)
@given(st.lists(FILTERS, min_size=1, max_size=5))
def test_engines_discard_the_same_trials(book, filters):
    """In native blocks of many trials, step by step with NumPy, and of trials in which a filter's cell is an error."""
    cells = CELLS | {"B3": "=IF(A1<0.3,A1,B2)", "C3": "=1/MAX(0.9995-A1,0)"}
    named = {f"f{i}": {k: v for k, v in f.items() if k != "limits"} | f["limits"] for i, f in enumerate(filters)}
    model = book(cells, INPUTS, FORECASTS, named)
    runs = [simulated(model, TRIALS, engine=engine) for engine in ("numpy", "jit")]
    message = [(r.discards, r.faults, r.accepted, r.error_trials, r.tally.rejected.tolist()) for r in runs]
    assert message[0] == message[1]
    for name, values in runs[0].forecasts.items():
        assert values.tobytes() == runs[1].forecasts[name].tobytes(), name


def test_sixty_filters_of_a_forecast_are_counted_each(book):
    own = {f"f{i}": {"cell": "A1", "at_least": (i + 1) / 80, "only_for": ("ten",)} for i in range(60)}
    model = book(CELLS, INPUTS, FORECASTS, own)
    for engine in ("numpy", "jit"):
        run = simulated(model, TRIALS, engine=engine)
        u = model.sampler(run.settings.seed, TRIALS).draw(0)["u"]
        first, _ = np.histogram(u, np.arange(61) / 80)
        assert run.discards["ten"] == Counter({f"f{i}": int(count) for i, count in enumerate(first)})


def test_without_such_filters_nothing_changes(book, model, run):
    plain = simulated(book(CELLS, INPUTS, FORECASTS, {"most": {"cell": "A1", "below": 0.95}}), TRIALS)
    assert plain.discards == {}
    np.testing.assert_array_equal(plain.trial_index, run.trial_index)
    kept = ~np.isnan(run.forecasts["ten"])
    np.testing.assert_array_equal(plain.forecasts["ten"][kept], run.forecasts["ten"][kept])


def test_record_json_and_sheets_say_what_was_discarded(run):
    rows = make_record(run).rows("forecast_filters")
    message = [(row["name"], row["only_for"], row["limits"], row["discarded"]) for row in rows]
    wanted = [(each.name, name, run.discards[name][each.name]) for each in OWN for name in each.only_for]
    assert [(name, forecast, count) for name, forecast, _, count in message] == wanted
    given = document(run)["forecast_filters"]
    assert [(each["name"], each["only_for"], each["discarded"]) for each in given] == wanted
    assert given[0]["limits"] == "at least 3"


def test_a_base_case_that_is_discarded_is_told_all_the_same(model):
    hidden = replace(model.definitions, forecast_filters=(own("low", "B1", "ten", at_least=6.0),))
    run = simulated(CompiledModel(model.workbook, hidden, model.path), 200)
    base = {each["name"]: each["base_case"] for each in document(run)["forecasts"]}
    assert base["ten"] == 5.0


def test_an_error_that_is_discarded_is_no_base_case(model):
    """B3 divides by 0 at the base case: it has no value there, not 0."""
    hidden = replace(model.definitions, forecast_filters=(own("low", "B1", "odd", at_least=6.0),))
    run = simulated(CompiledModel(model.workbook, hidden, model.path), 200)
    base = {each["name"]: each["base_case"] for each in document(run)["forecasts"]}
    assert base["odd"] is None
    assert base["ten"] == 5.0
