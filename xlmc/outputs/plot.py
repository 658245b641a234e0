"""A run as a figure of matplotlib: histograms and cumulative shares, and one picture each of what else is asked.

Numbers beside an axis have the form of the forecast's cell: a date, a percentage, an amount of money. Yes/no answers
and texts have a bar for each, and no curve, range or rank: the order of their numbers says nothing. Where evidence
weights the trials, each picture shows them as the statistics count them.
"""

from __future__ import annotations

import io
import math
import textwrap
from collections.abc import Callable, Mapping
from dataclasses import replace
from importlib.util import find_spec
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.analysis.studies.sensitivity.one_at_a_time import one_at_a_time
from xlmc.errors import SimulationError
from xlmc.montecarlo.definitions.forms import PLAIN, Form
from xlmc.montecarlo.definitions.number_styles import in_style_of
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.distributions.spelling import did_you_mean, name_key
from xlmc.montecarlo.model.keywords import forecast_named
from xlmc.montecarlo.number_text import count_text, counted_text, in_signs, percent, signs, styled_text
from xlmc.montecarlo.statistics import rank_correlation
from xlmc.outputs.document.axes_drawing import TITLE, draw_on, dress, short
from xlmc.outputs.document.colours import DARK, INK, LIGHT
from xlmc.outputs.document.drawn_trials import drawn_trials
from xlmc.outputs.document.parts import Bar, Bars, Chart, Line, Lines, Shape
from xlmc.outputs.filter_effect import shapes
from xlmc.outputs.histogram import Figure as Drawn
from xlmc.outputs.histogram import figures_of, short_name
from xlmc.outputs.summary import answer_text, central_text

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure

    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["KINDS", "notebook_figure", "plot"]

_WIDTH, _HEIGHT, _HEAD = 10.0, 2.9, 0.75
"""Lengths in inches: the width of the figure, the heights of a forecast and of the title."""

_POINTS: Final = 1_001
"""Points of a cumulative curve: one for each tenth of a percent, finer than a line is thick."""

_BARS, _DOTS = 12, 4_000
"""The most bars of a tornado, and dots of a scatter."""

_STEPS, _NAMES = 3, 8
"""Steps between dates or amounts of money, and texts, that an axis has room for."""

Floats = NDArray[np.float64]


@in_style_of("settings.number_style")
def plot(simulation: RunResult, name: str | None = None, kind: str | None = None, ax: Axes | None = None) -> Figure:
    """Draw a run.

    The figure belongs to no window: `figure.savefig("run.png")` writes it, and a notebook shows it.

    Args:
        simulation: the finished run.
        name: of a forecast, of an assumption before and after filtering, or None: all forecasts where no kind is named,
            otherwise the first that can be drawn.
        kind: one of `KINDS`; None for a histogram and the cumulative share side by side.
        ax: to draw into; None for a figure of its own.

    Raises:
        SimulationError: matplotlib is not installed, there is no such kind or name, or there is nothing to draw.
    """
    if find_spec("matplotlib") is None:
        hint = 'Install it: pip install "matplotlib>=3.8"'
        raise SimulationError("figures need matplotlib, which is not installed", hint=hint)
    if kind is None and ax is None:
        return _overview(simulation, name)
    kind = kind or "histogram"
    if kind not in KINDS:
        raise SimulationError(f"{kind!r} is not a kind of picture", hint=f"Choose one of {', '.join(KINDS)}")
    if ax is None:
        ax = notebook_figure(_WIDTH * 0.7, _HEAD + 1.3 * _HEIGHT).subplots()
    KINDS[kind](ax, simulation, name)
    return ax.get_figure(root=True) or ax.figure  # type: ignore[return-value]  # axes stand in a figure


def notebook_figure(width: float, height: float) -> Figure:
    """Make an empty figure, in inches, that a notebook shows as a picture without being told to."""
    from matplotlib.figure import Figure

    class Shown(Figure):
        """A figure that knows how to be a picture."""

        def _repr_png_(self) -> bytes:
            """Return the picture that a notebook shows."""
            stream = io.BytesIO()
            self.savefig(stream, format="png", dpi=110)
            return stream.getvalue()

    return Shown(figsize=(width, height), layout="constrained")


