"""A run as a figure of matplotlib: every forecast's histogram and cumulative share, with the central range shaded."""

from __future__ import annotations

import textwrap
from importlib.util import find_spec
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.errors import SimulationError
from xlmc.montecarlo.distributions.parameters import show
from xlmc.outputs.histogram import Figure as Drawn
from xlmc.outputs.histogram import figures_of
from xlmc.outputs.sheets.styles import DARK, GRID, INK, LIGHT
from xlmc.outputs.summary import central_text, estimate_text, percent

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["plot"]

_WIDTH, _HEIGHT, _HEAD = 10.0, 2.9, 0.75
"""Lengths in inches: the width of the figure, the heights of a forecast and of the title."""

_POINTS: Final = 1_001
"""Points of a cumulative curve: one for each tenth of a percent, finer than a line is thick."""

_LONGEST: Final = 55

Floats = NDArray[np.float64]


def plot(simulation: RunResult) -> Figure:
    """The figure, one row for each forecast that has a number in an accepted trial: histogram and cumulative share.

    It belongs to no window: `figure.savefig("run.png")` writes it, and a notebook shows it.

    Raises:
        SimulationError: matplotlib is not installed, or there is nothing to draw.
    """
    if find_spec("matplotlib") is None:
        hint = "Install it: pip install 'xlmc[plots]'"
        raise SimulationError("figures need matplotlib, which is not installed", hint=hint)
    drawn = figures_of(simulation)
    if not drawn:
        raise SimulationError("there is nothing to draw: no accepted trial has a number", hint="See the warnings")
    from matplotlib.figure import Figure

    figure = Figure(figsize=(_WIDTH, _HEAD + _HEIGHT * len(drawn)), layout="constrained")
    rows = figure.subplots(len(drawn), 2, squeeze=False, width_ratios=[3, 2])
    figure.suptitle(_title(simulation), color=INK, fontsize=12, fontweight="bold", parse_math=False)
    for (left, right), each in zip(rows, drawn, strict=True):
        _draw_histogram(left, each)
        _draw_cumulative(right, each, simulation)
    return figure


def _title(simulation: RunResult) -> str:
    name = textwrap.shorten(simulation.model.workbook.name, 60, placeholder="…")
    return f"{name}: {simulation.accepted:,} of {simulation.trials:,} trials accepted, seed {simulation.settings.seed}"


def _draw_histogram(axes: Axes, each: Drawn) -> None:
    bins, answer = each.bins, each.answer
    edges = np.append(bins.edges, bins.upper_edges[-1])
    inside = f"central {percent(answer.share)}: {central_text(answer)}"
    axes.stairs(bins.inside + bins.outside, edges, fill=True, color=LIGHT, label="other accepted trials")
    axes.stairs(bins.inside, edges, fill=True, color=DARK, label=inside)
    most = max(1.0, float((bins.inside + bins.outside).max()))  # 0 where all trials lie outside, below and above
    mean = float(_near(each, np.array(answer.mean.value)))
    axes.vlines(mean, 0.0, 1.05 * most, color=INK, linewidth=1.2, label=f"mean: {estimate_text(answer.mean)}")
    axes.set_title(_heading(each), loc="left", color=INK, fontsize=10, fontweight="bold", parse_math=False)
    axes.set_ylabel(f"Trials per {bins.width:g}" + (f" {answer.units}" if answer.units else ""), parse_math=False)
    axes.set_ylim(0, 1.5 * most)
    axes.legend(loc="upper left", fontsize=8, frameon=False, ncols=1)
    if bins.below or bins.above:
        text = f"not drawn: {bins.below:,} below, {bins.above:,} above"
        axes.annotate(text, (0.99, 0.95), xycoords="axes fraction", ha="right", va="top", fontsize=8)
    _dress(axes, each, edges)


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
        axes.axvline(threshold, color="#9C0006", linewidth=1.0, label=f"threshold {show(answer.threshold)}")
        axes.legend(loc="upper left", fontsize=8, frameon=False)
    axes.set_ylim(0, 100)
    axes.set_ylabel("Trials not above, %")
    axes.set_title("Cumulative", loc="left", color=INK, fontsize=10)
    _dress(axes, each, np.array(_ends(each)))


def _ends(each: Drawn) -> tuple[float, float]:
    return float(each.bins.edges[0]), float(each.bins.upper_edges[-1])


def _near(each: Drawn, values: Floats) -> Floats:
    """The values, moved to at most the axis's own length outside it: matplotlib fails with the largest doubles."""
    low, high = _ends(each)
    return values.clip(low - (high - low), high + (high - low))


def _heading(each: Drawn) -> str:
    return textwrap.shorten(each.name, _LONGEST, placeholder="…")


def _dress(axes: Axes, each: Drawn, edges: np.typing.NDArray[np.float64]) -> None:
    axes.set_xlim(float(edges[0]), float(edges[-1]))
    axes.set_xlabel(each.answer.units or "value", parse_math=False)
    axes.grid(color=GRID, linewidth=0.6)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
    axes.tick_params(colors=INK, labelsize=9)
