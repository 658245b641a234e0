from __future__ import annotations

import pytest

from xlmc.errors import ErrorCode
from xlmc.excel.address import Cell

AT_LEAST, AT_MOST, ABOVE, BELOW = "Answers!C11", "Answers!D11", "Answers!E11", "Answers!F11"

MISTAKES = [
    ({"Answers!A11": None}, "Answers!A11", "Name is blank", "Fill in Name"),
    ({"Answers!A11": " positive"}, "Answers!A12", "Two rows define the filter 'Positive'", "own name"),
    ({"Answers!B12": ("=Model!B2", 0.4)}, "Answers!A12", "Two filter rows have the same cell Model!B2", "one row"),
    ({AT_LEAST: "zero"}, AT_LEAST, "At least holds the text 'zero'", "Type a number"),
    ({BELOW: ErrorCode.DIV0}, BELOW, "Below holds the error #DIV/0!", "Correct the cell"),
    ({"Answers!G11": ErrorCode.NA}, "Answers!G11", "Because holds the error #N/A", "Correct the cell"),
    ({AT_LEAST: 2, BELOW: None, AT_MOST: 1}, AT_LEAST, "At least (2) and At most (1) contradict", "Correct one"),
    ({AT_LEAST: 1}, AT_LEAST, "At least (1) and Below (1) contradict each other: no trial could pass", "Correct one"),
    ({AT_LEAST: None, ABOVE: 1}, ABOVE, "Above (1) and Below (1) contradict", "Correct one"),
    ({AT_LEAST: None, ABOVE: 1, BELOW: None, AT_MOST: 1}, ABOVE, "Above (1) and At most (1) contradict", "Correct one"),
    ({AT_LEAST: ("=4/2", 2.0)}, AT_LEAST, "At least (2) and Below (1) contradict", "Correct one"),
    (
        {AT_LEAST: None, BELOW: None, "Model!B2": 0.4},
        "Model!B2",
        "The filter has no limit, and its cell holds 0.4",
        "Fill in At least",
    ),
    ({"Answers!B12": ("=Model!Z9", 0.0)}, "Model!Z9", "The filter cell is blank", "Point to the cell"),
    ({"Answers!B12": ("=Model!A1", "Speed")}, "Model!A1", "The filter cell holds the text 'Speed'", "Fill in At least"),
    ({"Model!B3": "ok"}, "Model!B3", "The filter cell holds the text 'ok'", "such as =B7>0"),
]


@pytest.mark.parametrize(("changes", "where", "message", "hint"), MISTAKES)
def test_mistakes(only_problem, changes, where, message, hint):
    only_problem(where, message, hint, changes)


@pytest.mark.parametrize(
    ("changes", "limits"),
    [
        ({}, (0, None, None, 1)),
        ({AT_MOST: 0.25, BELOW: None}, (0, 0.25, None, None)),
        ({AT_MOST: 0, BELOW: None}, (0, 0, None, None)),  # exactly 0 can pass
        ({AT_LEAST: None, BELOW: None, ABOVE: 0}, (None, None, 0, None)),
        ({AT_MOST: 0.9, ABOVE: -1}, (0, 0.9, -1, 1)),
        ({BELOW: ("=Model!B1", 41.5)}, (0, None, None, Cell("Answers", 11, 6))),
        ({BELOW: "=Model!B1"}, (0, None, None, Cell("Answers", 11, 6))),
    ],
)
def test_limits(read, changes, limits):
    result = read(changes)
    assert result.problems == result.notices == ()
    first = result.filters[0]
    assert (first.at_least, first.at_most, first.above, first.below) == limits


@pytest.mark.parametrize("cached", [True, False, 1.0, 0.0, 0.4, "ok", None, ErrorCode.DIV0])
def test_what_excel_saved_of_a_formula_says_nothing_of_the_filter(read, cached):
    result = read({"Model!B3": ("=B1>0", cached)})
    assert result.problems == result.notices == ()
    assert result.filters[1].at_least is result.filters[1].below is None


@pytest.mark.parametrize(
    ("changes", "where", "message"),
    [
        ({"Answers!G11": None}, "Answers!G11", "The filter 'e' gives no evidence under Because"),
        ({"Model!B2": 0.4}, "Model!B2", "The filter is a constant: it does not depend on anything"),
        ({"Answers!E10": "Abov"}, "Answers!E10", "The column 'Abov' is kept as a note only: did you mean Above?"),
    ],
)
def test_notices(read, changes, where, message):
    result = read(changes)
    assert result.problems == ()
    (notice,) = result.notices
    assert str(notice.where) == where
    assert message in notice.message
    assert len(result.filters) == 2


