"""The answers that formulas themselves mark: by `RiskOutput`, or by a cell that shows results of theirs."""

from __future__ import annotations

from xlmc.address import Cell
from xlmc.definitions.computed import Computed
from xlmc.definitions.findings import Findings
from xlmc.definitions.in_cells.calls import InCells
from xlmc.definitions.model import Forecast, name_key
from xlmc.definitions.tables.identity import Claims

__all__ = ["in_cell_forecasts"]


def in_cell_forecasts(
    found: InCells, computed: Computed, central: float, claims: Claims, findings: Findings
) -> list[Forecast]:
    """The cells with `RiskOutput`, then those of which `RiskMean(B9)` and its like show results.

    Args:
        found: the calls of the workbook.
        computed: which cells something gives a value.
        central: the share of the central range.
        claims: takes their names and cells; the rows of tables have taken theirs.
        findings: takes remarks.
    """
    outputs = [
        Forecast(_take(output.name or str(cell), cell, claims, findings), cell, cell, output.units, central)
        for cell, output in found.outputs.items()
        if cell not in claims.cells
    ]
    shown = []
    for cell, asked in found.results.items():
        for each in asked:
            if isinstance(each.place, str):
                _remark_on_name(each.place, each.function, cell, claims, findings)
            elif not computed.at_all(each.place):
                message = f"{each.function} asks for results of {each.place}, which nothing computes: nothing is shown"
                findings.notice(message, cell)
            elif each.place not in claims.cells:
                message = f"{each.place} is taken for a forecast, because {each.function} shows results of it"
                findings.notice(message, cell)
                name = _take(str(each.place), each.place, claims, findings)
                shown.append(Forecast(name, each.place, cell, central=central))
    return [*outputs, *shown]


def _take(name: str, cell: Cell, claims: Claims, findings: Findings) -> str:
    """Take the cell, and the name, with its cell behind it where another has that name."""
    claims.take_cell(cell, cell)
    if name_key(name) in claims.names:
        findings.notice(f"another forecast is called {name!r}; this one is called '{name} ({cell})'", cell)
        name = f"{name} ({cell})"
    return claims.take_name(name, cell)


def _remark_on_name(name: str, function: str, cell: Cell, claims: Claims, findings: Findings) -> None:
    if name_key(name) not in claims.names:
        message = f"{function} asks for results of {name!r}, and no forecast is called so: nothing is shown"
        findings.notice(message, cell)
