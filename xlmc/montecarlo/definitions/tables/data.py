"""The data of an assumption row: the range under Data, and the distribution that is made from it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from xlmc.errors import DefinitionError
from xlmc.excel.address import Area, Cell
from xlmc.excel.workbook.workbook import Workbook
from xlmc.montecarlo.definitions.cell_references import area_of_reference, formula_at
from xlmc.montecarlo.definitions.computed import Computed
from xlmc.montecarlo.definitions.definitions import CUTOFFS, DataRange, Parameter
from xlmc.montecarlo.definitions.problems import Findings
from xlmc.montecarlo.definitions.tables.table_rows import Row, as_text, logical, number_in, parameter, static_value
from xlmc.montecarlo.distributions import DataError, Family
from xlmc.montecarlo.distributions.parameters import show

__all__ = ["OPTIONS", "area_values", "cached_data_family", "data_family", "given_data", "refuse_options"]

OPTIONS = ("Cumulative", "Bandwidth")
"""Columns that say how to read the data of some distribution."""


_NO_WEIGHTS = 6
"""Columns from which on data are values alone."""

_SUM_TOLERANCE = 0.002
"""How far from 1 probabilities are together that were rounded."""


def given_data(row: Row, family: Family, computed: Computed, findings: Findings) -> DataRange:
    """Return the data that the row names.

    Args:
        row: the row.
        family: its distribution.
        computed: which cells have formulas.
        findings: takes the notice that a reference written as text goes stale.

    Raises:
        DefinitionError: the range is missing, or holds anything but numbers and blanks.
    """
    where = row.cell("Data") if row.has("Data") else row.where
    if not row.filled("Data"):
        hint = "Name the range that holds them, such as Inputs!Q2:R9" if row.has("Data") else "Add a column Data"
        raise DefinitionError(f"{family.name} needs Data, a range of cells", where=where, hint=hint)
    area = area_of_reference(row.workbook, _reference(row, where, findings), where.sheet, where)
    if family.data is not None and family.data.columns and area.columns not in family.data.columns:
        columns = " or ".join(map(str, family.data.columns))
        message = f"{family.name} takes {columns} columns ({family.data.content}), and {area} has {area.columns}"
        raise DefinitionError(message, where=where, hint="Correct the range")
    values = area_values(row.workbook, area, computed)
    data_range = DataRange(area, values, logical(row, "Cumulative"), parameter(row, "Bandwidth"))
    if family.data is not None and "Cumulative" in family.data.options and not data_range.cumulative:
        _remark_on_sum(data_range, row.workbook, findings)
    return data_range


def _remark_on_sum(data: DataRange, workbook: Workbook, findings: Findings) -> None:
    """Point out weights that look like probabilities and are not 1 together: they are taken as shares of their sum."""
    if not 1 < data.area.columns < _NO_WEIGHTS:
        return
    at = min(data.area.columns, 3) - 1
    weights = [static_value(row[at], workbook) for row in data.rows if any(each is not None for each in row)]
    known = [each for each in weights if each is not None]
    total = sum(known)
    if len(known) == len(weights) > 1 and max(known) < 1 and 0.5 < total < 1.5 and abs(total - 1) > _SUM_TOLERANCE:
        message = f"The probabilities sum to {show(total)}, not to 1: each is taken as its share of {show(total)}"
        findings.notice(message, Cell(data.area.sheet, data.area.top, data.area.left + at))


def area_values(workbook: Workbook, area: Area, computed: Computed) -> tuple[tuple[Parameter | None, ...], ...]:
    """Read what the cells of a range hold, row by row: numbers, cells with formulas, None for blanks.

    Raises:
        DefinitionError: a cell holds text, a logical or an error.
    """

    def value(cell: Cell) -> Parameter | None:
        content = workbook.content(cell)
        if content.is_blank:
            return None
        if computed.by_formula(cell) and content.value is None:
            return cell
        result = number_in("The data cell", content, cell)
        return cell if computed.by_formula(cell) else result

    cells = list(area.cells())
    width = area.columns
    return tuple(tuple(value(cell) for cell in cells[i : i + width]) for i in range(0, len(cells), width))


def refuse_options(row: Row, family: Family, findings: Findings) -> None:
    """Yield what is filled in for a distribution that cannot use it: options of data, cutoffs of Custom."""
    used = () if family.data is None else family.data.options
    findings.attempt(_refuse_cumulative, row, family, used)
    if row.filled("Bandwidth") and "Bandwidth" not in used:
        hint = "Clear the cell, or choose Empirical smoothed"
        findings.problem(f"{family.name} has no Bandwidth", row.cell("Bandwidth"), hint)
    for heading in CUTOFFS.values():
        if family.data is not None and not family.data.truncates and row.filled(heading):
            hint = "Clear the cell, and change the data: leave out what lies beyond the cutoff"
            findings.problem(f"{family.name} cannot be cut off", row.cell(heading), hint)


def _refuse_cumulative(row: Row, family: Family, used: tuple[str, ...]) -> None:
    if logical(row, "Cumulative") and "Cumulative" not in used:
        message = f"{family.name} has no weights that could be cumulative"
        raise DefinitionError(message, where=row.cell("Cumulative"), hint="Clear the cell")


def data_family(family: Family, data: DataRange, number: Callable[[Cell], float]) -> Family:
    """Make the distribution of the data.

    Args:
        family: of this name, with data or without.
        data: where they stand and what they are.
        number: gives the value of a cell with a formula.

    Raises:
        DefinitionError: the data are not a distribution; it names the cell to look at first.
    """

    def constant(value: Parameter | None) -> float | None:
        return number(value) if isinstance(value, Cell) else value

    rows = [[np.nan if value is None else constant(value) for value in row] for row in data.rows]
    bandwidth = constant(data.bandwidth)
    if bandwidth is not None and not bandwidth > 0:
        message = f"Bandwidth ({show(bandwidth)}) must be above 0"
        raise DefinitionError(message, where=data.area, hint="Type a number above 0, or leave the cell blank")
    options = {"cumulative": data.cumulative or None, "bandwidth": bandwidth}
    given = {key: value for key, value in options.items() if value is not None}
    try:
        return family.built(np.array(rows, dtype=float), **given)
    except DataError as fault:
        raise _located(fault, data.area) from None


def _located(fault: DataError, area: Area) -> DefinitionError:
    """Name the cells of the fault."""

    def cell(row: int, column: int) -> Cell:
        return Cell(area.sheet, area.top + row, area.left + column)

    if fault.row is None or cell(fault.row, fault.column or 0) not in area:  # a list that is written in a formula
        message = fault.message if fault.also is None else fault.message.format(also=area)
        return DefinitionError(message, where=area, hint=fault.hint)
    message = fault.message if fault.also is None else fault.message.format(also=cell(*fault.also))
    return DefinitionError(message, where=cell(fault.row, fault.column or 0), hint=fault.hint)


def cached_data_family(data: DataRange, family: Family, workbook: Workbook) -> Family | None:
    """`data_family` of the values that Excel saved; None if it has not calculated a cell yet.

    Raises:
        DefinitionError: see `data_family`.
    """
    saved = {cell: static_value(cell, workbook) for cell in data.cells}
    known = {cell: value for cell, value in saved.items() if value is not None}
    return data_family(family, data, known.__getitem__) if len(known) == len(saved) else None


def _reference(row: Row, where: Cell, findings: Findings) -> str:
    content = row.content("Data")
    if content.formula is not None:
        return formula_at(content.formula, where)
    if not isinstance(content.value, str):
        message = f"Data holds {as_text(content.value)}, which is not a range"
        raise DefinitionError(message, where=where, hint="Name the range that holds the data, such as Inputs!Q2:R9")
    text = content.value.strip().removeprefix("=").strip()
    if ":" in text and "[" not in text:
        message = (
            f"Data is the text {text!r}, which goes stale when rows move; a defined name or a table column follows"
        )
        findings.notice(message, where, alike="text in Data")
    return text
