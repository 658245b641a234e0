from __future__ import annotations

import pytest

from xlmc.engine.engines import ENGINES
from xlmc.errors import ErrorCode
from xlmc.excel.address import Area, Cell
from xlmc.excel.workbook.workbook import Formula
from xlmc.montecarlo.definitions.definitions_reader import read_definitions

HEADINGS = ["Name", "Value", "Distribution", "Data", "Cumulative", "Bandwidth", "Lower cutoff", "Upper cutoff", "Low"]
DATA = [[5, 15, 0.75], [16, 21, 0.25]]


@pytest.fixture
def book(make_book, blocks):
    """A workbook of one assumption made from the data in Data!A1 and below; a table Tests of Value and Weight."""

    def make(row, data=DATA, changes=None, names=()):
        cells = {
            **blocks("Inputs!A1", [HEADINGS, ["Cost", 10, *row]]),
            **blocks("Data!A1", data),
            **blocks("Data!H1", [["Value", "Weight"], [1, 2], [3, 4]]),
            **blocks("Answers!A1", [["Name", "Cell"], ["Double", ("=Inputs!$B$2", 10.0)]]),
            **(changes or {}),
        }
        tables = [
            ("xlmc_assumptions", "Inputs!A1:I2"),
            ("xlmc_forecasts", "Answers!A1:B2"),
            ("Tests", "Data!H1:I3"),
        ]
        return make_book(cells, tables, names)

    return make


@pytest.fixture
def read(book):
    return lambda *args, **kwargs: read_definitions(book(*args, **kwargs), ENGINES)


def only(result):
    assert result.problems == (), [str(problem) for problem in result.problems]
    return result.assumptions[0]


NAMES = [("Costs", "Data!$A$1:$C$2", None), ("Column", "Tests[Value]", None), ("Odd", "Data!A1*2", None)]
AREA = Area("Data", 1, 1, 2, 3)
WAYS = {
    "a formula": (("=Data!$A$1:$C$2", ErrorCode.VALUE), AREA),
    "a formula that was never calculated": ("=Data!$A$1:$C$2", AREA),
    "a spilling formula": ((Formula("Data!A1:C2", 2, 4, array=AREA, dynamic=True), ErrorCode.SPILL), AREA),
    "text": ("Data!A1:C2", AREA),
    "a name": ("Costs", AREA),
    "a name as a formula": (("=Costs", ErrorCode.VALUE), AREA),
    "a column of a table": ("Tests[Value]", Area("Data", 2, 8, 3, 8)),
    "columns of a table": ("=Tests[[Value]:[Weight]]", Area("Data", 2, 8, 3, 9)),
    "a table": ("tests", Area("Data", 2, 8, 3, 9)),
    "a name of a column": ("Column", Area("Data", 2, 8, 3, 8)),
}


@pytest.mark.parametrize(("data", "area"), WAYS.values(), ids=WAYS)
def test_ways_to_name_the_data(read, data, area):
    assumption = only(read(["Custom", data], names=NAMES))
    assert assumption.distribution == "Custom"
    assert assumption.parameters == {}
    assert assumption.data.area == area


def test_text_is_pointed_out_as_going_stale(read):
    (notice,) = read(["Custom", "Data!A1:C2"]).notices
    assert (str(notice.where), notice.message[:33]) == ("Inputs!D2", "Data is the text 'Data!A1:C2', wh")
    assert read(["Custom", "Tests"], changes={"Inputs!B2": 2}).notices == ()


def test_a_range_without_a_sheet_lies_on_the_tables_own(read):
    result = read(["Empirical", "K1:K2"], changes={"Inputs!K1": 9, "Inputs!K2": 11})
    assert only(result).data.area == Area("Inputs", 1, 11, 2, 11)


def test_what_is_read(read):
    result = only(read(["Custom", "Costs"], names=NAMES, changes={"Data!C1": None, "Data!A2": ("=15+1", 16.0)})).data
    assert result.rows == ((5.0, 15.0, None), (Cell("Data", 2, 1), 21.0, 0.25))
    assert list(result.cells) == [Cell("Data", 2, 1)]
    assert result.cumulative is False


def test_switches(read):
    assert only(read(["Custom", "Costs", True], [[5, 15, 0.75], [16, 21, 1]], names=NAMES)).data.cumulative
    assert only(read(["Empirical smoothed", "Tests[Value]", None, 0.5])).data.bandwidth == 0.5
    assert only(read(["Empirical smoothed", "Tests[Value]", None, ("=1/2", 0.5)])).data.bandwidth == Cell(
        "Inputs", 2, 6
    )


