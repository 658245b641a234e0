"""The sheet Statistics: everything about each forecast's accepted trials, every number with its error."""

from __future__ import annotations

from typing import TYPE_CHECKING

from xlmc.report import cells
from xlmc.report.cells import Shown
from xlmc.report.summary import ERROR_SENTENCE, percent

if TYPE_CHECKING:
    from xlmc.report.page import Page
    from xlmc.simulation import ForecastResult, Simulation
    from xlmc.statistics import Estimate

__all__ = ["WIDTHS", "write_statistics"]

_BLOCK = (26, 10, 12, 11, 11, 11)
WIDTHS = (*_BLOCK, 3, 14, 12, 11, 11, 11)
_RIGHT = len(_BLOCK) + 1
_LAST = len(WIDTHS) - 1
_ENDS = ["Value", "±", "95 % from", "to"]


def write_statistics(page: Page, simulation: Simulation) -> None:
    """Write the sheet."""
    name = simulation.model.workbook.name
    page.title("Statistics of the accepted trials", f"{name}: {simulation.accepted:,} accepted trials")
    page.wide(ERROR_SENTENCE, "remark", _LAST)
    for result in simulation.results.values():
        _write_forecast(page, result)
    page.printed(name)


def _write_forecast(page: Page, result: ForecastResult) -> None:
    page.heading(result.definition.name)
    top = page.row
    page.table(["Statistic", "Units", *_ENDS], _statistics(result))
    bottom, page.row = page.row, top
    page.table(["Percentile", *_ENDS], _percentiles(result), _RIGHT)
    page.row = max(bottom, page.row)


def _statistics(result: ForecastResult) -> list[list[Shown]]:
    found, units = result.statistics, result.definition.units
    rows = [[cells.text("Trials"), cells.text(""), cells.count(found.trials), *[cells.BLANK] * 3]]
    for label, unit, estimate in (
        ("Mean", units, found.mean),
        ("Median", units, found.median),
        ("Mode", units, found.mode),
        ("Standard deviation", units, found.standard_deviation),
        ("Variance", _squared(units), found.variance),
        ("Skewness", "", found.skewness),
        ("Kurtosis (normal 3)", "", found.kurtosis),
        ("Coefficient of variation", "", found.coefficient_of_variation),
        ("Minimum", units, found.minimum),
        ("Maximum", units, found.maximum),
        ("Range width", units, found.range_width),
        ("Mean standard error", units, found.mean_standard_error),
    ):
        rows.append([cells.text(label), cells.text(unit), *_with_interval(estimate)])
    return rows


def _percentiles(result: ForecastResult) -> list[list[Shown]]:
    found, definition = result.statistics, result.definition
    rows = [[cells.text(f"{p:g} %"), *_with_interval(estimate)] for p, estimate in found.percentiles.items()]
    for end, estimate in zip(("from", "to"), found.central, strict=True):
        rows.append([cells.text(f"{percent(definition.central)} range {end}", "name"), *_with_interval(estimate)])
    if found.probability_above is not None:
        above = found.probability_above
        shown = [*cells.share(above), *cells.interval(above, percent=True)]
        rows.append([cells.text(f"P(> {definition.threshold:g})", "name"), *shown])
    return rows


def _with_interval(estimate: Estimate) -> list[Shown]:
    return [*cells.estimate(estimate), *cells.interval(estimate)]


def _squared(units: str) -> str:
    if not units:
        return ""
    return f"{units}²" if units.isalpha() else f"({units})²"
