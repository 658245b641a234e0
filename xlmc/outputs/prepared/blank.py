"""The workbook of `xlmc new blank`: a small worked model, the tables with a row each, and a guide."""

from __future__ import annotations

from typing import Any, Final

from xlmc.excel.address import Cell
from xlmc.excel.workbook.reader import read_workbook
from xlmc.excel.workbook.writer import package_bytes
from xlmc.outputs.prepared.prepare import with_tables
from xlmc.outputs.prepared.tables_sheet import NewRow
from xlmc.outputs.sheets.exact_book import ExactBook
from xlmc.outputs.sheets.styles import CREATED

__all__ = ["blank_book"]

_MODEL: Final = "Model"
_SOURCE: Final = "Example: write what your numbers rest on"

_LENGTH, _WIDTH, _PRICE = 12.0, 8.0, 25.0

_GUIDE: Final = """\
# Your own model
1. Write your model on the sheet Model, or on sheets of your own: numbers in cells, and formulas.
2. On the sheet xlmc, give each uncertain number a row under Assumptions. Its Cell is a formula that points to it, such
    as =Model!C4. Choose a Distribution from the list, and type its numbers; say in Source where they come from.
3. Give each answer a row under Forecasts. Its Cell points to the formula.
4. Filters reject trials that are impossible. Correlations join assumptions that vary together. Decisions are cells
    that you choose: xlmc optimise finds their best values. Solve finds in every trial the number that gives a result.
    Settings are of the run. Delete the rows that you do not need.
5. Save the workbook, close it, and type:
        xlmc check BOOK.xlsx        shows what xlmc understood, and every mistake with its cell
        xlmc simulate BOOK.xlsx     runs it, and writes BOOK-results.xlsx
        xlmc open BOOK.xlsx         shows the answers in the browser while you move ranges

# What the distributions are for
Uniform: Low and High, and nothing more is known.  Triangular, BetaPERT: Low, Likeliest, High.
Normal: Mean and Std dev of a measurement.  Lognormal: Mean and Std dev of what is never negative.
Weibull, Gamma: times and strengths.  Yes-No: a probability.  Custom: a range of measured values, under Data.
xlmc prepare adds rows for new numbers and formulas of the model.
"""


def blank_book() -> bytes:
    """Return the file: a rectangle whose sides are uncertain, and what its area costs."""
    book = read_workbook(package_bytes(_model()), "blank.xlsx")
    length, width, price = (Cell(_MODEL, row, 3) for row in (4, 5, 6))
    area, cost = Cell(_MODEL, 8, 3), Cell(_MODEL, 9, 3)
    rows = {
        "xlmc_assumptions": [
            _assumption("Length", length, _LENGTH, "m", Distribution="Normal", Mean=_LENGTH, **{"Std dev": 0.5}),
            _assumption("Width", width, _WIDTH, "m", Distribution="Uniform", Low=7.0, High=9.0),
            _assumption("Price", price, _PRICE, "$/m²", Distribution="BetaPERT", Low=20.0, Likeliest=25.0, High=40.0),
        ],
        "xlmc_forecasts": [
            NewRow({"Name": "Area", "Units": "m²"}, area, _LENGTH * _WIDTH),
            NewRow({"Name": "Cost", "Units": "$", "Threshold": 3000.0}, cost, _LENGTH * _WIDTH * _PRICE),
        ],
        "xlmc_filters": [
            NewRow({"Name": "Area", "At least": 85.0, "At most": 110.0, "Because": _SOURCE}, area, _LENGTH * _WIDTH)
        ],
        "xlmc_correlations": [NewRow({"First": "Length", "Second": "Width", "Correlation": 0.3})],
        "xlmc_settings": [NewRow({"Setting": "Trials", "Value": 100_000.0})],
    }
    return with_tables(book, rows, "What is uncertain, and what is asked")


def _assumption(name: str, cell: Cell, value: float, units: str, **numbers: float | str) -> NewRow:
    return NewRow({"Name": name, "Units": units, "Source": _SOURCE, **numbers}, cell, value)


def _model() -> dict[str, bytes]:
    with ExactBook() as book:
        book.set_properties({"created": CREATED, "title": "A model of your own"})
        styles = {
            "title": book.add_format({"bold": True, "font_size": 14, "font_color": "#1F3044"}),
            "input": book.add_format({"bg_color": "#E6F4E6", "border": 1, "border_color": "#9FB8A3"}),
            "plain": book.add_format({}),
        }
        _write_model(book.add_worksheet(_MODEL), styles)
        guide: Any = book.add_worksheet("Guide")
        guide.set_column(0, 0, 120)
        guide.hide_gridlines(2)
        for row, line in enumerate(_GUIDE.splitlines()):
            guide.write_string(row, 0, line.removeprefix("# "), styles["title" if line.startswith("#") else "plain"])
    parts: dict[str, bytes] = book.parts
    return parts


def _write_model(sheet: Any, styles: dict[str, Any]) -> None:
    sheet.set_column(0, 0, 3)
    sheet.set_column(1, 1, 24)
    sheet.write_string(1, 1, "A worked example: replace it by your own model", styles["title"])
    inputs = (("Length", _LENGTH, "m"), ("Width", _WIDTH, "m"), ("Price", _PRICE, "$/m²"))
    for row, (name, value, unit) in enumerate(inputs, 3):
        sheet.write_string(row, 1, name)
        sheet.write_number(row, 2, value, styles["input"])
        sheet.write_string(row, 3, unit)
    answers = (("Area", "=C4*C5", _LENGTH * _WIDTH, "m²"), ("Cost", "=C8*C6", _LENGTH * _WIDTH * _PRICE, "$"))
    for row, (name, formula, value, unit) in enumerate(answers, 7):
        sheet.write_string(row, 1, name)
        sheet.write_formula(row, 2, formula, styles["plain"], value)
        sheet.write_string(row, 3, unit)
