from __future__ import annotations

import pytest

from xlmc.errors import ErrorCode
from xlmc.excel.address import Area, Cell
from xlmc.excel.workbook.workbook import Formula

SPILL = Formula("H1:H3", row=1, column=2, array=Area("Inputs", 1, 2, 3, 2))

# What is changed in the workbook, and the one problem it gives. Row 2 is Uniform, 4 Normal, 5 Trapezoid, 6 Triangular.
MISTAKES = [
    # name and cell
    ({"Inputs!A2": None, "Answers!A21": "Angle"}, "Inputs!A2", "Name is blank", "Fill in Name"),
    ({"Inputs!A2": ErrorCode.REF, "Answers!A21": "Angle"}, "Inputs!A2", "Name holds the error #REF!", "Correct"),
    (
        {"Inputs!A3": " WEIGHT "},
        "Inputs!A3",
        "Two rows define the assumption 'WEIGHT', this one and Inputs!A2",
        "own name",
    ),
    # distribution
    ({"Inputs!C2": "Unifrm"}, "Inputs!C2", "'Unifrm' is not a distribution", "Did you mean Uniform?"),
    ({"Inputs!C2": "Zipf"}, "Inputs!C2", "'Zipf' is not a distribution", "Use one of Uniform, Triangular"),
    ({"Inputs!C2": ErrorCode.NA}, "Inputs!C2", "Distribution holds the error #N/A", "Correct the cell"),
    # parameters that are missing, superfluous or no numbers
    ({"Inputs!D2": None}, "Inputs!D2", "Uniform needs Low, and this cell is blank", "Type a number"),
    ({"Inputs!E2": None}, "Inputs!E2", "Uniform needs High, and this cell is blank", "Type a number"),
    ({"Inputs!G4": None}, "Inputs!G4", "Normal needs Mean, and this cell is blank", "Type a number"),
    ({"Inputs!H4": None}, "Inputs!H4", "Normal needs Std dev, and this cell is blank", "Type a number"),
    ({"Inputs!N5": None}, "Inputs!N5", "Trapezoid needs Low likeliest, and this cell is blank", "Type a number"),
    (
        {"Inputs!F6": None},
        "Inputs!F6",
        "Triangle (Triangular) needs Likeliest, and this cell is blank",
        "Type a number",
    ),
    (
        {"Inputs!F6": None, "Inputs!F1": "Mode"},
        "Inputs!F6",
        "Triangle (Triangular) needs Mode, and this cell is blank",
        "Type",
    ),
    (
        {"Inputs!F6": None, "Inputs!F1": "X"},
        "Inputs!A6",
        "Triangle (Triangular) needs Likeliest, and the table has no",
        "Add a col",
    ),
    ({"Inputs!G2": 6700}, "Inputs!G2", "Uniform has no Mean", "choose a distribution that has this parameter"),
    ({"Inputs!F2": 6700}, "Inputs!F2", "Uniform has no Likeliest", "Clear the cell"),
    ({"Inputs!D4": 0}, "Inputs!D4", "Normal has no Low", "use Lower cutoff and Upper cutoff"),
    ({"Inputs!P1": "Scale", "Inputs!P3": 2}, "Inputs!P3", "Uniform has no Scale", "Clear the cell"),
    ({"Inputs!P1": "P90", "Inputs!P3": 2}, "Inputs!P3", "Uniform leaves no parameter blank", "one percentile for each"),
    ({"Inputs!P1": "Data", "Inputs!P3": "=Q1:Q9"}, "Inputs!P3", "Uniform has no Data", "Clear the cell"),
    ({"Inputs!P1": "Min", "Inputs!P3": 2}, "Inputs!P3", "Low is given twice, as Low and as Min", "Clear one of them"),
    ({"Inputs!D2": "6,661"}, "Inputs!D2", "Low holds the text '6,661', not a number", "Type it again as a number"),
    ({"Inputs!D2": True}, "Inputs!D2", "Low holds TRUE, not a number", "Type a number"),
    ({"Inputs!D2": ErrorCode.DIV0}, "Inputs!D2", "Low holds the error #DIV/0!", "Correct the cell"),
    ({"Inputs!D2": ("=1/0", ErrorCode.DIV0)}, "Inputs!D2", "Low holds the error #DIV/0!", "what it depends on"),
    ({"Inputs!D2": ("=A1", "Name")}, "Inputs!D2", "Low holds the text 'Name'", "Type a number"),
    # parameters that break a rule
    ({"Inputs!D2": 7000}, "Inputs!D2", "Low (7,000) is above High (6,861)", "Exchange the two"),
    ({"Inputs!D2": ("=7*1000", 7000.0)}, "Inputs!D2", "Low (7,000) is above High (6,861)", "Exchange the two"),
    ({"Inputs!D2": 1e200}, "Inputs!D2", "Low (1e+200) must be a number between -1E150 and 1E150", "Correct"),
    ({"Inputs!H4": -1}, "Inputs!H4", "Std dev (-1) must be above 0", "set Frozen to TRUE"),
    ({"Inputs!N5": 0.9}, "Inputs!N5", "Low likeliest (0.9) is above High likeliest (0.85)", "Exchange the two"),
    ({"Inputs!O5": 0.99}, "Inputs!O5", "High likeliest (0.99) is above High (0.95)", "The four must rise"),
    ({"Inputs!F6": 33}, "Inputs!F6", "Likeliest (33) is above High (32.5)", "from Low to High"),
    # cutoffs
    ({"Inputs!I4": 3}, "Inputs!I4", "Lower cutoff (3) is not below Upper cutoff (2.5)", "Exchange the two"),
    ({"Inputs!I4": "none"}, "Inputs!I4", "Lower cutoff holds the text 'none'", "Type a number"),
    (
        {"Inputs!J2": 6000},
        "Inputs!J2",
        "Upper cutoff (6,000) leaves nothing of the distribution",
        "from 6,661 to 6,861",
    ),
    (
        {"Inputs!I2": 7000},
        "Inputs!I2",
        "Lower cutoff (7,000) leaves nothing of the distribution",
        "from 6,661 to 6,861",
    ),
    # the assumption cell
    ({"Inputs!B2": ("=6000+761", 6761.0)}, "Inputs!B2", "The assumption cell holds a formula", "Paste Special"),
    ({"Inputs!B1": (SPILL, "Value")}, "Inputs!B2", "The assumption cell holds a formula", "Paste Special"),
    ({"Inputs!B2": "heavy"}, "Inputs!B2", "The assumption cell holds the text 'heavy'", "Type a number"),
    ({"Inputs!B2": "6761"}, "Inputs!B2", "The assumption cell holds the text '6761'", "Type it again as a number"),
    ({"Inputs!B2": True}, "Inputs!B2", "The assumption cell holds TRUE", "Type a number"),
    ({"Inputs!B2": ErrorCode.NA}, "Inputs!B2", "The assumption cell holds the error #N/A", "Correct the cell"),
    ({"Inputs!B6": None}, "Inputs!B6", "The assumption is frozen, and its cell is blank", "Type the value"),
    ({"Inputs!B6": "x"}, "Inputs!B6", "The assumption cell holds the text 'x'", "Type a number"),
    # the rest
    ({"Inputs!M2": "maybe"}, "Inputs!M2", "Frozen holds 'maybe', neither TRUE nor FALSE", "Type TRUE or FALSE"),
    ({"Inputs!K2": ErrorCode.NAME}, "Inputs!K2", "Units holds the error #NAME?", "Correct the cell"),
    ({"Inputs!L2": ErrorCode.NAME}, "Inputs!L2", "Source holds the error #NAME?", "Correct the cell"),
]


