"""The sheet that a conversion adds, as openpyxl reads it."""

from __future__ import annotations

import io

import openpyxl
import pytest

from xlmc.errors import ErrorCode
from xlmc.excel.address import Cell, InFormula
from xlmc.excel.formula import ir
from xlmc.excel.workbook.writer import package_bytes
from xlmc.montecarlo.definitions.new_tables import Block, Formula, NewRow, NewTable
from xlmc.outputs.conversion.converted_sheet import Left, _saved, built_sheet


def row(name="a", call=None, **cells):
    return NewRow({"Name": name, **cells}, "assumption", name, Cell("S", 3, 2), "Crystal Ball's dialog", call)


def opened(tables, left=(), formats=None, name="xlmc"):
    data = package_bytes(built_sheet(tables, left, name, formats))
    formulas, values = (openpyxl.load_workbook(io.BytesIO(data), data_only=only) for only in (False, True))
    assert formulas.sheetnames == [name]
    return formulas[name], values[name]


TWO = [
    NewTable("xlmc_assumptions", (row("a", Low=1.5, Frozen=True), row("b", Low="text")), ("Name", "Low", "Frozen")),
    NewTable("xlmc_forecasts", (row("c", Units="ft"),), ("Name", "Units")),
]


def test_tables_stand_below_each_other_with_room_for_a_row():
    sheet, _ = opened(TWO)
    assert dict(sheet.tables.items()) == {
        "xlmc_assumptions": "A6:C8",
        "xlmc_forecasts": "A12:B13",
        "xlmc_converted": "A17:F20",
    }
    titles = {address: sheet[address].value for address in ("A1", "A5", "A11", "A16")}
    assert titles == {
        "A1": "Definitions for xlmc",
        "A5": "Assumptions",
        "A11": "Forecasts",
        "A16": "What was converted, and from where",
    }
    assert sheet["A2"].value.startswith("What Crystal Ball's dialogs")
    assert sheet["A3"].value.startswith("A row with Call in")
    assert [[cell.value for cell in line] for line in sheet["A6:C8"]] == [
        ["Name", "Low", "Frozen"],
        ["a", 1.5, True],
        ["b", "text", None],
    ]
    assert not sheet.sheet_view.showGridLines
    assert sheet.page_setup.orientation == "landscape"


def test_what_was_converted_is_listed_with_where_it_stands():
    sheet, _ = opened(TWO)
    assert [[cell.value for cell in line[:5]] for line in sheet["A17:F20"]] == [
        ["What", "Definition", "Stood in", "Was", "Stands in"],
        ["assumption", "a", "S!B3", "Crystal Ball's dialog", "xlmc_assumptions, row 7"],
        ["assumption", "b", "S!B3", "Crystal Ball's dialog", "xlmc_assumptions, row 8"],
        ["assumption", "c", "S!B3", "Crystal Ball's dialog", "xlmc_forecasts, row 13"],
    ]
    assert sheet["A18"].font.color is None or sheet["A18"].font.color.rgb != "FFC00000"


def test_what_could_not_be_converted_is_red_and_names_its_cell():
    left = Left("assumption", "x", "S!B9", "a dialog", "its name is taken", Cell("S", 9, 2))
    plain = Left("forecast", "y", "S!B10", "a dialog", "its name is taken")
    sheet, _values = opened(TWO[1:], [left, plain])
    top = sheet.tables["xlmc_converted"].ref
    assert top == "A11:F14"
    assert [cell.value for cell in sheet[13]] == ["assumption", "x", "S!B9", "a dialog", "its name is taken", "=S!B9"]
    assert sheet["F14"].value is None
    for address in ("A13", "E13", "A14"):
        assert sheet[address].font.color.rgb == "FFC00000"
        assert sheet[address].font.bold
    assert sheet["A12"].font.color is None or sheet["A12"].font.color.rgb != "FFC00000"


@pytest.mark.parametrize(
    ("why", "height"),
    [("short", None), ("x" * 32, None), ("x" * 30 + " yy", 30), (" ".join(["word"] * 20), 60)],
)
def test_a_line_is_as_high_as_its_longest_text(why, height):
    """The fifth column has room for 32 letters."""
    sheet, _ = opened([], [Left("assumption", "x", "S!B9", "a dialog", why)])
    assert sheet.row_dimensions[7].height == height


def test_nothing_to_list_is_an_empty_row():
    sheet, _ = opened([])
    assert sheet.tables["xlmc_converted"].ref == "A6:F7"


def test_formulas_have_the_values_of_the_workbook():
    tree = ir.Binary("+", Cell("S", 1, 1), ir.Number(2.0))
    rows = tuple(row(f"f{n}", Low=Formula(tree, value)) for n, value in enumerate([4.5, "text", ErrorCode.DIV0]))
    sheet, values = opened([NewTable("xlmc_assumptions", rows, ("Name", "Low"))])
    assert [sheet[f"B{n}"].value for n in (7, 8, 9)] == ["=(S!A1+2.0)"] * 3
    assert [values[f"B{n}"].value for n in (7, 8, 9)] == [4.5, "text", "#DIV/0!"]


@pytest.mark.parametrize(("value", "saved"), [(None, ""), (0.0, 0.0), (ErrorCode.DIV0, "#DIV/0!"), ("x", "x")])
def test_a_value_as_it_is_saved(value, saved):
    assert _saved(value) == saved


def test_a_call_is_the_cell_under_value_of_its_row():
    call = InFormula.of(Cell("S", 4, 2), "1")
    rows = (row("drawn", call, Value=4.5), row("after", Value=2.0, Low=Formula(call, 4.5)))
    sheet, _ = opened([NewTable("xlmc_assumptions", rows, ("Name", "Value", "Low"))], formats={call: "0.0%"})
    assert sheet["C8"].value == "=$B$7"
    assert sheet["B7"].number_format == "0.0%"
    assert sheet["B7"].fill.fgColor.rgb == "FFDDEEDD"
    assert sheet["B8"].number_format == "General"
    assert sheet["B8"].fill.fill_type is None


def test_numbers_of_a_distribution_stand_below_all_tables():
    blocks = Block(((1.0, 2.0, 3.0), (0.5, None, 0.25))), Block(((7.0,), (8.0,)))
    rows = tuple(row(f"b{n}", Values=block) for n, block in enumerate(blocks))
    data = package_bytes(built_sheet([NewTable("xlmc_assumptions", rows, ("Name", "Values"))], (), "xlmc 2"))
    book = openpyxl.load_workbook(io.BytesIO(data))
    sheet = book["xlmc 2"]
    assert [sheet["B7"].value, sheet["B8"].value] == ["data_1", "data_2"]
    # the list has its headings in row 12 and two rows; its end and a gap of three are above row 18
    assert {name: each.attr_text for name, each in sheet.defined_names.items()} == {
        "data_1": "'xlmc 2'!$A$18:$C$19",
        "data_2": "'xlmc 2'!$A$21:$A$22",
    }
    assert [[cell.value for cell in line] for line in sheet["A18:C19"]] == [[1, 2, 3], [0.5, None, 0.25]]
    assert [sheet["A21"].value, sheet["A22"].value] == [7, 8]


def test_two_tables_of_a_kind_have_two_names():
    tables = [NewTable("xlmc_assumptions", (row(),), ("Name",)), NewTable("xlmc_assumptions", (row("b"),), ("Name",))]
    sheet, _ = opened(tables)
    assert [*sheet.tables] == ["xlmc_assumptions", "xlmc_assumptions_1", "xlmc_converted"]