def test_without_the_column_because(read):
    result = read(tables={"xlmc_filters": "Answers!A10:F12"})
    assert [str(notice.where) for notice in result.notices] == ["Answers!A11", "Answers!A12"]


def test_a_filter_may_be_an_assumption(read):
    result = read({"Answers!B11": ("=Inputs!B2", 6761.0), BELOW: None})
    assert result.problems == result.notices == ()
    assert result.filters[0].cell == Cell("Inputs", 2, 2)


TABLE = {"xlmc_checks": "Answers!A40:D42"}


@pytest.fixture
def rows(blocks):
    def make(*rows, headings=("Name", "Cell", "Because", "Witness")):
        return blocks("Answers!A40", [list(headings), *map(list, rows)])

    return make


def test_a_check_is_read_with_its_reason_and_notes(read, rows):
    result = read(rows(["Forward", ("=Model!B3", True), "FALSE: backward", "Lee"]), {"xlmc_checks": "Answers!A40:D41"})
    assert result.problems == result.notices == ()
    (check,) = result.checks
    assert (check.name, check.cell, check.row) == ("Forward", Cell("Model", 3, 2), Cell("Answers", 41, 1))
    assert check.because == "FALSE: backward"
    assert check.notes == {"Witness": "Lee"}


def test_a_value_column_is_the_cell_itself_and_a_copied_table_counts(read, rows):
    cells = rows(["Forward", ("=Model!B1>0", True), "moves"], headings=("Name", "Value", "Because"))
    result = read(cells, {"xlmc_checks3": "Answers!A40:C41"})
    assert result.problems == ()
    assert result.checks[0].cell == Cell("Answers", 41, 2)


@pytest.mark.parametrize(
    ("row", "where", "message", "hint"),
    [
        ([None, ("=Model!B3", True), "x"], "Answers!A41", "Name is blank", "Fill in Name"),
        (["Forward", None, "x"], "Answers!A41", "Nothing says which cell", "Cell"),
        (["Forward", ("=Model!Z9", 0.0), "x"], "Model!Z9", "The check cell is blank", "TRUE or FALSE"),
    ],
)
def test_mistakes_in_checks(only_problem, rows, row, where, message, hint):
    only_problem(where, message, hint, rows(row), {"xlmc_checks": "Answers!A40:D41"})


def test_two_checks_of_one_name_are_refused(only_problem, rows):
    cells = rows(["Same", ("=Model!B3", True)], ["same", ("=Model!B1", True)])
    only_problem("Answers!A42", "Two rows define the check", "own name", cells, TABLE)


def test_limits_are_refused_because_nobody_would_test_them(only_problem, rows):
    cells = rows(["Forward", ("=Model!B1", 1.0), 0], headings=("Name", "Cell", "At least"))
    message, hint = "A check has no limits", "or make the row a filter"
    only_problem("Answers!C41", message, hint, cells, {"xlmc_checks": "Answers!A40:C41"})


def test_a_constant_check_is_pointed_out(read, rows):
    result = read({**rows(["Always", ("=Model!D9", True)]), "Model!D9": True}, {"xlmc_checks": "Answers!A40:D41"})
    assert result.problems == ()
    assert "does not depend on anything" in result.notices[0].message


def test_a_table_without_rows_is_pointed_out(read, rows):
    result = read(rows([None, None]), {"xlmc_checks": "Answers!A40:D41"})
    assert result.problems == result.checks == ()
    (notice,) = result.notices
    assert str(notice) == "Answers!A40: The table xlmc_checks holds no check"


def test_a_filter_may_be_for_some_forecasts_only(read, only_problem):
    heading = {"Answers!H10": "Only for", "Answers!H11": " speed ; Speed"}
    table = {"xlmc_filters": "Answers!A10:H12"}
    result = read(heading, table)
    assert [(each.name, each.only_for) for each in result.forecast_filters] == [("e", ("Speed",))]
    assert [each.name for each in result.filters] == ["Positive"]
    only_problem("Answers!A11", "Only for names 'Sped'", "Speed", {**heading, "Answers!H11": "Sped"}, table)


def test_a_forecast_whose_row_has_a_mistake_is_one_nonetheless(only_problem):
    table = {"xlmc_filters": "Answers!A10:H12"}
    cells = {"Answers!H10": "Only for", "Answers!H11": "speed", "Answers!E2": "fast"}
    only_problem("Answers!E2", "Threshold holds the text 'fast'", "Type a number", cells, table)