def _overview(simulation: RunResult, name: str | None) -> Figure:
    """One row for each forecast that has a number in an accepted trial: histogram and cumulative share."""
    drawn = figures_of(simulation, None if name is None else [forecast_named(simulation.model, name)])
    if not drawn:
        raise _nothing()
    figure = notebook_figure(_WIDTH, _HEAD + _HEIGHT * len(drawn))
    rows = figure.subplots(len(drawn), 2, squeeze=False, width_ratios=[3, 2])
    figure.suptitle(_title(simulation), color=INK, fontsize=12, fontweight="bold", parse_math=False)
    for (left, right), each in zip(rows, drawn, strict=True):
        _draw_histogram(left, each)
        if each.answer.is_share:
            right.set_axis_off()  # a step for each answer, in an order that says nothing
        else:
            _draw_cumulative(right, each, simulation)
    return figure


def _nothing() -> SimulationError:
    return SimulationError("there is nothing to draw: no accepted trial has a number", hint="See the warnings")


def _one(simulation: RunResult, name: str | None) -> Drawn:
    """Return the forecast of a name, or the first that can be drawn."""
    figures = figures_of(simulation, None if name is None else [forecast_named(simulation.model, name)])
    if not figures:
        raise _nothing()
    return figures[0]


def _number(simulation: RunResult, name: str | None, kind: str, *, shares: bool = False) -> Drawn:
    """Return the same among forecasts that are numbers, which this kind of picture needs.

    Args:
        simulation: the run.
        name: of a forecast, or None.
        kind: of the picture.
        shares: whether yes/no answers count as numbers, 1 and 0.

    Raises:
        SimulationError: the forecast has another kind of answers, or all have.
    """
    figures = figures_of(simulation, None if name is None else [forecast_named(simulation.model, name)])
    if not figures:
        raise _nothing()
    fit = [each for each in figures if not each.answer.categories and (shares or each.answer.yes is None)]
    if not fit:
        what = "texts" if figures[0].answer.categories else "yes or no"
        hint = 'Draw its shares: kind="histogram"'
        raise SimulationError(f"The answers of {figures[0].answer.name!r} are {what}: no {kind} shows them", hint=hint)
    return fit[0]


def _histogram(axes: Axes, simulation: RunResult, name: str | None) -> None:
    _draw_histogram(axes, _one(simulation, name))


def _cumulative(axes: Axes, simulation: RunResult, name: str | None) -> None:
    each = _number(simulation, name, "cumulative curve")
    _draw_cumulative(axes, each, simulation)
    axes.set_title(f"{_heading(each)}: cumulative", **TITLE)


def _tornado(axes: Axes, simulation: RunResult, name: str | None) -> None:
    """Each assumption moved alone from its 10th to its 90th percentile, the widest bar on top."""
    each, model = _number(simulation, name, "tornado", shares=True), simulation.model
    index = next(i for i, forecast in enumerate(model.forecasts) if forecast.name == each.answer.name)
    result = one_at_a_time(model, [a.name for a in model.live], [index], _BARS)
    bars, base = [bar for bar in result.bars[index] if bar.low is not None and bar.high is not None], result.base[index]
    if not bars or base is None:
        hint = "Look at the base case: xlmc check says which cell is an error there"
        raise SimulationError(f"{each.answer.name!r} has no number at the base case", hint=hint)
    spans = (
        Bar(bar.assumption, ((base, float(bar.low or 0.0), "light"), (base, float(bar.high or 0.0), "dark")))
        for bar in bars
    )
    title = f"{_heading(each)}: one assumption at a time, no filter"
    looks = (("light", "with the assumption at its 10th percentile"), ("dark", "at its 90th"))
    draw_on(axes, Chart(title, each.answer.units or "value", Bars(tuple(spans), looks=looks), title))
    _write_numbers(axes.xaxis, each)


