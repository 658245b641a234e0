"""A state of the window as a scenario of the workbook, and back."""

from __future__ import annotations

from dataclasses import replace

import pytest
from live_books import book_of_decisions, book_of_readings

from xlmc.excel.address import parse_address
from xlmc.montecarlo.definitions.distribution import Distribution
from xlmc.montecarlo.definitions.scenarios import (
    Band,
    Correlated,
    Drawn,
    Frozen,
    Limits,
    Measured,
    Numbers,
    Range,
    Redrawn,
    Scenario,
    Stated,
    Switched,
    Typed,
)
from xlmc.montecarlo.model.loading import load
from xlmc.outputs.live.adjusted_scenarios import adjustments_of, changes_of, scenario_of
from xlmc.outputs.live.adjustments import NONE, Adjustments
from xlmc.outputs.live.kinds import distribution_in_kind

OWN = Adjustments()


@pytest.fixture(scope="module")
def readings(tmp_path_factory):
    return load(book_of_readings(tmp_path_factory.mktemp("readings") / "readings.xlsx")).definitions


@pytest.fixture(scope="module")
def decisions(tmp_path_factory):
    return load(book_of_decisions(tmp_path_factory.mktemp("decisions") / "decisions.xlsx")).definitions


@pytest.fixture(scope="module")
def related(model_of):
    inputs = {
        "u": {"cell": "A1", "low": 0.0, "high": 1.0},
        "v": {"cell": "A2", "low": 0.0, "high": 1.0, "frozen": True},
    }
    cells = {"A1": 0.5, "A2": 0.5, "B1": "=A1*A2"}
    return model_of(cells, inputs, {"x": "B1"}, correlations={("u", "v"): 0.5}).definitions


BOTH_WAYS = {
    "numbers": (
        {"assumptions": {"v": {"mean": 31.0, "upper_cutoff": NONE}}},
        Numbers("v", {"mean": 31.0, "upper_cutoff": None}),
    ),
    "a band": ({"assumptions": {"v": {"band_low": 5.0, "band_high": 95.0}}}, Band("v", 5.0, 95.0)),
    "held at its own value": ({"assumptions": {"v": {"frozen": True}}}, Frozen("v", None)),
    "held elsewhere": ({"assumptions": {"v": {"frozen": True, "base": 32.0}}}, Frozen("v", 32.0)),
    "limits": (
        {"filters": {"possible": {"at_most": 70.0, "at_least": NONE}}},
        Limits("possible", {"at_most": 70.0, "at_least": None}),
    ),
    "a reading": (
        {"filters": {"laser": {"reading": 31.0, "percent": 10.0}}},
        Measured("laser", {"reading": 31.0, "percent": 10.0}),
    ),
    "used": ({"filters": {"doubtful": {"used": True}}}, Switched("doubtful", True)),
    "not used": ({"filters": {"possible": {"used": False}}}, Switched("possible", False)),
    "a threshold": ({"forecasts": {"speed": {"threshold": 30.0}}}, Stated("speed", {"threshold": 30.0})),
    "no threshold": (
        {"forecasts": {"speed": {"threshold": NONE, "central": 80.0}}},
        Stated("speed", {"threshold": None, "central": 80.0}),
    ),
}


@pytest.mark.parametrize("name", BOTH_WAYS)
def test_a_change_both_ways(readings, name):
    given, change = BOTH_WAYS[name]
    adjustments = Adjustments(**given)
    assert changes_of(readings, adjustments) == [change]
    scenario = scenario_of(readings, name, adjustments)
    assert scenario == Scenario(name, (change,))
    assert adjustments_of(readings, scenario) == adjustments


@pytest.mark.parametrize(
    ("given", "changes"),
    [
        ({"assumptions": {"v": {"frozen": True, "base": 32.0, "mean": 31.0}}}, [Frozen("v", 32.0)]),
        ({"assumptions": {"v": {"base": 32.0}}}, []),  # it is drawn
        ({"assumptions": {"v": {"frozen": False, "mean": 31.0}}}, [Numbers("v", {"mean": 31.0})]),
        ({"assumptions": {"v": {"band_low": 0.0, "band_high": 100.0}}}, []),
        ({"assumptions": {"v": {"band_high": 90.0}}}, [Band("v", 0.0, 90.0)]),
        ({"filters": {"possible": {"used": False, "at_most": 70.0}}}, [Switched("possible", False)]),
        ({"filters": {"possible": {"used": True, "at_most": 70.0}}}, [Limits("possible", {"at_most": 70.0})]),
        ({"filters": {"doubtful": {"reading": 50.0}}}, []),
        (
            {"filters": {"doubtful": {"used": True, "reading": 50.0}}},
            [Switched("doubtful", True), Measured("doubtful", {"reading": 50.0})],
        ),
        ({"correlations": {"v and t": {"correlation": 0.3}}}, []),  # the workbook has none
    ],
)
def test_what_has_no_effect_is_left_out(readings, given, changes):
    assert changes_of(readings, Adjustments(**given)) == changes


def test_another_kind_and_its_numbers(readings):
    _, t = readings.assumptions
    adjustments = Adjustments(assumptions={"t": {"kind": "Normal", "mean": 2.1}})
    drawn = Redrawn("t", distribution_in_kind(t, "Normal"))
    assert changes_of(readings, adjustments) == [drawn, Numbers("t", {"mean": 2.1})]
    assert adjustments_of(readings, scenario_of(readings, "other", adjustments)) == adjustments
    assert changes_of(readings, Adjustments(assumptions={"t": {"kind": "Uniform"}})) == []
    moved = Scenario("s", (Redrawn("t", Distribution("Normal", 2.0, 0.5)),))
    assert adjustments_of(readings, moved) == Adjustments(assumptions={"t": {"kind": "Normal", "std_dev": 0.5}})
    assert adjustments_of(readings, Scenario("s", (Redrawn("t", Distribution("Weibull", 0.0, 1.0, 2.0)),))) is None


