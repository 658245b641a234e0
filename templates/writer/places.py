"""Where each quantity stands, fixed before anything is drawn, so that any sheet can point at any other."""

from __future__ import annotations

from xlsxwriter.utility import quote_sheetname, xl_rowcol_to_cell

from templates.description import Template, TestTable

__all__ = [
    "CURVE",
    "HEADER_ROW",
    "MOST_CAPTIONS",
    "RECORD",
    "RECORD_VALUES",
    "TESTS",
    "VALUE_COLUMN",
    "WAITING",
    "Place",
    "data_places",
    "drawing_sheet",
    "name_cells",
    "places",
    "reference",
    "rows_of_tests",
]

Place = tuple[str, int]
"""Sheet and row, the row counted from 0."""

HEADER_ROW = 4
VALUE_COLUMN = 3
WAITING = "Run-out"
"""The sheet of inputs that wait."""
RECORD = "Record"
"""The sheet of a table that is pasted."""
RECORD_VALUES = 17
"""The column of that sheet in which what is read from the table stands."""
CURVE = "Restitution"
"""The sheet of the second drawing."""
TESTS = "Stiffness"
"""The sheet of rows of tests."""
MOST_CAPTIONS = 3
"""Names that have the defined name of their cell beside them, within the columns that are not folded away."""
_GAP = 4
"""Rows between the last assumption and the first fixed input: room for new rows, a heading, a header row."""


def places(template: Template) -> dict[str, Place]:
    """Symbol -> place of every input and equation, and of the readings that formulas read."""
    result: dict[str, Place] = {}
    row = HEADER_ROW + 1
    for group in (template.assumptions, template.constants, template.optional):
        for given in group:
            result[given.symbol] = "Inputs", row
            row += 1
        row += _GAP
    result |= {given.symbol: (WAITING, row) for row, given in enumerate(template.waiting, HEADER_ROW + 1)}
    read = () if template.record is None else template.record.read
    result |= {each.symbol: (RECORD, row) for row, each in enumerate(read, HEADER_ROW + 1)}
    if template.tests is not None:
        first, scatter = rows_of_tests(template.tests)
        result |= {each.symbol: (TESTS, row) for row, each in enumerate(template.tests.read, first)}
        result |= {each.symbol: (TESTS, row) for row, each in enumerate(template.tests.scatter, scatter)}
    row = HEADER_ROW + 1
    for section in template.sections:
        for equation in section.equations:
            row += 1
            result[equation.symbol] = "Model", row
        row += 1
    for row, reading in enumerate(template.evidence, HEADER_ROW + 1):
        if reading.named:
            result[reading.named] = "Evidence", row
    return result


def rows_of_tests(tests: TestTable) -> tuple[int, int]:
    """The first row of what is read from the tests, and of how they scatter, counted from 0."""
    first = HEADER_ROW + 1 + tests.rows + _GAP
    return first, first + len(tests.read) + _GAP


def data_places(template: Template) -> list[int]:
    """The first row of numbers of each table of data, on sheet Inputs below all inputs."""
    filled = [group for group in (template.assumptions, template.constants, template.optional) if group]
    top = HEADER_ROW + 1 + sum(map(len, filled)) + _GAP * len(filled)
    tops = []
    for table in template.data:
        tops.append(top)
        top += len(table.rows) + _GAP
    return tops


def drawing_sheet(template: Template) -> str:
    """The name of the sheet of its diagram."""
    return "Drawing" if template.group else "Scene"


def name_cells(template: Template) -> list[tuple[int, int]]:
    """Row and column, on sheet Inputs, of the cell with the name of each vehicle; many names stand close together."""
    first, step = (VALUE_COLUMN, 2) if len(template.vehicles) <= MOST_CAPTIONS else (VALUE_COLUMN - 1, 1)
    return [(HEADER_ROW - 1, first + step * index) for index, _ in enumerate(template.vehicles)]


def reference(place: Place, *, absolute: bool = False) -> str:
    """`Model!D12`, or `Model!$D$12`."""
    sheet, row = place
    column = RECORD_VALUES if sheet == RECORD else VALUE_COLUMN
    return f"{quote_sheetname(sheet)}!{xl_rowcol_to_cell(row, column, row_abs=absolute, col_abs=absolute)}"