def _scatter(axes: Axes, simulation: RunResult, name: str | None) -> None:
    """Draw the forecast over the draws of the assumption that it follows most; of weighted trials an even choice."""
    each, kept = _number(simulation, name, "scatter", shares=True), simulation.kept_inputs
    weighting = simulation.weighting
    rows = slice(kept) if weighting is None else weighting.even_rows(kept)
    answer = simulation.results[each.answer.name].column[rows]
    known = ~np.isnan(answer)
    draws = {other: column[rows][known] for other, column in simulation.inputs.items()}
    answer = answer[known]
    ranks = {other: rank_correlation(x, answer).value for other, x in draws.items()} if answer.size > 2 else {}
    ranks = {other: rank for other, rank in ranks.items() if not math.isnan(rank)}
    if answer.size > 2 and np.all(answer == answer[0]):
        raise SimulationError(f"{each.answer.name!r} is the same in all accepted trials", hint="It follows nothing")
    if not ranks:
        raise SimulationError(f"no assumption was drawn that {each.answer.name!r} could follow", hint="Run more trials")
    most = max(ranks, key=lambda other: abs(ranks[other]))
    units = next(a.units for a in simulation.model.assumptions if a.name == most)
    cloud = Line("Accepted trials", tuple(zip(draws[most][:_DOTS].tolist(), answer[:_DOTS].tolist(), strict=True)))
    upwards = ", ".join(filter(None, (each.name, each.answer.units)))
    title = f"{_heading(each)}: rank correlation {styled_text(ranks[most], '.2f')}"
    draw_on(axes, Chart(title, ", ".join(filter(None, (most, units))), Lines((), upwards, cloud=cloud), title))
    _write_numbers(axes.yaxis, each)


def _trend(axes: Axes, simulation: RunResult, name: str | None) -> None:
    """Central ranges of the forecasts that have the units of the first, and its kind of numbers, side by side."""
    first = _number(simulation, name, "trend")
    rows = [
        each for each in figures_of(simulation) if not each.answer.is_share and _measure_of(each) == _measure_of(first)
    ]
    places = np.arange(len(rows))
    shades = {0.95: "#DCE6F1", 0.8: "#B8CCE4", first.answer.share: DARK}
    for share, shade in sorted(shades.items(), reverse=True):
        ends = [simulation.results[each.answer.name].central(share) for each in rows]
        low, high = (np.array([end[side].value for end in ends]) for side in (0, 1))
        axes.bar(places, high - low, bottom=low, width=0.5, color=shade, label=f"central {percent(share)}")
    means = [each.answer.mean.value for each in rows]
    axes.plot(places, means, "o", color=INK, markersize=4, label="mean")
    axes.set_xticks(places, [textwrap.fill(each.name, 18) for each in rows], parse_math=False)
    axes.use_sticky_edges = False
    axes.margins(y=0.05)
    axes.set_title("Central ranges", **TITLE)
    axes.legend(loc="best", fontsize=8, frameon=False)
    dress(axes, "")
    axes.set_ylabel(first.answer.units or "value", parse_math=False)
    _write_numbers(axes.yaxis, first)


def _measure_of(each: Drawn) -> tuple[object, ...]:
    """Return what the numbers of two forecasts must share to stand on one axis."""
    return each.answer.units, *each.answer.form.axis


