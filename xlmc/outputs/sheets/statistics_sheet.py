"""The sheet Statistics: everything about each forecast's accepted trials, every number with its error."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Final, TypeAlias

from xlmc.montecarlo.definitions.forms import PLAIN, Form
from xlmc.montecarlo.definitions.stating import NOT_ROUNDED, Kind
from xlmc.montecarlo.number_text import count_text, number_text
from xlmc.outputs.document import cells
from xlmc.outputs.document.cells import Shown
from xlmc.outputs.summary import error_sentence, percent

if TYPE_CHECKING:
    from xlmc.montecarlo.loop.forecast_result import ForecastResult
    from xlmc.montecarlo.simulation.simulation import RunResult
    from xlmc.montecarlo.statistics import Estimate
    from xlmc.outputs.sheets.page import Page

__all__ = ["WIDTHS", "write_forecast", "write_statistics"]

_Value: TypeAlias = str | float | None

_ACROSS: Final = 6
"""Forecasts side by side: as many as can be read on a page."""

_COLUMNS = (8.3, 6.3, 8.3, 8.3)
"""Of a forecast."""

WIDTHS = (23, *_COLUMNS * _ACROSS)

_ROW = 15.0

_ENDS = ["Value", "±", "95 % from", "to"]
_NOTHING = [cells.BLANK] * len(_ENDS)

_RIGHT = 7
"""The column of the percentiles, where they stand beside the statistics of one forecast."""


def write_statistics(page: Page, simulation: RunResult) -> None:
    """Write the sheet: forecasts side by side, their statistics and below these their percentiles."""
    name = simulation.model.workbook.name
    below = f"{name}: {count_text(simulation.accepted)} accepted trials. From … to: the 95 % interval of each number"
    page.height = _ROW
    page.title("Statistics of the accepted trials", below)
    results = list(simulation.results.values())
    last = len(_COLUMNS) * min(max(len(results), 1), _ACROSS)
    page.wide(f"{error_sentence(simulation.model.workbook)} A variance has the square of the units.", "remark", last)
    for start in range(0, len(results), _ACROSS):
        page.row += 1
        if start:
            page.may_begin()
        _write_group(page, results[start : start + _ACROSS])
    page.set_up_printing(name)


def _write_group(page: Page, results: Sequence[ForecastResult]) -> None:
    """Write the table of some forecasts."""
    starts = [0, *(1 + len(_COLUMNS) * index for index in range(len(results)))]
    last = len(_COLUMNS) * len(results)
    names = [Shown(_with_units(result), look="header") for result in results]
    page.line([Shown("Forecast", look="header left"), *names], starts, last)
    statistics = [{row[0].value: row[2:] for row in _statistics(result)} for result in results]
    _write_rows(page, "Statistic", statistics)
    _write_rows(page, "Percentile", [_below_statistics(result) for result in results])


def _with_units(result: ForecastResult) -> str:
    units = result.definition.units
    return f"{result.definition.name} ({units})" if units else result.definition.name


def _write_rows(page: Page, head: str, found: Sequence[dict[_Value, list[Shown]]]) -> None:
    """Write a row for each label, with the cells of each forecast; blank ones where a forecast has no such row."""
    heads = [Shown(each, look="header") for each in _ENDS * len(found)]
    page.line([Shown(head, look="header left"), *heads])
    for label in dict.fromkeys(label for rows in found for label in rows):
        page.line([Shown(label), *(cell for rows in found for cell in rows.get(label, _NOTHING))])


def _below_statistics(result: ForecastResult) -> dict[_Value, list[Shown]]:
    """Return percentiles, central range and the share above the threshold, under labels that all forecasts share."""
    definition, above = result.definition, result.statistics.probability_above
    rows: dict[_Value, list[Shown]] = {row[0].value: row[1:] for row in _percentiles(result)}
    if not rows:
        return rows
    form = result.form
    low, high = (_with_interval(each, result.statistics.mean, form) for each in result.statistics.central)
    rows["Central range, share"] = [Shown(definition.central, _percent_format(definition.central)), *_NOTHING[1:]]
    rows |= {"Central range from": low, "Central range to": high}
    if above is not None:
        rows["Threshold"] = [cells.exact(definition.threshold, form), *_NOTHING[1:]]
        rows["Above threshold"] = [*cells.share(above), *cells.interval(above, percent=True)]
    return rows


def _percent_format(share: float) -> str:
    """Percent with the decimals that the share has: `0%` for 0.51, `0.000%` for 0.99999."""
    decimals = f"{100.0 * share:.10f}".rstrip("0").partition(".")[2]
    return f"0{'.' * bool(decimals)}{'0' * len(decimals)}%"


def write_forecast(page: Page, result: ForecastResult) -> None:
    """Write everything about one forecast: its statistics, and its percentiles beside them."""
    page.heading(result.definition.name)
    top = page.row
    page.table(["Statistic", "Units", *_ENDS], _statistics(result))
    bottom, page.row = page.row, top
    page.table(["Percentile", *_ENDS], [*_percentiles(result), *_range_and_threshold(result)], _RIGHT)
    page.row = max(bottom, page.row)


def _statistics(result: ForecastResult) -> list[list[Shown]]:
    found, units = result.statistics, result.definition.units
    rows = [[Shown("Trials"), Shown(""), cells.count(found.trials), *[cells.BLANK] * 3]]
    if result.sample.w is not None:
        effective = round(result.sample.effective)
        rows.append([Shown("Effective trials"), Shown(""), cells.count(effective), *[cells.BLANK] * 3])
    if result.yes is not None:
        return [*rows, [Shown("Yes"), Shown(""), *cells.share(result.yes), *cells.interval(result.yes, percent=True)]]
    if result.kind is Kind.CATEGORY:
        return [*rows, *(_text_row(*each) for each in [*result.categories.items()][:_MOST_TEXTS])]
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
        form = result.form if label not in _PURE else PLAIN
        like = found.mean if form is result.form else found.variance
        rows.append([Shown(label), Shown(unit), *_with_interval(estimate, like, form, spread=label in _SPANS)])
    return rows


def _text_row(text: str, share: Estimate) -> list[Shown]:
    return [Shown(f"“{text}”"), Shown(""), *cells.share(share), *cells.interval(share, percent=True)]


_MOST_TEXTS: Final = 20
"""Texts of one forecast whose shares stand here; the sheet Results has them all."""

_PURE: Final = ("Variance", "Skewness", "Kurtosis (normal 3)", "Coefficient of variation")
"""Statistics that are not in the units of the forecast."""

_SPANS: Final = ("Standard deviation", "Range width", "Mean standard error")
"""Statistics that are differences: of dates they are spans of time."""


def _percentiles(result: ForecastResult) -> list[list[Shown]]:
    """Return the rows of percentiles; none of answers that are yes or no, or texts."""
    found = result.statistics
    if result.kind in NOT_ROUNDED:
        return []
    return [
        [Shown(f"{number_text(percentile)} %"), *_with_interval(each, found.mean, result.form)]
        for percentile, each in found.percentiles.items()
    ]


def _range_and_threshold(result: ForecastResult) -> list[list[Shown]]:
    found, definition = result.statistics, result.definition
    if result.kind in NOT_ROUNDED:
        return []
    labels = [Shown(f"{percent(definition.central)} range {end}", look="name") for end in ("from", "to")]
    rows = [
        [label, *_with_interval(each, found.mean, result.form)]
        for label, each in zip(labels, found.central, strict=True)
    ]
    above = found.probability_above
    if definition.threshold is not None and above is not None:
        shown = [*cells.share(above), *cells.interval(above, percent=True)]
        rows.append([Shown(f"Above {result.form.number(definition.threshold)}", look="name"), *shown])
    return rows


def _with_interval(estimate: Estimate, like: Estimate, form: Form, *, spread: bool = False) -> list[Shown]:
    pair = cells.estimate(estimate, like=like, form=form, spread=spread)
    return [*pair, *cells.interval(estimate, form=form, spread=spread)]


def _square(units: str) -> str:
    if not units:
        return ""
    return f"{units}²" if units.isalpha() else f"({units})²"
