"""The checks on Results and on the page: what each says, whether it holds, and the accepted trials that fail it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from xlmc.report.sheets import cells
from xlmc.report.sheets.cells import Shown
from xlmc.run.checking import checks_sentence

if TYPE_CHECKING:
    from xlmc.report.sheets.page import Page
    from xlmc.run.checking import CheckResult
    from xlmc.run.simulation import Simulation

__all__ = ["write_checks"]

_HEADERS = ("Check", "Cell", "Base case", "Trials failing", "Share", "±", "Because")
_STARTS = (0, 1, 3, 5, 6, 7, 8)


def write_checks(page: Page, simulation: Simulation, last: int) -> None:
    """Write the checks, and how many accepted trials fail each; nothing where the workbook has none.

    Args:
        page: the sheet.
        simulation: the run.
        last: the column that wide texts reach to.
    """
    checks = simulation.checks
    if not checks:
        return
    page.heading("Checks: each cell must be TRUE")
    page.spread([cells.text(header, "header left") for header in _HEADERS], _STARTS, last)
    for check in checks:
        page.spread(_line(check), _STARTS, last)
    page.row += 1
    page.wide(f"{checks_sentence(checks)}. A check rejects no trial.", "remark", last)


def _line(check: CheckResult) -> list[Shown]:
    found = check.base.found
    return [
        cells.text(check.name, "name"),
        cells.text(str(check.cell)),
        cells.text(cells.NONE if found is None else found, "warning" if check.holds is False else "text"),
        cells.count(check.failed),
        *cells.share(check.share),
        cells.text(check.because or cells.NONE),
    ]
