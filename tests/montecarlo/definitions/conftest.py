"""Workbooks without files: a dict of cells, and tables laid over them.

A cell is written as Excel users see it: a number, a text, TRUE; `"=B7"` is a formula that was never calculated and
`("=B7", 3.0)` one with its cached value. `None` takes a cell away.
"""

from __future__ import annotations

import pytest

from xlmc.engine.engines import ENGINES
from xlmc.excel.address import Cell, parse_address
from xlmc.excel.workbook.workbook import CellContent, DefinedName, Formula, Sheet, Table, Workbook
from xlmc.montecarlo.definitions.definitions_reader import read_definitions


def content(value, cell):
    if isinstance(value, CellContent):
        return value
    cached = None
    if isinstance(value, tuple):
        value, cached = value
    if isinstance(value, Formula):
        return CellContent(cached, value)
    if isinstance(value, str) and value.startswith("="):
        return CellContent(cached, Formula(value[1:], cell.row, cell.column))
    return CellContent(float(value) if type(value) is int else value)


def table(workbook_cells, name, address, totals_rows=0):
    area = parse_address(address)
    headings = (workbook_cells.get(Cell(area.sheet, area.top, column)) for column in range(area.left, area.right + 1))
    titles = (None if heading is None else heading.value for heading in headings)
    columns = tuple(f"Column{i}" if title is None else str(title) for i, title in enumerate(titles))
    return Table(name, area, columns, totals_rows=totals_rows)


def build(cells, tables=(), names=(), merged=(), sheets=()):
    """A workbook. `cells` address -> value; `tables` (name, address, totals rows); `names` (name, text, sheet)."""
    filled = {parse_address(address): value for address, value in cells.items() if value is not None}
    filled = {cell: content(value, cell) for cell, value in filled.items()}
    areas = [parse_address(address) for address in merged]
    titles = list(dict.fromkeys([*sheets, *(cell.sheet for cell in filled)]))
    return Workbook(
        name="case.xlsx",
        sheets={
            title: Sheet(
                title,
                f"xl/worksheets/sheet{number}.xml",
                {(cell.row, cell.column): held for cell, held in filled.items() if cell.sheet == title},
                merged=tuple(area for area in areas if area.sheet == title),
            )
            for number, title in enumerate(titles, start=1)
        },
        names=tuple(DefinedName(*name) for name in names),
        tables=tuple(table(filled, *each) for each in tables),
    )


def grid(corner, rows):
    """Cells of a block of rows whose upper left corner is given."""
    start = parse_address(corner)
    return {
        str(Cell(start.sheet, start.row + down, start.column + across)): value
        for down, row in enumerate(rows)
        for across, value in enumerate(row)
    }


HEADINGS = [
    "Name",
    "Value",
    "Distribution",
    "Low",
    "High",
    "Likeliest",
    "Mean",
    "Std dev",
    "Lower cutoff",
    "Upper cutoff",
    "Units",
    "Source",
    "Frozen",
    "Low likeliest",
    "High likeliest",
    "Witness",
]
CELLS = {
    **grid(
        "Inputs!A1",
        [
            HEADINGS,
            ["Weight", 6761, None, 6661, 6861, None, None, None, None, None, "lb", "scale ticket"],
            ["Angle", 186, "uniform", 181, 191, *[None] * 10, "Officer Lee"],
            ["Reaction", 1.25, "Normal", None, None, None, 1.25, 0.46, 0.5, 2.5, "s"],
            ["Friction", 0.78, "Trapezoid", 0.6, 0.95, *[None] * 8, 0.7, 0.85],
            ["Gravity", 32.174, "Triangle", 32, 32.5, 32.174, *[None] * 6, True],
        ],
    ),
    **grid("Model!A1", [["Speed", ("=Inputs!B2*2", 41.5)], ["Restitution", ("=B1/99", 0.4)], ["Ok", ("=B1>0", True)]]),
    **grid("Answers!A1", [["Name", "Cell", "Units", "Range %", "Threshold"], ["Speed", ("=Model!$B$1", 41.5), "mph"]]),
    **grid(
        "Answers!A10",
        [
            ["Name", "Cell", "At least", "At most", "Above", "Below", "Because"],
            ["e", ("=Model!B2", 0.4), 0, None, None, 1, "engagement"],
            ["Positive", ("=Model!B3", True), None, None, None, None, "rest positions"],
        ],
    ),
    **grid("Answers!A20", [["First", "Second", "Correlation"], ["Weight", "Friction", 0.5]]),
    **grid("Answers!A30", [["Setting", "Value"], ["Trials", 5000], ["Seed", 7]]),
}
TABLES = {
    "xlmc_assumptions": "Inputs!A1:P6",
    "xlmc_forecasts": "Answers!A1:E2",
    "xlmc_filters": "Answers!A10:G12",
    "xlmc_correlations": "Answers!A20:C21",
    "xlmc_settings": "Answers!A30:B32",
}


@pytest.fixture
def blocks():
    """`grid`, for cells given row by row."""
    return grid


@pytest.fixture
def make_book():
    """`build`, for workbooks of a test's own."""
    return build


@pytest.fixture
def changed_book():
    """A workbook without mistakes, but for the changes: address -> value, and tables by name (None takes one away)."""

    def book(changes=None, tables=None, names=(), merged=(), sheets=()):
        laid = {**TABLES, **(tables or {})}
        return build(
            {**CELLS, **(changes or {})},
            [(name, *(place if isinstance(place, tuple) else (place,))) for name, place in laid.items() if place],
            names,
            merged,
            sheets,
        )

    return book


@pytest.fixture
def read(changed_book):
    """The definitions of that workbook."""

    def definitions(*args, **kwargs):
        return read_definitions(changed_book(*args, **kwargs), ENGINES)

    return definitions


@pytest.fixture
def only_problem(read):
    """Read a workbook that has one mistake, and check place, words and advice."""

    def check(where, message, hint, *args, **kwargs):
        problems = read(*args, **kwargs).problems
        assert [problem.where for problem in problems] == [where], [str(problem) for problem in problems]
        assert message in problems[0].message
        assert hint in problems[0].hint
        assert not problems[0].message.endswith(".")
        assert not problems[0].hint.endswith(".")

    return check
