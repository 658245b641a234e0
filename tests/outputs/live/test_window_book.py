"""The rows on the left side of the window: what can be moved, by which steps, and the shapes of what is drawn."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from live_books import book_of_dates, book_of_decisions, book_of_readings
from scipy import stats

from xlmc.montecarlo.definitions.evidence import Within
from xlmc.montecarlo.definitions.forms import Form
from xlmc.montecarlo.definitions.run_options import RunOptions
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.model.loading import load
from xlmc.outputs.live.adjustments import NONE, Adjustments
from xlmc.outputs.live.window_book import (
    _shape,
    _shape_of_error,
    _step,
    _step_in,
    _step_of,
    assumption_rows,
    book_message,
    correlation_rows,
    decision_rows,
    filter_rows,
    run_row,
    scenario_rows,
    shapes_of,
    solve_rows,
    stated_rows,
)

OWN = Adjustments()


@pytest.fixture(scope="module")
def readings(tmp_path_factory):
    return load(book_of_readings(tmp_path_factory.mktemp("readings") / "readings.xlsx"))


@pytest.fixture(scope="module")
def decisions(tmp_path_factory):
    return load(book_of_decisions(tmp_path_factory.mktemp("decisions") / "decisions.xlsx"))


@pytest.fixture(scope="module")
def dates(tmp_path_factory):
    return load(book_of_dates(tmp_path_factory.mktemp("dates") / "dates.xlsx"))


def named(rows):
    return {each["name"]: each for each in rows}


def handles(row, part="numbers"):
    """Key -> value, that of the workbook, step, whether it is dragged, whether it can be taken away."""
    return {h["key"]: (h["value"], h["own"], h["step"], h["drags"], h["goes"]) for h in row[part]}


@pytest.mark.parametrize(
    ("span", "size", "step"),
    [
        (5.0, 1e9, 0.1),  # fifty steps of a tenth
        (4.99, 1e9, 0.01),
        (500.0, 0.0, 10.0),
        (0.5, 1e9, 0.01),
        (0.0, 250.0, 1.0),  # of a size, a fiftieth of a fifth
        (0.0, 249.0, 0.1),
        (math.inf, 2.5, 0.01),
        (0.0, 0.0, 0.01),
    ],
)
def test_a_step_is_the_largest_power_of_ten_of_which_a_range_has_fifty(span, size, step):
    assert _step(span, size) == step


def test_the_numbers_of_assumptions(readings):
    rows = named(assumption_rows(readings, OWN))
    assert handles(rows["v"]) == {
        "mean": (30, 30, 0.1, True, False),  # 30/250 is 0.12
        "std_dev": (4, 4, 0.01, False, False),
        "lower_cutoff": (20, 20, 0.01, True, True),
        "upper_cutoff": (38, 38, 0.1, True, True),
    }
    assert handles(rows["t"]) == {"low": (1.5, 1.5, 0.001, True, False), "high": (2.5, 2.5, 0.01, True, False)}
    assert [rows[name]["step"] for name in ("v", "t")] == [0.1, 0.01]  # of 18/50 and of 1/50
    assert [rows["v"][key] for key in ("cell", "kind", "base", "ownBase", "band", "changed", "frozen", "form")] == [
        "M!A1", "Normal", 30, 30, [0, 100], False, False, None
    ]  # fmt: skip


def test_numbers_that_were_changed_stand_beside_the_workbooks(readings):
    moved = OWN.having("assumption", "v", "upper_cutoff", NONE).having("assumption", "v", "mean", 31.0)
    moved = moved.having("assumption", "t", "band_low", 5.0).having("assumption", "t", "base", 2.25)
    rows = named(assumption_rows(readings, moved))
    assert handles(rows["v"])["upper_cutoff"] == (None, 38, 1.0, True, True)
    assert handles(rows["v"])["mean"][:2] == (31, 30)
    assert (rows["t"]["band"], rows["t"]["base"], rows["t"]["ownBase"]) == ([5, 100], 2.25, 2)
    assert rows["t"]["changed"]
    assert named(assumption_rows(readings, OWN))["v"]["changed"] is False


def test_a_row_is_made_again_only_where_it_is_changed(readings):
    before = named(assumption_rows(readings, OWN))
    after = named(assumption_rows(readings, OWN.having("assumption", "v", "mean", 32.0)))
    assert after["t"] is before["t"]
    assert handles(after["v"])["mean"][0] == 32


def test_a_number_that_a_formula_computes_cannot_be_moved(decisions):
    low, high = named(assumption_rows(decisions, OWN))["friction"]["numbers"]
    assert (low["value"], low["cell"]) == (0.6, "")
    assert (high["value"], high["own"], high["cell"], high["step"]) == (None, None, "0.8 (=M!C1*0.4)", 1.0)


@pytest.mark.parametrize(
    ("name", "step", "key", "key_step", "kind"),
    [
        ("start", 1.0, "low", 1.0, "moment"),  # a day, though 59/50 and 46054/250 would be more
        ("discount", 0.001, "low", 0.001, "factor"),  # 0.1/50
        ("price", 100.0, "std_dev", 10.0, "before"),  # 48,000/250 and 3,000/250
    ],
)
def test_dates_percentages_and_amounts_in_their_forms(dates, name, step, key, key_step, kind):
    row = named(assumption_rows(dates, OWN))[name]
    assert (row["step"], handles(row)[key][2]) == (step, key_step)
    shown = {"moment": "day", "factor": 100, "before": "$"}[kind]
    assert row["form"][kind] == shown
    assert row["numbers"][0]["form"][kind] == shown


@pytest.mark.parametrize(("shown", "step"), [("yyyy-mm-dd hh:mm", 1 / 24), ("hh:mm", 1 / 1440), ("d/m/yy", 1.0)])
def test_steps_of_times(shown, step):
    assert _step_in(Form(Kind.DATE, shown), 0.001) == step


def test_limits_of_filters_and_numbers_of_evidence(readings):
    rows = named(filter_rows(readings, OWN))
    assert [*rows] == ["possible", "at 40 ft", "laser", "witness", "marks", "camera", "doubtful"]
    assert handles(rows["possible"], "limits") == {
        "at_least": (0, 0, 0.01, True, True), "at_most": (80, 80, 0.1, True, True)
    }  # fmt: skip
    assert handles(rows["laser"], "limits") == {
        "reading": (30, 30, 0.1, True, False),
        "percent": (12, 12, 0.01, False, False),
        "resolution": (0.5, 0.5, 0.001, False, False),
    }
    assert rows["possible"]["says"] == "keeps at least 0 and at most 80"
    assert rows["camera"]["says"] == "reads 22, at least (Plus or minus 1): from 21"
    assert rows["doubtful"]["says"] == "not used: Use is off"
    assert {name: row["used"] for name, row in rows.items() if not row["used"]} == {"doubtful": False}
    # 80/50; 34 - 28 and the reading; 62 ± 3.5 · 9; one number of 22
    steps = {"possible": 1.0, "at 40 ft": 0.1, "witness": 1.0, "camera": 0.01}
    assert {name: rows[name]["step"] for name in steps} == steps


def test_shapes_of_errors(readings):
    rows = named(filter_rows(readings, OWN))
    shapes = {name: row["shape"] for name, row in rows.items()}
    assert shapes["possible"] is None
    assert shapes["camera"] is None  # bounded on one side
    assert shapes["at 40 ft"] == {"low": 28, "high": 34, "heights": [1]}
    for name, mean, sigma in (("witness", 62, 9), ("doubtful", 55, 8)):
        shape = shapes[name]
        assert (shape["low"], shape["high"]) == (mean - 3.5 * sigma, mean + 3.5 * sigma)
        width = 7 * sigma / 40
        middles = shape["low"] + width * (np.arange(40) + 0.5)
        density = stats.norm(mean, sigma).pdf
        np.testing.assert_allclose(shape["heights"], density(middles) / density(mean), atol=6e-4)
    sigma = shapes["marks"]["high"] / 60
    assert sigma > 1
    assert shapes["marks"]["low"] == pytest.approx(60 / sigma, rel=1e-12)  # as many times less as more


def test_evidence_that_reaches_too_far_has_no_shape():
    assert _shape_of_error(Within(5.0, 0.0, 1.0, (True, False))) is None
    assert _shape_of_error(Within(5.0, 0.0, 1.0, (False, True))) is None
    assert _shape_of_error(Within(5.0, 0.0, 1.0)) == {"low": 4, "high": 6, "heights": [1]}


def test_evidence_with_an_impossible_number_has_no_shape(readings):
    rows = named(filter_rows(readings, OWN.having("filter", "witness", "std_dev", -1.0)))
    assert rows["witness"]["shape"] is None
    assert rows["witness"]["changed"]
    assert not rows["laser"]["changed"]
    assert handles(rows["witness"], "limits")["std_dev"][:2] == (-1, 9)


def test_a_filter_that_is_changed(readings):
    row = named(filter_rows(readings, OWN.having("filter", "possible", "at_most", NONE)))["possible"]
    assert row["says"] == "keeps at least 0"
    assert handles(row, "limits")["at_most"] == (None, 80, 1.0, True, True)
    off = named(filter_rows(readings, OWN.having("filter", "possible", "used", False)))["possible"]
    assert (off["used"], off["switches"], off["changed"]) == (False, True, True)


def test_filters_of_one_forecast_say_so(model_of):
    filters = {"one": {"cell": "B1", "at_most": 500.0, "only_for": ("x",)}, "all": {"cell": "B1", "at_least": 0.1}}
    model = model_of({"A1": 0.5, "B1": "=A1*2"}, {"u": {"cell": "A1", "low": 0.0, "high": 1.0}}, {"x": "B1"}, filters)
    rows = named(filter_rows(model, OWN))
    assert [*rows] == ["all", "one"]
    assert rows["one"]["because"] == "only for x"
    assert rows["one"]["step"] == 1.0  # of one number, 500/250
    assert rows["all"]["because"] == ""


def test_how_forecasts_are_stated(readings):
    assert stated_rows(readings, OWN) == [
        {"name": "speed", "threshold": 35, "central": 51, "changed": False},
        {"name": "distance", "threshold": None, "central": 90, "changed": False},
    ]
    moved = OWN.having("forecast", "speed", "threshold", NONE).having("forecast", "distance", "central", 80.0)
    assert stated_rows(readings, moved) == [
        {"name": "speed", "threshold": None, "central": 51, "changed": True},
        {"name": "distance", "threshold": None, "central": 80, "changed": True},
    ]


def test_decisions_and_what_is_tried(decisions):
    rows = named(decision_rows(decisions, OWN))
    assert {name: (row["ends"], row["tried"], row["step"], row["choices"]) for name, row in rows.items()} == {
        "limit": ([30, 70], [30, 40, 50, 60, 70], 10, []),
        "grip": ([1.9, 2.5], [1.9, 2.0, 2.5], 0.01, []),  # typed values: a step of 0.6/50
        "road": ([0, 2], [0, 1, 2], 0.01, ["dry", "wet", "ice"]),
    }
    assert handles(rows["limit"]) == {"value": (50, 50, 0.1, True, False)}
    assert not any(row["changed"] for row in rows.values())
    moved = named(decision_rows(decisions, OWN.having("decision", "limit", "value", 60.0)))
    assert (handles(moved["limit"])["value"][:2], moved["limit"]["changed"]) == ((60, 50), True)
    assert not moved["grip"]["changed"]


@pytest.mark.parametrize(
    ("values", "step"),
    [
        ((0.5, 1.0, 1.5), 0.5),
        ((0.3, 0.6, 0.9), 0.3),
        ((1.0, 1.5), 0.5),
        ((0.7, 1.7, 2.7), 0.01),  # no multiples of their distance: 2/50
        ((5.0,), 0.01),  # one value: 5/250
    ],
)
def test_the_step_of_a_decision(decisions, values, step):
    decision = replace(decisions.definitions.decisions[0], values=values, listed=False, between=None)
    assert _step_of(decision) == step


def test_many_values_are_not_marked(decisions):
    first, *others = decisions.definitions.decisions
    for count, marked in ((60, 60), (61, 0)):
        many = replace(first, values=tuple(map(float, range(30, 30 + count))))
        model = decisions.changed(decisions.workbook, replace(decisions.definitions, decisions=(many, *others)))
        assert len(decision_rows(model, OWN)[0]["tried"]) == marked


def test_rows_that_solve(decisions):
    (row,) = solve_rows(decisions, OWN)
    assert row["says"] == "M!A4 is solved for in each trial, so that M!B1 equals To, the last of several values"
    assert (row["cell"], row["changed"]) == ("M!A4", False)
    assert [(h["heading"], h["value"], h["drags"]) for h in row["numbers"]] == [
        ("To", 40, False), ("Low", 0, False), ("High", None, False)
    ]  # fmt: skip
    (moved,) = solve_rows(decisions, OWN.having("solve", "stops", "to", 30.0))
    assert moved["changed"]
    assert (moved["numbers"][0]["value"], moved["numbers"][0]["own"]) == (30, 40)


def test_correlations(model_of):
    inputs = {"u": {"cell": "A1", "low": 0.0, "high": 1.0}, "v": {"cell": "A2", "low": 0.0, "high": 1.0}}
    model = model_of({"A1": 0.5, "A2": 0.5, "B1": "=A1*A2"}, inputs, {"x": "B1"}, correlations={("u", "v"): 0.5})
    assert correlation_rows(model, OWN) == [{"name": "u and v", "value": 0.5, "changed": False}]
    moved = OWN.having("correlation", "u and v", "correlation", -0.25)
    assert correlation_rows(model, moved) == [{"name": "u and v", "value": -0.25, "changed": True}]


def test_the_workbook_in_a_message(readings):
    message = book_message(readings)
    assert message["settings"] == "4,000 trials, Monte Carlo, seed 999"
    assert message["z"] == pytest.approx(stats.norm.ppf(0.975), rel=1e-12)
    assert message["forecasts"][1] == {"name": "distance", "units": "ft", "cell": "M!B2"}
    assert [*message["shapes"]] == ["v", "t"]


def test_the_run_asked_for(readings):
    assert run_row(readings, RunOptions()) == {"trials": 4000, "seed": 999, "own": [4000, 999], "changed": False}
    assert run_row(readings, RunOptions(trials=50)) == {"trials": 50, "seed": 999, "own": [4000, 999], "changed": True}


def test_stored_scenarios(readings):
    moved = OWN.having("forecast", "speed", "threshold", 36.0)
    (row,) = scenario_rows(readings.definitions, {"mine": moved})
    assert (row["name"], row["own"], row["shows"], len(row["changes"])) == ("mine", False, True, 1)


def test_shapes_of_a_uniform_and_of_a_normal_cut_off(readings):
    shapes = shapes_of(readings)
    assert shapes["t"]["heights"] == [1.0] * 40
    assert (shapes["t"]["low"], shapes["t"]["high"]) == pytest.approx((1.50025, 2.49975))  # the middles of 2,000 parts
    middles = np.linspace(20, 38, 81)[1::2]
    density = stats.norm(30, 4).pdf(middles)
    np.testing.assert_allclose(shapes["v"]["heights"], density / density.max(), atol=0.02)
    assert [*shapes_of(readings, ["t", "unknown"])] == ["t"]


def test_shapes_are_kept_while_nothing_moves(readings):
    known = {}
    first = shapes_of(readings, known=known)
    assert all(each is first[name] for name, each in shapes_of(readings, known=known).items())


@pytest.mark.parametrize(
    ("values", "ends"),
    [
        (np.linspace(2.0, 4.0, 2000), (2, 4)),
        (np.append(np.full(1001, np.nan), np.linspace(2.0, 4.0, 999)), None),  # fewer than half are numbers
        (np.append(np.full(1000, np.nan), np.linspace(2.0, 4.0, 1000)), (2, 4)),
        (np.append(np.linspace(0.0, 1.0, 1999), 1e6), (10 / 1998, 1989 / 1998)),  # without the ten at either end
        (np.append(np.linspace(0.0, 1.0, 1999), 2.9), (0, 2.9)),  # less than three times as far is no long tail
        (np.full(2000, 7.0), (7, 7)),
    ],
)
def test_the_ends_of_a_shape(values, ends):
    shape = _shape(values)
    assert (shape and (shape["low"], shape["high"])) == (ends and pytest.approx(ends, rel=1e-12))
    if ends == (7, 7):
        assert shape["heights"] == [1]