def _before_after(axes: Axes, simulation: RunResult, name: str | None) -> None:
    """Draw an assumption before and after filtering: the one that was asked for, or that the filters move most."""
    names = {name_key(each): each for each in simulation.inputs}
    if name is not None and name_key(name) not in names:
        raise SimulationError(f"there is no assumption {name!r}", hint=did_you_mean(name, names.values()))
    if not simulation.accepted or not names:
        raise _nothing()
    weights = None if simulation.weighting is None else simulation.weighting.weights[: simulation.kept_inputs]
    chosen = names[name_key(name)] if name else max(simulation.inputs, key=lambda each: _moved(simulation, each))
    result = shapes(simulation.prior[chosen], simulation.inputs[chosen], weights)
    if result is None:
        raise SimulationError(f"the draws of {chosen!r} have no shape", hint="They are one value, or too far apart")
    edges, before, accepted = (tuple(map(float, each)) for each in (result.edges, result.before, result.accepted))
    units = next(a.units for a in simulation.model.assumptions if a.name == chosen)
    title = f"{short(chosen)}, before and after the filters"
    draw_on(axes, Chart(title, units or "value", Shape(edges, before, accepted), title))
    _write_form(axes.xaxis, simulation.model.input_forms.get(chosen, PLAIN))


def _moved(simulation: RunResult, name: str) -> float:
    """How far apart the distributions before and after filtering are: the largest difference of cumulative shares."""
    before, weighting = np.sort(simulation.prior[name]), simulation.weighting
    after = simulation.inputs[name]
    after = np.sort(after if weighting is None else after[weighting.even_rows(after.size)])
    shares = np.searchsorted(after, before, "right") / after.size
    return float(np.abs(shares - np.arange(1, before.size + 1) / before.size).max())


def _drawing(axes: Axes, simulation: RunResult, name: str | None) -> None:
    """Draw accepted trials over the curves of the workbook's drawing; the name has no effect."""
    chart = drawn_trials(simulation)
    if chart is None:
        hint = "Its chart of points and lines marks the base case by one point of two assumptions or forecasts"
        raise SimulationError("the workbook has no drawing that trials can be drawn over", hint=hint)
    draw_on(axes, replace(chart, title="Trials over the chart"))


KINDS: Final[Mapping[str, Callable[[Axes, RunResult, str | None], None]]] = {
    "histogram": _histogram,
    "cumulative": _cumulative,
    "tornado": _tornado,
    "scatter": _scatter,
    "trend": _trend,
    "before-after": _before_after,
    "drawing": _drawing,
}
"""Kind of picture -> what draws it."""


def _title(simulation: RunResult) -> str:
    name = textwrap.shorten(simulation.model.workbook.name, 60, placeholder="…")
    return (
        f"{name}: {count_text(simulation.accepted)} of {count_text(simulation.trials)} trials "
        f"accepted, seed {simulation.settings.seed}"
    )


def _write_numbers(axis: Axis, each: Drawn) -> None:
    """Write the numbers beside an axis as the cell of the forecast shows them."""
    if each.answer.yes is not None:
        axis.set_ticks([0.0, 1.0], ["no", "yes"])
    else:
        _write_form(axis, each.answer.form)


def _write_form(axis: Axis, form: Form) -> None:
    from matplotlib.ticker import MaxNLocator, MultipleLocator

    if form.kind not in (Kind.NUMBER, Kind.WHOLE):
        axis.set_major_locator(MaxNLocator(_STEPS))
        if form.kind is Kind.DATE:
            low, high = axis.get_view_interval()
            axis.set_major_locator(MultipleLocator(form.rounded_width(max((high - low) / _STEPS, 1e-5))))
        pair = signs()  # matplotlib asks for the texts later
        axis.set_major_formatter(lambda value, _: _tick(form, value, pair))


def _tick(form: Form, value: float, pair: tuple[str, str]) -> str:
    with in_signs(*pair):
        return form.number(float(f"{value:.12g}")).replace("$", r"\$")  # which would begin a formula