@pytest.mark.parametrize(("changes", "where", "message", "hint"), MISTAKES)
def test_mistakes(read, only_problem, changes, where, message, hint):
    if changes.keys() & {"Inputs!B1"}:
        changes = {**changes, **dict.fromkeys(["Inputs!A3", "Inputs!B3", "Inputs!C3", "Inputs!D3", "Inputs!E3"])}
        changes["Inputs!P3"] = None
    only_problem(where, message, hint, changes)


def test_two_rows_of_one_cell(only_problem):
    changes = {"Inputs!P1": "Cell", "Inputs!B3": None, "Inputs!P3": ("=B2", 6761.0)}
    only_problem(
        "Inputs!A3", "Two assumption rows have the same cell Inputs!B2, this one and Inputs!A2", "one row", changes
    )


def test_several_mistakes_of_one_row_each_have_a_message(read):
    result = read({"Inputs!D4": 0, "Inputs!H4": "wide", "Inputs!M4": 3, "Inputs!J4": ErrorCode.NUM})
    assert [problem.where for problem in result.problems] == ["Inputs!M4", "Inputs!H4", "Inputs!J4", "Inputs!D4"]


def test_a_copied_sheet_repeats_names_once_per_row(read, blocks):
    copy = blocks("Copy!A1", [["Name", "Value", "Low", "High"], ["Weight", 1, 0, 2], ["Angle", 1, 0, 2]])
    problems = read(copy, tables={"xlmc_assumptions2": "Copy!A1:D3"}).problems
    assert [problem.where for problem in problems] == ["Copy!A2", "Copy!A3"]
    assert "came with a copied sheet" in problems[0].hint


