from __future__ import annotations

import pytest

from xlmc.address import Cell

TABLE = {"xlmc_checks": "Answers!A40:D42"}


@pytest.fixture
def rows(blocks):
    def make(*rows, headings=("Name", "Cell", "Because", "Witness")):
        return blocks("Answers!A40", [list(headings), *map(list, rows)])

    return make


def test_a_check_is_read_with_its_reason_and_notes(read, rows):
    found = read(rows(["Forward", ("=Model!B3", True), "FALSE: backward", "Lee"]), {"xlmc_checks": "Answers!A40:D41"})
    assert found.problems == found.notices == ()
    (check,) = found.checks
    assert (check.name, check.cell, check.row) == ("Forward", Cell("Model", 3, 2), Cell("Answers", 41, 1))
    assert check.because == "FALSE: backward"
    assert check.notes == {"Witness": "Lee"}


def test_a_value_column_is_the_cell_itself_and_a_copied_table_counts(read, rows):
    cells = rows(["Forward", ("=Model!B1>0", True), "moves"], headings=("Name", "Value", "Because"))
    found = read(cells, {"xlmc_checks3": "Answers!A40:C41"})
    assert found.problems == ()
    assert found.checks[0].cell == Cell("Answers", 41, 2)


@pytest.mark.parametrize(
    ("row", "where", "message", "hint"),
    [
        ([None, ("=Model!B3", True), "x"], "Answers!A41", "Name is blank", "Fill in Name"),
        (["Forward", None, "x"], "Answers!A41", "Nothing says which cell", "Cell"),
        (["Forward", ("=Model!Z9", 0.0), "x"], "Model!Z9", "The check cell is blank", "TRUE or FALSE"),
    ],
)
def test_mistakes(only_problem, rows, row, where, message, hint):
    only_problem(where, message, hint, rows(row), {"xlmc_checks": "Answers!A40:D41"})


def test_two_checks_of_one_name_are_refused(only_problem, rows):
    cells = rows(["Same", ("=Model!B3", True)], ["same", ("=Model!B1", True)])
    only_problem("Answers!A42", "Two rows define the check", "own name", cells, TABLE)


def test_limits_are_refused_because_nobody_would_test_them(only_problem, rows):
    cells = rows(["Forward", ("=Model!B1", 1.0), 0], headings=("Name", "Cell", "At least"))
    message, hint = "A check has no limits", "or make the row a filter"
    only_problem("Answers!C41", message, hint, cells, {"xlmc_checks": "Answers!A40:C41"})


def test_a_constant_check_is_pointed_out(read, rows):
    found = read({**rows(["Always", ("=Model!D9", True)]), "Model!D9": True}, {"xlmc_checks": "Answers!A40:D41"})
    assert found.problems == ()
    assert "does not depend on anything" in found.notices[0].message


def test_a_table_without_rows_is_pointed_out(read, rows):
    found = read(rows([None, None]), {"xlmc_checks": "Answers!A40:D41"})
    assert found.problems == found.checks == ()
    (notice,) = found.notices
    assert str(notice) == "Answers!A40: The table xlmc_checks holds no check"
