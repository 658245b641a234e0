"""Rows of `xlmc_scenarios`: what a heading and a cell mean, and what is said where they mean nothing."""

from __future__ import annotations

import pytest

from xlmc.analysis.results.statements.scenarios_in_words import changes_text
from xlmc.excel.address import parse_address
from xlmc.montecarlo.definitions.definitions import Definitions
from xlmc.montecarlo.definitions.scenarios import Band, Drawn, Frozen, Limits, Numbers, Range, Typed

TABLE = {"xlmc_scenarios": "Scenarios!A1:C2"}


def cells(blocks, heading, value, name="one", note="why"):
    return blocks("Scenarios!A1", [["Name", "Note", heading], [name, note, value]])


@pytest.fixture
def changes_of(read, blocks):
    """The changes of a scenario with one column."""

    def result(heading, value):
        definitions = read(cells(blocks, heading, value), TABLE, names=[("grip", "Inputs!$B$5", None)])
        assert definitions.problems == ()
        (scenario,) = definitions.scenarios
        assert (scenario.name, scenario.note, str(scenario.row)) == ("one", "why", "Scenarios!A2")
        assert all(str(change.where) == "Scenarios!C2" for change in scenario.changes)
        return scenario

    return result


INSIDE = {"at_least": 0.0, "at_most": 0.5, "above": None, "below": None}

GRAMMAR = [
    ("Friction", 0.7, Frozen("Friction", 0.7), "Friction = 0.7"),
    (" friction ", "frozen", Frozen("Friction", None), "Friction frozen"),
    ("Gravity", "Drawn", Drawn("Gravity"), "Gravity drawn"),
    ("Friction", ".6 to 0.8", Range("Friction", 0.6, 0.8), "Friction from 0.6 to 0.8"),
    ("Friction", "60 % – 80%", Range("Friction", 0.6, 0.8), "Friction from 0.6 to 0.8"),
    ("Friction", "-3 … −1e-1", Range("Friction", -3.0, -0.1), "Friction from -3 to -0.1"),
    ("Friction", "at most .8", Range("Friction", None, 0.8), "Friction at most 0.8"),
    ("Friction", "P0 to p10", Band("Friction", 0.0, 10.0), "Friction from P0 to P10"),
    ("grip", "P2.5 to P97.5", Band("Friction", 2.5, 97.5), "Friction from P2.5 to P97.5"),
    ("Inputs!B5", 0.7, Frozen("Friction", 0.7), "Friction = 0.7"),
    ("Friction", "0.72", Frozen("Friction", 0.72), "Friction = 0.72"),
    ("Friction low", 0.5, Typed("Inputs!D5", 0.5), "Friction low = 0.5"),
    ("Friction Distribution", "Uniform", Typed("Inputs!C5", "Uniform"), "Friction Distribution = Uniform"),
    ("Reaction lower_cutoff", "none", Typed("Inputs!I4", None), "Reaction lower_cutoff = nothing"),
    ("Friction Frozen", True, Typed("Inputs!M5", True), "Friction Frozen = TRUE"),
    (
        "e",
        "0 to .5",
        Limits("e", INSIDE),
        "e at least 0 and at most 0.5",
    ),
    ("e", "below .5", Limits("e", {"below": 0.5, "at_most": None}), "e below 0.5"),
    ("e At least", "none", Typed("Answers!C11", None), "e At least = nothing"),
    ("Speed Threshold", 30, Typed("Answers!E2", 30.0), "Speed Threshold = 30"),
]


def test_what_a_heading_and_a_cell_mean(changes_of, subtests):
    for heading, value, expected, words in GRAMMAR:
        with subtests.test(heading, value=value):
            scenario = changes_of(heading, value)
            (result,) = scenario.changes
            if isinstance(expected, Typed):
                assert (result.cell, result.value) == (parse_address(expected.cell), expected.value)
            else:
                assert type(result) is type(expected)
                assert [getattr(result, name) for name in expected.__slots__ if name != "where"] == [
                    getattr(expected, name) for name in expected.__slots__ if name != "where"
                ]
            assert changes_text(scenario, Definitions()) == words


