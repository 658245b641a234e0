"""What to type into a table so that it says what a changed row says."""

from __future__ import annotations

from dataclasses import replace

import pytest

from xlmc.excel.address import Cell
from xlmc.montecarlo.definitions.definitions import Assumption, Filter, Forecast
from xlmc.montecarlo.definitions.evidence import Evidence
from xlmc.montecarlo.definitions.tables.changed_cells import NO_TABLE, cells_that_change, use_cell
from xlmc.montecarlo.definitions.tables.evidence_rows import as_filter

ROW, INPUT = Cell("S", 2, 1), Cell("S", 9, 9)
NORMAL = Assumption("a", INPUT, "Normal", {"mean": 1.0, "std_dev": 2.0}, ROW, base=1.0)
CUT = replace(NORMAL, given={**NORMAL.given, "lower_cutoff": 0.0})
FORECAST = Forecast("f", INPUT, ROW, central=0.9)
FILTER = Filter("w", INPUT, ROW, at_least=1.0)
EVIDENCE = as_filter(Evidence("e", INPUT, ROW, 4.0, "uniform", {"plus_minus": 1.0}))


def measured(**changes):
    return as_filter(replace(EVIDENCE.evidence, **changes))


@pytest.fixture
def book(workbook, table):
    """A table of one row, at S!A2, with these headings and what stands under them."""

    def make(kind, **columns):
        headings = [heading.replace("_", " ") for heading in columns]
        cells = {f"{chr(65 + at)}1": heading for at, heading in enumerate(headings)}
        cells |= {f"{chr(65 + at)}2": value for at, value in enumerate(columns.values()) if value is not None}
        address = f"A1:{chr(64 + len(headings))}2"
        return workbook(cells, tables=[table(kind, address, *headings)])

    return make


@pytest.mark.parametrize(
    ("old", "new", "columns", "cells", "lacking"),
    [
        (NORMAL, replace(NORMAL, frozen=True), {"Frozen": None}, {"B2": True}, []),
        (NORMAL, replace(NORMAL, frozen=True), {}, {}, ["Frozen"]),
        (replace(NORMAL, frozen=True), NORMAL, {}, {}, []),  # a table without the column freezes nothing
        (NORMAL, NORMAL.with_numbers({"mean": 3.0}), {"Mean": 1.0, "Std_dev": 2.0}, {"B2": 3.0}, []),
        (NORMAL, NORMAL.with_numbers({"mean": 3.0}), {"Std_dev": 2.0}, {}, ["Mean"]),
        (NORMAL, NORMAL.with_numbers({"lower_cutoff": 0.0}), {"Lower_cutoff": None}, {"B2": 0.0}, []),
        (CUT, CUT.with_numbers({"lower_cutoff": None}), {"Lower_cutoff": 0.0}, {"B2": None}, []),
        (NORMAL, replace(NORMAL, units="m"), {"Units": "ft"}, {"B2": "m"}, []),
        (NORMAL, replace(NORMAL, source="me"), {"Source": None}, {"B2": "me"}, []),
        (NORMAL, replace(NORMAL, base=5.0), {}, {"I9": 5.0}, []),
        (NORMAL, NORMAL, {"Mean": 1.0}, {}, []),
        (FORECAST, replace(FORECAST, central=0.8), {"Range_%": 90.0}, {"B2": 80.0}, []),
        (FORECAST, replace(FORECAST, central=0.07), {"Range_%": 90.0}, {"B2": 7.0}, []),
        (FORECAST, replace(FORECAST, threshold=3.0), {"Threshold": None}, {"B2": 3.0}, []),
        (FILTER, replace(FILTER, at_least=2.0), {"At_least": 1.0, "At_most": None}, {"B2": 2.0}, []),
        (FILTER, replace(FILTER, at_least=None, below=2.0), {"At_least": 1.0}, {"B2": None}, ["Below"]),
        (EVIDENCE, measured(reading=5.0), {"Reading": 4.0}, {"B2": 5.0}, []),
        (EVIDENCE, measured(sizes={"plus_minus": 2.0}), {"Plus_or_minus": 1.0}, {"B2": 2.0}, []),
        (EVIDENCE, measured(sizes={"plus_minus": 2.0}), {"±": 1.0}, {"B2": 2.0}, []),
        (EVIDENCE, measured(sizes={"plus_minus": 2.0}), {"Plus_or_minus": None, "±": 1.0}, {"C2": 2.0}, []),
        (EVIDENCE, measured(sizes={"std_dev": 2.0}), {"±": 1.0}, {"B2": None}, ["Std dev"]),
    ],
)
def test_a_change_is_typed_into_the_columns_that_say_it(book, old, new, columns, cells, lacking):
    kind = {Assumption: "xlmc_assumptions", Forecast: "xlmc_forecasts", Filter: "xlmc_filters"}[type(old)]
    kind = "xlmc_evidence" if old is EVIDENCE else kind
    result, missing = cells_that_change(book(kind, Name=old.name, **columns), old, new)
    assert {str(cell).removeprefix("S!"): value for cell, value in result.items()} == cells
    assert missing == lacking


def test_what_stands_in_no_table_has_no_cells(workbook):
    book = workbook({"A1": 1.0})
    assert cells_that_change(book, NORMAL, replace(NORMAL, units="m")) == ({}, [NO_TABLE])
    assert use_cell(book, ROW) is None


def test_a_row_is_switched_in_its_column_use(book):
    assert use_cell(book("xlmc_filters", Name="w", Use=None), ROW) == Cell("S", 2, 2)
    assert use_cell(book("xlmc_filters", Name="w"), ROW) is None
