"""The data of an assumption row: the range under Data, and the distribution that is made from it."""

from __future__ import annotations

from collections.abc import Callable

from xlmc.address import Area, Cell
from xlmc.definitions.area_reference import area_of_reference
from xlmc.definitions.computed import Computed
from xlmc.definitions.fields import logical, number_in, parameter, static_value
from xlmc.definitions.findings import Findings
from xlmc.definitions.model import DataRange, Parameter
from xlmc.definitions.parameters import CUTOFFS, Given, given_parameters
from xlmc.definitions.references import formula_at
from xlmc.definitions.tables import Row, as_text, is_blank
from xlmc.distributions import DATA_FAMILIES, DataFamily, Family
from xlmc.distributions.base import show
from xlmc.distributions.custom import Custom, Piece
from xlmc.distributions.custom_data import BadData
from xlmc.distributions.data_families import DataOptions
from xlmc.errors import DefinitionError
from xlmc.workbook.model import Workbook

__all__ = [
    "DATA_HEADINGS",
    "area_values",
    "cached_data_family",
    "data_family",
    "given_cutoffs",
    "given_data",
    "refuse_cumulative",
]

DATA_HEADINGS = ("Data", "Cumulative", "Bandwidth")


def given_data(row: Row, kind: DataFamily, computed: Computed, findings: Findings) -> DataRange:
    """The data that the row names.

    Args:
        row: the row.
        kind: its distribution.
        computed: which cells have formulas.
        findings: takes the notice that a reference written as text goes stale.

    Raises:
        DefinitionError: the range is missing, or holds anything but numbers and blanks.
    """
    where = row.cell("Data") if row.has("Data") else row.where
    if not row.filled("Data"):
        hint = "Name the range that holds them, such as Inputs!Q2:R9" if row.has("Data") else "Add a column Data"
        raise DefinitionError(f"{kind.name} needs Data, a range of cells", where=where, hint=hint)
    area = area_of_reference(row.workbook, _reference(row, where, findings), where.sheet, where)
    bandwidth = parameter(row, "Bandwidth")
    if bandwidth is not None and "Bandwidth" not in kind.options:
        hint = "Clear the cell, or choose Empirical smoothed"
        raise DefinitionError(f"{kind.name} has no Bandwidth", where=row.cell("Bandwidth"), hint=hint)
    return DataRange(area, area_values(row.workbook, area, computed), logical(row, "Cumulative"), bandwidth)


def area_values(workbook: Workbook, area: Area, computed: Computed) -> tuple[tuple[Parameter | None, ...], ...]:
    """What the cells of a range hold, row by row: numbers, cells with formulas, None for blanks.

    Raises:
        DefinitionError: a cell holds text, a logical or an error.
    """

    def value(cell: Cell) -> Parameter | None:
        content = workbook.content(cell)
        if is_blank(content):
            return None
        if computed.by_formula(cell) and content.value is None:
            return cell
        found = number_in("The data cell", content, cell)
        return cell if computed.by_formula(cell) else found

    cells = list(area.cells())
    width = area.columns
    return tuple(tuple(value(cell) for cell in cells[i : i + width]) for i in range(0, len(cells), width))


def given_cutoffs(row: Row, kind: DataFamily, findings: Findings) -> Given:
    """The cutoffs of the row; parameters that the distribution has not are refused."""
    stand_in = Custom([Piece(0.0, 1.0)], kind.name)
    stand_in.columns = DATA_HEADINGS
    if not kind.truncates:
        for heading in CUTOFFS.values():
            if row.filled(heading):
                hint = "Clear the cell, and change the data: leave out what lies beyond the cutoff"
                findings.problem(f"{kind.name} cannot be cut off", row.cell(heading), hint)
    return given_parameters(row, stand_in, findings)


def refuse_cumulative(row: Row, kind: DataFamily | None, name: str) -> None:
    """Only weights in data can be cumulative.

    Raises:
        DefinitionError: Cumulative is TRUE for a distribution without them, or is no logical.
    """
    if logical(row, "Cumulative") and (kind is None or "Cumulative" not in kind.options):
        message = f"{name} has no weights that could be cumulative"
        raise DefinitionError(message, where=row.cell("Cumulative"), hint="Clear the cell")


def data_family(name: str, data: DataRange, number: Callable[[Cell], float]) -> Family:
    """The distribution that the data make.

    Args:
        name: as `DATA_FAMILIES` spells it.
        data: where they stand and what they are.
        number: gives the value of a cell with a formula.

    Raises:
        DefinitionError: the data are no distribution; it names the cell to look at first.
    """

    def settled(value: Parameter | None) -> float | None:
        return number(value) if isinstance(value, Cell) else value

    rows = [[settled(value) for value in row] for row in data.rows]
    bandwidth = settled(data.bandwidth)
    if bandwidth is not None and not bandwidth > 0:
        message = f"Bandwidth ({show(bandwidth)}) must be above 0"
        raise DefinitionError(message, where=data.area, hint="Type a number above 0, or leave the cell blank")
    try:
        return DATA_FAMILIES[name].make(rows, DataOptions(data.cumulative, bandwidth))
    except BadData as fault:
        places = [Cell(data.area.sheet, data.area.top + row, data.area.left + column) for row, column in fault.places]
        message = fault.message.format(*places)
        raise DefinitionError(message, where=places[0], hint=fault.hint) from None


def cached_data_family(name: str, data: DataRange, workbook: Workbook) -> Family | None:
    """`data_family` of the values that Excel saved; None where it has not calculated a cell yet.

    Raises:
        DefinitionError: see `data_family`.
    """
    saved = {cell: static_value(cell, workbook) for cell in data.cells}
    known = {cell: value for cell, value in saved.items() if value is not None}
    return data_family(name, data, known.__getitem__) if len(known) == len(saved) else None


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
        findings.notice(message, where)
    return text
