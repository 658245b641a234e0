"""The charts of a run: what each shows, which no writer changes."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

from xlmc.analysis.studies.sensitivity.measures import noise
from xlmc.montecarlo.definitions.forms import PLAIN, Form
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.statistics import Estimate
from xlmc.outputs.document.parts import Bar, Bars, Chart, Line, Lines, Shape
from xlmc.outputs.filter_effect import shapes_of
from xlmc.outputs.summary import frequent_texts, shares_of

if TYPE_CHECKING:
    from collections.abc import Mapping

    from xlmc.analysis.studies.sensitivity import FilterLimit, ForecastSensitivity, LimitAnswer
    from xlmc.montecarlo.simulation.simulation import RunResult
    from xlmc.outputs.histogram import Figure

__all__ = [
    "acceptance_chart",
    "influence_charts",
    "limit_chart",
    "limit_chart_of_ranges",
    "moved_most",
    "shape_chart",
    "shares_chart",
    "tornado_chart",
    "width_of_range",
]

SHARE: Final = Form(Kind.PERCENT)
"""How shares are written."""

_MOST_MOVED: Final = 6
"""Forecasts in one chart of changes: more lines, and their names, leave no room for one another."""


def shape_chart(simulation: RunResult, name: str) -> Chart | None:
    """How often an assumption has each value, before filtering and accepted; None where all draws are one value."""
    shapes = shapes_of(simulation, name)
    if shapes is None:
        return None
    edges, before, accepted = (tuple(map(float, each)) for each in (shapes.edges, shapes.before, shapes.accepted))
    shape = Shape(edges, before, accepted, simulation.model.input_forms.get(name, PLAIN))
    return Chart("", "", shape, f"{name}: before filtering pale, accepted as a line", 28.0)


def influence_charts(sensitivity: ForecastSensitivity, most: int, *, sobol: bool = False) -> list[Chart]:
    """Chart what each assumption has to do with a forecast, the largest influence on top; bars of noise are pale.

    Four charts: the variance explained; the dependence, or the total effects where there are Sobol indices; the rank
    correlation; and the contribution to variance, signed, as Crystal Ball shows it.
    """
    of = list(zip(sensitivity.influences[:most], noise(sensitivity), strict=False))
    total = ("Total effect (Sobol)", "Share of the variance, alone and with others")
    dependence = ("Dependence", "0 %: none; 100 %: nothing else matters")
    others = [(each.assumption, each.total if sobol else each.dependence) for each, _ in of]
    pale = [weak.total if sobol else weak.dependence for _, weak in of]
    second = [_bar(name, share, weak) for (name, share), weak in zip(others, pale, strict=True) if share is not None]
    explained = [_bar(each.assumption, each.explained, weak.explained) for each, weak in of]
    ranks = [_bar(each.assumption, each.rank_correlation, weak.correlation) for each, weak in of]
    parts = [_bar(each.assumption, each.contribution, weak.correlation) for each, weak in of]
    return [
        _bars("Variance explained", "Share of the variance explained", explained, SHARE),
        _bars(*(total if sobol else dependence), second, SHARE),
        _bars("Rank correlation", "Rank correlation with the forecast (Spearman)", ranks),
        _bars("Contribution to variance (approximate)", "Squared rank correlation, % of all, signed", parts, SHARE),
    ]


def tornado_chart(sensitivity: ForecastSensitivity, most: int) -> Chart:
    """How far the forecast moves from its base case as one assumption moves alone."""
    base = sensitivity.base or 0.0
    bars = [
        Bar(
            bar.assumption,
            tuple((0.0, end - base, look) for end, look in ((bar.low, "light"), (bar.high, "dark")) if end is not None),
        )
        for bar in sensitivity.bars[:most]
    ]
    looks = (("light", "at 10 %"), ("dark", "at 90 %"))
    return _bars(
        "Tornado", _change("Change from the base case", sensitivity.change_units), bars, sensitivity.change_form, looks
    )


def shares_chart(figure: Figure) -> Chart:
    """Draw the share of each text, or of yes and no, with its error."""
    shares = shares_of(figure.answer)
    bars = tuple(_bar(text or "(empty)", share, pale=False) for text, share in frequent_texts(shares)[0].items())
    return Chart("", "Share of the accepted trials", Bars(bars, SHARE), f"{figure.name}: {figure.description}", 125.0)


def limit_chart(limit: FilterLimit, indexes: list[int], unit: str, form: Form = PLAIN) -> Chart:
    """How the means of some forecasts, which have one unit, change as a limit of a filter moves.

    Args:
        limit: of the filter.
        indexes: of the forecasts.
        unit: theirs.
        form: how changes of them are written.
    """
    changes = {limit.slopes[index].forecast: [p.answers[index].change for p in limit.points] for index in indexes}
    return _moved(_of_means(limit, indexes), limit, changes, _change("Change of the mean", unit), form)


def width_of_range(forecast: ForecastSensitivity, now: LimitAnswer) -> float:
    """Return the width of a forecast's central range; of yes and no, which have none, that of all shares."""
    return 1.0 if forecast.form.kind is Kind.YES_NO else now.high.value - now.low.value


