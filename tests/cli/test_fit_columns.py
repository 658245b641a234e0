"""`xlmc fit` of several columns: what is read from a file or a range, what is refused, and what is written."""

from __future__ import annotations

import json
from types import SimpleNamespace

import click
import numpy as np
import openpyxl
import pytest

from xlmc.cli.fit_columns import _as_json, _pairs, _report, columns_of_csv, columns_of_range
from xlmc.errors import DefinitionError, WorkbookError
from xlmc.montecarlo.statistics import Estimate

pytestmark = pytest.mark.usefixtures("fitted_once")


@pytest.fixture
def in_a_command():
    """Reading a book sets the number style of the command that runs."""
    with click.Context(click.Command("fit")):
        yield


def _copula(name, aic, turned=False, **parameters):
    return SimpleNamespace(name=name, aic=aic, turned=turned, parameters=parameters)


GAUSSIAN, CLAYTON = _copula("Gaussian", -10.0, r=0.5), _copula("Clayton", -12.25, theta=1.2345)


@pytest.mark.parametrize(
    ("copulas", "cells"),
    [
        ([CLAYTON, GAUSSIAN], ("Clayton", "theta 1.23", "2.2")),
        ([GAUSSIAN, CLAYTON], ("Gaussian", "r 0.5", "0.0")),
        ([CLAYTON], ("Clayton", "theta 1.23", "")),
        ([_copula("t", -13.0, r=-0.25, freedom=4.0), GAUSSIAN], ("t", "r -0.25, freedom 4", "3.0")),
        ([_copula("Gumbel", -13.0, turned=True, theta=2.0), GAUSSIAN], ("Gumbel, turned", "theta 2", "3.0")),
    ],
)
def test_a_pair_of_columns_has_its_best_copula_and_how_far_the_gaussian_one_is_behind(copulas, cells):
    pair = SimpleNamespace(first="a", second="b", n=1234, correlation=Estimate(0.5, 0.02), copulas=copulas)
    [row] = _pairs(SimpleNamespace(pairs=[pair])).rows
    assert row == ("a", "b", "1,234", "0.500 ± 0.020", *cells)
    [result] = _as_json(SimpleNamespace(columns=[], pairs=[pair]), "book")["pairs"]
    assert (result["first"], result["second"], result["rows"]) == ("a", "b", 1234)
    assert [(each["name"], each["aic"], each["turned"]) for each in result["copulas"]] == [
        (each.name, each.aic, each.turned) for each in copulas
    ]


@pytest.mark.parametrize(("count", "columns"), [(1, "1 column"), (2, "2 columns")])
def test_what_is_said_of_columns_that_are_not_fitted(count, columns):
    texts = SimpleNamespace(fitting=None, best=None, shares={"yes": Estimate(0.25, 0.01)}, name="t", why="")
    other = SimpleNamespace(fitting=None, best=None, shares={}, name="u", why="it has 2 values")
    result = _report(SimpleNamespace(columns=[texts, other][:count], pairs=[]), "data.csv")
    assert result.below == f"data.csv: {columns}"
    table, *others = result.blocks
    assert (table.title, table.rows) == ("t: shares of its texts", (("yes", "25.0 ± 1.0 %"),))
    assert [each.text for each in others] == ["Not fitted: u: it has 2 values."][: count - 1]


@pytest.fixture
def csv(tmp_path):
    def write(*lines):
        path = tmp_path / "data.csv"
        path.write_text("\n".join(lines), encoding="utf-8")
        return path

    return write


@pytest.fixture
def sheet(tmp_path, in_a_command):
    def write(*rows):
        book = openpyxl.Workbook()
        for row in rows:
            book.active.append(row)
        book.save(tmp_path / "data.xlsx")
        return tmp_path / "data.xlsx"

    return write


@pytest.mark.parametrize(
    ("lines", "expected"),
    [
        (["a,b", "1,x", "2.5,y"], {"a": [1.0, 2.5], "b": ["x", "y"]}),
        (["a;b", "1,5;x", "2;"], {"a": [1.5, 2.0], "b": ["x", None]}),
        (["a\tb", "1.5\t-", "2\tn/a"], {"a": [1.5, 2.0], "b": [None, None]}),
        ([" a , b ", " 1 , NA ", "2"], {"a": [1.0, 2.0], "b": [None, None]}),
        (["a,b", '"1,5",2', "3,4"], {"a": ["1,5", "3"], "b": [2.0, 4.0]}),  # a comma that parts nothing
        (["a,", "1,", "2,"], {"a": [1.0, 2.0]}),
        (["a,b", "1,", "", "2,3"], {"a": [1.0, 2.0], "b": [None, 3.0]}),
    ],
)
def test_cells_of_a_file(csv, lines, expected):
    assert columns_of_csv(csv(*lines), None) == expected


@pytest.mark.parametrize(
    ("rows", "expected"),
    [
        ([["a", "b"], [1, "x"], [2.5, None]], {"a": [1.0, 2.5], "b": ["x", None]}),
        ([["a", "b"], [True, " x "], [False, " "]], {"a": ["TRUE", "FALSE"], "b": ["x", None]}),
        ([["a", None], [1, None], [2, None]], {"a": [1.0, 2.0]}),
    ],
)
def test_cells_of_a_range(sheet, rows, expected):
    assert columns_of_range(sheet(*rows), "A1:B3") == (expected, "data.xlsx Sheet!A1:B3")


