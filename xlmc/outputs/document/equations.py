"""The equations that a workbook prints beside its cells, with their sources."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from xlmc.excel.address import Cell
from xlmc.excel.workbook.workbook import CellContent, Sheet, Workbook
from xlmc.montecarlo.definitions.tables.table_rows import as_text
from xlmc.montecarlo.model.labels import calculated_texts
from xlmc.montecarlo.model.model import CompiledModel

__all__ = ["Equation", "equations_of"]

_HEADS = ("quantity", "symbol", "units", "equation", "source")
_NEEDED = frozenset({"quantity", "equation"})
_COLUMNS = 40
"""How far to the right a heading is looked for."""


class Equation(NamedTuple):
    """One row: what is computed, its symbol and units, the equation, where that is from; texts may be empty."""

    quantity: str
    symbol: str
    units: str
    equation: str
    source: str


def equations_of(model: CompiledModel) -> list[Equation]:
    """Return the equations of the cells that the answers need, where a sheet has the columns Quantity and Equation.

    A row counts if one of its cells is a forecast or a filter, or is read by one.
    """
    equations: list[Equation] = []
    needed: dict[str, set[int]] = {}
    asked = {each.cell for each in model.forecasts} | {each.cell for each in model.filters}
    for cell in model.lowering.read | asked:
        needed.setdefault(cell.sheet, set()).add(cell.row)
    for name in model.workbook.sheets:  # others are not parsed for it
        if name in needed:
            equations += _of_sheet(model.workbook, model.workbook.sheets[name], needed[name])
    feeding = model.definitions.feeding
    for file, book in {} if feeding is None else feeding.sources.items():
        for name, sheet in model.workbook.links[f"[{file}]"].sheets.items():
            equations += _of_sheet(book, sheet, needed.get(name, set()))
    return equations


def _of_sheet(workbook: Workbook, sheet: Sheet, needed: set[int]) -> Iterator[Equation]:
    cells: Mapping[tuple[int, int], CellContent] = sheet.cells
    heads: dict[int, dict[str, int]] = {}
    for (row, column), content in cells.items():
        head = as_text(content.value).casefold() if isinstance(content.value, str) else ""
        if head in _HEADS and column <= _COLUMNS:
            heads.setdefault(row, {}).setdefault(head, column)
    starts = sorted(row for row, result in heads.items() if result.keys() >= _NEEDED)
    if not starts:
        return
    below = {row: heads[max(above)] for row in sorted(needed) if (above := [start for start in starts if start < row])}
    spots = [(row, at) for row, columns in below.items() for at in columns.values() if (row, at) in cells]
    missing = [Cell(sheet.name, *spot) for spot in spots if cells[spot].is_uncalculated]
    calculated = {cell[1:]: text for cell, text in calculated_texts(workbook, missing).items()} if missing else {}
    shown = {spot: calculated.get(spot) or as_text(cells[spot].value) for spot in spots}
    for row, columns in below.items():
        texts = {head: shown.get((row, at), "") for head, at in columns.items()}
        if texts["equation"]:
            yield Equation(*(texts.get(head, "") for head in _HEADS))