def test_correlations_and_what_the_workbook_holds(related):
    adjustments = OWN.having("correlation", "u and v", "correlation", -0.25)
    assert changes_of(related, adjustments) == [Correlated("u", "v", -0.25)]
    assert adjustments_of(related, scenario_of(related, "s", adjustments)) == adjustments
    drawn = OWN.having("assumption", "v", "frozen", False)
    assert changes_of(related, drawn) == [Drawn("v")]
    assert adjustments_of(related, Scenario("s", (Drawn("v"),))) == drawn
    assert changes_of(related, OWN.having("assumption", "v", "base", 0.75)) == [Frozen("v", 0.75)]
    assert changes_of(related, OWN.having("assumption", "v", "high", 0.75)) == []  # it is held anyway


@pytest.mark.parametrize(
    ("change", "values"),
    [
        (Range("t", 1.6, 2.4), {"low": 1.6, "high": 2.4}),
        (Range("t", None, 2.4), {"high": 2.4}),
        (Range("t", 1.6, None), {"low": 1.6}),
        (Range("v", 1.6, 2.4), None),  # a normal has no ends
        (Range("gone", 1.6, 2.4), None),
        (Numbers("t", {"lower_cutoff": None}), {}),  # there is none to be taken away
        (Numbers("t", {"lower_cutoff": 1.7}), None),  # no handle for a new one
        (Numbers("v", {"lower_cutoff": None}), {"lower_cutoff": NONE}),
    ],
)
def test_ranges_and_cutoffs(readings, change, values):
    rows = {change.assumption: values} if values else {}
    assert adjustments_of(readings, Scenario("s", (change,))) == (None if values is None else Adjustments(rows))


ANY = parse_address("Z9", "T")


@pytest.mark.parametrize(
    ("of", "value", "expected"),
    [
        (("xlmc_assumptions", "v", "Mean"), 31, ("assumption", "v", "mean", 31.0)),
        (("xlmc_assumptions", "v", "Std dev"), 3.5, ("assumption", "v", "std_dev", 3.5)),
        (("xlmc_assumptions", "v", "Lower cutoff"), 21, ("assumption", "v", "lower_cutoff", 21.0)),
        (("xlmc_assumptions", "v", "Upper cutoff"), None, ("assumption", "v", "upper_cutoff", NONE)),
        (("xlmc_assumptions", "v", "Mean"), None, None),  # a mean cannot be taken away
        (("xlmc_assumptions", "v", "Frozen"), True, ("assumption", "v", "frozen", True)),
        (("xlmc_assumptions", "v", "Frozen"), False, ("assumption", "v", "frozen", False)),
        (("xlmc_assumptions", "v", "Frozen"), 1.0, None),
        (("xlmc_assumptions", "v", "Mean"), True, None),
        (("xlmc_assumptions", "v", "Mean"), "31", None),
        (("xlmc_assumptions", "v", "Units"), 3.0, None),
        (("xlmc_assumptions", "gone", "Mean"), 31, None),
        (("xlmc_filters", "possible", "At most"), 70, ("filter", "possible", "at_most", 70.0)),
        (("xlmc_filters", "possible", "At most"), None, ("filter", "possible", "at_most", NONE)),
        (("xlmc_evidence", "laser", "Reading"), 31, ("filter", "laser", "reading", 31.0)),
        (("xlmc_evidence", "at 40 ft", "±"), 2, ("filter", "at 40 ft", "plus_minus", 2.0)),
        (("xlmc_evidence", "laser", "Percent"), 10, ("filter", "laser", "percent", 10.0)),
        (("xlmc_evidence", "laser", "Percent"), None, None),
        (("xlmc_forecasts", "speed", "Threshold"), 30, ("forecast", "speed", "threshold", 30.0)),
        (("xlmc_forecasts", "speed", "Threshold"), None, ("forecast", "speed", "threshold", NONE)),
        (("xlmc_forecasts", "speed", "Range %"), 80, ("forecast", "speed", "central", 80.0)),
        (("xlmc_forecasts", "speed", "Range %"), None, None),
        (("xlmc_settings", "Trials", "Value"), 80, None),
        (None, 80, None),
    ],
)
def test_what_is_typed_into_a_row_of_a_table(readings, of, value, expected):
    adjustments = adjustments_of(readings, Scenario("s", (Typed(ANY, value, of=of),)))
    assert adjustments == (expected and OWN.having(*expected))


def test_what_is_typed_into_cells_of_decisions_and_of_what_is_solved_for(decisions):
    adjustments = OWN.having("decision", "limit", "value", 60.0).having("decision", "road", "value", 1.0)
    adjustments = adjustments.having("solve", "stops", "to", 30.0)
    limit, road, stops = changes_of(decisions, adjustments)
    assert (limit.cell, limit.value, limit.named) == (parse_address("A3", "M"), 60, "limit")
    assert (road.cell, road.value) == (parse_address("D1", "M"), "wet")
    assert (stops.value, stops.named, stops.of) == (30, "stops To", ("xlmc_solve", "stops", "To"))
    assert adjustments_of(decisions, scenario_of(decisions, "s", adjustments)) == adjustments
    assert adjustments_of(decisions, Scenario("s", (replace(road, value="snow"),))) is None
    assert adjustments_of(decisions, Scenario("s", (replace(limit, value="fast"),))) is None
    assert adjustments_of(decisions, Scenario("s", (replace(stops, value=None),))) is None
