"""The sheets Sensitivity and Filter limits; the second only where there is a limit that could be moved."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from xlmc.report.sheets import limits_sheet, sensitivity_sheet
from xlmc.studies.sensitivity import sensitivities

if TYPE_CHECKING:
    from xlsxwriter.workbook import Workbook

    from xlmc.report.sheets.page import Page
    from xlmc.run.simulation import Simulation

__all__ = ["write_dependence"]


def write_dependence(book: Workbook, page: Callable[[str, tuple[float, ...]], Page], simulation: Simulation) -> None:
    """Write both; `page` adds a sheet of a name with columns of these widths."""
    found, name = sensitivities(simulation), simulation.model.workbook.name
    sensitivity_sheet.write_sensitivity(page("Sensitivity", sensitivity_sheet.WIDTHS), book, found, name)
    if found.filter_limits or found.varying_limits or found.omitted_limits:
        limits_sheet.write_limits(page("Filter limits", limits_sheet.WIDTHS), book, found, name)
