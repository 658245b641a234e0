"""Statistics: everything about the accepted trials of each forecast, every number with its error and its interval."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Final

from xlmc.montecarlo.definitions.forms import PLAIN
from xlmc.montecarlo.definitions.stating import NOT_ROUNDED, Kind
from xlmc.montecarlo.number_text import number_text, percent_format
from xlmc.outputs.document import cells
from xlmc.outputs.document.cells import BLANK, Shown
from xlmc.outputs.document.measured import Measured, counted_share
from xlmc.outputs.document.parts import Block, Content, Heading, Paragraph, Table
from xlmc.outputs.summary import error_sentence, with_units

if TYPE_CHECKING:
    from xlmc.montecarlo.loop.forecast_result import ForecastResult
    from xlmc.montecarlo.simulation.simulation import RunResult
    from xlmc.montecarlo.statistics import Estimate
    from xlmc.outputs.document.material import Material

__all__ = ["section", "statistics_blocks", "statistics_sentence", "statistics_tables"]

_PURE: Final = ("Variance", "Skewness", "Kurtosis (normal 3)", "Coefficient of variation")
"""Statistics that are not in the units of the forecast."""

_SPANS: Final = ("Standard deviation", "Range width", "Mean standard error")
"""Statistics that are differences: of dates they are spans of time."""

_MOST_TEXTS: Final = 20
"""Texts of one forecast whose shares stand here; the answers have them all."""


def statistics_blocks(simulation: RunResult, names: Sequence[str]) -> Iterator[Block]:
    """Yield the statistics of the forecasts of these names, one after the other."""
    yield Paragraph(statistics_sentence(simulation), "small")
    for name in names:
        yield Heading(name, 2)
        yield from statistics_tables([simulation.results[name]])


def statistics_sentence(simulation: RunResult) -> str:
    """Say what the tables have in common."""
    return f"{error_sentence(simulation.model.workbook)} A variance has the square of the units."


def statistics_tables(results: Sequence[ForecastResult]) -> Iterator[Table]:
    """Yield the statistics of forecasts side by side, then their percentiles; none of answers that have none."""
    for head, made in (("Statistic", _statistics), ("Percentile", _percentiles)):
        answer = [made(result) for result in results]
        labels = dict.fromkeys(label for rows in answer for label in rows)
        if labels:
            lines = ((label, *(rows.get(label, BLANK) for rows in answer)) for label in labels)
            yield Table(
                "",
                (head, *(with_units(each.definition.name, each.definition.units) for each in results)),
                tuple(lines),
                over="Forecast",
            )


def _statistics(result: ForecastResult) -> Mapping[str, Content]:
    """Return label -> number."""
    description = result.statistics
    rows: dict[str, Content] = {"Trials": cells.count(description.trials)}
    if result.sample.w is not None:
        rows["Effective trials"] = cells.count(round(result.sample.effective))
    if result.yes is not None:
        return rows | {"Yes": counted_share(result.yes)}
    if result.kind is Kind.CATEGORY:
        return rows | {f"“{text}”": counted_share(share) for text, share in [*result.categories.items()][:_MOST_TEXTS]}
    statistics = {
        "Mean": description.mean,
        "Median": description.median,
        "Mode": description.mode,
        "Standard deviation": description.standard_deviation,
        "Variance": description.variance,
        "Skewness": description.skewness,
        "Kurtosis (normal 3)": description.kurtosis,
        "Coefficient of variation": description.coefficient_of_variation,
        "Minimum": description.minimum,
        "Maximum": description.maximum,
        "Range width": description.range_width,
        "Mean standard error": description.mean_standard_error,
    }
    return rows | {label: _statistic(result, label, estimate) for label, estimate in statistics.items()}


def _statistic(result: ForecastResult, label: str, estimate: Estimate) -> Measured:
    form = PLAIN if label in _PURE else result.form
    like = result.statistics.mean if form is result.form else result.statistics.variance
    return Measured(estimate, "spread" if label in _SPANS else "number", form, interval=True, like=like)


def _percentiles(result: ForecastResult) -> Mapping[str, Content]:
    """Return label -> percentile, end of the central range, and the share above the threshold; none of answers that
    are yes or no, or texts.
    """
    if result.kind in NOT_ROUNDED:
        return {}
    description, definition = result.statistics, result.definition
    rows: dict[str, Content] = {
        f"{number_text(percentile)} %": _percentile(result, each)
        for percentile, each in description.percentiles.items()
    }
    low, high = description.central
    rows["Central range, share"] = Shown(definition.central, _percent_format(definition.central))
    rows |= {"Central range from": _percentile(result, low), "Central range to": _percentile(result, high)}
    if description.probability_above is not None:
        rows["Threshold"] = cells.exact(definition.threshold, result.form)
        rows["Above threshold"] = counted_share(description.probability_above)
    return rows


def _percentile(result: ForecastResult, estimate: Estimate) -> Measured:
    return Measured(estimate, form=result.form, interval=True, like=result.statistics.mean)


def _percent_format(share: float) -> str:
    """Percent with the decimals that the share has: `0%` for 0.51, `0.000%` for 0.99999."""
    return percent_format(len(f"{100.0 * share:.10f}".rstrip("0").partition(".")[2]))


def section(material: Material) -> Iterator[Block]:
    """Yield the statistics of the chosen forecasts."""
    return statistics_blocks(material.simulation, material.forecasts)