def limit_chart_of_ranges(
    limit: FilterLimit, forecasts: Mapping[str, ForecastSensitivity], indexes: list[int]
) -> Chart:
    """Chart the same of forecasts of any units: each change as a part of the forecast's central range."""
    changes = {limit.slopes[index].forecast: _parts_of_range(limit, forecasts, index) for index in indexes}
    return _moved(_of_means(limit, indexes), limit, changes, "Change of the mean, of the central range", SHARE)


def moved_most(limit: FilterLimit, forecasts: Mapping[str, ForecastSensitivity]) -> list[int]:
    """Return the indexes of the forecasts whose means move most, as parts of their central ranges, in their order: as
    many as a chart has room for.
    """

    def farthest(index: int) -> float:
        parts = (abs(each.value) for each in _parts_of_range(limit, forecasts, index))
        return max(filter(math.isfinite, parts), default=0.0)

    return sorted(sorted(range(len(limit.slopes)), key=farthest, reverse=True)[:_MOST_MOVED])


def _of_means(limit: FilterLimit, indexes: list[int]) -> str:
    """Return the title of a chart of changes: of all forecasts that have one, or of those that move most."""
    few = len(indexes) == _MOST_MOVED < len(limit.slopes)
    return f"Change of the {_MOST_MOVED} means that move most" if few else "Change of each mean"


def _parts_of_range(limit: FilterLimit, forecasts: Mapping[str, ForecastSensitivity], index: int) -> list[Estimate]:
    """Return the changes of a forecast's mean as parts of its central range with the limit as it is."""
    now = next(point for point in limit.points if point.limit == limit.limit).answers[index]
    width = width_of_range(forecasts[now.forecast], now)
    return [_part(each.answers[index].change, width) for each in limit.points]


def acceptance_chart(limit: FilterLimit) -> Chart:
    """Chart the share of the trials that is accepted as a limit of a filter moves."""
    shares = {"Share": [point.acceptance for point in limit.points]}
    return _moved("Share of trials accepted", limit, shares, "Share", SHARE)


def _moved(title: str, limit: FilterLimit, result: dict[str, list[Estimate]], upwards: str, form: Form) -> Chart:
    """Chart numbers at each value of a limit, with a line for each name."""
    lines = tuple(
        Line(name, tuple((p.limit, each.value, each.error) for p, each in zip(limit.points, numbers, strict=True)))
        for name, numbers in result.items()
    )
    data = Lines(lines, upwards, dots=True, now=limit.limit, from_zero=True, form_across=limit.form, form_upwards=form)
    return Chart(title, f"Limit: {limit.filter} {limit.relation}", data, f"{title}: {', '.join(result)}")


def _part(estimate: Estimate, whole: float) -> Estimate:
    if whole <= 0.0:
        return Estimate(math.nan)
    return Estimate(estimate.value / whole, None if estimate.error is None else estimate.error / whole)


def _change(what: str, units: str) -> str:
    return f"{what}, {units}" if units else what


def _bars(
    title: str, across: str, bars: list[Bar], form: Form = PLAIN, looks: tuple[tuple[str, str], ...] = ()
) -> Chart:
    message = f"{title}: {', '.join(bar.name for bar in bars)}"
    return Chart(title, across, Bars(tuple(bars), form, looks), message, 125.0)


def _bar(name: str, estimate: Estimate, pale: bool) -> Bar:
    value = estimate.value if math.isfinite(estimate.value) else 0.0
    whisker = None if estimate.error is None else (value - estimate.error, value + estimate.error)
    return Bar(name, ((0.0, value, "light" if pale else "dark"),), whisker)
