from __future__ import annotations

import pytest

from xlmc.excel.address import Cell
from xlmc.excel.workbook.workbook import CellContent, Formula

POINTED = Cell("Model", 1, 2)
AT = "Answers!B2"  # the Cell of the forecast
LOOSE = {"Model 2!D4": ("=1+1", 2.0), "Answers!J5": ("=1+1", 2.0), "it's!B1": ("=1", 1.0)}
NAMES = (
    ("Speed_here", "Answers!$J$5", "Answers"),
    ("Speed_now", "Model!$B$1", None),
    ("Wide", "Model!$B$1:$B$2", None),
    ("Tiny", "Model!$B$1:$B$1", None),
    ("Lost", "Model!#REF!", None),
    ("Moving", "Model!B1", None),
    ("Shifty", "OFFSET(Model!$B$1,1,0)", None),
    ("Nowhere", "Gone!$B$1", None),
    ("Both", "Model!$B$1", None),
    ("Both", "Answers!$J$5", "Answers"),
    ("Same", "Model!$B$1", None),
    ("Same", "=Model!$B$1", "Answers"),
    ("Far", "Model!$B$1", "Model"),
)


@pytest.mark.parametrize(
    ("written", "cell"),
    [
        ("=Model!B1", POINTED),
        ("=Model!$B$1", POINTED),
        ("=model!b1", POINTED),
        ("=+Model!B1", POINTED),
        ("='Model'!B1", POINTED),
        ("='Model 2'!D4", Cell("Model 2", 4, 4)),
        ("='it''s'!B1", Cell("it's", 1, 2)),
        ("=$J$5", Cell("Answers", 5, 10)),
        ("=J5", Cell("Answers", 5, 10)),
        ("=Speed_now", POINTED),
        ("=SPEED_NOW", POINTED),
        ("=Speed_here", Cell("Answers", 5, 10)),
        ("=Answers!Speed_here", Cell("Answers", 5, 10)),
        ("=Model!Far", POINTED),
        ("=Both", Cell("Answers", 5, 10)),  # as Excel reads it: the sheet's own first
        ("=Model!Both", POINTED),
        ("=Tiny", POINTED),
        ("=Model!B1:B1", POINTED),
    ],
)
def test_a_formula_that_is_one_reference(read, written, cell):
    result = read({**LOOSE, AT: (written, 2.0)}, names=NAMES)
    assert [str(problem) for problem in result.problems] == []
    assert result.forecasts[0].cell == cell
    assert result.notices == ()


@pytest.mark.parametrize(
    ("written", "cell"),
    [
        ("Model!B1", POINTED),
        ("'Model 2'!D4", Cell("Model 2", 4, 4)),
        ("Model 2!D4", Cell("Model 2", 4, 4)),
        ("Speed_now", POINTED),
        ("speed_here", Cell("Answers", 5, 10)),
        ("Same", POINTED),
        ("Model!Far", POINTED),
    ],
)
def test_a_text_that_is_one_reference_goes_stale(read, written, cell):
    result = read({**LOOSE, AT: written}, names=NAMES)
    assert [str(problem) for problem in result.problems] == []
    assert result.forecasts[0].cell == cell
    (notice,) = result.notices
    assert notice.message == (
        f"Cell is the text {written!r}, which goes stale when rows move or names change; the formula ={cell} follows"
    )
    assert str(notice.where) == AT


@pytest.mark.parametrize(
    ("written", "message", "hint"),
    [
        ("d2", "'d2' names no sheet, and may be a cell or a name", "Write the formula =D2"),
        ("$B$7", "'$B$7' names no sheet", "Inputs!$B$7"),
        ("B1:B2", "'B1:B2' names no sheet", "name the sheet"),
        ("Modle!B1", "There is no worksheet 'Modle'", "Did you mean Model?"),
        ("=Modle!B1", "There is no worksheet 'Modle'", "Did you mean Model?"),
        ("='No such'!B1", "There is no worksheet 'No such'", "Use one of"),
        ("=Nowhere", "There is no worksheet 'Gone'", "Use one of"),
        ("=Model!B1:B2", "Model!B1:B2 is more than one cell", "Write one cell"),
        ("=Wide", "Model!B1:B2 is more than one cell", "Write one cell"),
        ("Wide", "Model!B1:B2 is more than one cell", "Write one cell"),
        ("=Model!B1*2", "'Model!B1*2' is not one reference", "Write one cell"),
        ("=SUM(Model!B1)", "'SUM(Model!B1)' is not one reference", "Write one cell"),
        ("=Model!B1+Model!B2", "is not one reference", "Write one cell"),
        ("=Model:Answers!B1", "is not one reference", "Write one cell"),
        ("=Table1[Low]", "'Table1[Low]' is not one reference", "Write one cell"),
        ("=[1]Model!B1", "lies in another workbook", "must be in this workbook"),
        ("='[other.xlsx]Model'!B1", "lies in another workbook", "must be in this workbook"),
        ("=7", "'7' is not one reference", "Write one cell"),
        ("=#REF!", "is not one reference", "Write one cell"),
        ("=Speed_nwo", "'Speed_nwo' is neither a cell nor a defined name", "Did you mean Speed_now?"),
        ("the speed", "'the speed' is not one reference", "Write one cell"),
        ("Quux", "'Quux' is neither a cell nor a defined name", "Write one cell"),
        ("=Far", "'Far' is a name of the sheet Model only", "=Model!Far"),
        ("Far", "'Far' is a name of the sheet Model only", "=Model!Far"),
        ("Both", "'Both' is a name of the workbook and another one of this sheet", "Fill in Cell"),
        ("=Lost", "The name Lost has lost its cell (Model!#REF!)", "Name Manager"),
        ("=Moving", "The name Moving stands for Model!B1, which moves", "Write it with $"),
        ("=Shifty", "The name Shifty stands for OFFSET(Model!$B$1,1,0), not for one cell", "Write one cell"),
        (7, "Cell holds 7, which is not a reference", "=Inputs!B7"),
        (True, "Cell holds TRUE, which is not a reference", "=Inputs!B7"),
    ],
)
def test_what_cell_must_not_hold(only_problem, written, message, hint):
    value = (written, 2.0) if isinstance(written, str) and written.startswith("=") else written
    only_problem(AT, message, hint, {**LOOSE, AT: value}, names=NAMES)


