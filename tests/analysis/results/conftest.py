from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from simulated import simulated

from xlmc.errors import Notice
from xlmc.excel.address import parse_address
from xlmc.excel.workbook.workbook import CellContent, Formula, Sheet, Workbook
from xlmc.montecarlo.definitions.definitions import Assumption, Correlation, Definitions, Filter, Forecast, Settings
from xlmc.montecarlo.model.model import CompiledModel

CELLS = {
    "A1": 2.0,
    "A2": 3.0,
    "A3": 1.0,
    "A4": 10.0,
    "A5": 0.5,
    "B1": "=A1*A2+A4",
    "B2": "=1/MAX(A1-1.6,0)",
    "C1": "=SQRT(A2-2.1)",
    "D1": "=A1*2-2.5",
    "E1": "=A5",
}


def _cell(address):
    return parse_address(address, "S")


def _content(address, value):
    if isinstance(value, str):
        cell = _cell(address)
        return CellContent(None, Formula(value[1:], cell.row, cell.column))
    return CellContent(value)


def _workbook():
    cells = {(_cell(a).row, _cell(a).column): _content(a, value) for a, value in CELLS.items()}
    notice = Notice("calculation is manual", "book.xlsx")
    return Workbook("my book.xlsx", {"S": Sheet("S", "part", cells)}, notices=(notice,), sha256="ab" * 32)


def _definitions():
    cell = _cell
    uniform = Assumption("width", cell("A1"), "Uniform", {"low": 1.0, "high": 3.0}, cell("A1"), 2.0)
    return Definitions(
        assumptions=(
            replace(uniform, units="ft", source="tape", notes={"By": "JD", "Day": "3"}),
            Assumption(
                "length", cell("A2"), "Normal", {"mean": 3.0, "std_dev": 0.5, "lower_cutoff": 2.0}, cell("A2"), 3.0
            ),
            replace(uniform, name="idle", cell=cell("A3")),
            replace(uniform, name="held", cell=cell("A4"), frozen=True, base=10.0),
            Assumption("late", cell("A5"), "Uniform", {"low": 0.0, "high": cell("D1")}, cell("A5"), 0.5),
        ),
        forecasts=(
            Forecast("area", cell("B1"), cell("B1"), "ft²", threshold=16.0, notes={"Symbol": "A"}),
            Forecast("inverse", cell("B2"), cell("B2"), central=0.9),
            Forecast("copy", cell("E1"), cell("E1")),
        ),
        filters=(Filter("root", cell("C1"), cell("C1"), at_most=1.2, because="seen"),),
        correlations=(Correlation("width", "length", 0.4, cell("A9")),),
        settings=Settings(trials=4000, seed=5),
    )


@pytest.fixture(scope="session")
def model():
    """A model with every kind of definition, and every kind of error."""
    return CompiledModel(_workbook(), _definitions(), Path("my book.xlsx"))


@pytest.fixture(scope="session")
def run(model):
    return simulated(model)
