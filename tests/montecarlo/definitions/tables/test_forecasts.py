from __future__ import annotations

import math

import pytest

from xlmc.errors import ErrorCode
from xlmc.excel.address import Area, Cell
from xlmc.excel.workbook.workbook import Formula
from xlmc.montecarlo.definitions.stating import Kind, Role

MISTAKES = [
    ({"Answers!A2": None}, "Answers!A2", "Name is blank", "Fill in Name"),
    ({"Answers!D2": 0}, "Answers!D2", "Range % (0) must be above 0 and below 100", "such as 51"),
    ({"Answers!D2": 100}, "Answers!D2", "Range % (100) must be above 0 and below 100", "such as 51"),
    ({"Answers!D2": -5}, "Answers!D2", "Range % (-5) must be above 0 and below 100", "such as 51"),
    ({"Answers!D2": "51 %"}, "Answers!D2", "Range % holds the text '51 %'", "Type a number"),
    ({"Answers!D2": "=50+1"}, "Answers!D2", "Range % has never been calculated", "Open the workbook"),
    ({"Answers!E2": "fast"}, "Answers!E2", "Threshold holds the text 'fast'", "Type a number"),
    ({"Answers!E2": ErrorCode.NA}, "Answers!E2", "Threshold holds the error #N/A", "Correct the cell"),
    ({"Answers!B2": ("=Model!Z9", 0.0)}, "Model!Z9", "The forecast cell is blank", "Point to the cell with the result"),
    (
        {"Answers!B2": ("=Model!A1", "Speed")},
        "Model!A1",
        "The forecast cell holds the text 'Speed'",
        "Point to the cell with the result",
    ),
    ({"Model!C1": ErrorCode.NUM, "Answers!B2": "=Model!C1"}, "Model!C1", "holds the error #NUM!", "Correct the cell"),
]


@pytest.mark.parametrize(("changes", "where", "message", "hint"), MISTAKES)
def test_mistakes(only_problem, changes, where, message, hint):
    only_problem(where, message, hint, changes)


@pytest.mark.parametrize(
    ("row", "where", "message"),
    [
        (
            [" SPEED ", ("=Model!B2", 0.4)],
            "Answers!A3",
            "Two rows define the forecast 'SPEED', this one and Answers!A2",
        ),
        (["Other", ("=Model!B1", 41.5)], "Answers!A3", "Two forecast rows have the same cell Model!B1"),
    ],
)
def test_two_rows_of_one_name_or_cell(only_problem, blocks, row, where, message):
    only_problem(where, message, "row", blocks("Answers!A3", [row]), tables={"xlmc_forecasts": "Answers!A1:E3"})


@pytest.mark.parametrize(
    ("typed", "share"), [(None, 0.51), (51, 0.51), (90, 0.9), (2.5, 0.025), (("=50+1", 51.0), 0.51)]
)
def test_range(read, typed, share):
    result = read({"Answers!D2": typed})
    assert result.problems == result.notices == ()
    assert result.forecasts[0].central == share


@pytest.mark.parametrize(("typed", "share", "text"), [(0.51, 0.51, "51"), (0.9, 0.9, "90"), (1, 0.01, "1")])
def test_a_range_that_may_be_a_share(read, typed, share, text):
    result = read({"Answers!D2": typed})
    assert result.forecasts[0].central == share
    assert [str(notice) for notice in result.notices] == [f"Answers!D2: Range % {typed} is read as {text} %"]


def test_the_settings_give_the_range_of_rows_that_have_none(read, blocks):
    settings = blocks("Answers!A31", [["Range %", 90]])
    assert read(settings).forecasts[0].central == 0.9
    assert read({**settings, "Answers!D2": 51}).forecasts[0].central == 0.51


def test_threshold_and_notes(read):
    result = read({"Answers!E2": ("=5*7", 35.0), "Answers!C1": "Asked by", "Answers!C2": "the court"})
    assert result.forecasts[0].threshold == 35
    assert result.forecasts[0].notes == {"Asked by": "the court"}
    assert result.forecasts[0].units == ""


@pytest.mark.parametrize(
    ("low", "high", "asked"),
    [(35, 40.5, (35, 40.5)), (35, None, (35, math.inf)), (None, 35, (-math.inf, 35)), (None, None, None)],
)
def test_the_range_of_a_certainty(read, blocks, low, high, asked):
    columns = blocks("Answers!F1", [["Certainty from", "Certainty to"], [low, high]])
    result = read(columns, tables={"xlmc_forecasts": "Answers!A1:G2"})
    assert not result.problems
    assert result.forecasts[0].asked == asked


def test_a_certainty_of_no_range(only_problem, blocks):
    columns = blocks("Answers!F1", [["Certainty from", "Certainty to"], [2, 1]])
    message = "The range of the certainty begins at 2 and ends at 1"
    only_problem("Answers!F2", message, "Exchange", columns, tables={"xlmc_forecasts": "Answers!A1:G2"})


