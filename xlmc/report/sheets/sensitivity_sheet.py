"""The sheet Sensitivity: what each forecast depends on, two pages a forecast: charts, then their numbers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Final

from xlmc.report.sheets import cells
from xlmc.report.sheets.bar_charts import ROWS as CHART_ROWS
from xlmc.report.sheets.influence_table import ROWS, influence_captions, influence_charts, write_influences
from xlmc.report.sheets.moves_table import move_captions, move_charts, write_moves

if TYPE_CHECKING:
    from xlsxwriter.workbook import Workbook

    from xlmc.report.sheets.page import Page
    from xlmc.studies.sensitivity import ForecastSensitivity, Sensitivities

__all__ = ["WIDTHS", "sensitivity_sentences", "write_sensitivity"]

WIDTHS = (38, 10, 10, 9, 9, 11, 9, 9, 11, 9, 13, *[9] * 5)
_LAST: Final = len(WIDTHS) - 1
_RIGHT: Final = 6
"""The column of the right-hand chart."""

_SCALE: Final = 51
"""The percentage at which six charts fit on a page."""


def write_sensitivity(page: Page, book: Workbook, found: Sensitivities, name: str) -> None:
    """Write the sheet."""
    page.title("Sensitivity: what the answers depend on", f"{name}: {found.accepted:,} accepted trials")
    for sentence in sensitivity_sentences(found):
        page.wide(sentence, "remark", _LAST)
    breaks: list[int] = []
    for number, forecast in enumerate(found.forecasts):
        if number:
            breaks.append(page.row)
        _write_forecast(page, book, forecast, found, breaks)
    page.printed(name, breaks=breaks, scale=_SCALE)


def sensitivity_sentences(found: Sensitivities) -> list[str]:
    """What the numbers are, and rest on."""
    told = [
        "Influences are those among the accepted trials: filters change which assumptions matter. ± is the standard "
        "error from a limited number of trials; no sensitivity says that the model fits the crash."
    ]
    if found.sobol_reason:
        told.append(f"{found.sobol_reason}.")
    if found.examined < found.accepted:
        told.append(f"Influences rest on {found.examined:,} of the {found.accepted:,} accepted trials.")
    if found.omitted:
        told.append(f"{found.omitted:,} assumptions with less influence in a first, coarse look were left out.")
    if found.medians:
        told.append(f"Held at their medians, for their cells are blank: {', '.join(found.medians)}.")
    return told


def _write_forecast(
    page: Page, book: Workbook, forecast: ForecastSensitivity, found: Sensitivities, breaks: list[int]
) -> None:
    """The charts stand before the tables that they draw, so room is left for them."""
    page.heading(f"{forecast.forecast} ({forecast.units})" if forecast.units else forecast.forecast)
    if not forecast.influences and not forecast.bars:
        page.wide("No assumption is drawn: there is nothing that it could depend on.", "paragraph", _LAST)
        return
    top, sobol = page.row, found.sobol_trials > 0
    pairs = (2 if forecast.influences else 0) + (1 if forecast.bars else 0)
    page.row += pairs * (CHART_ROWS + 1)
    breaks.append(page.row)
    charts: list[Any] = []
    captions: list[str] = []
    if forecast.influences:
        at = write_influences(page, forecast, sobol)
        charts += influence_charts(book, at, forecast, sobol)
        captions += influence_captions(forecast, found.sobol_trials)
        _write_rest(page, len(forecast.influences))
    else:
        page.wide(_nothing(forecast), "paragraph", _LAST)
    if forecast.bars:
        page.row += 1
        at = write_moves(page, forecast)
        charts += move_charts(book, at, forecast)
        captions += move_captions(forecast)
    bottom, page.row = page.row, top
    for place in range(0, len(charts), 2):
        _write_pair(page, charts[place : place + 2], captions[place : place + 2])
    page.row = bottom


def _nothing(forecast: ForecastSensitivity) -> str:
    return (
        f"It is a number in {forecast.trials:,} accepted trials: too few to say what influences it, or it is the same "
        "in all of them, or the draws of the accepted trials were not kept."
    )


def _write_rest(page: Page, count: int) -> None:
    if count > ROWS:
        page.wide(f"and {count - ROWS:,} more that explain less.", "remark", _LAST)


def _write_pair(page: Page, charts: Sequence[Any], captions: Sequence[str]) -> None:
    for chart, column, caption in zip(charts, (0, _RIGHT), captions, strict=True):
        page.sheet.insert_chart(page.row, column, chart, {"object_position": 1, "description": caption})
    page.row += CHART_ROWS
    texts = [cells.text(caption, "caption") for caption in captions]
    gap = cells.text("", "caption")
    page.spread([texts[0], gap, texts[1], gap], [0, _RIGHT - 1, _RIGHT, _LAST], _LAST)
