"""The sheet Statistics: everything about each forecast's accepted trials, every number with its error."""

from __future__ import annotations

from typing import TYPE_CHECKING

from xlmc.report.sheets import cells
from xlmc.report.sheets.cells import Shown
from xlmc.report.summary import ERROR_SENTENCE, percent

if TYPE_CHECKING:
    from xlmc.report.sheets.page import Page
    from xlmc.run.forecast_result import ForecastResult
    from xlmc.run.simulation import Simulation
    from xlmc.statistics import Estimate

__all__ = ["WIDTHS", "write_forecast", "write_statistics"]

_BLOCK = (26, 9, 11, 10, 10, 10)
WIDTHS = (*_BLOCK, 2, 18, 11, 10, 10, 10)
_RIGHT = len(_BLOCK) + 1
_LAST = len(WIDTHS) - 1
_ON_A_PAGE, _SCALE = 3, 48
"""Forecasts, and the percentage at which so many fit, of A4 too, and with a font that is wider than Excel's own."""

_ENDS = ["Value", "±", "95 % from", "to"]


def write_statistics(page: Page, simulation: Simulation) -> None:
    """Write the sheet."""
    name = simulation.model.workbook.name
    below = f"{name}: {simulation.accepted:,} accepted trials. From … to: the 95 % interval of each number"
    page.title("Statistics of the accepted trials", below)
    page.row += 1
    page.wide(ERROR_SENTENCE, "remark", _LAST)
    breaks = []
    for number, result in enumerate(simulation.results.values()):
        if number and number % _ON_A_PAGE == 0:
            breaks.append(page.row)
        write_forecast(page, result)
    page.set_up_printing(name, breaks=breaks, scale=_SCALE, upright=True)


def write_forecast(page: Page, result: ForecastResult) -> None:
    """Write everything about one forecast: its statistics, and its percentiles beside them."""
    page.heading(result.definition.name)
    top = page.row
    page.table(["Statistic", "Units", *_ENDS], _statistics(result))
    bottom, page.row = page.row, top
    page.table(["Percentile", *_ENDS], _percentiles(result), _RIGHT)
    page.row = max(bottom, page.row)


def _statistics(result: ForecastResult) -> list[list[Shown]]:
    found, units = result.statistics, result.definition.units
    rows = [[Shown("Trials"), Shown(""), cells.count(found.trials), *[cells.BLANK] * 3]]
    if result.sample.w is not None:
        effective = round(result.sample.effective)
        rows.append([Shown("Effective trials"), Shown(""), cells.count(effective), *[cells.BLANK] * 3])
    for label, unit, estimate in (
        ("Mean", units, found.mean),
        ("Median", units, found.median),
        ("Mode", units, found.mode),
        ("Standard deviation", units, found.standard_deviation),
        ("Variance", _square(units), found.variance),
        ("Skewness", "", found.skewness),
        ("Kurtosis (normal 3)", "", found.kurtosis),
        ("Coefficient of variation", "", found.coefficient_of_variation),
        ("Minimum", units, found.minimum),
        ("Maximum", units, found.maximum),
        ("Range width", units, found.range_width),
        ("Mean standard error", units, found.mean_standard_error),
    ):
        rows.append([Shown(label), Shown(unit), *_with_interval(estimate, found.mean)])
    return rows


def _percentiles(result: ForecastResult) -> list[list[Shown]]:
    found, definition = result.statistics, result.definition
    labels = [Shown(f"{percentile:g} %") for percentile in found.percentiles]
    labels += [Shown(f"{percent(definition.central)} range {end}", look="name") for end in ("from", "to")]
    estimates = (*found.percentiles.values(), *found.central)
    rows = [[label, *_with_interval(each, found.mean)] for label, each in zip(labels, estimates, strict=True)]
    if found.probability_above is not None:
        above = found.probability_above
        shown = [*cells.share(above), *cells.interval(above, percent=True)]
        rows.append([Shown(f"Above {definition.threshold:g}", look="name"), *shown])
    return rows


def _with_interval(estimate: Estimate, like: Estimate) -> list[Shown]:
    return [*cells.estimate(estimate, like=like), *cells.interval(estimate)]


def _square(units: str) -> str:
    if not units:
        return ""
    return f"{units}²" if units.isalpha() else f"({units})²"