def _draw_histogram(axes: Axes, each: Drawn) -> None:
    bins, answer = each.bins, each.answer
    edges = np.append(bins.edges, bins.upper_edges[-1])
    most = max(1.0, float((bins.inside + bins.outside).max()))  # 0 where all trials lie outside, below and above
    if answer.is_share:
        axes.stairs(bins.inside + bins.outside, edges, fill=True, color=DARK, label=_shares_text(each))
    else:
        inside = f"central {percent(answer.share)}: {central_text(answer)}"
        axes.stairs(bins.inside + bins.outside, edges, fill=True, color=LIGHT, label="other accepted trials")
        axes.stairs(bins.inside, edges, fill=True, color=DARK, label=inside.replace("$", r"\$"))
        mean = float(_near(each, np.array(answer.mean.value)))
        text = f"mean: {answer_text(answer)}".replace("$", r"\$")
        axes.vlines(mean, 0.0, 1.05 * most, color=INK, linewidth=1.2, label=text)
    axes.set_title(_heading(each), **TITLE)
    per = "" if bins.names is not None else f" per {bins.form.width(bins.width)}"
    per += f" {answer.units}" if per and answer.units else ""
    axes.set_ylabel(f"Trials{per}", parse_math=False)
    axes.set_ylim(0, 1.5 * most)
    axes.legend(loc="upper left", fontsize=8, frameon=False, ncols=1).set_in_layout(False)
    if bins.below or bins.above:
        text = f"not drawn: {count_text(bins.below)} below, {count_text(bins.above)} above"
        if answer.categories:
            text = f"not drawn: {counted_text(bins.above, 'trial')} of rarer texts"
        axes.annotate(text, (0.99, 0.95), xycoords="axes fraction", ha="right", va="top", fontsize=8)
    _dress(axes, each, edges)


def _shares_text(each: Drawn) -> str:
    """Return the share of yes, or of the most frequent text, in words."""
    of = "yes" if each.answer.yes is not None else short_name(each.answer.unit)
    return f"{of}: {answer_text(each.answer)}".replace("$", r"\$")


def _draw_cumulative(axes: Axes, each: Drawn, simulation: RunResult) -> None:
    answer, share = each.answer, np.linspace(0.0, 1.0, _POINTS)
    values = simulation.results[answer.name].sample.quantile(share)
    low, high = _near(each, np.array([answer.low.value, answer.high.value]))
    axes.axvspan(low, high, color=LIGHT, alpha=0.45, linewidth=0)
    axes.plot(_near(each, values), 100.0 * share, color=DARK, linewidth=1.6)
    tail = 50.0 * (1.0 - answer.share)
    axes.hlines([tail, 100.0 - tail], *_ends(each), color=INK, linewidth=0.7, linestyle=":")
    if answer.threshold is not None:
        threshold = float(_near(each, np.array(answer.threshold)))
        text = f"threshold {answer.form.number(answer.threshold)}".replace("$", r"\$")
        axes.axvline(threshold, color="#9C0006", linewidth=1.0, label=text)
        axes.legend(loc="upper left", fontsize=8, frameon=False)
    axes.set_ylim(0, 100)
    axes.set_ylabel("Trials not above, %")
    axes.set_title("Cumulative", loc="left", color=INK, fontsize=10)
    _dress(axes, each, np.array(_ends(each)))


def _ends(each: Drawn) -> tuple[float, float]:
    return float(each.bins.edges[0]), float(each.bins.upper_edges[-1])


def _near(each: Drawn, values: Floats) -> Floats:
    """Move the values to at most the axis's own length outside it: matplotlib fails with the largest doubles."""
    low, high = _ends(each)
    return values.clip(low - (high - low), high + (high - low))


def _heading(each: Drawn) -> str:
    return short(each.name)


def _dress(axes: Axes, each: Drawn, edges: Floats) -> None:
    axes.set_xlim(float(edges[0]), float(edges[-1]))
    dress(axes, each.answer.units or "value")
    if each.answer.is_share:
        ends = each.bins.edges + 0.5 * each.bins.width
        named = [(x, text) for x, text in zip(ends.tolist(), each.bins.labels, strict=True) if text]
        named = named[:: -(-len(named) // _NAMES)]
        axes.set_xticks([x for x, _ in named], [textwrap.fill(text, 16) for _, text in named], parse_math=False)
        axes.set_xlabel(each.axis, parse_math=False)
    else:
        _write_numbers(axes.xaxis, each)
