"""The figure of a study: errors against work in logarithms, and the front of the methods that nothing beats."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import numpy as np

from xlmc.methods import STATISTICS, Curve, Study
from xlmc.methods.need import worst
from xlmc.methods.recommendation import seconds_text
from xlmc.report.methods.tables import floor_of, slope_text

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["STYLES", "draw", "front_of"]

# Okabe and Ito's palette; the markers tell the methods apart without colour.
STYLES: Final[dict[str, tuple[str, str]]] = {
    "mc": ("#0072B2", "o"),
    "lhs": ("#E69F00", "s"),
    "sobol": ("#009E73", "^"),
    "grid": ("#D55E00", "D"),
    "surrogate": ("#CC79A7", "P"),
    "mc/jit": ("#56B4E9", "v"),
    "mc/float32": ("#882255", "<"),
    "mc/formulas": ("#999999", "X"),
    "taylor-1": ("#000000", "1"),
    "taylor-2": ("#000000", "2"),
}
_OTHER: Final = ("#444444", ".")
_GREY: Final = "#6B7785"
_AXES: Final = {"seconds": "time of a run, s", "evaluations": "evaluations of the workbook"}


def draw(study: Study, against: str = "seconds") -> Figure:
    """Six panels: four statistics, the accepted share, and the front.

    Args:
        study: what was measured.
        against: `seconds` or `evaluations`.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(14.5, 9.6), layout="constrained")
    axes = figure.subplots(2, 3, sharex=True)
    for axis, (statistic, name) in zip(axes.flat, STATISTICS.items(), strict=False):
        _statistic(axis, study, statistic, name, against)
    _acceptance(axes[1, 1], study, against)
    _front(axes[1, 2], study, against)
    for axis in axes[1]:
        axis.set_xlabel(_AXES[against])
    for axis in axes.flat:
        _dressed(axis)
    handles: dict[str, Any] = {}
    for axis in axes.flat:
        for handle, label in zip(*axis.get_legend_handles_labels(), strict=True):
            handles.setdefault(label, handle)
    figure.legend([*handles.values()], [*handles], loc="outside lower center", ncols=4, frameon=False)
    figure.suptitle(_title(study), fontsize=12)
    return figure


def _title(study: Study) -> str:
    shortest, longest = study.ladder[0], study.ladder[-1]
    return (
        f"{study.model.workbook.name}: error against work, runs of {shortest:,} to {longest:,} trials\n"
        f"root mean square over up to {study.replicates} runs and {len(study.model.forecasts)} forecasts, against "
        f"{study.reference.trials:,} reference trials; slopes against the trials"
    )


def _statistic(axis: Axes, study: Study, statistic: str, name: str, against: str) -> None:
    for curve in study.every:
        error = [100.0 * rung.shares[statistic] for rung in curve.rungs]
        if np.isfinite(error).any():
            _line(axis, curve, [float(getattr(rung, against)) for rung in curve.rungs], error)
    floor = 100.0 * floor_of(study, statistic)
    if np.isfinite(floor) and floor > 0.0:
        axis.axhline(floor, color=_GREY, lw=1.2, ls=":", label="the reference's own error")
    axis.set_title(f"{name}: error, % of SD", loc="left", fontsize=11)


def _line(axis: Axes, curve: Curve, across: list[float], error: list[float]) -> None:
    colour, marker = STYLES.get(curve.method.key, _OTHER)
    if not all(rung.measured for rung in curve.rungs):  # its time is of another order, and would squeeze the rest
        last = curve.rungs[-1]
        label = f"{curve.method.name}: not drawn, {seconds_text(last.seconds)} for {last.budget:,} trials"
        axis.plot([], [], ls="none", color=colour, marker=marker, ms=6.5, label=label)
        return
    once = len(curve.rungs) == 1
    label = curve.method.name if once else f"{curve.method.name} (slope {slope_text(curve.slope('mean', 'budget'))})"
    shape: dict[str, Any] = {"ls": "none", "ms": 11, "mew": 1.6} if once else {"ls": "-", "ms": 6.5, "mew": 1.0}
    axis.plot(across, error, color=colour, marker=marker, lw=1.5, label=label, **shape)


def _acceptance(axis: Axes, study: Study, against: str) -> None:
    known = study.reference.acceptance
    drawn = False
    for curve in study.every:
        found = [
            (float(getattr(rung, against)), 100.0 * rung.acceptance.value / known.value)
            for rung in curve.rungs
            if rung.acceptance is not None and rung.acceptance.value > 0.0
        ]
        if found:
            drawn = True
            _line(axis, curve, [x for x, _ in found], [y for _, y in found])
    if known.error:
        axis.axhline(100.0 * known.error / known.value, color=_GREY, lw=1.2, ls=":")
    axis.set_title("Accepted share: error, % of it", loc="left", fontsize=11)
    if not drawn:
        _say(axis, "every trial is accepted")


def _front(axis: Axes, study: Study, against: str) -> None:
    shown = [curve for curve in study.every if all(rung.measured for rung in curve.rungs)]
    points = [
        (curve, float(getattr(rung, against)), error)
        for curve in shown
        for rung in curve.rungs
        if np.isfinite(error := worst(study, curve, rung))
    ]
    for curve, across, error in points:
        colour, marker = STYLES.get(curve.method.key, _OTHER)
        axis.plot(across, error, marker, color=colour, ms=11 if len(curve.rungs) == 1 else 6.5, ls="none")
    front = front_of([(across, error) for _, across, error in points])
    if front:
        axis.step([x for x, _ in front], [y for _, y in front], where="post", color=_GREY, lw=1.4, label="Pareto front")
    axis.axhline(1.0, color="#B00020", lw=1.2, label=f"the accuracy asked for, {study.accuracy[0]}")
    axis.set_title("Worst number: error over the one asked for", loc="left", fontsize=11)


def front_of(points: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """The points than which none is better in both: least work first.

    >>> front_of([(1.0, 5.0), (2.0, 6.0), (3.0, 1.0)])
    [(1.0, 5.0), (3.0, 1.0)]
    """
    found: list[tuple[float, float]] = []
    for point in sorted(points):
        if not found or point[1] < found[-1][1]:
            found.append(point)
    return found


def _dressed(axis: Axes) -> None:
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    axis.set(xscale="log", yscale="log")
    axis.grid(which="major", color="#D5DBE3", lw=0.7)
    axis.set_axisbelow(True)
    for side in ("top", "right"):
        axis.spines[side].set_visible(False)
    axis.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5), numticks=12))
    for ticks in (axis.xaxis, axis.yaxis):
        ticks.set_major_formatter(FuncFormatter(_tick))
        ticks.set_minor_formatter(NullFormatter())


def _tick(value: float, _: float) -> str:
    return f"{value:,.12g}" if 1e-4 < value < 1e6 else f"{value:.0e}"


def _say(axis: Axes, text: str) -> None:
    axis.text(0.5, 0.5, text, transform=axis.transAxes, ha="center", color=_GREY)