def test_a_formula_without_a_cached_value_is_enough(read):
    assert read({AT: "=Model!B1"}).forecasts[0].cell == POINTED


def test_both_value_and_cell(only_problem):
    changes = {"Answers!C1": "Value", "Answers!C2": ("=Model!B1", 41.5)}
    only_problem(AT, "Both Value and Cell are filled in", "Clear one of them", changes)


class TestNeitherValueNorCell:
    def test_the_defined_name_equal_to_name(self, read):
        result = read({AT: None, "Answers!A2": "speed_now"}, names=NAMES)
        assert result.problems == ()
        assert result.forecasts[0].cell == POINTED
        assert result.notices == ()

    def test_the_name_may_be_the_sheets_own(self, read):
        result = read({**LOOSE, AT: None, "Answers!A2": "Speed_here"}, names=NAMES)
        assert result.forecasts[0].cell == Cell("Answers", 5, 10)

    @pytest.mark.parametrize(
        ("name", "message", "hint"),
        [
            ("Speed", "Nothing says which cell 'Speed' is: there is no defined name 'Speed'", "Fill in Cell"),
            ("Both", "'Both' is a name of the workbook and another one of this sheet", "Fill in Cell"),
            ("Far", "'Far' is a name of the sheet Model only", "=Model!Far"),
            ("Wide", "Model!B1:B2 is more than one cell", "Write one cell"),
        ],
    )
    def test_mistakes(self, only_problem, name, message, hint):
        only_problem("Answers!A2", message, hint, {AT: None, "Answers!A2": name}, names=NAMES)

    def test_with_both_columns_blank_and_no_name(self, only_problem):
        changes = {AT: None, "Answers!C1": "Value", "Answers!C2": None}
        only_problem("Answers!A2", "Nothing says which cell 'Speed' is", "Fill in Value or Cell", changes)

    def test_a_blank_value_column_is_an_input_to_fill_in(self, read):
        result = read({"Inputs!B2": None})
        assert result.assumptions[0].cell == Cell("Inputs", 2, 2)
        assert result.assumptions[0].base is None


class TestMergedCells:
    def test_the_first_cell_is_the_cell(self, read):
        assert read(merged=["Model!B1:C2"], changes={"Answers!B11": ("=Model!D9", 0.4)}).forecasts[0].cell == POINTED

    @pytest.mark.parametrize("written", ["=Model!C1", "=Model!B2", "=Model!C2"])
    def test_the_others_are_not(self, only_problem, written):
        changes = {AT: (written, 0.0), "Answers!B11": ("=Model!B3", 0.4), "Answers!B12": ("=Model!B4", True)}
        changes["Model!B4"] = ("=TRUE()", True)
        only_problem(
            AT, "lies inside the merged cells Model!B1:C2", "Point to Model!B1", changes, merged=["Model!B1:C2"]
        )


def test_a_filled_down_column_of_references(read):
    child = Formula("Model!B2", row=11, column=2)
    result = read({"Answers!B12": (child, True)})
    assert result.problems == ()
    assert [each.cell.row for each in result.filters] == [2, 3]


def test_a_formula_typed_into_a_text_cell_is_text(read):
    result = read({AT: CellContent("=Model!B1")})
    assert result.forecasts[0].cell == POINTED
    assert "goes stale" in result.notices[0].message


def test_what_is_so_of_a_whole_column_is_said_once(read):
    result = read({AT: "Model!B1", "Answers!B11": "Model!B2", "Answers!B12": "Model!B3"})
    forecast, filters = map(str, result.notices)
    assert forecast.endswith("the formula =Model!B1 follows")
    assert filters.startswith("Answers!B11: Cell is the text 'Model!B2', which goes stale")
    assert filters.endswith("the formula =Model!B2 follows (so in 1 more cell of this column)")