def test_a_table_without_the_column_still_takes_numbers(read, blocks):
    """The assumptions of this book have no column Lower cutoff."""
    given = {f"Inputs!I{row}": None for row in range(1, 7)}
    definitions = read({**cells(blocks, "Friction lower cutoff", 0.65), **given}, TABLE)
    assert definitions.problems == ()
    (change,) = definitions.scenarios[0].changes
    assert (change.assumption, change.values) == ("Friction", {"lower_cutoff": 0.65})
    assert isinstance(change, Numbers)


WRONG = [
    (
        "Frition",
        0.7,
        "C1",
        "'Frition' is neither an assumption, a filter, a defined name nor a cell",
        "Did you mean Friction?",
    ),
    ("B7", 1, "C1", "'B7' is neither", "Name the sheet, too, such as Inputs!B7"),
    ("Nowhere!B7", 1, "C1", "There is no worksheet 'Nowhere'", "Use one of"),
    ("Friction", "0.6 bis 0.8", "C2", "'0.6 bis 0.8' says nothing of the assumption 'Friction'", "a range such as"),
    ("Friction", "0,7", "C2", "'0,7' says nothing of the assumption", "a range such as"),
    ("Friction", "P10", "C2", "'P10' says nothing of the assumption", "a band such as"),
    ("Friction", True, "C2", "'TRUE' says nothing of the assumption", "frozen, or drawn"),
    ("e", 0.5, "C2", "'0.5' is not a limit of the filter 'e'", "at most 0.5"),
    ("Friction", ("=1/0", None), "C2", "Friction has never been calculated", "calculate it"),
]


def test_what_means_nothing(read, blocks, subtests):
    for heading, value, where, message, hint in WRONG:
        with subtests.test(heading, value=value):
            (problem,) = read(cells(blocks, heading, value), TABLE).problems
            assert problem.where == f"Scenarios!{where}"
            assert message in problem.message
            assert hint in problem.hint


def test_names_of_scenarios_and_columns_are_taken_once(read, blocks):
    laid = blocks(
        "Scenarios!A1",
        [["Name", "Friction", "Inputs!B5", "Speed Value"], ["a", 0.7], ["A ", 0.8], [None, 0.9], ["b", None]],
    )
    definitions = read({**laid, "Scenarios!D1": "Note"}, {"xlmc_scenarios": "Scenarios!A1:D5"})
    assert [(problem.where, problem.message[:40]) for problem in definitions.problems] == [
        ("Scenarios!C1", "The columns 'Friction' and 'Inputs!B5' ch"[:40]),
        ("Scenarios!A3", "Two rows define the scenario 'A', this on"[:40]),
        ("Scenarios!A4", "The scenario has no name"),
    ]
    assert "Scenarios!A5: The scenario 'b' changes nothing" in map(str, definitions.notices)


def test_an_address_as_a_heading_goes_stale_and_a_name_does_not(read, blocks):
    for heading, reported in (("Model!A1", True), ("speed_cell", False)):
        laid = cells(blocks, heading, 1.0)
        notices = read(laid, TABLE, names=[("speed_cell", "Model!$A$1", None)]).notices
        assert any("goes stale when rows move" in str(notice) for notice in notices) == reported


def test_what_may_mean_two_things_is_refused(read, blocks):
    """An assumption and a filter of one name, and a column that names neither."""
    laid = {**cells(blocks, "Friction", "0.6 to 0.8"), "Answers!A11": "Friction"}
    (problem,) = read(laid, TABLE).problems
    assert (problem.where, problem.message) == ("Scenarios!C1", "'Friction' may mean several things")
    laid = {**cells(blocks, "Friction At most", 0.8), "Answers!A11": "Friction"}
    assert read(laid, TABLE).problems == ()


def test_a_misspelt_table_is_not_ignored(read, blocks):
    (problem,) = read(cells(blocks, "Friction", 0.7), {"xlmc_scenario": "Scenarios!A1:C2"}).problems
    assert "did you mean xlmc_scenarios?" in problem.message


@pytest.mark.parametrize(
    ("heading", "value", "where", "mistake"),
    [
        ("Weight", "frozen", "Inputs!D2", "heavy"),
        ("weight low", 5, "Inputs!E2", "heavy"),
        ("e", "below .5", "Answers!C11", "none at all"),
    ],
)
def test_a_row_with_a_mistake_is_a_row_nonetheless(read, blocks, heading, value, where, mistake):
    """There is one problem, that of the row: its name is no heading that means nothing."""
    (problem,) = read({**cells(blocks, heading, value), where: mistake}, TABLE).problems
    assert problem.where == where
