"""The sheet Trials: accepted trials, one in each row, with all assumptions and forecasts, to check or key in again."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from xlmc.montecarlo.definitions.forms import PLAIN
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.number_text import count_text, counted_text
from xlmc.montecarlo.simulation.simulation import weight_heading
from xlmc.outputs.document import cells
from xlmc.outputs.document.cells import Shown
from xlmc.outputs.sheets.styles import Reference
from xlmc.outputs.summary import with_units

if TYPE_CHECKING:
    from xlmc.montecarlo.simulation.simulation import RunResult
    from xlmc.outputs.sheets.page import Page

__all__ = ["HEADER", "MOST_ROWS", "TRIAL_ROWS", "WIDTHS", "TrialsAt", "write_trials"]


TRIAL_ROWS = 10_000
"""Accepted trials on the sheet, unless asked otherwise: more make the file slow to open."""

NUMBERS = 1_000_000
"""Numbers on the sheet, unless asked otherwise: with more than 100 assumptions and forecasts there are fewer trials."""

WIDTHS = (9,)
HEADER = 3
"""The row of the headings, counted from 0."""

MOST_ROWS = 1_048_576 - HEADER - 1
"""What a sheet has room for."""

_WIDTH = 13


@dataclass(frozen=True, slots=True)
class TrialsAt:
    """The place of the trials in the workbook.

    Attributes:
        sheet: its name.
        shown: trials on it, the first accepted ones.
        first_forecast: the column of the first forecast, counted from 0; the others follow.
    """

    sheet: str
    shown: int
    first_forecast: int

    def heading(self, index: int) -> Reference:
        """Return a reference to the heading of a forecast, its name and units."""
        return [self.sheet, HEADER, self.first_forecast + index]

    def column(self, index: int, most: int | None = None) -> Reference:
        """Return a reference to the cells of a forecast, or to its first `most`; there is none without trials."""
        column, rows = self.first_forecast + index, self.shown if most is None else most
        return [self.sheet, HEADER + 1, column, HEADER + rows, column]


def write_trials(page: Page, simulation: RunResult, rows: int = TRIAL_ROWS) -> TrialsAt:
    """Write the sheet with the first `rows` accepted trials, and say so where there are more."""
    live, forecasts = simulation.model.live, simulation.model.forecasts
    if rows == TRIAL_ROWS:
        rows = min(rows, NUMBERS // max(1, len(live) + len(forecasts)))
    shown = max(0, min(rows, simulation.kept_inputs, MOST_ROWS))
    name = simulation.model.workbook.name
    below = f"{name}, seed {simulation.settings.seed}. Trials are numbered from 0."
    page.title_of_data("Accepted trials", below, name, HEADER)
    page.put(page.row, 0, _count_line(shown, simulation.accepted))
    page.row = HEADER
    columns = _columns(simulation, shown)
    page.sheet.set_column(1, max(1, len(columns)), _WIDTH)
    page.sheet.set_row(HEADER, 64)
    for column, heading in enumerate([Shown("Trial", look="header"), *(heading for heading, _ in columns)]):
        page.put(HEADER, column, heading)
    page.row = HEADER + 1
    _write_values(page, simulation, [values for _, values in columns], len(live))
    page.sheet.freeze_panes(HEADER + 1, 1)
    page.sheet.autofilter(HEADER, 0, HEADER + shown, len(columns))
    return TrialsAt(page.sheet.get_name(), shown, 1 + len(live))


def _count_line(shown: int, accepted: int) -> Shown:
    if shown == accepted:
        return Shown(
            f"All {counted_text(accepted, 'accepted trial')}." if accepted else "No trial was accepted.",
            look="subtitle",
        )
    return Shown(
        f"Only the first {count_text(shown)} of {counted_text(accepted, 'accepted trial')} stand here.", look="alarm"
    )


def _columns(simulation: RunResult, shown: int) -> list[tuple[Shown, NDArray[np.float64]]]:
    """Headings with units, green for assumptions and blue for forecasts, and `(shown,)` values in memory."""

    def column(heading: Shown, values: NDArray[np.float64]) -> tuple[Shown, NDArray[np.float64]]:
        return heading, values[:shown].copy()

    live, forecasts = simulation.model.live, simulation.model.forecasts
    inputs = [
        column(Shown(with_units(a.name, a.units), look="header assumption"), simulation.inputs[a.name]) for a in live
    ]
    outputs = [
        column(Shown(with_units(f.name, f.units), look="header forecast"), simulation.forecasts[f.name])
        for f in forecasts
    ]
    weighting = simulation.weighting
    heading = Shown(weight_heading([*simulation.inputs, *simulation.forecasts]), look="header")
    weights = [] if weighting is None else [column(heading, weighting.weights)]
    return inputs + outputs + weights


def _write_values(page: Page, simulation: RunResult, columns: list[NDArray[np.float64]], inputs: int) -> None:
    """Write the trials: numbers in the form of each forecast, texts where these are the answer."""
    shown, results = columns[0].size if columns else 0, list(simulation.results.values())
    page.numbers(page.row, 0, simulation.trial_index[:shown].tolist(), "0", "trial")
    for column, values in enumerate(columns):
        result = results[column - inputs] if 0 <= column - inputs < len(results) else None
        texts = None if result is None else simulation.labels.get(result.definition.name)
        if texts is not None:
            for row, number in enumerate(values.tolist(), page.row):
                page.put(row, column + 1, Shown(cells.NONE if number != number else texts[int(number)]))
            continue
        form = PLAIN if result is None or result.kind is Kind.YES_NO else result.form
        page.numbers(page.row, column + 1, values.tolist(), cells.spread_format(_spread(values), form))
    page.row += shown


def _spread(values: NDArray[np.float64]) -> float:
    known = values[~np.isnan(values)]
    return float(known.max()) - float(known.min()) if known.size > 1 else 0.0
