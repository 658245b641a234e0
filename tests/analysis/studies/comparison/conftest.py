from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import openpyxl
import pytest

from xlmc.montecarlo.model.loading import load
from xlmc.montecarlo.model.model import CompiledModel

TEMPLATES = Path(__file__).resolve().parents[4] / "templates"
_HEADINGS = {"base": 4, "low": 7, "high": 8}


@pytest.fixture
def answering(book):
    """`answering("a", 0, 1)`: a book whose forecast `y` is the uniform assumption of that name, plus a shift."""

    def make(name, low, high, units="", shift=0.0, filters=None):
        cells = {"A1": (low + high) / 2, "D1": f"=A1+{shift!r}"}
        made = book(cells, {name: {"cell": "A1", "low": low, "high": high}}, {"y": "D1"}, filters or {})
        forecasts = tuple(replace(f, units=units) for f in made.forecasts)
        assumptions = tuple(replace(a, units=units) for a in made.assumptions)
        definitions = replace(made.definitions, forecasts=forecasts, assumptions=assumptions)
        return CompiledModel(made.workbook, definitions, Path(f"{name}.xlsx"))

    return make


@pytest.fixture
def filled_in(tmp_path):
    """`filled_in("momentum-si", {"alpha_2": (87, 93), "limit": 25})`: a template with other ranges, and numbers."""

    def make(template, given):
        made = openpyxl.load_workbook(TEMPLATES / f"{template}.xlsx")
        sheet = made["Inputs"]
        rows = {sheet.cell(row, 3).value: row for row in range(1, sheet.max_row + 1)}
        for symbol, value in given.items():
            cells = {"base": value}
            if isinstance(value, tuple):
                cells = {"base": sum(value) / 2, "low": value[0], "high": value[1]}
            for heading, number in cells.items():
                sheet.cell(rows[symbol], _HEADINGS[heading]).value = number
        path = tmp_path / f"{template}.xlsx"
        made.save(path)
        return load(path)

    return make