class TestParameters:
    @pytest.mark.parametrize("cached", [6661.0, 6861.0])
    def test_a_formula_stays_a_cell(self, read, cached):
        result = read({"Inputs!D2": ("=6600+61", cached)})
        assert result.problems == ()
        assert result.assumptions[0].parameters == {"low": Cell("Inputs", 2, 4), "high": 6861.0}

    def test_a_formula_without_cached_value_is_checked_by_the_run(self, read):
        result = read({"Inputs!D2": "=6600+61", "Inputs!I4": "=1-1"})
        assert result.problems == result.notices == ()
        assert result.assumptions[0].parameters["low"] == Cell("Inputs", 2, 4)
        assert result.assumptions[2].cutoffs["lower_cutoff"] == Cell("Inputs", 4, 9)

    @pytest.mark.parametrize(
        ("column", "row", "heading"),
        [
            ("D", 2, "Minimum"),
            ("D", 2, "min"),
            ("E", 2, "Max"),
            ("F", 6, "Most likely"),
            ("F", 6, "MODE"),
            ("H", 4, "Standard deviation"),
            ("H", 4, "SD"),
            ("H", 4, "std_dev"),
            ("N", 5, "LOW-LIKELIEST"),
        ],
    )
    def test_other_headings(self, read, column, row, heading):
        assert read({f"Inputs!{column}1": heading}).assumptions == read().assumptions
        missing = read({f"Inputs!{column}1": heading, f"Inputs!{column}{row}": None})
        assert heading in missing.problems[0].message

    def test_two_columns_of_one_parameter_where_one_is_filled(self, read):
        result = read({"Inputs!P1": "Min", "Inputs!P3": 181, "Inputs!D3": None})
        assert result.problems == ()
        assert result.assumptions[1].parameters["low"] == 181

    @pytest.mark.parametrize("cutoffs", [(6700, None), (None, 6800), (6700, 6800)])
    def test_one_cutoff_is_enough(self, read, cutoffs):
        result = read({"Inputs!I2": cutoffs[0], "Inputs!J2": cutoffs[1]})
        assert result.problems == ()
        assert tuple(map(result.assumptions[0].cutoffs.get, ("lower_cutoff", "upper_cutoff"))) == cutoffs

    @pytest.mark.parametrize("typed", ["Triangular", "triang", " TRIANGLE "])
    def test_the_family_is_spelt_as_the_registry_does(self, read, typed):
        assert read({"Inputs!C6": typed}).assumptions[4].distribution == "Triangular"


NOTICES = [
    ({"Inputs!D2": 6761, "Inputs!E2": 6761}, "Inputs!D2", "Low and High are both 6,761: the assumption does not vary"),
    ({"Inputs!B2": None}, "Inputs!B2", "The assumption cell is blank, so there is no base case"),
    ({"Inputs!B2": 7000}, "Inputs!B2", "The base case (7,000) lies outside the distribution (6,661 to 6,861)"),
    ({"Inputs!J2": 6700}, "Inputs!B2", "The base case (6,761) lies outside the distribution (6,661 to 6,700)"),
    ({"Inputs!P1": "Sources"}, "Inputs!P1", "The column 'Sources' is kept as a note only: did you mean Source?"),
]


@pytest.mark.parametrize(("changes", "where", "message"), NOTICES)
def test_notices(read, changes, where, message):
    result = read(changes)
    assert result.problems == ()
    assert [str(notice) for notice in result.notices] == [f"{where}: {message}"]
    assert len(result.assumptions) == 5


@pytest.mark.parametrize("word", [True, "yes", "TRUE", "Yes "])
def test_frozen(read, word):
    result = read({"Inputs!M3": word})
    assert result.problems == ()
    assert [each.frozen for each in result.assumptions] == [False, True, False, False, True]


def test_cell_anywhere_else(read):
    changes = {"Inputs!P1": "Cell", "Inputs!B3": None, "Inputs!P3": ("=Model!C7", 186.0), "Model!C7": 186}
    result = read(changes)
    assert result.problems == ()
    assert (result.assumptions[1].cell, result.assumptions[1].base) == (Cell("Model", 7, 3), 186)
