from __future__ import annotations

import io
from pathlib import Path
from types import SimpleNamespace

import openpyxl
import pytest
from packed_sheets import packed_sheets
from simulated import simulated

from xlmc.excel.address import parse_address
from xlmc.excel.workbook.workbook import CellContent, Formula, Sheet, Workbook
from xlmc.montecarlo.definitions.definitions import Assumption, Definitions, Filter, Forecast, Settings
from xlmc.montecarlo.model.model import CompiledModel


def _cell(address):
    return parse_address(address, "S")


def _content(address, value):
    if isinstance(value, str) and value.startswith("="):
        cell = _cell(address)
        return CellContent(None, Formula(value[1:], cell.row, cell.column))
    return CellContent(value)


def _workbook(cells):
    result = {(_cell(a).row, _cell(a).column): _content(a, value) for a, value in cells.items()}
    return Workbook("book.xlsx", {"S": Sheet("S", "part", result)})


def uniform(name, address, low, high, **more):
    return Assumption(name, _cell(address), "Uniform", {"low": low, "high": high}, _cell(address), **more)


def forecast(name, address, **more):
    return Forecast(name, _cell(address), _cell(address), **more)


def filter_(name, address, **more):
    return Filter(name, _cell(address), _cell(address), **more)


def simulate(cells, assumptions, forecasts, filters=(), correlations=(), *, trials=2000, seed=1):
    settings = Settings(trials=trials, seed=seed)
    definitions = Definitions(
        tuple(assumptions), tuple(forecasts), tuple(filters), tuple(correlations), settings=settings
    )
    return simulated(CompiledModel(_workbook(cells), definitions, Path("book.xlsx")))


@pytest.fixture(scope="session")
def make():
    """Builders of definitions, and of runs of workbooks without a file."""
    return SimpleNamespace(uniform=uniform, forecast=forecast, filter=filter_, simulate=simulate, cell=_cell)


@pytest.fixture(scope="session")
def package_of():
    """The result sheets of a run as a file would hold them, made once of each run."""
    made = {}

    def pack(simulation):
        if id(simulation) not in made:
            made[id(simulation)] = packed_sheets(simulation), simulation  # which keeps its id as long
        return made[id(simulation)][0]

    return pack


@pytest.fixture(scope="session")
def opened():
    """`opened(run, "Results")`: result sheets, all or those of these names, as openpyxl reads them."""

    def read(simulation, *names, **options):
        return openpyxl.load_workbook(io.BytesIO(packed_sheets(simulation, *names, **options)))

    return read


@pytest.fixture(scope="session")
def run():
    """Two forecasts, two filters of which one may be an error, an idle and a frozen assumption."""
    cells = {
        "A1": 2.0,
        "A2": 3.0,
        "A3": 1.0,
        "A4": 10.0,
        "B1": "=A1*A2+A4",
        "B2": "=A1-A2",
        "C1": "=SQRT(A2-2.1)",
        "C2": "=A1",
    }
    assumptions = [
        uniform("width", "A1", 1.0, 3.0, base=2.0, units="ft", source="tape", notes={"By": "JD"}),
        uniform("length", "A2", 2.0, 4.0, base=3.0, units="ft", source="=plan"),
        uniform("idle", "A3", 0.0, 1.0, base=1.0),
        uniform("held", "A4", 0.0, 20.0, base=10.0, frozen=True),
    ]
    forecasts = [
        forecast("area", "B1", units="ft", threshold=16.0),
        forecast("difference", "B2", units="ft"),
    ]
    filters = [
        filter_("root", "C1", at_most=1.2, because="seen"),
        filter_("narrow", "C2", above=1.1, below=2.5, because="=measured"),
    ]
    return simulate(cells, assumptions, forecasts, filters, trials=5000)


@pytest.fixture(scope="session")
def weighted(model_of):
    """A run whose trials evidence weights: a standard normal number, read as 1 with a standard deviation of 0.5."""
    normal = {"cell": "A1", "distribution": "Normal", "mean": 0, "std_dev": 1}
    evidence = {"reading": {"cell": "C1", "reading": 1, "error": "normal", "std_dev": 0.5}}
    model = model_of({"A1": 0.0, "B1": "=A1*1", "C1": "=A1*1"}, {"a": normal}, {"y": "B1"}, evidence=evidence)
    return simulated(model, 4_000, seed=1, evidence="weights")


@pytest.fixture(scope="session")
def none_accepted():
    """A run in which the filter leaves nothing."""
    assumptions = [uniform("a", "A1", 0.0, 1.0, base=0.5)]
    forecasts = [forecast("x", "B1", threshold=1.0)]
    return simulate({"A1": 0.5, "B1": "=A1*2", "C1": "=A1>5"}, assumptions, forecasts, [filter_("never", "C1")])


@pytest.fixture(scope="session")
def one_accepted():
    """A run of a single trial."""
    assumptions = [uniform("a", "A1", 0.0, 1.0, base=0.5)]
    return simulate({"A1": 0.5, "B1": "=A1*2"}, assumptions, [forecast("x", "B1", threshold=1.0)], trials=1)


@pytest.fixture(scope="session")
def book(run, package_of):
    """The result sheets of `run`."""
    return openpyxl.load_workbook(io.BytesIO(package_of(run)))


@pytest.fixture(scope="session")
def rows_of():
    """A sheet's rows as lists of values, without empty cells at their ends."""

    def rows(sheet):
        result = []
        for row in sheet.iter_rows(values_only=True):
            values = list(row)
            while values and values[-1] is None:
                values.pop()
            result.append(values)
        return result

    return rows


@pytest.fixture(scope="session")
def row_of(rows_of):
    """The first row of a sheet that begins with a text, or has it in a given column."""

    def row(sheet, text, column=0):
        return next(values for values in rows_of(sheet) if len(values) > column and values[column] == text)

    return row
