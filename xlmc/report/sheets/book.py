"""All result sheets as a workbook of their own, built in memory: the same run gives the same bytes."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING

from xlmc.report.figure import figures_of
from xlmc.report.sheets import (
    assumptions,
    bins,
    certainty_sheet,
    charts,
    pairs_sheet,
    record_sheet,
    results,
    statistics_sheet,
    trials,
)
from xlmc.report.sheets.curves import Curves
from xlmc.report.sheets.dependence_sheets import write_dependence
from xlmc.report.sheets.page import Page
from xlmc.report.sheets.styles import CREATED, Styles
from xlmc.results.record import make_record

if TYPE_CHECKING:
    from xlmc.run.simulation import Simulation

__all__ = ["build_sheets"]


def build_sheets(simulation: Simulation, *, command: str | None = None, rows: int = trials.TRIAL_ROWS) -> bytes:
    """The result sheets of a run: Results, Charts, Statistics, Certainty, Pairs, Assumptions, Sensitivity, Filter
    limits, Trials, Bins, Curves, Record.

    Args:
        simulation: the finished run.
        command: what the person typed, for the record.
        rows: the most accepted trials to write out.
    """
    from xlsxwriter import Workbook

    from xlmc.report.sheets.exact_sheet import ExactSheet

    packed = io.BytesIO()
    with Workbook(packed, {"in_memory": True, "strings_to_formulas": False, "strings_to_urls": False}) as book:
        book.set_properties({"created": CREATED})
        styles = Styles(book)

        def page(name: str, widths: tuple[float, ...]) -> Page:
            return Page(book.add_worksheet(name, ExactSheet), styles, widths)

        results.write_results(page("Results", results.WIDTHS), simulation)
        drawing = page("Charts", charts.WIDTHS)
        statistics_sheet.write_statistics(page("Statistics", statistics_sheet.WIDTHS), simulation)
        certain = page("Certainty", certainty_sheet.WIDTHS)
        together = page("Pairs", pairs_sheet.WIDTHS)
        assumptions.write_assumptions(page("Assumptions", assumptions.WIDTHS), simulation)
        write_dependence(book, page, simulation)
        shown = trials.write_trials(page("Trials", trials.WIDTHS), simulation, rows)
        certainty_sheet.write_certainty(certain, simulation, shown)
        figures, name = figures_of(simulation), simulation.model.workbook.name
        places = bins.write_bins(page("Bins", ()), figures, name)
        curves = Curves(page("Curves", ()), name)
        charts.write_charts(drawing, book, simulation, figures, places, curves)
        pairs_sheet.write_pairs(together, book, simulation, curves, shown)
        curves.finish()
        record_sheet.write_record(page("Record", record_sheet.WIDTHS), make_record(simulation, command), name)
    return packed.getvalue()
