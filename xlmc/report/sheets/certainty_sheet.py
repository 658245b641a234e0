"""The sheet Certainty: results in words, how certain their ranges are, and cells that count any other range.

*Certainty* is Crystal Ball's word for the share of the trials in a range.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from xlmc.report.sheets import cells
from xlmc.report.sheets.own_range import write_own_ranges
from xlmc.results.statements import MEANING, certainties, statements

if TYPE_CHECKING:
    from xlmc.report.sheets.cells import Shown
    from xlmc.report.sheets.page import Page
    from xlmc.report.sheets.trials import TrialsAt
    from xlmc.results.statements import Certainty
    from xlmc.run.simulation import Simulation

__all__ = ["LAST", "WIDTHS", "write_certainty", "write_ranges"]

WIDTHS = (34, 26, 12, 12, 11, 11, 11)
LAST = len(WIDTHS) - 1
_ON_A_PAGE, _SCALE = 33, 80
"""Rows, and the percentage at which so many fit."""


def write_certainty(page: Page, simulation: Simulation, trials: TrialsAt) -> None:
    """Write the sheet; `trials` is where the trials stand that its formulas count."""
    name = simulation.model.workbook.name
    page.title("Certainty", f"{name}: {simulation.accepted:,} accepted trials")
    page.heading("In words")
    for statement in statements(simulation):
        page.wide(f"{statement.text}.", "quote", LAST)
    page.row += 1
    page.wide(MEANING, "remark", LAST)
    page.heading("Certainty of ranges")
    write_ranges(page, simulation)
    start = page.row
    write_own_ranges(page, simulation, trials, LAST)
    apart = start // _ON_A_PAGE != page.row // _ON_A_PAGE
    page.printed(name, scale=_SCALE, breaks=[start] if apart else [])


def write_ranges(page: Page, simulation: Simulation) -> None:
    """Write the certainty of every forecast's central range and threshold."""
    rows = [_line(name, each) for name, result in simulation.results.items() for each in certainties(result)]
    if not rows:
        page.wide("No forecast has a number in an accepted trial.", "paragraph", LAST)
        return
    page.table(["Forecast", "Range", "Trials in it", "Certainty", "±", "95 % from", "to"], rows)


def _line(name: str, found: Certainty) -> list[Shown]:
    share = found.share
    return [
        cells.text(name, "name"),
        cells.text(found.words),
        cells.count(round(share.value * share.n)),
        *cells.share(share),
        *cells.interval(share, percent=True),
    ]
