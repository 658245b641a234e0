"""Our reader against openpyxl's on workbooks that Excel saved: every formula, every cached value."""

import warnings
from datetime import date, time, timedelta
from functools import lru_cache
from pathlib import Path

import openpyxl
import pytest
from openpyxl.formula.translate import Translator
from openpyxl.reader import excel
from openpyxl.utils.datetime import to_excel
from openpyxl.utils.escape import unescape
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


def filled(sheet):
    """Place -> cell, for the cells that hold something; openpyxl's own iteration makes those that are not there."""
    return {place: cell for place, cell in sheet._cells.items() if cell.value not in (None, "")}


def loaded(path):
    """Without charts and pictures, which take long to read."""
    with pytest.MonkeyPatch.context() as patch, warnings.catch_warnings():
        patch.setattr(excel, "find_images", lambda package, path: ([], []))
        warnings.simplefilter("ignore")  # of extensions that openpyxl would lose on saving
        return openpyxl.load_workbook(path), openpyxl.load_workbook(path, data_only=True)


PORTIONS = 8
"""Every eighth workbook is a test, so that processes share them."""


@pytest.mark.parametrize("portion", range(PORTIONS))
def test_formulas_and_values_as_openpyxl_reads_them(portion, subtests):
    readable = [path for path in BOOKS if path.name not in UNREADABLE_BY_OPENPYXL]
    for path in readable[portion::PORTIONS]:
        with subtests.test(path.name):
            _compare_with_openpyxl(path)


def _compare_with_openpyxl(path):
    book = read_workbook(path)
    formulas, values = loaded(path)
    assert list(book.sheets) == [sheet.title for sheet in formulas.worksheets]
    for sheet in formulas.worksheets:
        cells = book.sheets[sheet.title].cells
        theirs, cached = filled(sheet), filled(values[sheet.title])
        found = {place: text for place, content in cells.items() if (text := written(content, place))}
        assert found == {place: formula_of(cell) for place, cell in theirs.items() if formula_of(cell)}
        # An empty text is now blank, now a text to openpyxl.
        found = {place: (type(c.value), c.value) for place, c in cells.items() if c.value not in (None, "")}
        assert found == {place: value_of(cell, values.epoch) for place, cell in cached.items()}


@pytest.mark.parametrize("name", sorted(UNREADABLE_BY_OPENPYXL))
def test_books_that_openpyxl_cannot_read_are_read_or_refused_with_a_reason(name):
    if name == DAMAGED:
        with pytest.raises(WorkbookError, match="Bad CRC-32"):
            read_workbook(FOLDER / name)
    else:
        book = read_workbook(FOLDER / name)
        assert any(book.sheets[sheet].cells for sheet in book.sheets)
