"""Charts on axes of matplotlib, from the same description that the SVG drawings and the sheets are made from."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from xlmc.outputs.document.colours import DARK, GRID, INK, LIGHT
from xlmc.outputs.document.parts import Bars, Chart, Lines, Shape

if TYPE_CHECKING:
    from collections.abc import Mapping

    from matplotlib.axes import Axes

__all__ = ["TITLE", "draw_on", "dress", "short"]

_LONGEST: Final = 55
_FILLS: Final = {"dark": DARK, "light": LIGHT}
TITLE: Final[Mapping[str, Any]] = {
    "loc": "left",
    "color": INK,
    "fontsize": 10,
    "fontweight": "bold",
    "parse_math": False,
}
"""How titles of axes look."""


def draw_on(axes: Axes, chart: Chart) -> None:
    """Draw a chart on axes, with its title and the names of both; the numbers beside them are matplotlib's own."""
    match chart.data:
        case Bars():
            _bars(axes, chart.data)
        case Lines():
            _lines(axes, chart.data)
        case Shape():
            _shape(axes, chart.data)
    dress(axes, chart.across_and_looks)
    if chart.title:
        axes.set_title(chart.title, **TITLE)


def short(name: str) -> str:
    """Cut a long name."""
    return textwrap.shorten(name, _LONGEST, placeholder="…")


def dress(axes: Axes, below: str) -> None:
    """Dress axes alike: a grid behind, no frame, small labels."""
    axes.set_xlabel(below, parse_math=False)
    axes.grid(color=GRID, linewidth=0.6)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
    axes.tick_params(colors=INK, labelsize=9)


def _bars(axes: Axes, shown: Bars) -> None:
    places = np.arange(len(shown.bars))[::-1]
    for place, bar in zip(places, shown.bars, strict=True):
        for start, end, look in bar.pieces:
            axes.barh(place, end - start, left=start, color=_FILLS[look])
        if bar.whisker is not None:
            axes.plot(bar.whisker, (place, place), color=INK, linewidth=1.0, marker="|")
    starts = {start for bar in shown.bars for start, _, _ in bar.pieces}
    axes.axvline(starts.pop() if len(starts) == 1 else 0.0, color=INK, linewidth=1.0)
    axes.set_yticks(places, [short(bar.name) for bar in shown.bars], parse_math=False)


def _lines(axes: Axes, shown: Lines) -> None:
    for line in shown.all:
        across, upwards = zip(*((point[0], point[1]) for point in line.points), strict=True)
        if line is shown.cloud:
            axes.plot(across, upwards, ".", color=DARK, markersize=2.5, alpha=0.5, label=line.name)
            continue
        [drawn] = axes.plot(across, upwards, marker="o" if shown.dots else "", markersize=4, label=line.name)
        errors = [(*point[:2], point[2]) for point in line.points if len(point) > 2 and point[2]]
        for x, y, error in errors:
            axes.plot((x, x), (y - error, y + error), color=drawn.get_color(), linewidth=0.8)
    if shown.now is not None:
        axes.axvline(shown.now, color=INK, linewidth=1.0, linestyle="--")
    if shown.share:
        axes.set_ylim(0.0, 1.0)
    elif shown.from_zero:
        axes.axhline(0.0, color=GRID, linewidth=1.0)
    axes.set_ylabel(shown.upwards, parse_math=False)
    if shown.lines:
        axes.legend(loc="best", fontsize=8, frameon=False)


def _shape(axes: Axes, shown: Shape) -> None:
    axes.stairs(shown.before, shown.edges, fill=True, color=LIGHT, label="before the filters")
    axes.stairs(shown.accepted, shown.edges, color=INK, linewidth=1.6, label="accepted")
    axes.set_ylabel("Share of the draws")
    axes.legend(loc="best", fontsize=8, frameon=False)
