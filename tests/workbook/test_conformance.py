"""Our reader against openpyxl's on workbooks that Excel saved: every formula, every cached value."""

import warnings
from collections import defaultdict
from datetime import date, time, timedelta
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

import openpyxl
import pytest
from cases import cases
from openpyxl.formula.translate import Translator
from openpyxl.reader import excel
from openpyxl.utils.datetime import to_excel
from openpyxl.utils.escape import unescape
from openpyxl.worksheet._reader import WorkSheetParser, WorksheetReader
from openpyxl.worksheet.formula import ArrayFormula, DataTableFormula

from xlmc.address import column_letters
from xlmc.errors import ErrorCode, WorkbookError
from xlmc.workbook.reader import read_workbook

FOLDER = Path(__file__).parents[3] / "shared" / "conformance" / "workbooks"
BOOKS = sorted(FOLDER.glob("*.xls[xm]"))

pytestmark = pytest.mark.skipif(not BOOKS, reason=f"no workbooks saved by Excel in {FOLDER}")

DAMAGED = "apache__clusterfuzz-testcase-minimized-POIXSSFFuzzer-5937385319563264.xlsx"
UNREADABLE_BY_OPENPYXL = {"ClosedXML__formats.xlsx", DAMAGED}


def value_of(cell, epoch):
    """The type and value that openpyxl reads, in our terms."""
    if isinstance(cell.value, date | time | timedelta):  # what it makes of numbers formatted so, to a millisecond
        return float, pytest.approx(to_excel(cell.value, epoch), abs=2e-8)
    if cell.data_type == "e":
        return ErrorCode, ErrorCode.from_text(cell.value)
    if isinstance(cell.value, str):
        return str, unescape(cell.value)
    return (bool, cell.value) if isinstance(cell.value, bool) else (float, float(cell.value))


def formula_of(cell):
    """A cell's formula as openpyxl reads it, or None."""
    if isinstance(cell.value, DataTableFormula) or cell.data_type != "f":
        return None
    text = cell.value.text if isinstance(cell.value, ArrayFormula) else cell.value
    return (text or "").removeprefix("=") or None


def written(content, place):
    """Our formula as the cell itself would write it, translated from its master's place by openpyxl."""
    formula = content.formula
    if formula is None or (formula.row, formula.column) == place:
        return formula and formula.text
    row, column = place
    translator = _translator(formula.text, formula.row, formula.column)
    return translator.translate_formula(f"{column_letters(column)}{row}").removeprefix("=")


@lru_cache(maxsize=1_000)  # most cells of a shared formula follow each other
def _translator(text, row, column):
    return Translator(f"={text}", origin=f"{column_letters(column)}{row}")


def filled(cells):
    """Place -> cell, for the cells that hold something."""
    return {place: cell for place, cell in cells.items() if cell.value not in (None, "")}


class ReadCell(NamedTuple):
    """A cell as openpyxl parses it."""

    value: object
    data_type: str


def cached_cells(sheet, parsed):
    """Place -> cell with the value that openpyxl would read with `data_only`."""
    return sheet._cells | {(cell["row"], cell["column"]): ReadCell(cell["value"], cell["data_type"]) for cell in parsed}


def loaded(path):
    """The workbook with formulas, and what Excel cached for these by sheet, both in one reading.

    It is without charts and pictures, which take long to read.
    """
    cached = defaultdict(list)
    parse_cell, bind_cells = WorkSheetParser.parse_cell, WorksheetReader.bind_cells

    def parse_twice(parser, element):
        cell = parse_cell(parser, element)
        if cell["data_type"] == "f":
            parser.data_only, parser.col_counter = True, cell["column"] - 1
            cached[id(parser)].append(parse_cell(parser, element))
            parser.data_only = False
        return cell

    def bind(reader):
        bind_cells(reader)
        cached[reader.ws.title] = cached.pop(id(reader.parser), [])

    with pytest.MonkeyPatch.context() as patch, warnings.catch_warnings():
        patch.setattr(excel, "find_images", lambda package, path: ([], []))
        patch.setattr(WorkSheetParser, "parse_cell", parse_twice)
        patch.setattr(WorksheetReader, "bind_cells", bind)
        warnings.simplefilter("ignore")  # of extensions that openpyxl would lose on saving
        return openpyxl.load_workbook(path), cached


@cases("path", [path for path in BOOKS if path.name not in UNREADABLE_BY_OPENPYXL] or [None])
def test_formulas_and_values_as_openpyxl_reads_them(path):
    book = read_workbook(path)
    formulas, values = loaded(path)
    assert list(book.sheets) == [sheet.title for sheet in formulas.worksheets]
    for sheet in formulas.worksheets:
        cells = book.sheets[sheet.title].cells
        theirs, cached = filled(sheet._cells), filled(cached_cells(sheet, values[sheet.title]))
        found = {place: text for place, content in cells.items() if (text := written(content, place))}
        assert found == {place: formula_of(cell) for place, cell in theirs.items() if formula_of(cell)}
        # An empty text is now blank, now a text to openpyxl.
        found = {place: (type(c.value), c.value) for place, c in cells.items() if c.value not in (None, "")}
        assert found == {place: value_of(cell, formulas.epoch) for place, cell in cached.items()}


@pytest.mark.parametrize("name", sorted(UNREADABLE_BY_OPENPYXL))
def test_books_that_openpyxl_cannot_read_are_read_or_refused_with_a_reason(name):
    if name == DAMAGED:
        with pytest.raises(WorkbookError, match="Bad CRC-32"):
            read_workbook(FOLDER / name)
    else:
        book = read_workbook(FOLDER / name)
        assert any(book.sheets[sheet].cells for sheet in book.sheets)