@pytest.mark.parametrize(("wanted", "names"), [(None, ["Speed", "Space", "Time"]), ("sp*", ["Speed", "Space"])])
def test_columns_may_be_chosen(csv, sheet, wanted, names):
    assert [*columns_of_csv(csv("Speed,Space,Time", "1,2,3"), wanted)] == names
    assert [*columns_of_range(sheet(["Speed", "Space", "Time"], [1, 2, 3]), "A1:C2", wanted)[0]] == names


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        (["a,b"], "The file has no values"),
        (["a,b", "1,2", "1,2,3"], "Line 3 has 3 cells, and there are 2 headings"),
        (["a,b,a", "1,2,3"], "Column 3 of the file: another column has the heading 'a', too"),
        (["a,", "1,2"], "Column 2 of the file: the column has no heading"),
    ],
)
def test_files_that_are_no_table(csv, lines, message):
    with pytest.raises(WorkbookError, match=message):
        columns_of_csv(csv(*lines), None)


@pytest.mark.parametrize(
    ("rows", "where", "message"),
    [
        ([["a", "b"]], "Sheet!A1:B1", "The range has one row"),
        ([["a", "a "], [1, 2]], "Sheet!B1", "Another column has the heading 'a', too"),
        ([["a", None], [1, 2]], "Sheet!B1", "The column has no heading"),
        ([["a", "b"], [1, "#N/A"]], "Sheet!B2", "The cell holds #N/A"),
    ],
)
def test_ranges_that_are_no_table(sheet, rows, where, message):
    with pytest.raises(DefinitionError, match=message) as caught:
        columns_of_range(sheet(*rows), f"A1:B{len(rows)}")
    assert caught.value.where == where


@pytest.mark.parametrize(("lines", "code"), [(14, 1), (15, 0)])
def test_a_column_with_too_few_numbers_is_exit_code_1(xlmc, csv, lines, code):
    """Beside texts, which are enough however few."""
    numbers = np.random.default_rng(5).normal(10, 1, lines)
    path = csv("Speed,Surface", *(f"{number:.3f},{'dry' if number > 10 else 'wet'}" for number in numbers))
    outcome = xlmc("fit", path)
    assert outcome.code == code, outcome.err
    assert (f"Speed: {lines} values cannot tell families of distributions apart" in outcome.err) == (code == 1)


def test_columns_of_a_file_are_fitted_with_their_correlations_into_a_book(xlmc, tmp_path):
    rng = np.random.default_rng(3)
    friction = rng.normal(0.7, 0.05, 50)
    lines = [f"{mu:.4f};{30 + 60 * (mu - 0.7) + rng.normal(0, 2):.3f};{kind}".replace(".", ",")
             for mu, kind in zip(friction, rng.choice(["dry", "wet"], 50), strict=True)]  # fmt: skip
    data, book = tmp_path / "data.csv", tmp_path / "fitted.xlsx"
    data.write_text("\n".join(["Friction;Speed;Surface", *lines]), encoding="utf-8")
    outcome = xlmc("fit", data, "--uncertain", "--into", book, "-o", tmp_path / "found.html", "--json")
    assert outcome.code == 0, outcome.err
    result = json.loads(outcome.out)
    assert [each["name"] for each in result["columns"]] == ["Friction", "Speed", "Surface"]
    assert set(result["columns"][2]["shares"]) == {"dry", "wet"}
    assert result["pairs"][0]["rank_correlation"]["value"] > 0.6
    names = [row[0].value for row in openpyxl.load_workbook(book)["Fitted"].iter_rows(min_row=6)]
    assert "Friction: Mean" in names
    assert "Speed" in names
    again = xlmc("fit", data, "Sp*", "--into", book)
    assert again.code == 2
    assert "Two rows define the assumption 'Speed'" in again.err


def test_columns_of_a_range_have_headings(xlmc, tmp_path):
    made = openpyxl.Workbook()
    for row in [["a", "b", "c"], *([n + 0.5, 2 * n + (n % 3), "x" if n % 2 else "y"] for n in range(30))]:
        made.active.append(row)
    path = tmp_path / "data.xlsx"
    made.save(path)
    outcome = xlmc("fit", f"{path}!A1:C31", "--columns")
    assert outcome.code == 0, outcome.err
    assert "How the columns hang together" in outcome.out
    assert "c: shares of its texts" in outcome.out
    for given, message in (
        ((f"{path}!A1:C31", "--uncertain"), "--uncertain is for several columns"),
        ((f"{path}!A1:C1", "--columns"), "the range has one row"),
        ((f"{path}!A1:C31", "--columns", "--name", "x"), "are for one column alone"),
    ):
        outcome = xlmc("fit", *given)
        assert outcome.code == 2
        assert message.casefold() in outcome.err.casefold()


def test_a_semicolon_in_a_heading_makes_no_decimal_comma(xlmc, tmp_path):
    """Cells of a file that commas part hold no decimal commas: `1,234` in quotation marks is a text."""
    data = tmp_path / "data.csv"
    lines = [f'"1,{200 + number}",{number + 0.5}' for number in range(30)]
    data.write_text("\n".join(["Speed; rounded,Time", *lines]), encoding="utf-8")
    outcome = xlmc("fit", data, "--json")
    assert outcome.code == 0, outcome.err
    rounded, time = json.loads(outcome.out)["columns"]
    assert (rounded["distribution"], len(rounded["shares"])) == (None, 30)
    assert time["values"] == 30
