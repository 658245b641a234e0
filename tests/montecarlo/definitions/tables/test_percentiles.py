"""Parameters that may be left blank, and percentiles in place of parameters, as table columns."""

from __future__ import annotations

import pytest

from xlmc.excel.address import Cell
from xlmc.montecarlo.definitions.tables.assumptions import is_percentile
from xlmc.montecarlo.distributions import FAMILIES

ROW = ["Name", "Value", "Distribution"]


@pytest.fixture
def one(read, blocks):
    """The definitions of a table with one more assumption, `Extra`, from columns heading -> content."""

    def make(distribution, **columns):
        headings = {heading.replace("_", "."): value for heading, value in columns.items()}
        cells = blocks("Extra!A1", [[*ROW, *headings], ["Extra", 4.0, distribution, *headings.values()]])
        return read(cells, tables={"xlmc_assumptions2": f"Extra!A1:{'ABCDEFGHIJ'[2 + len(headings)]}2"})

    return make


def extra(result):
    assert result.problems == (), [str(problem) for problem in result.problems]
    return next(each for each in result.assumptions if each.name == "Extra")


@pytest.mark.parametrize(
    ("heading", "expected"),
    [("P10", True), ("p90", True), ("P2.5", True), ("P 50", True), ("P", False), ("P10x", False), ("Price", False)],
)
def test_headings(heading, expected):
    assert is_percentile(heading) is expected


def test_a_parameter_with_a_default_may_be_blank(one):
    assumption = extra(one("Gamma", Location=None, Scale=2, Shape=3))
    assert assumption.parameters == {"location": 0.0, "scale": 2.0, "shape": 3.0}
    assert assumption.own_family is None
    assert extra(one("Gamma", Scale=2, Shape=3)).parameters["location"] == 0
    assert extra(one("Gamma", Location=1, Scale=2, Shape=3)).parameters["location"] == 1


def test_a_rule_about_a_default_names_the_other_cell(one):
    problems = one("Lognormal", **{"Mean": -1, "Std dev": 2}).problems
    assert [(each.where, each.message) for each in problems] == [("Extra!D2", "Mean (-1) must be above Location (0)")]


def test_percentiles_in_place_of_all_parameters(one):
    assumption = extra(one("Normal", P10=0.8, P90=2.0))
    assert assumption.distribution == "Normal"
    assert assumption.parameters == {"p10": 0.8, "p90": 2.0}
    assert assumption.family.mean(0.8, 2.0) == pytest.approx(1.4)


def test_percentiles_in_place_of_some(one):
    assumption = extra(one("Triangular", P90=9, Likeliest=5, P10=3))
    assert assumption.parameters == {"likeliest": 5.0, "p10": 3.0, "p90": 9.0}
    assert assumption.notes == {}


def test_a_percentile_between_whole_ones(one):
    result = one("Normal", P2_5=0.0, P97_5=1.0)
    assert extra(result).parameters == {"p2.5": 0.0, "p97.5": 1.0}
    assert not any("note only" in notice.message for notice in result.notices)


def test_a_blank_location_stays_at_its_default_unless_there_is_a_percentile_for_it(one):
    assert extra(one("Lognormal", P10=2, P90=9)).parameters == {"location": 0.0, "p10": 2.0, "p90": 9.0}
    assert extra(one("Lognormal", P10=2, P50=4, P90=9)).parameters == {"p10": 2.0, "p50": 4.0, "p90": 9.0}


@pytest.mark.parametrize(
    ("given", "ends"),
    [({"P5": 10.5, "P95": 19.5}, (10, 20)), ({"Low": 10, "P90": 19}, (10, 20)), ({"P25": 1, "High": 4}, (0, 4))],
)
def test_a_uniform_has_the_ends_that_its_percentiles_ask_for(one, given, ends):
    draw = extra(one("Uniform", **given)).checked
    assert draw.distribution.support() == pytest.approx(ends, abs=1e-12)


def test_a_formula_stays_a_cell(one):
    assumption = extra(one("Normal", P10=("=0.4*2", 0.8), P90=2.0))
    assert assumption.parameters["p10"] == Cell("Extra", 2, 4)


@pytest.mark.parametrize(
    ("distribution", "columns", "where", "message"),
    [
        ("Uniform", {"P10": 1}, "Extra!D2", "Uniform leaves Low, High blank, and gives P10"),
        (None, {"P10": 1, "P90": 2}, "Extra!A2", "the row gives P10, P90, and no Distribution"),
        ("Normal", {"P10": 1}, "Extra!D2", "Normal leaves Mean, Std dev blank, and gives P10"),
        (
            "Normal",
            {"Mean": 1, "P10": 1, "P90": 2},
            "Extra!F2",
            "Normal leaves Std dev blank, and gives P10, P90",
        ),
        (
            "Normal",
            {"Mean": 1, "SD": 1, "P90": 2},
            "Extra!F2",
            "Normal leaves no parameter blank, and gives P90",
        ),
        ("Normal", {"P0": 1, "P90": 2}, "Extra!D2", "P0 is not a percentile"),
        ("Normal", {"P10": 1, "P100": 2}, "Extra!E2", "P100 is not a percentile"),
        ("Normal", {"P10": 2, "P90": 1}, "Extra!D2", "P10 (2) is not below P90 (1)"),
        ("Normal", {"P10": 2, "P90": "high"}, "Extra!E2", "P90 holds the text 'high', not a number"),
        ("Exponential", {"P50": -1}, "Extra!D2", "No single Exponential has P50 -1"),
        ("Triangular", {"P10": 3, "P50": 5, "P90": 9}, "Extra!F2", "No single Triangular has P10 3, P50 5, P90 9"),
    ],
)
def test_mistakes(one, distribution, columns, where, message):
    problem = one(distribution, **columns).problems[0]
    assert problem.where == where
    assert problem.message.startswith(message)
    assert problem.hint


@pytest.mark.parametrize("name", ["Cumul", "General", "Histogrm"])
def test_a_distribution_of_points_needs_its_data(one, name):
    problems = one(name, Low=1, High=5).problems
    assert problems[0].message.startswith(name)
    assert "data" in problems[0].message.casefold()
    assert problems[0].hint


def test_a_base_case_outside_is_pointed_out(one):
    notices = one("Triangular", P10=5, Likeliest=6, P90=7).notices
    assert any("The base case (4) lies outside the distribution" in notice.message for notice in notices)


def test_families_that_take_percentiles():
    """Every continuous one but those that are told by points or percentiles already."""
    without = {"Trigen", "Cumul", "General", "Histogrm"}
    continuous = [family for family in FAMILIES.values() if family.roles]
    assert len(continuous) >= 15
    assert without.isdisjoint(family.name for family in continuous)
    assert all(len(family.roles) == len(family.parameters) for family in continuous)
