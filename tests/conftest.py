"""Workbooks without files: `cells` are address -> value, addresses without a sheet lie on `S`.

A value is what a cell holds; a text that begins with `=` is a formula, and a pair is a formula and the value Excel
cached for it.
"""

from __future__ import annotations

from pathlib import Path
from types import MappingProxyType

import pytest
from openpyxl.workbook.defined_name import DefinedName as WrittenName
from workbook_files import workbook_of

from xlmc.excel.address import Area, parse_address
from xlmc.excel.workbook.workbook import CellContent, DefinedName, Formula, Sheet, Table, Workbook
from xlmc.montecarlo.definitions.definitions import Assumption, Correlation, Definitions, Filter, Forecast
from xlmc.montecarlo.definitions.evidence import Evidence
from xlmc.montecarlo.definitions.tables.evidence_rows import as_filter
from xlmc.montecarlo.model.model import CompiledModel


def _content(value, row, column):
    if isinstance(value, CellContent):
        return value
    value, cached = value if isinstance(value, tuple) else (value, None)
    if isinstance(value, str) and value.startswith("="):
        return CellContent(cached, Formula(value[1:], row, column))
    return CellContent(value)


def _workbook(cells, names=None, tables=(), sheets=(), **others):
    laid = {sheet: {} for sheet in ("S", *sheets)}
    for address, value in cells.items():
        cell = parse_address(address, "S")
        laid.setdefault(cell.sheet, {})[cell.row, cell.column] = _content(value, cell.row, cell.column)
    defined = [(*key.rpartition("!")[::2], text) for key, text in (names or {}).items()]
    return Workbook(
        "book.xlsx",
        {name: Sheet(name, f"xl/worksheets/{name}.xml", held) for name, held in laid.items()},
        tuple(DefinedName(name, text, sheet or None) for sheet, name, text in defined),
        tuple(tables),
        **others,
    )


def _parameter(value):
    return parse_address(value, "S") if isinstance(value, str) else float(value)


def _assumption(name, given, workbook):
    given = dict(given)
    cell = parse_address(given.pop("cell"), "S")
    fixed = {key: given.pop(key) for key in ("distribution", "frozen") if key in given}
    given = {key: _parameter(value) for key, value in given.items()}
    fixed = {"distribution": "Uniform", **fixed}
    return Assumption(name, cell, given=given, row=cell, base=workbook.content(cell).value, **fixed)


def _filter(name, given):
    given = {"cell": given} if isinstance(given, str) else dict(given)
    cell, of = parse_address(given.pop("cell"), "S"), given.pop("only_for", ())
    return Filter(name, cell, cell, only_for=of, **{key: _parameter(value) for key, value in given.items()})


def _evidence(name, given):
    given = dict(given)
    cell = parse_address(given.pop("cell"), "S")
    reading, error = (_parameter(given.pop("reading")), given.pop("error", "uniform"))
    return Evidence(name, cell, cell, reading, error, {key: _parameter(value) for key, value in given.items()})


def _definitions(workbook, assumptions, forecasts, filters, correlations, evidence=MappingProxyType({})):
    places = {name: parse_address(address, "S") for name, address in forecasts.items()}
    items = tuple(_evidence(name, given) for name, given in evidence.items())
    made = [_filter(name, given) for name, given in filters.items()]
    return Definitions(
        tuple(_assumption(name, given, workbook) for name, given in assumptions.items()),
        tuple(Forecast(name, cell, cell) for name, cell in places.items()),
        (*(each for each in made if not each.only_for), *map(as_filter, items)),
        tuple(Correlation(*pair, value, parse_address("A1", "Correlations")) for pair, value in correlations.items()),
        evidence=items,
        forecast_filters=tuple(each for each in made if each.only_for),
    )


@pytest.fixture(scope="session")
def workbook():
    """`workbook(cells, names={"Rate": "S!$A$1", "Data!Rate": …}, tables=…, sheets=…)`: a `Workbook`."""
    return _workbook


@pytest.fixture(scope="session")
def table():
    """`table("Table1", "S!A1:B3", "Low", "High")`: a `Table`."""

    def make(name, address, *columns, **rows):
        area = parse_address(address, "S")
        assert isinstance(area, Area)
        return Table(name, area, columns, **rows)

    return make


@pytest.fixture(scope="session")
def definitions():
    """`definitions(workbook, assumptions, forecasts, filters, correlations, evidence)`; see `book` for these."""
    return _definitions


def _model(cells, assumptions=None, forecasts=None, filters=None, correlations=None, evidence=None, **of_workbook):
    workbook = _workbook(cells, **of_workbook)
    given = assumptions or {}, forecasts or {}, filters or {}, correlations or {}, evidence or {}
    return CompiledModel(workbook, _definitions(workbook, *given), Path("book.xlsx"))


@pytest.fixture(scope="session")
def book():
    """A `Model` from cells and definitions, each by name.

    An assumption is `{"cell": "A1", "low": 0, "high": 1}`, with `distribution`, `frozen` and cutoffs if need be; a
    parameter that is an address is a dynamic one. A forecast is an address. A filter is an address, or
    `{"cell": "A1", "below": 1}`, with the names of forecasts as `only_for` if it is a filter of these alone. A
    correlation is `{("a", "b"): 0.5}`. Evidence is `{"cell": "A1", "reading": 1, "error": "normal", "std_dev": 0.5}`.
    """

    return _model


@pytest.fixture(scope="session")
def model_of():
    """As `book`, where a folder has a `book` of its own."""
    return _model


SMALL_BOOK = {
    "Inputs": [
        ["Name", "Value", "Low", "High", "Units", "Source"],
        ["width", 2.0, 1.0, 3.0, "ft", "tape"],
        ["=length", 3.0, 2.0, 4.0, "ft", "plan"],
        [],
        ["Rate", 2.5],
        ["Extra", 1.0, None, 2.0],
    ],
    "Model": [
        ["=Inputs!B2*Inputs!B3*Rate", "=SUM(Inputs!B6:D6)"],
        ["=A1+B1", "=1/MAX(Inputs!B2-1.2,0)"],
        ["=SQRT(Inputs!B3-2.1)"],
    ],
    "Wanted": [
        ["Name", "Cell", "Units", "Threshold"],
        ["area", "=Model!A2", "ft²", 20.0],
        ["inverse", "=Model!B2", None, None],
        [],
        ["Name", "Cell", "At most", "Because"],
        ["root", "=Model!A3", 1.2, "seen"],
        [],
        ["Setting", "Value"],
        ["Trials", 400],
        ["Seed", 7],
    ],
}
"""Two assumptions, one with a name that looks like a formula; a forecast and a filter that may be errors."""


@pytest.fixture(scope="session")
def small_book(tmp_path_factory):
    """A workbook file of two assumptions, two forecasts and a filter, with errors, a name, and a blank in a range."""
    tables = {
        "xlmc_assumptions": "Inputs!A1:F3",
        "xlmc_forecasts": "Wanted!A1:D3",
        "xlmc_filters": "Wanted!A5:D6",
        "xlmc_settings": "Wanted!A8:B10",
    }
    book = workbook_of(SMALL_BOOK, tables)
    book["Inputs"]["A3"].data_type = "s"
    book.defined_names["Rate"] = WrittenName("Rate", attr_text="Inputs!$B$5")
    path = tmp_path_factory.mktemp("small") / "small.xlsx"
    book.save(path)
    return path