MISTAKES = {
    "no data": (["Custom", None], {}, "Inputs!D2", "Custom needs Data, a range of cells", "Name the range"),
    "a number": (["Custom", 5], {}, "Inputs!D2", "Data holds 5, which is not a range", "Name the range"),
    "an unknown name": (["Custom", "Csots"], {}, "Inputs!D2", "'Csots' is neither a range of cells", "Write one range"),
    "a name of something else": (["Custom", "Odd"], {}, "Inputs!D2", "The name stands for Data!A1*2", "one range"),
    "an unknown sheet": (["Custom", "Dta!A1:C2"], {}, "Inputs!D2", "There is no worksheet 'Dta'", "Did you mean Data?"),
    "an unknown table": (["Custom", "Test[Value]"], {}, "Inputs!D2", "There is no table 'Test'", "Did you mean Tests?"),
    "an unknown column": (["Custom", "Tests[Val]"], {}, "Inputs!D2", "has no column 'Val'", "Did you mean Value?"),
    "too many cells": (["Custom", "Data!A1:XFD1048576"], {}, "Inputs!D2", "17,179,869,184 cells", "1,048,576 cells"),
    "text among the data": (
        ["Custom", "Costs"],
        {"Data!B2": "high"},
        "Data!B2",
        "The data cell holds the text 'high', not a number",
        "Type a number",
    ),
    "an error among the data": (
        ["Custom", "Costs"],
        {"Data!B2": ("=1/0", ErrorCode.DIV0)},
        "Data!B2",
        "The data cell holds the error #DIV/0!",
        "Correct the cell",
    ),
    "an overlap": (
        ["Custom", "Costs"],
        {"Data!A2": 14},
        "Data!A2",
        "This row (14 to 21) overlaps the row of Data!A1 (5 to 15)",
        "Let each range end",
    ),
    "an overlap with a computed end": (
        ["Custom", "Costs"],
        {"Data!B1": ("=8*2+4", 20.0)},
        "Data!A2",
        "overlaps the row of Data!A1 (5 to 20)",
        "Let each range end",
    ),
    "a falling cumulative weight": (
        ["Custom", "Costs", True],
        {},
        "Data!C2",
        "The cumulative weight (0.25) falls: before it, in Data!C1, it is 0.75",
        "Sort the rows",
    ),
    "too few columns": (
        ["Discrete", "Tests[Value]"],
        {},
        "Inputs!D2",
        "Discrete takes 2 columns (values, probabilities), and Data!H2:H3 has 1",
        "Correct the range",
    ),
    "cutoffs of Custom": (["Custom", "Costs", *[None] * 2, 6], {}, "Inputs!G2", "Custom cannot be cut off", "the data"),
    "a parameter": (["Custom", "Costs", *[None] * 4, 6], {}, "Inputs!I2", "Custom has no Low", "Clear the cell"),
    "a bandwidth of Custom": (["Custom", "Costs", None, 1], {}, "Inputs!F2", "Custom has no Bandwidth", "Empirical sm"),
    "a bandwidth of 0": (
        ["Empirical smoothed", "Tests[Value]", None, 0],
        {},
        "Data!H2:H3",
        "Bandwidth (0) must be above 0",
        "leave the cell blank",
    ),
    "cumulative values": (
        ["Empirical", "Tests[Value]", True],
        {},
        "Inputs!E2",
        "Empirical has no weights that could be cumulative",
        "Clear the cell",
    ),
    "no logical": (["Custom", "Costs", "perhaps"], {}, "Inputs!E2", "Cumulative holds 'perhaps'", "Type TRUE or FALSE"),
    "cutoffs that leave nothing": (
        ["Empirical", "Tests[Value]", *[None] * 2, 7],
        {},
        "Inputs!G2",
        "Lower cutoff (7) leaves nothing of the distribution",
        "from 1 to 3",
    ),
    "a parameter of a parametric one": (
        [None, "Costs", *[None] * 4, 6],
        {},
        "Inputs!A2",
        "Uniform needs High, and the table has no such column",
        "Add a column High",
    ),
}


@pytest.mark.parametrize(("row", "changes", "where", "message", "hint"), MISTAKES.values(), ids=MISTAKES)
def test_mistakes(read, row, changes, where, message, hint):
    problems = read(row, changes=changes, names=NAMES).problems
    assert problems[0].where == where, [str(problem) for problem in problems]
    assert message in problems[0].message
    assert hint in problems[0].hint
    if row[0] is not None and row[2:3] != ["perhaps"]:
        assert len(problems) == 1, [str(problem) for problem in problems]


def test_a_base_case_that_the_data_lack(read):
    result = read(["Custom", "Costs"], names=NAMES, changes={"Inputs!B2": 99})
    (notice,) = result.notices
    assert notice.message == "The base case (99) lies outside the distribution (5 to 21)"


def test_data_of_one_value(read):
    result = read(["DUniform", "Tests[Value]"], changes={"Data!H3": 1, "Inputs!B2": 1})
    (notice,) = result.notices
    assert notice.message == "Every draw is 1: the assumption does not vary"


def test_data_not_yet_calculated_are_left_to_the_run(read):
    result = read(["Custom", "Costs"], names=NAMES, changes={"Data!A2": "=15+1"})
    assert list(only(result).data.cells) == [Cell("Data", 2, 1)]
