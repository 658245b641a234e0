"""Which cells of a workbook hold what a change is about, and what they would hold after it."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from xlmc.excel.address import Cell, InFormula
from xlmc.excel.workbook.workbook import CellValue, Workbook
from xlmc.montecarlo.definitions.definitions import CUTOFFS, Assumption, Correlation, Filter, Forecast, Parameter
from xlmc.montecarlo.definitions.evidence import SIZES
from xlmc.montecarlo.definitions.problems import Findings
from xlmc.montecarlo.definitions.tables.filters import LIMITS
from xlmc.montecarlo.definitions.tables.reserved_tables import DefinitionTable, definition_tables
from xlmc.montecarlo.definitions.tables.table_rows import Row, as_text
from xlmc.montecarlo.distributions.spelling import name_key

__all__ = ["NO_TABLE", "cells_that_change", "tables_of", "use_cell"]

NO_TABLE = "of a table"

_Row = Assumption | Filter | Forecast | Correlation


def cells_that_change(
    workbook: Workbook, old: _Row, new: _Row, tables: Collection[DefinitionTable] | None = None
) -> tuple[dict[Cell, CellValue], list[str]]:
    """Return the cells to be typed into, so that a row says what `new` says in place of `old`.

    Args:
        workbook: that they are in.
        old: what the row says.
        new: what it is to say.
        tables: those of the workbook, from who asks for many rows.

    Returns:
        Cell -> what it would hold, None for nothing; and the headings of the columns that the table lacks. What is in
        no table, as a draw in a cell, has no cells: that is `NO_TABLE`.
    """
    row = _row_of(workbook, old.row, tables)
    if isinstance(old, Correlation) or isinstance(new, Correlation):
        assert isinstance(new, Correlation)
        return _coefficients(workbook, row, new)
    if row is None or isinstance(old.cell, InFormula):
        return {}, [NO_TABLE]
    result: dict[Cell, CellValue] = {}
    lacking: list[str] = []
    for headings, value in _columns(old, new):
        heading = next(filter(row.filled, headings), None) or next(filter(row.has, headings), None)
        if heading is not None:
            result[row.cell(heading)] = value
        elif value is not None and value is not False:
            lacking.append(headings[0])
    if isinstance(old, Assumption) and isinstance(new, Assumption) and old.base != new.base:
        result[old.cell] = new.base
    return result, lacking


def _coefficients(workbook: Workbook, row: Row | None, new: Correlation) -> tuple[dict[Cell, CellValue], list[str]]:
    """Return the cells of a correlation: one of a list of pairs, one or both of a matrix."""
    if row is None:
        return {}, [NO_TABLE]
    if row.has("First") and row.has("Second"):
        return {row.cell("Correlation"): new.number}, []
    first, *others = row.headings
    pair, body = {name_key(new.first), name_key(new.second)}, row.table.table.body
    result: dict[Cell, CellValue] = {}
    for number in range(body.top, body.bottom + 1):
        each = Row(workbook, row.table, number)
        name = name_key(as_text(each.content(first).value))
        for heading in others:
            if each.filled(heading) and {name, name_key(heading)} == pair:
                result[each.cell(heading)] = new.number
    return result, []


def use_cell(workbook: Workbook, first: Cell) -> Cell | None:
    """Return the cell of the column `Use` in the row that begins there; None where its table has no such column."""
    row = _row_of(workbook, first)
    return row.cell("Use") if row is not None and row.has("Use") else None


def tables_of(workbook: Workbook) -> tuple[DefinitionTable, ...]:
    """Return the tables of a workbook whose rows may change."""
    return tuple(each for kind in definition_tables(workbook, Findings()).values() for each in kind)


def _row_of(workbook: Workbook, first: Cell, tables: Collection[DefinitionTable] | None = None) -> Row | None:
    tables = tables_of(workbook) if tables is None else tables
    table = next((each for each in tables if first in each.table.area), None)
    return None if table is None else Row(workbook, table, first.row)


def _columns(
    old: Assumption | Filter | Forecast, new: Assumption | Filter | Forecast
) -> Iterator[tuple[tuple[str, ...], CellValue]]:
    """Return the headings of each column that says something else, and what it says."""
    if isinstance(old, Assumption) and isinstance(new, Assumption):
        if old.frozen != new.frozen:
            yield ("Frozen",), new.frozen
        if old.distribution != new.distribution:
            yield ("Distribution",), new.distribution
        specs = {spec.key: spec for spec in (*old.family.parameters, *new.family.parameters)}
        for key, spec in specs.items():
            if old.parameters.get(key) != new.parameters.get(key):
                yield spec.headings, _number(new.parameters.get(key))
        for key, heading in CUTOFFS.items():
            if old.cutoffs.get(key) != new.cutoffs.get(key):
                yield (heading,), _number(new.cutoffs.get(key))
        if old.units != new.units:
            yield ("Units",), new.units
        if old.source != new.source:
            yield ("Source",), new.source
    elif isinstance(old, Forecast) and isinstance(new, Forecast):
        if old.central != new.central:
            yield ("Range %",), float(f"{100.0 * new.central:.12g}")
        if old.threshold != new.threshold:
            yield ("Threshold",), new.threshold
    elif isinstance(old, Filter) and isinstance(new, Filter) and old.evidence and new.evidence:
        if old.evidence.reading != new.evidence.reading:
            yield ("Reading",), _number(new.evidence.reading)
        for key, heading in SIZES.items():
            if old.evidence.sizes.get(key) != new.evidence.sizes.get(key):
                headings = (heading, "±") if key == "plus_minus" else (heading,)
                yield headings, _number(new.evidence.sizes.get(key))
    elif isinstance(old, Filter) and isinstance(new, Filter):
        for key, heading in LIMITS.items():
            if getattr(old, key) != getattr(new, key):
                yield (heading,), _number(getattr(new, key))


def _number(given: Parameter | None) -> float | None:
    assert not isinstance(given, Cell), "a change gives a number"
    return given