def stated(blocks, *row):
    """Cells that add the columns of how an answer is stated, with this row below them."""
    units, *others = row
    return {"Answers!C2": units, **blocks("Answers!F1", [["Report to", "Kind", "Role"], others])}


WIDE = {"xlmc_forecasts": "Answers!A1:H2"}


@pytest.mark.parametrize(
    ("row", "report_to", "kind", "role"),
    [
        ((None, None, None, None), None, None, Role.ANSWER),
        (("mph", 1, "Number", "answer"), 1.0, Kind.NUMBER, Role.ANSWER),
        (("mph", " 0.5 MPH ", "Whole  number", "Lower bound"), 0.5, Kind.WHOLE, Role.LOWER),
        (("°", "1°", "number", "upper-bound"), 1.0, Kind.NUMBER, Role.UPPER),
        (("deg", "1 °", None, "DIAGNOSTIC"), 1.0, None, Role.DIAGNOSTIC),
        ((None, "=2/4", "date", None), 0.5, Kind.DATE, Role.ANSWER),
        ((None, None, "Yes/No", None), None, Kind.YES_NO, Role.ANSWER),
        ((None, None, "yes/no", "upper bound"), None, Kind.YES_NO, Role.UPPER),
        (("$", "1e3 $", "currency", None), 1000.0, Kind.CURRENCY, Role.ANSWER),
    ],
    ids=str,
)
def test_how_an_answer_is_stated(read, blocks, row, report_to, kind, role):
    row = [("=2/4", 0.5) if each == "=2/4" else each for each in row]
    result = read(stated(blocks, *row), tables=WIDE)
    assert not result.problems
    [forecast] = result.forecasts
    assert (forecast.report_to, forecast.kind, forecast.role) == (report_to, kind, role)
    assert not forecast.notes


@pytest.mark.parametrize(
    ("row", "where", "message", "hint"),
    [
        ((None, 0, None, None), "Answers!F2", "Report to (0) must be above 0", "such as 1"),
        ((None, -1, None, None), "Answers!F2", "Report to (-1) must be above 0", "such as 1"),
        ((None, "coarse", None, None), "Answers!F2", "Report to holds the text 'coarse'", "Type a number"),
        (("mph", "1 km/h", None, None), "Answers!F2", "in 'km/h', and the forecast is in 'mph'", "units"),
        ((None, "1 mph", None, None), "Answers!F2", "in 'mph', and the forecast has no units", "units"),
        ((None, True, None, None), "Answers!F2", "Report to holds TRUE, not a number", "Type a number"),
        ((None, None, "speed", None), "Answers!G2", "Kind 'speed' is unknown", "a column of notes"),
        ((None, None, None, "lower bond"), "Answers!H2", "Role 'lower bond' is unknown", "Did you mean lower bound?"),
        ((None, None, "category", "upper bound"), "Answers!H2", "of the kind category is no bound", "Kind"),
        ((None, 1, "yes/no", None), "Answers!F2", "of the kind yes/no is not rounded", "Kind"),
        ((None, 1, "category", None), "Answers!F2", "of the kind category is not rounded", "Kind"),
        ((None, ErrorCode.NA, None, None), "Answers!F2", "Report to holds the error #N/A", "Correct the cell"),
    ],
    ids=str,
)
def test_how_an_answer_is_not_stated(only_problem, blocks, row, where, message, hint):
    only_problem(where, message, hint, stated(blocks, *row), tables=WIDE)


@pytest.mark.parametrize("value", [41.5, True])
def test_a_constant_is_pointed_out(read, value):
    result = read({"Model!B1": value})
    assert result.problems == ()
    assert [str(notice) for notice in result.notices] == [
        "Model!B1: The forecast is a constant: it does not depend on anything"
    ]


def test_a_spilled_cell_is_no_constant(read):
    spilled = Formula("A1:A3*2", row=1, column=5, array=Area("Model", 1, 5, 3, 5), dynamic=True)
    result = read({"Model!E1": (spilled, 1.0), "Model!E2": 2, "Answers!B2": ("=Model!E2", 2.0)})
    assert result.problems == result.notices == ()


def test_a_forecast_may_be_an_assumption(read):
    result = read({"Answers!B2": ("=Inputs!B2", 6761.0)})
    assert result.problems == result.notices == ()
    assert result.forecasts[0].cell == result.assumptions[0].cell == Cell("Inputs", 2, 2)


def test_a_value_column_is_the_cell(read):
    result = read({"Answers!B1": "Value", "Answers!B2": ("=Model!B1", 41.5)})
    assert result.forecasts[0].cell == Cell("Answers", 2, 2)


def test_a_blank_value_is_a_blank_forecast(only_problem):
    only_problem("Answers!B2", "The forecast cell is blank", "Point to", {"Answers!B1": "Value", "Answers!B2": None})
