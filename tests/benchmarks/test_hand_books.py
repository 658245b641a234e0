"""The hand-written programs of the benchmarks give xlmc's numbers on the same draws, for any number of rows."""

from __future__ import annotations

import books
import hand_c
import hand_written_march
import hand_written_plain
import numpy as np
import pytest
import tables
from simulated import simulated

from xlmc.montecarlo.model.loading import load

TRIALS = 300
CELLS = (20, 60, 300)


def drawn(path, rows):
    run = simulated(load(path), TRIALS, seed=3, engine="numpy", keep_inputs=None)
    inputs = np.array([run.inputs[name] for name, *_ in rows])
    return inputs, np.array([run[forecast.name].values for forecast in run.model.forecasts])


@pytest.fixture(scope="module")
def marches(tmp_path_factory):
    folder = tmp_path_factory.mktemp("marches")
    result = {}
    for cells in CELLS:
        path = folder / f"{cells}.xlsx"
        books.write_march(path, cells)
        result[cells] = drawn(path, books.MARCH)
    return result


@pytest.mark.parametrize("search", hand_written_march.SEARCHES)
@pytest.mark.parametrize("cells", CELLS)
def test_time_steps_in_numpy(marches, cells, search):
    inputs, truth = marches[cells]
    evaluate = hand_written_march.buffered(TRIALS, cells, search)
    for _ in range(2):  # the arrays of the first block are used again
        np.testing.assert_allclose(evaluate(inputs.copy()), truth, rtol=1e-12)


@pytest.mark.parametrize("search", hand_written_march.SEARCHES)
@pytest.mark.parametrize("cells", CELLS)
def test_time_steps_in_c(marches, library, cells, search):
    inputs, truth = marches[cells]
    np.testing.assert_allclose(hand_c.March(library, cells, search).evaluate(inputs), truth, rtol=1e-12)


@pytest.mark.parametrize("search", hand_written_march.SEARCHES)
def test_drawn_answers_of_time_steps_are_of_one_distribution(library, search):
    n, chunk = 20_001, 1_024
    for result in (
        hand_written_march.simulate(n, 1, chunk, 100, search),
        hand_c.March(library, 100, search).simulate(n, 1, chunk),
    ):
        assert result.shape == (1, n)
        centred = hand_written_march.simulate(n, 2, chunk, 100, search)
        error = centred.std() * np.sqrt(2 / n)
        assert abs(result.mean() - centred.mean()) < 5 * error
        assert result.std() == pytest.approx(centred.std(), rel=0.05)


def test_both_searches_find_every_row_of_the_road():
    begins, *_ = hand_written_march.road_columns()
    places = np.concatenate([begins, np.nextafter(begins[1:], 0), np.nextafter(begins, 1e9)])
    by_halves = begins.searchsorted(places, "right") - 1
    guessed = np.minimum(places / books.ROAD_STEP, len(begins) - 1).astype(int)
    np.testing.assert_array_equal(by_halves, guessed)


@pytest.mark.parametrize("name", hand_written_plain.BOOKS)
def test_powers_and_the_wide_book(name, tmp_path, monkeypatch):
    """The wide one narrower, with as many terms to a forecast."""
    path = tmp_path / f"{name}.xlsx"
    if name == "wide":
        assumptions, forecasts = books.WIDE_ASSUMPTIONS // 20, books.WIDE_FORECASTS // 20
        monkeypatch.setattr(hand_written_plain, "WIDE_ASSUMPTIONS", assumptions)
        monkeypatch.setattr(hand_written_plain, "WIDE_FORECASTS", forecasts)
        books.write_wide(path, assumptions, forecasts)
    else:
        books.make_books(tmp_path, [name])
    inputs, truth = drawn(path, books.POWERS if name == "powers" else books.wide_inputs(assumptions))
    result = hand_written_plain.BOOKS[name].kernel(TRIALS)(inputs)
    assert result.shape == truth.shape
    np.testing.assert_allclose(result, truth, rtol=1e-12)


def test_every_power_cell_is_needed(tmp_path):
    model = load(books.make_books(tmp_path, ["powers"])["powers"])
    assert len(model.live) == len(books.POWERS)
    assert len(model.needed.graph.formulas) == len(books.POWER_CELLS) + len(books.POWER_FORECASTS)


@pytest.mark.parametrize(("assumptions", "forecasts"), [(1, 1), (10, 3), (3, 10), (40, 40)])
def test_a_wide_book_needs_every_assumption(tmp_path, assumptions, forecasts):
    path = tmp_path / "wide.xlsx"
    books.write_wide(path, assumptions, forecasts)
    model = load(path)
    assert (len(model.live), len(model.forecasts)) == (assumptions, forecasts)


def test_tables_show_the_cost_of_a_cell():
    record = {"family": "xlmc", "absent": None, "note": "", "versions": {}, "rates": [1e6], "rate": 1e6}
    record |= {"ready_median": 1.0, "checked": 1, "differs": [], "ns a cell": 0.5, "to xlmc/jit": 0.25}
    table = tables.TABLES["rates"]({"cells-1000": {"xlmc/numpy": record}})
    assert "| contestant | trials/s | ns a cell | × xlmc/jit |" in table
    assert "| 0.5 | 0.25 |" in table
