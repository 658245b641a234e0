"""Our reader against openpyxl's on workbooks that Excel saved: formulas and cached values."""

from datetime import date, time, timedelta
from pathlib import Path
from typing import NamedTuple
from xml.etree.ElementTree import iterparse

import pytest
from openpyxl.reader.excel import ExcelReader
from openpyxl.utils.datetime import to_excel
from openpyxl.utils.escape import unescape
from openpyxl.worksheet import _reader
from openpyxl.worksheet._reader import ROW_TAG, WorkSheetParser
from openpyxl.worksheet.formula import ArrayFormula, DataTableFormula

from xlmc.errors import ErrorCode, WorkbookError
from xlmc.excel.address import column_letters
from xlmc.excel.workbook.reader import read_workbook

FOLDER = Path(__file__).parents[4] / "shared" / "conformance" / "workbooks"
BOOKS = sorted(FOLDER.glob("*.xls[xm]"))

pytestmark = pytest.mark.skipif(not BOOKS, reason=f"no workbooks saved by Excel in {FOLDER}")

DAMAGED = "apache__clusterfuzz-testcase-minimized-POIXSSFFuzzer-5937385319563264.xlsx"
UNREADABLE_BY_OPENPYXL = {"ClosedXML__formats.xlsx", DAMAGED}


class Shared(NamedTuple):
    """A formula that a cell shares with the first one of its group; what openpyxl would translate to the cell."""

    text: str
    origin: str

    def translate_formula(self, _):
        return self


class ReadCell(NamedTuple):
    """A cell as openpyxl parses it."""

    value: object
    data_type: str


def value_of(cell, epoch):
    """The type and value that openpyxl reads, in our terms."""
    if isinstance(cell.value, date | time | timedelta):  # to a millisecond
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
    if isinstance(cell.value, Shared):
        return Shared(cell.value.text.removeprefix("="), cell.value.origin)
    text = cell.value.text if isinstance(cell.value, ArrayFormula) else cell.value
    return (text or "").removeprefix("=") or None


def written(content, place):
    """Our formula: its text where it stands in the cell itself, else with its origin."""
    formula = content.formula
    if formula is None or (formula.row, formula.column) == place:
        return formula and formula.text
    return Shared(formula.text, f"{column_letters(formula.column)}{formula.row}")


def filled(cells):
    """Place -> cell, for the cells that hold something."""
    return {place: cell for place, cell in cells.items() if cell.value not in (None, "")}


def loaded(path):
    """The epoch; and by the title of each worksheet its cells as they stand, and with what Excel cached for formulas.

    openpyxl parses the cells and nothing else, those of formulas twice. It knows no styles: dates stay numbers.
    """
    reader = ExcelReader(path)
    reader.read_manifest()
    reader.read_strings()
    reader.read_workbook()
    result = {}
    for sheet, rel in reader.parser.find_sheets():
        if rel.target in reader.valid_files and "chartsheet" not in rel.Type:
            with reader.archive.open(rel.target) as file:
                result[sheet.name] = parsed(file, reader.shared_strings, reader.wb.epoch)
    return reader.wb.epoch, result


def parsed(file, strings, epoch):
    """The cells of a sheet as they stand, and with cached values: of each place, what openpyxl makes of it."""
    parser = WorkSheetParser(None, strings, epoch=epoch)
    parse_cell, stand, cached = parser.parse_cell, {}, {}

    def parse_twice(element):
        cell = parse_cell(element)
        place = cell["row"], cell["column"]
        stand[place] = cached[place] = ReadCell(cell["value"], cell["data_type"])
        if cell["data_type"] == "f":
            parser.data_only, parser.col_counter = True, cell["column"] - 1
            again = parse_cell(element)
            cached[place] = ReadCell(again["value"], again["data_type"])
            parser.data_only = False
        return cell

    parser.parse_cell = parse_twice
    for _, element in iterparse(file):
        if element.tag == ROW_TAG:
            parser.parse_row(element)
            element.clear()
    return stand, cached


@pytest.mark.parametrize("path", [path for path in BOOKS if path.name not in UNREADABLE_BY_OPENPYXL] or [None])
def test_formulas_and_values_as_openpyxl_reads_them(path, monkeypatch):
    monkeypatch.setattr(_reader, "Translator", Shared)
    book = read_workbook(path)
    epoch, sheets = loaded(path)
    assert list(book.sheets) == list(sheets)
    for title, (formulas, values) in sheets.items():
        cells = book.sheets[title].cells
        result = {place: text for place, content in cells.items() if (text := written(content, place))}
        theirs = {place: text for place, cell in filled(formulas).items() if (text := formula_of(cell))}
        assert result == theirs
        # An empty text is now blank, now a text to openpyxl.
        result = {place: (type(c.value), c.value) for place, c in cells.items() if c.value not in (None, "")}
        assert result == {place: value_of(cell, epoch) for place, cell in filled(values).items()}


@pytest.mark.parametrize("name", sorted(UNREADABLE_BY_OPENPYXL))
def test_books_that_openpyxl_cannot_read_are_read_or_refused_with_a_reason(name):
    if name == DAMAGED:
        with pytest.raises(WorkbookError, match="Bad CRC-32"):
            read_workbook(FOLDER / name)
    else:
        book = read_workbook(FOLDER / name)
        assert any(book.sheets[sheet].cells for sheet in book.sheets)
