"""The charts of a run: what each shows, which no writer changes."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from xlmc.analysis.studies.sensitivity.measures import noise
from xlmc.montecarlo.definitions.forms import PLAIN, Form
from xlmc.outputs.document.parts import Bar, Bars, Chart, Line, Lines, Shape
from xlmc.outputs.filter_effect import shapes_of
from xlmc.outputs.summary import frequent_texts, shares_of

if TYPE_CHECKING:
    from xlmc.analysis.studies.sensitivity import FilterLimit, ForecastSensitivity
    from xlmc.montecarlo.simulation.simulation import RunResult
    from xlmc.montecarlo.statistics import Estimate
    from xlmc.outputs.histogram import Figure

__all__ = ["contribution_chart", "influence_chart", "limit_chart", "shape_chart", "shares_chart", "tornado_chart"]


def shape_chart(simulation: RunResult, name: str) -> Chart | None:
    """How often an assumption has each value, before filtering and accepted; None where all draws are one value."""
    found = shapes_of(simulation, name)
    if found is None:
        return None
    edges, before, accepted = (tuple(map(float, each)) for each in (found.edges, found.before, found.accepted))
    shape = Shape(edges, before, accepted, simulation.model.input_forms.get(name, PLAIN))
    return Chart("", "", shape, f"{name}: before filtering pale, accepted as a line", 28.0)


def influence_chart(found: ForecastSensitivity, most: int, title: str = "") -> Chart:
    """Chart the share of a forecast's variance that each assumption explains, in %, the largest on top.

    Bars that may be noise are pale.
    """
    pairs = zip(found.influences[:most], noise(found), strict=False)
    bars = tuple(_share(each.assumption, each.explained, weak.explained) for each, weak in pairs)
    return _bars(title, "Variance explained", "Share of the variance explained, %", bars)


def contribution_chart(found: ForecastSensitivity, most: int, title: str) -> Chart:
    """Chart the squared rank correlation of each assumption, in % of their sum and signed, as Crystal Ball shows it."""
    pairs = zip(found.influences[:most], noise(found), strict=False)
    bars = tuple(_share(each.assumption, each.contribution, weak.correlation) for each, weak in pairs)
    return _bars(title, title, "Squared rank correlation, % of all, signed", bars)


def tornado_chart(found: ForecastSensitivity, most: int, title: str) -> Chart:
    """How far the forecast moves from its base case as one assumption moves alone."""
    base = found.base or 0.0
    bars = tuple(
        Bar(
            bar.assumption,
            tuple((0.0, end - base, look) for end, look in ((bar.low, "light"), (bar.high, "dark")) if end is not None),
        )
        for bar in found.bars[:most]
    )
    units = f", {found.change_units}" if found.change_units else ""
    return _bars(title, title, f"Change{units} (light: at 10 %, dark: at 90 %)", bars, found.change_form)


def shares_chart(figure: Figure) -> Chart:
    """Draw the share of each text, or of yes and no, with its error."""
    shares = shares_of(figure.answer)
    bars = tuple(_share(text or "(empty)", share, pale=False) for text, share in frequent_texts(shares)[0].items())
    return Chart("", "Accepted trials, %", Bars(bars), f"{figure.name}: {figure.said}", 125.0)


def limit_chart(limit: FilterLimit, indexes: list[int], unit: str, form: Form = PLAIN) -> Chart:
    """How the means of some forecasts, which have one unit, change as a limit of a filter moves.

    Args:
        limit: of the filter.
        indexes: of the forecasts.
        unit: theirs.
        form: how changes of them are written.
    """
    lines = tuple(
        Line(
            limit.slopes[index].forecast,
            tuple((p.limit, p.answers[index].change.value, p.answers[index].change.error) for p in limit.points),
        )
        for index in indexes
    )
    upwards = f"Change of the mean{f', {unit}' if unit else ''}"
    across = f"Limit: {limit.filter} {limit.relation}"
    said = f"Change of each mean: {', '.join(line.name for line in lines)}"
    data = Lines(lines, upwards, dots=True, now=limit.limit, from_zero=True, form_upwards=form)
    return Chart("Change of each mean", across, data, said)


def _bars(title: str, what: str, across: str, bars: tuple[Bar, ...], form: Form = PLAIN) -> Chart:
    return Chart(title, across, Bars(bars, form), f"{what}: {', '.join(bar.name for bar in bars)}", 125.0)


def _share(name: str, found: Estimate, pale: bool) -> Bar:
    value = 100.0 * found.value if math.isfinite(found.value) else 0.0
    error = None if found.error is None else 100.0 * found.error
    whisker = None if error is None else (value - error, value + error)
    return Bar(name, ((0.0, value, "light" if pale else "dark"),), whisker)
