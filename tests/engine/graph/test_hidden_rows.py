"""SUBTOTAL and AGGREGATE of rows that a filter hides, and of rows hidden by hand.

Microsoft's page of SUBTOTAL: 1 to 11 include rows hidden by hand, 101 to 111 leave them out; all leave out rows that
a filter leaves out. The file marks both alike: while any filter of the sheet has a condition, Excel takes every hidden
row of that sheet for filtered, also outside the range of the filter.
"""

from __future__ import annotations

import pytest
import xlsxwriter

from xlmc.analysis.studies.verify import verify
from xlmc.errors import FormulaError
from xlmc.excel.address import Area
from xlmc.excel.workbook.reader import read_workbook
from xlmc.montecarlo.model.model import CompiledModel

FORMULAS = {
    "SUBTOTAL(9,A2:A5)": (15.0, 11.0, 11.0, 11.0),
    "SUBTOTAL(109,A2:A5)": (11.0, 11.0, 11.0, 11.0),
    "SUBTOTAL(1,A2:A5)": (3.75, 11 / 3, 11 / 3, 11 / 3),
    "SUBTOTAL(3,A2:A5)": (4.0, 3.0, 3.0, 3.0),
    "SUBTOTAL(9,A2:A8)": (255.0, 183.0, 183.0, 183.0),
    "SUBTOTAL(109,A2:A8)": (183.0, 183.0, 183.0, 183.0),
    "AGGREGATE(9,5,A2:A5)": (11.0, 11.0, 11.0, 11.0),
    "AGGREGATE(9,4,A2:A5)": (15.0, 15.0, 15.0, 15.0),
    "SUBTOTAL(9,A2:A3,A4:A8)": (255.0, 183.0, 183.0, 183.0),
    "SUBTOTAL(109,A2:A3,A4:A8)": (183.0, 183.0, 183.0, 183.0),
    "AGGREGATE(9,5,A2:A3,A4:A5)": (11.0, 11.0, 11.0, 11.0),
    "AGGREGATE(9,4,A2:A3,A4:A5)": (15.0, 15.0, 15.0, 15.0),
    "AGGREGATE(14,5,A2:A8,A4)": (2.0, 2.0, 2.0, 2.0),
    "SUM(A2:A5)": (15.0, 15.0, 15.0, 15.0),
}
"""With rows 4 and 8 hidden: by hand; by a filter over rows 2 to 5, beside which all hidden rows count as filtered."""


def _written(path, filtered):
    book = xlsxwriter.Workbook(path)
    sheet = book.add_worksheet("S")
    sheet.write_column("A1", ["n", 1, 2, 4, 8, 16, 156, 68])
    sheet.write_column("B1", ["kind", "a", "a", "b", "a", "a", "a", "b"])
    for row in (3, 7):
        sheet.set_row(row, None, None, {"hidden": True})
    if filtered == "sheet":
        sheet.autofilter("A1:B5")
        sheet.filter_column("B", "x == a")
    elif filtered == "by value":
        sheet.autofilter("A1:B5")
        sheet.filter_column_list("B", ["a"])
    elif filtered == "without a condition":
        sheet.autofilter("A1:B5")
    for row, formula in enumerate(FORMULAS):
        sheet.write_formula(20 + row, 5, f"={formula}")
    book.close()
    return read_workbook(path)


@pytest.mark.parametrize(
    ("filtered", "which"), [("by hand", 0), ("without a condition", 0), ("sheet", 1), ("by value", 1)]
)
def test_totals_leave_out_what_a_filter_hides(tmp_path, filtered, which):
    book = _written(tmp_path / "book.xlsx", filtered)
    result = {check.cell.row - 21: check.got for check in verify(book).cells}
    assert [result[row] for row in range(len(FORMULAS))] == [pytest.approx(each[which]) for each in FORMULAS.values()]


def test_the_filter_of_a_table_counts(workbook, table):
    from dataclasses import replace

    cells = {"A1": "n", "A2": 1.0, "A3": 2.0, "A4": 4.0, "Z9": "=SUBTOTAL(9,A2:A4)"}
    hidden = workbook(cells, tables=[table("T", "A1:A4", "n", filtered=Area("S", 1, 1, 4, 1))])
    for tables, expected in ((hidden.tables, 5.0), ((replace(hidden.tables[0], filtered=None),), 7.0)):
        sheet = replace(hidden.sheets["S"], hidden_rows=frozenset({3}))
        (check,) = verify(replace(hidden, sheets={"S": sheet}, tables=tables)).cells
        assert check.got == expected


def test_a_table_part_tells_of_its_filter():
    from xlmc.excel.workbook.structure import read_table

    part = (
        '<table xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main" name="T" displayName="T" ref="A1:B9">'
        '<autoFilter ref="A1:B9">{}</autoFilter>'
        '<tableColumns><tableColumn name="a"/><tableColumn name="b"/></tableColumns></table>'
    )
    condition = '<filterColumn colId="1"><filters><filter val="x"/></filters></filterColumn>'
    button = '<filterColumn colId="1" hiddenButton="1"/>'
    assert read_table(part.format(condition).encode(), "t.xml", "S").filtered == Area("S", 1, 1, 9, 2)
    assert read_table(part.format(button).encode(), "t.xml", "S").filtered is None


def test_a_total_that_varies_over_hidden_rows_is_refused(tmp_path, book):
    from dataclasses import replace

    model = book(
        {"A1": 9.0, "B1": 1.0, "B2": 2.0, "C1": "=SUBTOTAL(A1,B1:B2)"}, {"a": {"cell": "A1", "low": 9, "high": 9}},
        {"total": "C1"},
    )  # fmt: skip
    assert model.function({"a": [9.0]})["total"].tolist() == [3.0]
    sheet = replace(model.workbook.sheets["S"], hidden_rows=frozenset({2}))
    with pytest.raises(FormulaError, match="hidden"):
        CompiledModel(replace(model.workbook, sheets={"S": sheet}), model.definitions, tmp_path / "book.xlsx")
